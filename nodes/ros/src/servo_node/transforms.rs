use crate::{Outcome, Talker};
use bag::msg::{Header, Message, Quaternion, Vector3};
use r2r::{Node, QosProfile};
use serde::{Deserialize, Serialize};
use servo::TickRecord;
use spatial::Pose;

/// `tf2_msgs/msg/TFMessage`.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
struct Tf {
    transforms: Vec<TransformStamped>,
}

/// `geometry_msgs/msg/TransformStamped`.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
struct TransformStamped {
    header: Header,
    child_frame_id: String,
    translation: Vector3,
    rotation: Quaternion,
}

impl Message for Tf {
    const NAME: &'static str = "tf2_msgs/msg/TFMessage";
}

/// Where the part is, for whoever listens to /tf: the frame of the part at the hand's pose, and a second one, its name
/// with `_proxy`, at the proxy's.
pub struct Transforms {
    out: Talker<Tf>,
    world: String,
    part: String,
    proxy: String,
}

impl Transforms {
    /// Offers /tf; `None` if the ROS that this program was built on has no tf2_msgs.
    #[must_use]
    pub fn offer(node: &mut Node, world: &str, part: &str) -> Option<Self> {
        let qos = QosProfile { depth: 100, ..QosProfile::default() };
        let out = Talker::new(node, "/tf", qos).ok()?;
        Some(Self { out, world: world.to_owned(), part: part.to_owned(), proxy: format!("{part}_proxy") })
    }

    /// Tells where a tick found the part.
    ///
    /// # Errors
    /// The middleware refuses the message.
    pub fn tell(&self, tick: &TickRecord) -> Outcome<()> {
        self.out.say(&self.message(tick))
    }

    fn message(&self, tick: &TickRecord) -> Tf {
        let transform = |child: &str, world_from_child: &Pose| TransformStamped {
            header: Header { stamp: tick.input.stamp.into(), frame_id: self.world.clone() },
            child_frame_id: child.to_owned(),
            translation: world_from_child.translation.into(),
            rotation: world_from_child.rotation.into(),
        };
        Tf { transforms: vec![transform(&self.part, &tick.hip), transform(&self.proxy, &tick.proxy)] }
    }
}
