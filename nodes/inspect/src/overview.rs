use crate::blueprint::{self, Eyes};
use crate::sink::Sink;
use crate::subject::Subject;
use crate::surface::Surface;
use crate::{InspectError, legend, palette, physical};
use cspace::{BasicContact, CFacePolygon, c_face_polygons};
use glam::{DQuat, DVec3};
use rerun::{Clear, RecordingStream, RecordingStreamResult};
use spatial::Pose;
use std::time::Duration;

/// Orientations of the sweep: three turns, one about each axis of W, a degree and a half a step.
const STEPS_PER_TURN: usize = 240;
/// Time line of the sweep.
const SWEEP: &str = "sweep_deg";
/// The part in the hand, turned, beside the obstacles.
const PART: &str = "/physical_m/part";
/// The C-obstacles.
const C_OBSTACLES: &str = "/cspace_m/c_obstacles";

/// The kinds of C-faces, and their colours.
const KINDS: [(&str, palette::Rgb); 4] =
    [("type_a", palette::OTHER), ("type_b", palette::NEAR), ("type_c", palette::LOCAL), ("several", palette::TOUCHING)];

/// Records a scene without a run: parts, convex pieces, and the C-obstacles over a sweep of orientations.
///
/// # Errors
/// The sink cannot be opened or does not take the recording within `timeout`.
pub fn record_overview(subject: &Subject, sink: &Sink, timeout: Duration) -> Result<(), InspectError> {
    let stream = sink.open()?;
    record(&stream, subject)?;
    stream.flush_with_timeout(timeout).map_err(|e| InspectError::Flush { sink: sink.name(), reason: e.to_string() })
}

pub(crate) fn record(stream: &RecordingStream, subject: &Subject) -> RecordingStreamResult<()> {
    let eyes = Eyes::of(subject);
    blueprint::send_overview(stream, &eyes, SWEEP)?;
    legend::open_overview(stream)?;
    stream.log_static("/cspace_m", &rerun::ViewCoordinates::RIGHT_HAND_Z_UP())?;
    physical::open_obstacles(stream, subject)?;
    for (part, polyhedron) in subject.world.moving.iter().enumerate() {
        let entity = format!("{PART}/{}", subject.moving_name(part));
        let surface = Surface::of(polyhedron);
        stream.log_static(entity.as_str(), &surface.mesh(palette::glass(palette::SCP, 0.75)))?;
        stream.log_static(format!("{entity}/edges"), &surface.edges(palette::solid(palette::SCP), 1.5))?;
    }
    // The part hovers above the obstacles, where nothing hides it.
    let (low, high) = subject.fixed_bounds();
    let hover = DVec3::new(0.5 * (low.x + high.x), 0.5 * (low.y + high.y), high.z + 1.3 * subject.moving_size());
    let turn = std::f64::consts::TAU / STEPS_PER_TURN as f64;
    let mut degrees = 0.0;
    for axis in [DVec3::Z, DVec3::X, DVec3::Y] {
        for step in 0..STEPS_PER_TURN {
            let rotation = DQuat::from_axis_angle(axis, turn * step as f64);
            stream.set_duration_secs(SWEEP, degrees);
            stream.log(PART, &physical::transform(&Pose::new(hover, rotation)))?;
            c_obstacles(stream, subject, rotation)?;
            degrees += 360.0 / STEPS_PER_TURN as f64;
        }
    }
    Ok(())
}

fn c_obstacles(stream: &RecordingStream, subject: &Subject, rotation: DQuat) -> RecordingStreamResult<()> {
    let mut surfaces: [Surface; 4] = Default::default();
    for a in &subject.world.moving {
        for fixed in &subject.world.fixed {
            for face in c_face_polygons(a, &fixed.polyhedron, rotation) {
                surfaces[kind(&face)].push(&face.vertices, face.normal_w);
            }
        }
    }
    for ((name, color), surface) in KINDS.iter().zip(&surfaces) {
        let entity = format!("{C_OBSTACLES}/{name}");
        if surface.is_empty() {
            stream.log(entity.as_str(), &Clear::recursive())?;
        } else {
            stream.log(entity.as_str(), &surface.mesh(palette::glass(*color, 0.4)))?;
            stream.log(format!("{entity}/edges"), &surface.edges(palette::solid(*color), 1.4))?;
        }
    }
    Ok(())
}

fn kind(face: &CFacePolygon) -> usize {
    match face.contacts[..] {
        [BasicContact::TypeA { .. }] => 0,
        [BasicContact::TypeB { .. }] => 1,
        [BasicContact::TypeC { .. }] => 2,
        _ => 3,
    }
}
