use crate::parameters::{Declared, ParameterServer};
use crate::{Failure, Outcome};
use bag::{BagOptions, Compression};
use r2r::ParameterValue as V;
use std::path::PathBuf;
use std::time::Duration;

/// What to record and where.
#[derive(Clone, Debug)]
pub struct RecorderOptions {
    /// The bag's folder; it must not exist yet.
    pub output: PathBuf,
    /// Topics to record, absolute names; empty: all of `nodes`.
    pub topics: Vec<String>,
    /// Nodes whose topics are recorded, absolute names.
    pub nodes: Vec<String>,
    /// Every topic there is.
    pub all: bool,
    /// How the bag is written.
    pub bag: BagOptions,
}

impl RecorderOptions {
    /// The recorder's parameters.
    #[must_use]
    pub fn declared() -> Vec<Declared> {
        vec![
            Declared::fixed("output", V::String(String::new()), "folder of the bag to write; must not exist yet"),
            Declared::fixed("topics", V::StringArray(Vec::new()), "topics to record; empty: all topics of `nodes`"),
            Declared::fixed(
                "nodes",
                V::StringArray(vec!["haptic_servo".into()]),
                "nodes whose topics are recorded, with /diagnostics, when `topics` is empty",
            ),
            Declared::fixed("all", V::Bool(false), "record every topic that there is or will be"),
            Declared::fixed("compression", V::String("zstd".into()), "compression of chunks").one_of(&["zstd", "none"]),
            Declared::fixed("split_size_mb", V::Double(0.0), "a new file after so many MB; 0: never").within(0.0, 1e6),
            Declared::fixed("split_duration", V::Double(600.0), "a new file after so many seconds; 0: never")
                .within(0.0, 1e6),
            Declared::fixed("flush_interval", V::Double(0.4), "seconds that a kill -9 can cost at most")
                .within(0.02, 10.0),
        ]
    }

    /// The options as the parameters have them; relative names are taken in `namespace`.
    ///
    /// # Errors
    /// If there is no output folder.
    pub fn from_parameters(parameters: &ParameterServer, namespace: &str) -> Outcome<Self> {
        let output = parameters.text("output");
        if output.is_empty() {
            return Err(Failure::new("parameter `output` is not set: name a new folder, for example -p output:=bag"));
        }
        let absolute = |names: Vec<String>| names.iter().map(|n| absolute_name(namespace, n)).collect::<Vec<_>>();
        let seconds = |name: &str| Duration::from_secs_f64(parameters.number(name));
        let megabytes = parameters.number("split_size_mb");
        let bag = BagOptions {
            compression: if parameters.text("compression") == "none" {
                Compression::None
            } else {
                Compression::Zstd(1)
            },
            flush_interval: seconds("flush_interval"),
            max_file_size: (megabytes > 0.0).then_some((megabytes * 1e6) as u64),
            max_file_duration: Some(seconds("split_duration")).filter(|d| !d.is_zero()),
            ros_distro: std::env::var("ROS_DISTRO").unwrap_or_default(),
            ..BagOptions::default()
        };
        Ok(Self {
            output: PathBuf::from(output),
            topics: absolute(parameters.texts("topics")),
            nodes: absolute(parameters.texts("nodes")),
            all: parameters.switch("all"),
            bag,
        })
    }

    /// Whether a topic is to be recorded.
    #[must_use]
    pub fn wants(&self, topic: &str) -> bool {
        if self.all {
            return true;
        }
        if !self.topics.is_empty() {
            return self.topics.iter().any(|t| t == topic);
        }
        topic == "/diagnostics"
            || self.nodes.iter().any(|n| topic.strip_prefix(n.as_str()).is_some_and(|r| r.starts_with('/')))
    }
}

/// A name as the graph has it.
#[must_use]
pub fn absolute_name(namespace: &str, name: &str) -> String {
    if name.starts_with('/') { name.to_owned() } else { format!("{}/{name}", namespace.trim_end_matches('/')) }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn options(topics: &[&str]) -> RecorderOptions {
        RecorderOptions {
            output: "x".into(),
            topics: topics.iter().map(|t| (*t).to_owned()).collect(),
            nodes: vec!["/left/haptic_servo".into()],
            all: false,
            bag: BagOptions::default(),
        }
    }

    #[test]
    fn a_node_is_its_topics_and_no_namesake() {
        let o = options(&[]);
        assert!(o.wants("/left/haptic_servo/ticks") && o.wants("/diagnostics"));
        assert!(!o.wants("/left/haptic_servo2/ticks") && !o.wants("/right/haptic_servo/ticks"));
    }

    #[test]
    fn named_topics_are_recorded_alone() {
        let o = options(&["/a"]);
        assert!(o.wants("/a") && !o.wants("/left/haptic_servo/ticks") && !o.wants("/diagnostics"));
    }

    #[test]
    fn relative_names_are_those_of_the_namespace() {
        assert_eq!(absolute_name("/", "a/b"), "/a/b");
        assert_eq!(absolute_name("/left", "a"), "/left/a");
        assert_eq!(absolute_name("/left", "/a"), "/a");
    }
}
