use crate::blueprint;
use crate::eye::Eyes;
use crate::pairs::Pairs;
use crate::sink::Sink;
use crate::subject::Subject;
use crate::surface::Surface;
use crate::union::{self, Obstacle};
use crate::{InspectError, legend, palette, physical};
use cspace::{BasicContact, CFacePolygon};
use glam::{DQuat, DVec3};
use rerun::{Clear, RecordingStream, RecordingStreamResult};
use spatial::Pose;
use std::time::Duration;

/// Orientations of the sweep: three turns, one about each axis of W.
const TURN_DEG: i64 = 360;
/// Degrees from one to the next.
const STEP_DEG: usize = 2;
/// Time line of the sweep, in whole degrees: counted, since rerun writes seconds behind a duration.
const SWEEP: &str = "sweep_deg";
/// The part in the hand, turned, beside the obstacles.
const PART: &str = "/physical_m/part";
/// The C-obstacles.
const C_OBSTACLES: &str = "/cspace_m/c_obstacles";

/// The kinds of C-faces, and their colours.
const KINDS: [(&str, palette::Rgb); 4] =
    [("type_a", palette::OTHER), ("type_b", palette::NEAR), ("type_c", palette::LOCAL), ("several", palette::TOUCHING)];

/// Records a scene without a run: parts, convex pieces, and the C-obstacles over a sweep of orientations; of large bodies
/// the side that faces the part.
///
/// # Errors
/// The sink cannot be opened or does not take the recording within `timeout`.
pub fn record_overview(subject: &Subject, sink: &Sink, timeout: Duration) -> Result<(), InspectError> {
    let stream = sink.open()?;
    record(&stream, subject)?;
    stream.flush_with_timeout(timeout).map_err(|e| InspectError::flush(sink.name(), &e))
}

pub(crate) fn record(stream: &RecordingStream, subject: &Subject) -> RecordingStreamResult<()> {
    let eyes = Eyes::of(subject, DQuat::IDENTITY);
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
    let mut pairs = Pairs::new(&subject.world);
    // The part hovers above the obstacles, where nothing hides it.
    let (low, high) = subject.fixed_bounds();
    let hover = DVec3::new(0.5 * (low.x + high.x), 0.5 * (low.y + high.y), high.z + 1.3 * subject.moving_size());
    for (begin, axis) in (0..).step_by(TURN_DEG as usize).zip([DVec3::Z, DVec3::X, DVec3::Y]) {
        for degrees in (0..TURN_DEG).step_by(STEP_DEG) {
            let rotation = DQuat::from_axis_angle(axis, (degrees as f64).to_radians());
            stream.set_time_sequence(SWEEP, begin + degrees);
            stream.log(PART, &physical::transform(&Pose::new(hover, rotation)))?;
            c_obstacles(stream, subject, &mut pairs, &Pose::new(hover, rotation))?;
        }
    }
    Ok(())
}

fn c_obstacles(
    stream: &RecordingStream,
    subject: &Subject,
    pairs: &mut Pairs,
    pose: &Pose,
) -> RecordingStreamResult<()> {
    let mut polygons = Vec::new();
    for part in 0..subject.world.moving.len() {
        for piece in 0..subject.world.fixed.len() {
            let faces = pairs.polygons(&subject.world, (part, piece), pose, f64::INFINITY);
            polygons.push((faces, pairs.is_whole(part, piece)));
        }
    }
    let mut obstacles = Vec::new();
    for (faces, whole) in &polygons {
        obstacles.push(Obstacle { faces: faces.iter().map(|face| (face, kind(face))).collect(), whole: *whole });
    }
    let surfaces: [Surface; 4] = union::surfaces(&obstacles, 0);
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
