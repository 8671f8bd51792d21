use crate::{Failure, Outcome};
use bag::msg::{Header, SceneDescription, SceneFile};
use scene::{Bundle, Scene};
use sha2::{Digest, Sha256};
use spatial::Stamp;
use std::path::PathBuf;

/// A scene as its message: text and meshes, so that a bag renders again where the files are no longer at hand.
#[must_use]
pub fn scene_description(scene: &Scene, at: Stamp, frame_id: &str) -> SceneDescription {
    let bundle = &scene.bundle;
    let files: Vec<SceneFile> =
        bundle.files.iter().map(|(path, data)| SceneFile { path: path.clone(), data: data.clone() }).collect();
    let mut hash = Sha256::new();
    let texts = std::iter::once(bundle.yaml.as_bytes()).chain(files.iter().map(|f| f.data.as_slice()));
    for (i, bytes) in texts.enumerate() {
        if i > 0 {
            hash.update(files[i - 1].path.as_bytes());
        }
        hash.update((bytes.len() as u64).to_le_bytes());
        hash.update(bytes);
    }
    SceneDescription {
        header: Header { stamp: at.into(), frame_id: frame_id.to_owned() },
        name: scene.name.clone(),
        sha256: hex(&hash.finalize()),
        yaml: bundle.yaml.clone(),
        files,
    }
}

/// The scene of a message, built as if from its files.
///
/// # Errors
/// What is wrong with it, as for the files themselves.
pub fn scene_from(description: &SceneDescription) -> Outcome<Scene> {
    let bundle = Bundle {
        path: PathBuf::from(format!("{} (received)", description.name)),
        yaml: description.yaml.clone(),
        files: description.files.iter().map(|f| (f.path.clone(), f.data.clone())).collect(),
    };
    Scene::build(bundle).map_err(|e| Failure::new(e.to_string()))
}

/// SHA-256 of a text, as 64 lower-case hexadecimal digits.
#[must_use]
pub fn sha256(text: &str) -> String {
    hex(&Sha256::digest(text.as_bytes()))
}

fn hex(bytes: &[u8]) -> String {
    bytes.iter().map(|b| format!("{b:02x}")).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::path::Path;

    #[test]
    fn a_scene_comes_through_its_message_with_the_same_parts() {
        let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../config/scenes/peg_in_hole/scene.yaml");
        let scene = Scene::load(&file).unwrap();
        let sent = scene_description(&scene, Stamp(0), "world");
        let back = scene_from(&sent).unwrap();
        assert_eq!(back.name, scene.name);
        let corners = |s: &Scene| s.world.fixed.iter().map(|f| f.polyhedron.vertices().to_vec()).collect::<Vec<_>>();
        assert_eq!(corners(&back), corners(&scene));
        assert_eq!(scene_description(&back, Stamp(1), "map").sha256, sent.sha256);
        let mut touched = sent.clone();
        touched.files[0].data.push(b'\n');
        assert_ne!(scene_description(&scene_from(&touched).unwrap(), Stamp(0), "world").sha256, sent.sha256);
    }

    #[test]
    fn the_hash_of_nothing_is_the_known_one() {
        assert_eq!(sha256(""), "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
    }
}
