use super::{CFace, Header, Pose};
use serde::{Deserialize, Serialize};

/// `cspace_haptics_msgs/msg/LocalCSpace`.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct LocalCSpace {
    /// Stamp of the tick; frame W.
    pub header: Header,
    /// Sequence number of the tick it was taken from.
    pub sequence: u64,
    /// The hand's pose of A in W: metres and unit quaternion. Its position is the HIP, its orientation fixes the
    /// slice.
    pub pose: Pose,
    /// The surface contact pose (SCP), A in W.
    pub proxy_pose: Pose,
    /// Penetration of the hand's pose, metres, >= 0.
    pub depth: f64,
    /// Formation of the whole body, one of PrincipalContact.KIND_*.
    pub kind: u8,
    /// Near and its applicable neighbours for every active pair.
    pub c_faces: Vec<CFace>,
}
