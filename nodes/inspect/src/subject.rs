use cspace::World;
use glam::DVec3;
use scene::{Body, Scene};
use std::path::Path;
use std::sync::Arc;

/// What is looked at: the bodies and what to call them.
#[derive(Clone, Debug)]
pub struct Subject {
    /// Name of the scene.
    pub name: String,
    /// The bodies.
    pub world: Arc<World>,
    /// Names of the parts of A, in the order of `World::moving`; missing ones are numbered.
    pub moving_names: Vec<String>,
    /// Names of the obstacles, in the order of the scene's `fixed` list; missing ones are numbered.
    pub fixed_names: Vec<String>,
}

impl Subject {
    /// A subject whose bodies are numbered.
    #[must_use]
    pub fn new(name: &str, world: Arc<World>) -> Self {
        Self { name: name.into(), world, moving_names: Vec::new(), fixed_names: Vec::new() }
    }

    /// A scene: bodies are named after their meshes.
    #[must_use]
    pub fn of(scene: &Scene) -> Self {
        let name = |body: &Body| Path::new(&body.mesh).file_stem().unwrap_or_default().to_string_lossy().into_owned();
        // A body of the hand may have several parts; each obstacle is one name.
        let moving = scene.moving.iter().flat_map(|body| {
            let name = name(body);
            let one = body.parts.len() == 1;
            (0..body.parts.len()).map(move |i| if one { name.clone() } else { format!("{name}_{i}") })
        });
        Self {
            name: scene.name.clone(),
            world: Arc::clone(&scene.world),
            moving_names: moving.collect(),
            fixed_names: scene.fixed.iter().map(name).collect(),
        }
    }

    /// The name of part `i` of A.
    pub(crate) fn moving_name(&self, part: usize) -> String {
        self.moving_names.get(part).map_or_else(|| format!("part_{part}"), |name| path_part(name))
    }

    /// The name of the obstacle that piece `piece` belongs to.
    pub(crate) fn obstacle_name(&self, piece: usize) -> String {
        let obstacle = self.world.fixed[piece].obstacle as usize;
        self.fixed_names.get(obstacle).map_or_else(|| format!("obstacle_{obstacle}"), |name| path_part(name))
    }

    /// The name of piece `piece`: the obstacle's, numbered if the obstacle has several.
    pub(crate) fn piece_name(&self, piece: usize) -> String {
        let obstacle = self.world.fixed[piece].obstacle;
        let siblings: Vec<usize> =
            (0..self.world.fixed.len()).filter(|&i| self.world.fixed[i].obstacle == obstacle).collect();
        let name = self.obstacle_name(piece);
        match siblings.iter().position(|&i| i == piece) {
            Some(index) if siblings.len() > 1 => format!("{name}_{index}"),
            _ => name,
        }
    }

    /// Greatest distance of a vertex of A from A's origin, metres: the measure for arrows and labels.
    pub(crate) fn moving_size(&self) -> f64 {
        let vertices = self.world.moving.iter().flat_map(|part| part.vertices().iter());
        vertices.map(|v| v.length()).fold(0.0, f64::max).max(1e-6)
    }

    /// Corners of the box around all obstacles, metres, W.
    pub(crate) fn fixed_bounds(&self) -> (DVec3, DVec3) {
        bounds(self.world.fixed.iter().flat_map(|part| part.polyhedron.vertices().iter().copied()))
    }
}

/// Corners of the box around points; around the origin alone if there are none.
pub(crate) fn bounds(points: impl Iterator<Item = DVec3>) -> (DVec3, DVec3) {
    points
        .fold(None, |b: Option<(DVec3, DVec3)>, p| Some(b.map_or((p, p), |(lo, hi)| (lo.min(p), hi.max(p)))))
        .unwrap_or_default()
}

/// A name that is safe as one part of an entity path.
fn path_part(name: &str) -> String {
    let safe: String =
        name.chars().map(|c| if c.is_alphanumeric() || c == '_' || c == '-' { c } else { '_' }).collect();
    if safe.is_empty() { "_".into() } else { safe }
}
