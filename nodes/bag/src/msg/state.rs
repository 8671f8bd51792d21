use super::{ContactPoint, Header, PrincipalContact, Time, Wrench};
use serde::{Deserialize, Serialize};

/// `cspace_haptics_msgs/msg/ContactState`.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct ContactState {
    /// Stamp of this message; frame W.
    pub header: Header,
    /// One of EVENT_*.
    pub event: u8,
    /// Counts states since the servo started, from 0; a begin, its ongoing messages and its end have the same
    /// index.
    pub index: u64,
    /// Formation of the whole body: the highest of the principal contacts, one of PrincipalContact.KIND_*.
    pub kind: u8,
    /// The principal contacts of all pairs that touch; empty when free. They identify the state.
    pub principal_contacts: Vec<PrincipalContact>,
    /// The basic contacts at the stamp, at most the 16 deepest.
    pub contacts: Vec<ContactPoint>,
    /// When the state began.
    pub begin: Time,
    /// Time spent in the state so far, s, >= 0.
    pub duration: f64,
    /// Penetration of the hand's pose, metres, >= 0: at the stamp, and the largest of the state.
    pub depth: f64,
    /// Penetration of the hand's pose, metres, >= 0: at the stamp, and the largest of the state.
    pub max_depth: f64,
    /// Law's wrench on the hand at the stamp: N and N.m, axes of W, torque about A's origin.
    pub wrench: Wrench,
    /// Norm of the law's force over the state: mean and largest, N, >= 0.
    pub mean_force: f64,
    /// Norm of the law's force over the state: mean and largest, N, >= 0.
    pub max_force: f64,
    /// Norm of the law's torque about A's origin over the state: mean and largest, N.m, >= 0.
    pub mean_torque: f64,
    /// Norm of the law's torque about A's origin over the state: mean and largest, N.m, >= 0.
    pub max_torque: f64,
    /// Work that the hand has done against the law's wrench in the state, J; < 0 where the contact has given energy
    /// back.
    pub work: f64,
}
