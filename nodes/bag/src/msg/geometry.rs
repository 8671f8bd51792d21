use super::Header;
use serde::{Deserialize, Serialize};
use spatial::{DQuat, DVec3};

macro_rules! triple {
    ($(#[$doc:meta])* $name:ident) => {
        $(#[$doc])*
        #[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
        pub struct $name {
            /// Along x.
            pub x: f64,
            /// Along y.
            pub y: f64,
            /// Along z.
            pub z: f64,
        }

        impl From<DVec3> for $name {
            fn from(v: DVec3) -> Self {
                Self { x: v.x, y: v.y, z: v.z }
            }
        }

        impl From<$name> for DVec3 {
            fn from(v: $name) -> Self {
                Self::new(v.x, v.y, v.z)
            }
        }
    };
}

triple!(
    /// `geometry_msgs/msg/Point`, metres.
    Point
);
triple!(
    /// `geometry_msgs/msg/Vector3`.
    Vector3
);

/// `geometry_msgs/msg/Quaternion`.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[allow(missing_docs, reason = "the components of a quaternion")]
pub struct Quaternion {
    pub x: f64,
    pub y: f64,
    pub z: f64,
    pub w: f64,
}

impl Default for Quaternion {
    fn default() -> Self {
        DQuat::IDENTITY.into()
    }
}

impl From<DQuat> for Quaternion {
    fn from(q: DQuat) -> Self {
        Self { x: q.x, y: q.y, z: q.z, w: q.w }
    }
}

impl From<Quaternion> for DQuat {
    fn from(q: Quaternion) -> Self {
        // Not normalised: a record must give back the very bits it took.
        Self::from_xyzw(q.x, q.y, q.z, q.w)
    }
}

/// `geometry_msgs/msg/Pose`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Pose {
    /// Metres.
    pub position: Point,
    /// Unit quaternion.
    pub orientation: Quaternion,
}

impl From<spatial::Pose> for Pose {
    fn from(p: spatial::Pose) -> Self {
        Self { position: p.translation.into(), orientation: p.rotation.into() }
    }
}

impl From<Pose> for spatial::Pose {
    fn from(p: Pose) -> Self {
        Self::new(p.position.into(), p.orientation.into())
    }
}

/// `geometry_msgs/msg/Twist`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Twist {
    /// m/s.
    pub linear: Vector3,
    /// rad/s.
    pub angular: Vector3,
}

impl From<spatial::Twist> for Twist {
    fn from(t: spatial::Twist) -> Self {
        Self { linear: t.linear.into(), angular: t.angular.into() }
    }
}

impl From<Twist> for spatial::Twist {
    fn from(t: Twist) -> Self {
        Self { linear: t.linear.into(), angular: t.angular.into() }
    }
}

/// `geometry_msgs/msg/Wrench`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Wrench {
    /// N.
    pub force: Vector3,
    /// N.m.
    pub torque: Vector3,
}

impl From<spatial::Wrench> for Wrench {
    fn from(w: spatial::Wrench) -> Self {
        Self { force: w.force.into(), torque: w.torque.into() }
    }
}

impl From<Wrench> for spatial::Wrench {
    fn from(w: Wrench) -> Self {
        Self::new(w.force.into(), w.torque.into())
    }
}

macro_rules! stamped {
    ($(#[$doc:meta])* $name:ident, $field:ident: $inner:ident) => {
        $(#[$doc])*
        #[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
        pub struct $name {
            /// When and in which frame.
            pub header: Header,
            /// What.
            pub $field: $inner,
        }
    };
}

stamped!(
    /// `geometry_msgs/msg/PoseStamped`.
    PoseStamped, pose: Pose
);
stamped!(
    /// `geometry_msgs/msg/TwistStamped`.
    TwistStamped, twist: Twist
);
stamped!(
    /// `geometry_msgs/msg/WrenchStamped`.
    WrenchStamped, wrench: Wrench
);
