use r2r::builtin_interfaces::msg::Time;
use r2r::geometry_msgs::msg as geometry;
use r2r::std_msgs::msg::Header;
use spatial::{DQuat, DVec3, Pose, Stamp, Twist, Wrench};

/// A moment.
#[must_use]
pub fn time(stamp: Stamp) -> Time {
    let (sec, nanosec) = stamp.sec_nanosec();
    Time { sec, nanosec }
}

/// The moment of a message.
#[must_use]
pub fn stamp(time: &Time) -> Stamp {
    Stamp::from_sec_nanosec(time.sec, time.nanosec)
}

/// A header.
#[must_use]
pub fn header(at: Stamp, frame_id: &str) -> Header {
    Header { stamp: time(at), frame_id: frame_id.to_owned() }
}

/// Three numbers as a vector.
#[must_use]
pub fn vector(v: DVec3) -> geometry::Vector3 {
    geometry::Vector3 { x: v.x, y: v.y, z: v.z }
}

/// Three numbers as a point.
#[must_use]
pub fn point(v: DVec3) -> geometry::Point {
    geometry::Point { x: v.x, y: v.y, z: v.z }
}

/// The numbers of a vector.
#[must_use]
pub fn from_vector(v: &geometry::Vector3) -> DVec3 {
    DVec3::new(v.x, v.y, v.z)
}

/// A pose.
#[must_use]
pub fn pose(p: &Pose) -> geometry::Pose {
    let q = p.rotation;
    geometry::Pose {
        position: point(p.translation),
        orientation: geometry::Quaternion { x: q.x, y: q.y, z: q.z, w: q.w },
    }
}

/// The pose of a message, as it came: not checked, not normalised.
#[must_use]
pub fn from_pose(p: &geometry::Pose) -> Pose {
    let (t, q) = (&p.position, &p.orientation);
    Pose::new(DVec3::new(t.x, t.y, t.z), DQuat::from_xyzw(q.x, q.y, q.z, q.w))
}

/// A twist.
#[must_use]
pub fn twist(t: &Twist) -> geometry::Twist {
    geometry::Twist { linear: vector(t.linear), angular: vector(t.angular) }
}

/// A wrench.
#[must_use]
pub fn wrench(w: &Wrench) -> geometry::Wrench {
    geometry::Wrench { force: vector(w.force), torque: vector(w.torque) }
}

/// The wrench of a message, as it came.
#[must_use]
pub fn from_wrench(w: &geometry::Wrench) -> Wrench {
    Wrench::new(from_vector(&w.force), from_vector(&w.torque))
}

/// A pose with its moment and frame.
#[must_use]
pub fn pose_stamped(at: Stamp, frame_id: &str, p: &Pose) -> geometry::PoseStamped {
    geometry::PoseStamped { header: header(at, frame_id), pose: pose(p) }
}

/// A twist with its moment and frame.
#[must_use]
pub fn twist_stamped(at: Stamp, frame_id: &str, t: &Twist) -> geometry::TwistStamped {
    geometry::TwistStamped { header: header(at, frame_id), twist: twist(t) }
}

/// A wrench with its moment and frame.
#[must_use]
pub fn wrench_stamped(at: Stamp, frame_id: &str, w: &Wrench) -> geometry::WrenchStamped {
    geometry::WrenchStamped { header: header(at, frame_id), wrench: wrench(w) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn poses_wrenches_and_times_come_back_bit_for_bit() {
        let p = Pose::from_xyz_rpy(DVec3::new(0.1, -0.2, 0.3), DVec3::new(1.0, 2.0, 3.0));
        assert_eq!(from_pose(&pose(&p)), p);
        let w = Wrench::new(DVec3::new(1.0, 2.0, 3.0), DVec3::new(-0.1, 0.2, 0.3));
        assert_eq!(from_wrench(&wrench(&w)), w);
        let t = Stamp(1_700_000_000_123_456_789);
        assert_eq!(stamp(&time(t)), t);
    }
}
