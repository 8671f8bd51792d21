use crate::subject::{Subject, bounds};
use glam::DVec3;
use rerun::external::re_sdk_types::blueprint::archetypes::EyeControls3D;
use spatial::DQuat;

/// Tangent of half the viewer's angle of view, upright.
const TAN_HALF_VIEW: f64 = 0.52;
/// Width of a 3D view over its height, in the layouts of this crate on a screen of 16 to 9.
const ASPECT: f64 = 1.35;
/// The part of the view that the bodies may fill.
const FILL: f64 = 0.93;
/// An eye as near as this (metres) asks for enlarged bodies.
const CLOSE: f64 = 0.1;
/// How far to the side, back and up the eye stands.
const STAND: [f64; 3] = [0.62, 0.68, 0.46];

/// Where to look from.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Eye {
    /// Position of the eye, metres, W.
    pub position: DVec3,
    /// Point in the middle of the picture, metres, W.
    pub target: DVec3,
}

impl Eye {
    /// Looks at a box from the direction `from`, as near as the whole box is in the picture.
    fn framing((low, high): (DVec3, DVec3), from: DVec3) -> Self {
        let target = 0.5 * (low + high);
        let half = 0.5 * (high - low);
        let back = from.normalize();
        let right = DVec3::Z.cross(back).normalize();
        let up = back.cross(right);
        let needed = |corner: DVec3| {
            let aside = (corner.dot(up).abs()).max(corner.dot(right).abs() / ASPECT);
            corner.dot(back) + aside / (TAN_HALF_VIEW * FILL)
        };
        let sign = |i: u32, bit: u32| if i >> bit & 1 == 1 { 1.0 } else { -1.0 };
        let corners = (0..8).map(|i| half * DVec3::new(sign(i, 0), sign(i, 1), sign(i, 2)));
        let distance = corners.map(needed).fold(0.0, f64::max).max(1e-6);
        Self { position: target + back * distance, target }
    }

    /// How many times larger than they are the bodies must be drawn: the viewer draws nothing that is nearer to the eye
    /// than some centimetres.
    pub(crate) fn enlargement(&self) -> f64 {
        let distance = self.position.distance(self.target);
        if distance < CLOSE { 1.0 / distance } else { 1.0 }
    }

    /// The eye as the viewer takes it, in a view that is enlarged so.
    pub(crate) fn controls(&self) -> EyeControls3D {
        let enlargement = self.enlargement();
        EyeControls3D::new()
            .with_position((self.position * enlargement).as_vec3().to_array())
            .with_look_target((self.target * enlargement).as_vec3().to_array())
            .with_eye_up([0.0, 0.0, 1.0])
    }
}

/// The two eyes of a run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Eyes {
    /// Of the physical scene.
    pub physical: Eye,
    /// Of the C-space view.
    pub cspace: Eye,
}

impl Eyes {
    /// So that the obstacles, with the part above them, and the C-obstacles of A turned by `rotation` are in the picture.
    pub(crate) fn of(subject: &Subject, rotation: DQuat) -> Self {
        let (low, high) = subject.fixed_bounds();
        let turned = subject.world.moving.iter().flat_map(|part| part.vertices().iter().map(|v| rotation * *v));
        let (part_low, part_high) = bounds(turned);
        let from = open_side(subject);
        let above = DVec3::Z * 0.7 * (part_high.z - part_low.z);
        let physical = Eye::framing((low, high + above), from);
        // The C-obstacles are B (+) (-R A).
        Self { physical, cspace: Eye::framing((low - part_high, high - part_low), from) }
    }
}

/// The direction of the quarter from which tall obstacles stand behind low ones; from the right and front if it is all one.
fn open_side(subject: &Subject) -> DVec3 {
    let (low, high) = subject.fixed_bounds();
    let middle = 0.5 * (low + high);
    let size = (high - low).length();
    let vertices = || subject.world.fixed.iter().flat_map(|f| f.polyhedron.vertices().iter());
    let hidden = |side: DVec3| vertices().map(|v| (v.z - low.z) * side.dot(*v - middle)).sum::<f64>();
    let [x, y, z] = STAND;
    let sides = [DVec3::new(x, -y, 0.0), DVec3::new(-x, -y, 0.0), DVec3::new(x, y, 0.0), DVec3::new(-x, y, 0.0)];
    let mut best = sides[0];
    for side in sides {
        if hidden(side) < hidden(best) - 1e-6 * size * size {
            best = side;
        }
    }
    best + DVec3::Z * z
}

#[cfg(test)]
mod tests {
    use super::*;
    use cspace::{FixedPart, Polyhedron, World};
    use std::sync::Arc;

    fn cuboid(low: DVec3, high: DVec3) -> Arc<Polyhedron> {
        let corner =
            |i: u32| DVec3::new(f64::from(i & 1), f64::from(i >> 1 & 1), f64::from(i >> 2 & 1)) * (high - low) + low;
        let corners: Vec<DVec3> = (0..8).map(corner).collect();
        let faces = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
        Arc::new(Polyhedron::from_faces(&corners, &faces.map(|f| f.to_vec())).expect("a box"))
    }

    fn scene(wall: (DVec3, DVec3), scale: f64) -> Subject {
        let piece =
            |(low, high): (DVec3, DVec3)| FixedPart { polyhedron: cuboid(low * scale, high * scale), obstacle: 0 };
        let floor = (DVec3::new(-1.0, -1.0, -0.2), DVec3::new(1.0, 1.0, 0.0));
        let moving = vec![cuboid(DVec3::splat(-0.3 * scale), DVec3::splat(0.3 * scale))];
        Subject::new("corner", Arc::new(World { moving, fixed: vec![piece(floor), piece(wall)] }))
    }

    #[test]
    fn a_wall_stands_at_the_back() {
        let right = scene((DVec3::new(0.8, -1.0, 0.0), DVec3::new(1.0, 1.0, 1.0)), 1.0);
        let eyes = Eyes::of(&right, DQuat::IDENTITY);
        assert!(eyes.physical.position.x < 0.0 && eyes.physical.position.y < 0.0, "{eyes:?}");
        let left = scene((DVec3::new(-1.0, -1.0, 0.0), DVec3::new(-0.8, 1.0, 1.0)), 1.0);
        assert!(Eyes::of(&left, DQuat::IDENTITY).physical.position.x > 0.0);
    }

    #[test]
    fn every_corner_is_in_the_picture_at_every_scale() {
        for scale in [1e-3, 1.0, 1e3] {
            let subject = scene((DVec3::new(-0.2, -0.2, 0.0), DVec3::new(0.2, 0.2, 1.0)), scale);
            let eye = Eyes::of(&subject, DQuat::IDENTITY).physical;
            let back = (eye.position - eye.target).normalize();
            let right = DVec3::Z.cross(back).normalize();
            let mut widest = 0.0f64;
            for v in subject.world.fixed.iter().flat_map(|f| f.polyhedron.vertices()) {
                let to = *v - eye.position;
                let depth = -to.dot(back);
                let (x, y) = (to.dot(right) / depth / ASPECT, to.dot(back.cross(right)) / depth);
                widest = widest.max(x.abs()).max(y.abs());
            }
            assert!(widest < TAN_HALF_VIEW && widest > 0.5 * TAN_HALF_VIEW, "at {scale}: {widest}");
        }
    }
}
