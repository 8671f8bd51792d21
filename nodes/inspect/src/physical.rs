use crate::palette;
use crate::subject::Subject;
use crate::surface::Surface;
use glam::DVec3;
use haptics::ContactPoint;
use rerun::components::Radius;
use rerun::{Arrows3D, Clear, LineStrips3D, Points3D, RecordingStream, RecordingStreamResult, Transform3D};
use servo::TickRecord;
use spatial::Pose;
use std::collections::BTreeMap;

/// Root of the physical scene; lengths in metres, axes of W.
pub(crate) const ROOT: &str = "/physical_m";
const HAND: &str = "/physical_m/hand";
const PROXY: &str = "/physical_m/proxy";
const POINTS: &str = "/physical_m/contact/points";
const NORMALS: &str = "/physical_m/contact/normals";
const REGIONS: &str = "/physical_m/contact/regions";
const FORCE: &str = "/physical_m/force";
const TORQUE: &str = "/physical_m/torque";

/// How long the arrows are drawn.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ArrowScale {
    /// Metres per newton.
    pub force: f64,
    /// Metres per newton metre.
    pub torque: f64,
    /// Length of a contact's normal, metres.
    pub normal: f64,
}

impl ArrowScale {
    /// Arrows at the limits are some four times as long as the part in the hand, in round numbers: most forces are far
    /// below.
    pub(crate) fn new(size: f64, max_force: f64, max_torque: f64) -> Self {
        let per = |limit: f64| round_down(4.0 * size / if limit.is_finite() && limit > 0.0 { limit } else { 10.0 });
        Self { force: per(max_force), torque: per(max_torque), normal: 0.25 * size }
    }
}

/// The next smaller of 1, 2, 5 times a power of ten.
fn round_down(x: f64) -> f64 {
    let decade = 10f64.powf(x.log10().floor());
    let steps = [5.0, 2.0, 1.0];
    decade * steps.into_iter().find(|s| x >= s * decade * (1.0 - 1e-9)).unwrap_or(1.0)
}

/// Draws what does not move: obstacles, and the meshes of the hand's part under the two poses.
pub(crate) fn open(stream: &RecordingStream, subject: &Subject) -> RecordingStreamResult<()> {
    open_obstacles(stream, subject)?;
    for (part, polyhedron) in subject.world.moving.iter().enumerate() {
        let surface = Surface::of(polyhedron);
        let name = subject.moving_name(part);
        stream.log_static(format!("{PROXY}/{name}"), &surface.mesh(palette::glass(palette::SCP, 0.55)))?;
        stream.log_static(format!("{PROXY}/{name}/edges"), &surface.edges(palette::solid(palette::SCP), 1.5))?;
        // The hand's pose is a ghost: outlines only, so that it never hides the part that touches.
        stream.log_static(format!("{HAND}/{name}"), &surface.edges(palette::solid(palette::HIP), 1.2))?;
    }
    Ok(())
}

/// Draws the obstacles by their convex pieces.
pub(crate) fn open_obstacles(stream: &RecordingStream, subject: &Subject) -> RecordingStreamResult<()> {
    stream.log_static(ROOT, &rerun::ViewCoordinates::RIGHT_HAND_Z_UP())?;
    for (piece, fixed) in subject.world.fixed.iter().enumerate() {
        let entity = format!("{ROOT}/obstacles/{}", subject.piece_name(piece));
        let surface = Surface::of(&fixed.polyhedron);
        stream.log_static(entity.as_str(), &surface.mesh(palette::glass(palette::OBSTACLE, 0.22)))?;
        stream.log_static(format!("{entity}/edges"), &surface.edges(palette::glass(palette::OBSTACLE, 0.9), 1.0))?;
    }
    Ok(())
}

/// Draws one frame. The stream's time is set.
pub(crate) fn frame(stream: &RecordingStream, record: &TickRecord, scale: &ArrowScale) -> RecordingStreamResult<()> {
    stream.log(HAND, &transform(&record.hip))?;
    stream.log(PROXY, &transform(&record.proxy))?;
    let contacts = record.formation.points();
    stream.log(POINTS, &points(contacts))?;
    stream.log(NORMALS, &normals(contacts, scale.normal))?;
    let (fill, rim) = regions(contacts);
    if fill.is_empty() {
        stream.log(REGIONS, &Clear::flat())?;
    } else {
        stream.log(REGIONS, &fill.mesh(palette::glass(palette::TOUCHING, 0.8)))?;
    }
    stream.log(format!("{REGIONS}/rim"), &rim)?;
    let wrench = record.out_wrench;
    stream.log(FORCE, &arrow(application_point(record), wrench.force * scale.force, palette::FORCE))?;
    stream.log(TORQUE, &arrow(record.proxy.translation, wrench.torque * scale.torque, palette::TORQUE))
}

/// Where the force's arrow starts: the middle of the contacts, A's origin when free.
fn application_point(record: &TickRecord) -> DVec3 {
    let contacts = record.formation.points();
    if contacts.is_empty() {
        return record.proxy.translation;
    }
    contacts.iter().map(|c| c.point_w).sum::<DVec3>() / contacts.len() as f64
}

pub(crate) fn transform(pose: &Pose) -> Transform3D {
    Transform3D::from_translation_rotation(
        pose.translation.as_vec3().to_array(),
        rerun::Quaternion::from_xyzw(pose.rotation.as_quat().to_array()),
    )
}

pub(crate) fn arrow(from: DVec3, along: DVec3, color: palette::Rgb) -> Arrows3D {
    // An arrow of no length is left out: the viewer would draw its tip.
    let drawn = (along.length() > 1e-9).then_some(());
    Arrows3D::from_vectors(drawn.map(|()| along.as_vec3().to_array()))
        .with_origins(drawn.map(|()| from.as_vec3().to_array()))
        .with_colors([palette::solid(color)])
        .with_radii([Radius::new_ui_points(2.5)])
}

fn points(contacts: &[ContactPoint]) -> Points3D {
    Points3D::new(contacts.iter().map(|c| c.point_w.as_vec3().to_array()))
        .with_colors([palette::solid(palette::TOUCHING)])
        .with_radii([Radius::new_ui_points(5.0)])
}

fn normals(contacts: &[ContactPoint], length: f64) -> Arrows3D {
    Arrows3D::from_vectors(contacts.iter().map(|c| (c.normal_w * length).as_vec3().to_array()))
        .with_origins(contacts.iter().map(|c| c.point_w.as_vec3().to_array()))
        .with_colors([palette::solid(palette::NEAR)])
        .with_radii([Radius::new_ui_points(1.2)])
}

/// The contact regions H (paper, section IV.B): the hull of each pair's points, a polygon or a segment.
fn regions(contacts: &[ContactPoint]) -> (Surface, LineStrips3D) {
    let mut pairs: BTreeMap<(u32, u32), Vec<&ContactPoint>> = BTreeMap::new();
    for contact in contacts {
        pairs.entry((contact.part_a, contact.piece_b)).or_default().push(contact);
    }
    let mut fill = Surface::default();
    let mut rims: Vec<Vec<[f32; 3]>> = Vec::new();
    for pair in pairs.values() {
        let ring = around(pair);
        if ring.len() >= 3 {
            fill.push(&ring, pair[0].normal_w);
        }
        if ring.len() >= 2 {
            rims.push(ring.iter().chain(ring.first()).map(|p| p.as_vec3().to_array()).collect());
        }
    }
    let rim = LineStrips3D::new(rims)
        .with_colors([palette::solid(palette::TOUCHING)])
        .with_radii([Radius::new_ui_points(1.5)]);
    (fill, rim)
}

/// The points of one pair in order around their middle: they are the corners of a convex polygon.
fn around(pair: &[&ContactPoint]) -> Vec<DVec3> {
    let middle = pair.iter().map(|c| c.point_w).sum::<DVec3>() / pair.len() as f64;
    let u = pair[0].normal_w.try_normalize().unwrap_or(DVec3::Z).any_orthonormal_vector();
    let v = pair[0].normal_w.cross(u);
    let angle = |p: DVec3| (p - middle).dot(v).atan2((p - middle).dot(u));
    let mut ring: Vec<DVec3> = pair.iter().map(|c| c.point_w).collect();
    ring.sort_by(|p, q| angle(*p).total_cmp(&angle(*q)));
    ring
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn arrows_have_round_scales() {
        let scale = ArrowScale::new(0.03, 10.0, 0.5);
        assert!((scale.force - 0.01).abs() < 1e-12, "{scale:?}");
        assert!((scale.torque - 0.2).abs() < 1e-12, "{scale:?}");
        assert!(ArrowScale::new(0.03, f64::INFINITY, 0.0).torque.is_finite());
    }
}
