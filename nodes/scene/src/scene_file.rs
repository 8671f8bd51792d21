use crate::SceneError;
use serde::Deserialize;
use serde_saphyr::{MessageFormatter, Spanned, UserMessageFormatter};
use spatial::{DVec3, Pose};
use std::path::Path;

/// scene.yaml as it stands in the file; unknown keys are errors.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SceneFile {
    /// Name of the scene.
    pub name: String,
    /// The parts of A, in A's frame.
    pub moving: Vec<Entry>,
    /// The obstacles, in W.
    pub fixed: Vec<Entry>,
}

/// One mesh of a scene.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Entry {
    /// Mesh or URDF file, relative to the scene file.
    pub mesh: Spanned<String>,
    /// Where it is.
    #[serde(default)]
    pose: Option<Spanned<PoseEntry>>,
    /// Factor on the mesh's coordinates, before the pose.
    #[serde(default)]
    scale: Option<Spanned<f64>>,
    /// What to do with meshes that are not convex.
    #[serde(default)]
    pub convex: Convexity,
    /// Coulomb coefficient of this obstacle, static and kinetic alike; otherwise the gains say.
    #[serde(default)]
    friction: Option<Spanned<f64>>,
}

#[derive(Clone, Copy, Debug, Default, Deserialize)]
#[serde(deny_unknown_fields)]
struct PoseEntry {
    #[serde(default)]
    xyz: [f64; 3],
    #[serde(default)]
    rpy: [f64; 3],
}

/// What to do with a mesh that is not convex.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Convexity {
    /// Decompose it if needed.
    #[default]
    Auto,
    /// Refuse it.
    Exact,
    /// Take its convex hull.
    Hull,
}

impl SceneFile {
    /// Reads the YAML text of the file named `file`.
    pub fn parse(yaml: &str, file: &Path) -> Result<Self, SceneError> {
        let mut options = serde_saphyr::Options::default();
        options.with_snippet = false;
        let scene: Self = serde_saphyr::from_str_with_options(yaml, options)
            .map_err(|e| SceneError::new(file, e.location().map(|l| l.line()).filter(|l| *l > 0), plain(&e)))?;
        if scene.name.trim().is_empty() {
            return Err(SceneError::new(file, None, "`name` is empty"));
        }
        for (list, entries) in [("moving", &scene.moving), ("fixed", &scene.fixed)] {
            if entries.is_empty() {
                return Err(SceneError::new(file, None, format!("`{list}` names no mesh")));
            }
            for entry in entries {
                entry.check(list, file)?;
            }
        }
        Ok(scene)
    }
}

/// The parser's message for users, without its own account of the place.
fn plain(e: &serde_saphyr::Error) -> String {
    UserMessageFormatter.format_message(e).into_owned()
}

impl Entry {
    fn check(&self, list: &str, file: &Path) -> Result<(), SceneError> {
        let refuse = |at: u64, reason: String| Err(SceneError::new(file, Some(at), reason));
        if self.mesh.value.is_empty() {
            return refuse(self.mesh.defined.line(), "`mesh` is empty".into());
        }
        if let Some(pose) = &self.pose
            && !pose.value.xyz.iter().chain(&pose.value.rpy).all(|x| x.is_finite())
        {
            return refuse(pose.defined.line(), "`pose` has a number that is not finite".into());
        }
        if let Some(scale) = &self.scale
            && !(scale.value > 0.0 && scale.value.is_finite())
        {
            return refuse(scale.defined.line(), format!("`scale` is {}: need a finite number > 0", scale.value));
        }
        match &self.friction {
            Some(f) if list == "moving" => refuse(f.defined.line(), "`friction` belongs to entries of `fixed`".into()),
            Some(f) if !(0.0..=10.0).contains(&f.value) => {
                refuse(f.defined.line(), format!("`friction` is {}: need 0 to 10", f.value))
            }
            _ => Ok(()),
        }
    }

    /// Where the mesh is: in A's frame or in W.
    pub fn pose(&self) -> Pose {
        let PoseEntry { xyz, rpy } = self.pose.as_ref().map(|p| p.value).unwrap_or_default();
        Pose::from_xyz_rpy(DVec3::from(xyz), DVec3::from(rpy))
    }

    /// Factor on the mesh's coordinates.
    pub fn scale(&self) -> f64 {
        self.scale.as_ref().map_or(1.0, |s| s.value)
    }

    /// Coulomb coefficient, if the scene states one.
    pub fn friction(&self) -> Option<f64> {
        self.friction.as_ref().map(|f| f.value)
    }
}
