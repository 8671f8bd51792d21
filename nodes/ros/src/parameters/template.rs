use super::Declared;
use r2r::ParameterValue as V;
use servo::config::parameter_file;

/// A parameter file of a node with every default and its meaning, to start from: those of `config/`.
#[must_use]
pub fn yaml_template(node: &str, declared: &[Declared]) -> String {
    let head = format!("# Parameters of {node}, with their defaults. Generated from what the node declares.\n");
    let comment = |parameter: &Declared| {
        let allowed = match parameter.range {
            Some((min, max)) => format!("{min} to {max}; "),
            None if !parameter.choices.is_empty() => format!("{}; ", parameter.choices.join(", ")),
            None => String::new(),
        };
        let change = if parameter.live { "live" } else { "at start" };
        format!("{} ({allowed}{change})", parameter.description)
    };
    parameter_file(&head, declared.iter().map(|p| (p.name.as_str(), Some(comment(p)), value(&p.default))))
}

fn value(value: &V) -> String {
    match value {
        V::Bool(b) => b.to_string(),
        V::Integer(i) => i.to_string(),
        V::Double(x) => format!("{x:?}"),
        V::String(s) => format!("{s:?}"),
        V::StringArray(v) => format!("{v:?}"),
        V::DoubleArray(v) => format!("{v:?}"),
        other => unreachable!("no node declares a {}", other.type_name()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{device_node, follower_node, recorder::RecorderOptions};

    #[test]
    fn levels_are_opened_once() {
        let declared = ["a", "b.c", "b.d", "e"].map(|name| Declared::fixed(name, V::Double(1.0), "meaning"));
        let text = yaml_template("n", &declared);
        let lines: Vec<&str> = text.lines().filter(|l| !l.trim_start().starts_with('#')).collect();
        assert_eq!(lines[2..], ["    a: 1.0", "    b:", "      c: 1.0", "      d: 1.0", "    e: 1.0"]);
    }

    /// Rewrites the files when `UPDATE_GENERATED` is set, otherwise compares.
    #[test]
    fn the_committed_templates_are_fresh() {
        let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../../config");
        for (node, declared) in [
            ("haptic_device", device_node::declared()),
            ("haptic_follower", follower_node::declared()),
            ("haptic_recorder", RecorderOptions::declared()),
        ] {
            let text = yaml_template(node, &declared);
            let file = folder.join(format!("{node}.param.yaml"));
            if std::env::var_os("UPDATE_GENERATED").is_some() {
                std::fs::write(&file, &text).unwrap();
            }
            let committed = std::fs::read_to_string(&file).unwrap_or_default();
            assert!(
                committed == text,
                "{node}.param.yaml is stale: UPDATE_GENERATED=1 cargo test -p cspace_haptics fresh"
            );
        }
    }
}
