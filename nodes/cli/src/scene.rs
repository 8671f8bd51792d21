use crate::failure::Failure;
use crate::stdout::say;
use cspace::Polyhedron;
use scene::Body;
use std::path::{Path, PathBuf};

/// `scene`: look at scenes.
#[derive(clap::Args)]
pub struct Args {
    #[command(subcommand)]
    command: Command,
}

#[derive(clap::Subcommand)]
enum Command {
    /// Load a scene with all its meshes and say what it is made of.
    Check {
        /// The scene file.
        scene: PathBuf,
    },
}

/// Runs `scene`.
pub fn run(args: &Args) -> Result<(), Failure> {
    let Command::Check { scene } = &args.command;
    check(scene)
}

fn check(path: &Path) -> Result<(), Failure> {
    let scene = scene::Scene::load(path).map_err(Failure::plain)?;
    say(&format!("scene {}", scene.name))?;
    for body in &scene.moving {
        describe("moving", body, scene.world.moving[body.parts.clone()].iter().map(AsRef::as_ref))?;
    }
    for body in &scene.fixed {
        describe("fixed", body, scene.world.fixed[body.parts.clone()].iter().map(|f| f.polyhedron.as_ref()))?;
    }
    say("ok")
}

fn describe<'a>(list: &str, body: &Body, parts: impl Iterator<Item = &'a Polyhedron>) -> Result<(), Failure> {
    let (mut pieces, mut faces, mut vertices) = (0, 0, 0);
    for part in parts {
        pieces += 1;
        faces += part.face_count();
        vertices += part.corner_ids().count();
    }
    let note = body.note.as_ref().map_or(String::new(), |n| format!(" ({n})"));
    let friction = body.friction.map_or(String::new(), |f| format!(", friction {f}"));
    let mesh = &body.mesh;
    say(&format!("{list} {mesh}: {pieces} convex, {faces} faces, {vertices} vertices{friction}{note}"))
}
