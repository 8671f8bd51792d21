use serde::{Deserialize, Serialize};

/// The force law.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
#[repr(u8)]
pub enum LawKind {
    /// The paper's equations (1) to (6) as written.
    Paper = 0,
    /// The paper's force, torque about the nearest point of the contact region.
    Pstar = 1,
    /// Depth-weighted contact region: continuous across single and multiple contacts.
    Blended = 2,
    /// The proxy pose by a convex QP in six dimensions; the wrench is the coupling's pull.
    #[default]
    Proxy = 3,
}

/// Everything of the rendering that may change while it runs. `Copy`: one latest-value cell carries it whole.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Gains {
    /// The force law.
    pub law: LawKind,
    /// Coupling (and wall) stiffness k_F, N/m.
    pub stiffness: f64,
    /// Coupling damping, N.s/m.
    pub damping: f64,
    /// Rotational coupling stiffness, N.m/rad (law `proxy`).
    pub rotation_stiffness: f64,
    /// Rotational coupling damping, N.m.s/rad.
    pub rotation_damping: f64,
    /// Depth over which a contact's weight fades (law `blended`), metres.
    pub blend_depth: f64,
    /// Greatest force on the hand, N.
    pub max_force: f64,
    /// Greatest torque on the hand, N.m.
    pub max_torque: f64,
    /// Greatest change of force, N/s.
    pub max_force_rate: f64,
    /// Greatest change of torque, N.m/s.
    pub max_torque_rate: f64,
    /// Time of the ramp after enabling, s.
    pub ramp_time: f64,
    /// Coulomb friction coefficients, static and kinetic, for obstacles that state none; 0 is off.
    pub friction_static: f64,
    /// See `friction_static`.
    pub friction_kinetic: f64,
    /// Whether the passivity controller acts (the observer always runs).
    pub passivity: bool,
    /// Edge rounding (law `proxy`): greatest speed at which the proxy catches up with the hand, m/s, on top of the hand's own;
    /// infinite is off. Falling off a sharp edge changes the force by at most `stiffness (2 d + proxy_speed T)` in a tick
    /// of T in which no point of the part in the hand moved farther than d.
    pub proxy_speed: f64,
}

impl Default for Gains {
    fn default() -> Self {
        Self {
            law: LawKind::Proxy,
            stiffness: 1000.0,
            damping: 1.0,
            rotation_stiffness: 1.0,
            rotation_damping: 0.002,
            blend_depth: 5e-4,
            max_force: 10.0,
            max_torque: 0.5,
            max_force_rate: 20_000.0,
            max_torque_rate: 1_000.0,
            ramp_time: 0.5,
            friction_static: 0.0,
            friction_kinetic: 0.0,
            passivity: true,
            proxy_speed: 2.0,
        }
    }
}
