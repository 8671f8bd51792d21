use crate::failure::Failure;
use bag::msg::SceneDescription;
use scene::{Bundle, Scene};
use std::path::Path;

/// The scene that a bag carries, built from the bytes in it.
pub fn scene_of(bag: &Path, description: &SceneDescription) -> Result<Scene, Failure> {
    if description.digest() != description.sha256 {
        return Err(Failure::file(bag, "the scene in it does not fit its hash; name the scene with --scene"));
    }
    let bundle = Bundle {
        path: bag.join(&description.name),
        yaml: description.yaml.clone(),
        files: description.files.iter().map(|f| (f.path.clone(), f.data.clone())).collect(),
    };
    Scene::build(bundle).map_err(Failure::plain)
}
