use super::{Driver, ParamSpec, Range, StabilityPolicy, Value};
use haptics::LawKind;

macro_rules! param {
    ($name:literal, $range:expr, $unit:literal, $live:ident, $variant:ident, [$($field:tt)+], $meaning:literal) => {
        ParamSpec {
            name: $name,
            range: $range,
            unit: $unit,
            live: $live,
            meaning: $meaning,
            get: |c| Value::$variant(c.$($field)+.clone()),
            set: |c, v| {
                if let Value::$variant(v) = v {
                    c.$($field)+ = v.clone();
                }
            },
        }
    };
}

/// `Float` with its range.
macro_rules! float {
    ($name:literal, $min:literal .. $max:literal, $unit:literal, $live:ident, [$($field:tt)+], $meaning:literal) => {
        param!($name, Range::Float { min: $min, max: $max }, $unit, $live, Float, [$($field)+], $meaning)
    };
}

macro_rules! int {
    ($name:literal, $min:literal .. $max:literal, $unit:literal, $live:ident, [$($field:tt)+], $meaning:literal) => {
        param!($name, Range::Int { min: $min, max: $max }, $unit, $live, Int, [$($field)+], $meaning)
    };
}

/// A choice whose texts are the names of an enum's values, in one table for both ways.
macro_rules! choice {
    ($name:literal, $live:ident, [$($field:tt)+], [$($text:literal => $value:path),+], $meaning:literal) => {
        ParamSpec {
            name: $name,
            range: Range::Choice(&[$($text),+]),
            unit: "",
            live: $live,
            meaning: $meaning,
            get: |c| Value::Text(match c.$($field)+ { $($value => $text),+ }.into()),
            set: |c, v| {
                if let Value::Text(t) = v {
                    c.$($field)+ = match t.as_str() {
                        $($text => $value,)+
                        _ => return,
                    };
                }
            },
        }
    };
}

#[allow(non_upper_case_globals, reason = "reads as words in the table below")]
const live: bool = true;
#[allow(non_upper_case_globals, reason = "reads as words in the table below")]
const restart: bool = false;

/// All parameters, in the order of the template and the table.
#[must_use]
pub fn schema() -> &'static [ParamSpec] {
    SCHEMA
}

static SCHEMA: &[ParamSpec] = &[
    param! { "frame_id", Range::Text, "", restart, Text, [frame_id],
    "Frame of everything that is published: the world W." },
    param! { "child_frame_id", Range::Text, "", restart, Text, [child_frame_id], "Frame of the manipulated part A." },
    float! { "publish_rate", 1.0..1000.0, "Hz", restart, [publish_rate],
    "Rate of pose, proxy pose and wrench; local C-space comes at 60 Hz, markers at 20 Hz, ticks are never thinned out." },
    param! { "scene", Range::Text, "", restart, Text, [scene], "A scene.yaml, or the name of an installed scene." },
    choice! { "law", live, [gains.law],
    ["paper" => LawKind::Paper, "pstar" => LawKind::Pstar, "blended" => LawKind::Blended, "proxy" => LawKind::Proxy],
    "Force law: the paper's equations, nearest point of the contact region, depth-weighted region, or proxy." },
    float! { "gains.stiffness", 1.0..20000.0, "N/m", live, [gains.stiffness], "Stiffness of contact and coupling." },
    float! { "gains.damping", 0.0..100.0, "N.s/m", live, [gains.damping], "Damping of the coupling." },
    float! { "gains.rotation_stiffness", 0.001..100.0, "N.m/rad", live, [gains.rotation_stiffness],
    "Rotational stiffness of the coupling (law proxy)." },
    float! { "gains.rotation_damping", 0.0..1.0, "N.m.s/rad", live, [gains.rotation_damping],
    "Rotational damping of the coupling." },
    float! { "gains.blend_depth", 0.000001..0.01, "m", live, [gains.blend_depth],
    "Depth over which a contact's weight fades (law blended)." },
    float! { "gains.friction_static", 0.0..10.0, "", live, [gains.friction_static],
    "Static Coulomb coefficient of obstacles that state none; 0 is off." },
    float! { "gains.friction_kinetic", 0.0..10.0, "", live, [gains.friction_kinetic],
    "Kinetic Coulomb coefficient of obstacles that state none; 0 is off." },
    ParamSpec {
        name: "gains.proxy_speed",
        range: Range::Float { min: 0.0, max: 100.0 },
        unit: "m/s",
        live,
        meaning: "Greatest speed of the proxy: bounds its fall off a sharp edge; 0 is no bound.",
        get: |c| Value::Float(if c.gains.proxy_speed.is_finite() { c.gains.proxy_speed } else { 0.0 }),
        set: |c, v| {
            if let Value::Float(x) = v {
                c.gains.proxy_speed = if *x > 0.0 { *x } else { f64::INFINITY };
            }
        },
    },
    float! { "limits.max_force", 0.0..200.0, "N", live, [gains.max_force], "Greatest force on the hand." },
    float! { "limits.max_torque", 0.0..20.0, "N.m", live, [gains.max_torque], "Greatest torque on the hand." },
    float! { "limits.max_force_rate", 1.0..1000000.0, "N/s", live, [gains.max_force_rate],
    "Greatest change of force." },
    float! { "limits.max_torque_rate", 0.01..100000.0, "N.m/s", live, [gains.max_torque_rate],
    "Greatest change of torque." },
    float! { "limits.ramp_time", 0.01..10.0, "s", live, [gains.ramp_time],
    "Time from nothing to full force after enabling." },
    param! { "passivity.enabled", Range::Bool, "", live, Bool, [gains.passivity],
    "Whether the passivity controller acts; the observer always runs." },
    float! { "passivity.max_damping", 0.0..1000.0, "N.s/m", restart, [passivity.max_damping],
    "Greatest damping that the passivity controller adds." },
    float! { "passivity.lever", 0.001..1.0, "m", restart, [passivity.lever],
    "Lever by which rotation is weighed against translation in dissipating." },
    float! { "passivity.budget", 0.000001..1.0, "J", restart, [passivity.budget],
    "Energy given to the hand beyond what it has put in at which the force is reduced." },
    choice! { "device.driver", restart, [device.driver],
    ["simulated" => Driver::Simulated, "replay" => Driver::Replay, "spacemouse" => Driver::SpaceMouse, "topic" => Driver::Topic],
    "Where the hand's pose comes from: simulated operator, file of poses, SpaceMouse, or another node's topics." },
    float! { "device.timeout", 0.0005..1.0, "s", restart, [device.timeout],
    "Age at which a sample is stale and the force is zero." },
    param! { "device.file", Range::Text, "", restart, Text, [device.file],
    "Driver replay: CSV of poses t,x,y,z,qx,qy,qz,qw." },
    param! { "device.path", Range::Text, "", restart, Text, [device.path],
    "Driver spacemouse: hidraw device; empty for the first one found." },
    float! { "device.speed", 0.001..2.0, "m/s", restart, [device.speed],
    "Driver spacemouse: speed at full deflection." },
    float! { "device.turn_speed", 0.01..10.0, "rad/s", restart, [device.turn_speed],
    "Driver spacemouse: angular speed at full deflection." },
    ParamSpec {
        name: "device.operator.seed",
        range: Range::Int { min: 0, max: i64::MAX },
        unit: "",
        live: restart,
        meaning: "Simulated operator: seed of tremor and errors; the same seed moves the same.",
        get: |c| Value::Int(i64::try_from(c.device.operator.seed).unwrap_or(i64::MAX)),
        set: |c, v| {
            if let Value::Int(i) = v {
                c.device.operator.seed = u64::try_from(*i).unwrap_or(0);
            }
        },
    },
    float! { "device.operator.mass", 0.05..20.0, "kg", restart, [device.operator.mass],
    "Simulated operator: mass of hand and handle." },
    float! { "device.operator.damping", 0.0..200.0, "N.s/m", restart, [device.operator.damping],
    "Simulated operator: damping of the arm." },
    float! { "device.operator.stiffness", 1.0..5000.0, "N/m", restart, [device.operator.stiffness],
    "Simulated operator: stiffness of the arm." },
    float! { "device.operator.tremor_force", 0.0..5.0, "N", restart, [device.operator.tremor_force],
    "Simulated operator: amplitude of the tremor." },
    float! { "device.operator.tremor_torque", 0.0..0.2, "N.m", restart, [device.operator.tremor_torque],
    "Simulated operator: amplitude of the tremor's torque." },
    float! { "device.operator.misalignment", 0.0..0.5, "rad", restart, [device.operator.misalignment],
    "Simulated operator: by how much the part is held askew." },
    float! { "device.operator.aim_error", 0.0..0.05, "m", restart, [device.operator.aim_error],
    "Simulated operator: how far the hand aims beside the mark." },
    float! { "device.operator.speed", 0.05..20.0, "", restart, [device.operator.speed],
    "Simulated operator: speed of the plan, 1 as planned." },
    float! { "mapping.scale", 0.001..100.0, "", restart, [mapping.scale],
    "Translation of the part over translation of the hand." },
    int! { "mapping.clutch_button", -1..31, "", restart, [mapping.clutch_button],
    "Button that holds the part while the hand moves on; -1 for none." },
    int! { "mapping.deadman_button", -1..31, "", restart, [mapping.deadman_button],
    "Button that must be held for any force; -1 for none." },
    float! { "mapping.x", -100.0..100.0, "m", restart, [mapping.xyz.x],
    "Origin of the device's base frame in the world, x." },
    float! { "mapping.y", -100.0..100.0, "m", restart, [mapping.xyz.y],
    "Origin of the device's base frame in the world, y." },
    float! { "mapping.z", -100.0..100.0, "m", restart, [mapping.xyz.z],
    "Origin of the device's base frame in the world, z." },
    float! { "mapping.roll", -7.0..7.0, "rad", restart, [mapping.rpy.x],
    "Orientation of the device's base frame in the world, about fixed x." },
    float! { "mapping.pitch", -7.0..7.0, "rad", restart, [mapping.rpy.y],
    "Orientation of the device's base frame in the world, about fixed y." },
    float! { "mapping.yaw", -7.0..7.0, "rad", restart, [mapping.rpy.z],
    "Orientation of the device's base frame in the world, about fixed z." },
    float! { "mapping.velocity_cutoff", 1.0..5000.0, "Hz", restart, [mapping.velocity_cutoff],
    "Corner frequency of the velocity estimate." },
    float! { "jump.distance", 0.0001..10.0, "m", restart, [jump.distance],
    "Motion between two ticks that counts as a jump: contact is sought anew, force ramps from zero." },
    float! { "jump.angle", 0.001..3.2, "rad", restart, [jump.angle], "Turn between two ticks that counts as a jump." },
    float! { "contacts.debounce", 0.0..10.0, "s", restart, [contacts.debounce],
    "Time that a contact state must last to count: events on ~/contacts come so much later, dated back; `bag segment` takes it from the bag." },
    float! { "contacts.min_depth", 0.0..0.01, "m", restart, [contacts.min_depth],
    "Depth of the hand from which on a contact counts; it ends when it is gone." },
    choice! { "stability.check", restart, [stability.check],
    ["off" => StabilityPolicy::Off, "warn" => StabilityPolicy::Warn, "refuse" => StabilityPolicy::Refuse],
    "What to do at start about gains beyond the bounds of stability." },
    float! { "stability.damping", 0.0..100.0, "N.s/m", restart, [stability.damping],
    "Damping of device and hand that can be counted on." },
    float! { "stability.rotation_damping", 0.0..1.0, "N.m.s/rad", restart, [stability.rotation_damping],
    "Rotational damping of device and hand that can be counted on." },
    float! { "stability.mass", 0.001..20.0, "kg", restart, [stability.mass],
    "Mass of device and hand, the lightest to be expected." },
    float! { "stability.inertia", 0.000001..1.0, "kg.m^2", restart, [stability.inertia],
    "Moment of inertia of device and hand, the least to be expected." },
    float! { "stability.delay", 0.0..0.1, "s", restart, [stability.delay],
    "Delay between measuring and showing beyond the hold of one tick; the passivity controller makes up for it too." },
    float! { "stability.resolution", 0.0..0.01, "m", restart, [stability.resolution],
    "Step of the device's encoders: what the passivity observer takes for no motion." },
    float! { "stability.angular_resolution", 0.0..0.1, "rad", restart, [stability.angular_resolution],
    "Step of the device's encoders for rotation." },
    float! { "realtime.rate", 250.0..10000.0, "Hz", restart, [realtime.rate], "Ticks a second." },
    int! { "realtime.priority", 0..99, "", restart, [realtime.priority],
    "SCHED_FIFO priority of the servo thread; 0 for none." },
    int! { "realtime.cpu", -1..1023, "", restart, [realtime.cpu],
    "CPU of the servo thread, and the node's other threads off it; -1 for any." },
    param! { "realtime.lock_memory", Range::Bool, "", restart, Bool, [realtime.lock_memory],
    "Whether memory is locked against paging." },
];
