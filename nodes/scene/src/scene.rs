use crate::pieces::convex_pieces;
use crate::scene_file::{Entry, SceneFile};
use crate::{Bundle, SceneError};
use cspace::{FixedPart, Polyhedron, World};
use std::ops::Range;
use std::path::Path;
use std::sync::Arc;

/// A scene, checked and made of convex parts.
#[derive(Clone, Debug)]
pub struct Scene {
    /// Its name.
    pub name: String,
    /// The convex parts.
    pub world: Arc<World>,
    /// The entries of `moving`; `parts` are indices into `World::moving`.
    pub moving: Vec<Body>,
    /// The entries of `fixed`, as `FixedPart::obstacle` counts them; `parts` are indices into `World::fixed`.
    pub fixed: Vec<Body>,
    /// What it was built from.
    pub bundle: Bundle,
}

/// One entry of a scene.
#[derive(Clone, Debug, PartialEq)]
pub struct Body {
    /// The mesh, as the scene file names it.
    pub mesh: String,
    /// Its convex parts.
    pub parts: Range<usize>,
    /// Coulomb coefficient, where the scene states one.
    pub friction: Option<f64>,
    /// What had to be done to make it convex, if anything; says when it is only approximated.
    pub note: Option<String>,
}

impl Scene {
    /// Reads and builds a scene file.
    ///
    /// # Errors
    /// The first thing found wrong with the scene file or one of its meshes: what, in which file, in which line.
    pub fn load(path: &Path) -> Result<Self, SceneError> {
        Self::build(Bundle::read(path)?)
    }

    /// Builds a scene from bytes; reads no file.
    ///
    /// # Errors
    /// As [`Scene::load`].
    pub fn build(bundle: Bundle) -> Result<Self, SceneError> {
        let file = SceneFile::parse(&bundle.yaml, &bundle.path)?;
        let (mut moving_parts, mut fixed_parts) = (Vec::new(), Vec::new());
        let (mut moving, mut fixed) = (Vec::new(), Vec::new());
        for entry in &file.moving {
            moving.push(body(&bundle, entry, &mut moving_parts, Arc::new)?);
        }
        for (obstacle, entry) in (0u32..).zip(&file.fixed) {
            let part = |p| FixedPart { polyhedron: Arc::new(p), obstacle };
            fixed.push(body(&bundle, entry, &mut fixed_parts, part)?);
        }
        let world = Arc::new(World { moving: moving_parts, fixed: fixed_parts });
        Ok(Self { name: file.name, world, moving, fixed, bundle })
    }

    /// Coulomb coefficients by obstacle, as `FixedPart::obstacle` counts them; `None` where the gains decide.
    #[must_use]
    pub fn frictions(&self) -> Vec<Option<f64>> {
        self.fixed.iter().map(|b| b.friction).collect()
    }
}

fn body<T>(
    bundle: &Bundle,
    entry: &Entry,
    parts: &mut Vec<T>,
    part: impl Fn(Polyhedron) -> T,
) -> Result<Body, SceneError> {
    let first = parts.len();
    let mut note: Option<String> = None;
    for mesh in bundle.meshes(entry)? {
        let (pieces, new_note) =
            convex_pieces(&mesh, entry.convex).map_err(|e| bundle.refusal(&entry.mesh.value, &e))?;
        parts.extend(pieces.into_iter().map(&part));
        note = note.or(new_note);
    }
    Ok(Body { mesh: entry.mesh.value.clone(), parts: first..parts.len(), friction: entry.friction(), note })
}
