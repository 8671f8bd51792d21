use crate::flat::straightened;
use crate::scene_file::{Entry, SceneFile};
use crate::urdf::{UrdfShape, parse_urdf};
use crate::{Mesh, MeshError, SceneError, parse_obj, parse_stl};
use serde::{Deserialize, Serialize};
use spatial::{DVec3, Pose};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// A scene file and every mesh it names, as bytes: all that a scene is built from. A bag carries it, so that a
/// recorded motion renders the same without the files it was made from.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Bundle {
    /// The scene file, for messages.
    pub path: PathBuf,
    /// Its text.
    pub yaml: String,
    /// Meshes by the name that the scene file gives them; a URDF's own meshes as `URDF#NAME`.
    pub files: BTreeMap<String, Vec<u8>>,
}

impl Bundle {
    /// Reads a scene file and the meshes it names.
    pub fn read(path: &Path) -> Result<Self, SceneError> {
        let yaml = String::from_utf8(read(path)?).map_err(|_| SceneError::new(path, None, "not UTF-8 text"))?;
        let scene = SceneFile::parse(&yaml, path)?;
        let mut bundle = Self { path: path.to_owned(), yaml, files: BTreeMap::new() };
        for entry in scene.moving.iter().chain(&scene.fixed) {
            bundle.add(entry)?;
        }
        Ok(bundle)
    }

    /// The scene file and those that it names, as far as they are files of their own.
    #[must_use]
    pub fn paths(&self) -> Vec<PathBuf> {
        let meshes = self.files.keys().map(|name| self.label(name));
        std::iter::once(self.path.clone()).chain(meshes).collect()
    }

    fn add(&mut self, entry: &Entry) -> Result<(), SceneError> {
        let name = &entry.mesh.value;
        if self.files.contains_key(name) {
            return Ok(());
        }
        let file = self.label(name);
        let bytes = std::fs::read(&file).map_err(|e| {
            // The scene file is at fault where it names what is not there.
            SceneError::new(&self.path, Some(entry.mesh.defined.line()), format!("mesh {}: {e}", file.display()))
        })?;
        if extension(name) == "urdf" {
            for geometry in urdf(&bytes, &file)? {
                if let UrdfShape::Mesh { file: mesh, .. } = geometry.shape {
                    let bytes = read(&urdf_mesh_path(&file, &mesh)?)?;
                    self.files.insert(format!("{name}#{mesh}"), bytes);
                }
            }
        }
        self.files.insert(name.clone(), bytes);
        Ok(())
    }

    /// The file of a mesh, for messages.
    pub(crate) fn label(&self, name: &str) -> PathBuf {
        self.path.parent().unwrap_or(Path::new("")).join(name)
    }

    /// The meshes of an entry, scaled and placed: in A's frame or in W.
    pub(crate) fn meshes(&self, entry: &Entry) -> Result<Vec<Mesh>, SceneError> {
        let name = &entry.mesh.value;
        let bytes = self.bytes(name)?;
        let place = |mesh: &Mesh, pose: Pose, scale: DVec3| mesh.transformed(&pose, scale);
        if extension(name) != "urdf" {
            let mesh = parse_mesh(name, bytes).map_err(|e| self.refusal(name, &e))?;
            return Ok(vec![place(&mesh, entry.pose(), DVec3::splat(entry.scale()))]);
        }
        let mut meshes = Vec::new();
        for geometry in urdf(bytes, &self.label(name))? {
            let (mesh, scale) = match &geometry.shape {
                UrdfShape::Box(mesh) => (mesh.clone(), DVec3::ONE),
                UrdfShape::Mesh { file, scale } => {
                    let key = format!("{name}#{file}");
                    (parse_mesh(file, self.bytes(&key)?).map_err(|e| self.refusal(&key, &e))?, *scale)
                }
            };
            let in_root = place(&mesh, geometry.root_from_geometry, scale);
            meshes.push(place(&in_root, entry.pose(), DVec3::splat(entry.scale())));
        }
        Ok(meshes)
    }

    fn bytes(&self, name: &str) -> Result<&[u8], SceneError> {
        let missing = || SceneError::new(&self.path, None, format!("mesh {name}: not in the bundle"));
        self.files.get(name).map(Vec::as_slice).ok_or_else(missing)
    }

    pub(crate) fn refusal(&self, name: &str, e: &MeshError) -> SceneError {
        SceneError::new(self.label(name), e.line, &e.reason)
    }
}

fn read(path: &Path) -> Result<Vec<u8>, SceneError> {
    std::fs::read(path).map_err(|e| SceneError::new(path, None, e))
}

fn extension(name: &str) -> String {
    Path::new(name).extension().unwrap_or_default().to_string_lossy().to_ascii_lowercase()
}

fn parse_mesh(name: &str, bytes: &[u8]) -> Result<Mesh, MeshError> {
    let mesh = match extension(name).as_str() {
        "obj" => {
            parse_obj(std::str::from_utf8(bytes).map_err(|_| MeshError::whole("not UTF-8 text: not an OBJ file"))?)
        }
        "stl" => Ok(parse_stl(bytes)?.welded()),
        other => Err(MeshError::whole(format!("unknown kind of mesh {other:?}: need .obj, .stl or .urdf"))),
    };
    mesh.map(straightened)
}

fn urdf(bytes: &[u8], file: &Path) -> Result<Vec<crate::urdf::UrdfGeometry>, SceneError> {
    let text = std::str::from_utf8(bytes).map_err(|_| SceneError::new(file, None, "not UTF-8 text: not a URDF"))?;
    parse_urdf(text).map_err(|e| SceneError::new(file, e.line, e.reason))
}

/// `package://P/x` is looked for under the nearest folder named P above the URDF; other names are relative to it.
fn urdf_mesh_path(urdf: &Path, name: &str) -> Result<PathBuf, SceneError> {
    let folder = urdf.parent().unwrap_or(Path::new(""));
    let Some(rest) = name.strip_prefix("package://") else {
        return Ok(folder.join(name.strip_prefix("file://").unwrap_or(name)));
    };
    let (package, inner) = rest.split_once('/').unwrap_or((rest, ""));
    let above = std::path::absolute(folder).unwrap_or_else(|_| folder.to_owned());
    let found = above.ancestors().find(|a| a.file_name().is_some_and(|n| n == package));
    found
        .map(|a| a.join(inner))
        .ok_or_else(|| SceneError::new(urdf, None, format!("{name}: no folder {package} above this file")))
}
