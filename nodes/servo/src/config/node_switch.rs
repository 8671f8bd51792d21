use super::{ParamError, Value};

/// A switch that concerns the node around the servo and no tick: parameter files may set it, no bag holds it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct NodeSwitch {
    /// Name, dots between the levels of the tree.
    pub name: &'static str,
    /// The value when nobody says otherwise.
    pub default: bool,
    /// What it means, one line.
    pub meaning: &'static str,
}

/// All switches of the node; none acts live.
#[must_use]
pub const fn node_switches() -> &'static [NodeSwitch] {
    &[
        NodeSwitch {
            name: "enabled",
            default: false,
            meaning: "Whether force is on from the start, without a call of ~/enable.",
        },
        NodeSwitch {
            name: "publish_tf",
            default: true,
            meaning: "Whether /tf tells child_frame_id (the hand's pose) and child_frame_id_proxy in frame_id, if this ROS has tf2_msgs.",
        },
        NodeSwitch {
            name: "device.trust_stamps",
            default: true,
            meaning: "Driver topic: whether the driver's clock is this machine's or synchronised to it, so that a sample is as old as its stamp says.",
        },
    ]
}

/// Whether `name` is a switch of the node.
///
/// # Errors
/// It is, and the value is none of a switch.
pub(super) fn is_node_switch(name: &str, value: &Value) -> Result<bool, ParamError> {
    match (node_switches().iter().find(|s| s.name == name), value) {
        (None, _) => Ok(false),
        (Some(_), Value::Bool(_)) => Ok(true),
        (Some(s), other) => Err(ParamError::Type { name: s.name, got: other.type_name(), want: "bool" }),
    }
}
