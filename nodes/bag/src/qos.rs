use std::fmt::Write as _;

/// The part of a quality-of-service profile that bags carry.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Qos {
    /// `true`: keep the last `depth`; `false`: keep all.
    pub keep_last: bool,
    /// Queue depth.
    pub depth: u32,
    /// Reliable, else best effort.
    pub reliable: bool,
    /// Transient local (a late joiner gets the last messages), else volatile.
    pub transient_local: bool,
}

impl Qos {
    /// Reliable, volatile, the last ten: the default of ROS 2.
    pub const RELIABLE: Self = Self { keep_last: true, depth: 10, reliable: true, transient_local: false };
    /// Best effort, volatile, the last five: sensor data.
    pub const SENSOR_DATA: Self = Self { keep_last: true, depth: 5, reliable: false, transient_local: false };
    /// Reliable and kept for late joiners, the last one.
    pub const LATCHED: Self = Self { keep_last: true, depth: 1, reliable: true, transient_local: true };

    /// The profile as an item of a YAML sequence (rosbag2 metadata version 9), every line indented by `indent` spaces.
    /// Deadlines and life spans are infinite.
    pub(crate) fn yaml_item(self, indent: usize) -> String {
        let pad = " ".repeat(indent);
        let mut out = String::new();
        let forever = format!("\n{pad}    sec: 9223372036\n{pad}    nsec: 854775807");
        let _ = write!(
            out,
            "{pad}- history: {}\n{pad}  depth: {}\n{pad}  reliability: {}\n{pad}  durability: {}\n\
             {pad}  deadline:{forever}\n{pad}  lifespan:{forever}\n{pad}  liveliness: automatic\n\
             {pad}  liveliness_lease_duration:{forever}\n{pad}  avoid_ros_namespace_conventions: false\n",
            if self.keep_last { "keep_last" } else { "keep_all" },
            self.depth,
            if self.reliable { "reliable" } else { "best_effort" },
            if self.transient_local { "transient_local" } else { "volatile" },
        );
        out
    }
}
