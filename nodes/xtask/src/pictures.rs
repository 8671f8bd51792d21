//! `cargo xtask pictures`: the README's pictures, drawn anew from recordings of replayed motions, without a screen.

mod motion;
mod temporary;
mod vulkan;

use crate::cargo_build;
use crate::demo::child::Family;
use crate::demo::viewer;
use crate::env;
use crate::progress::Step;
use crate::workspace;
use anyhow::{Context, Result, bail};
use motion::{Key, key};
use std::fs;
use std::path::Path;
use std::process::{Command, ExitCode};
use std::time::{Duration, Instant};
use temporary::Temporary;

/// Which pictures to draw.
#[derive(clap::Args)]
pub struct Arguments {
    /// Only this picture; otherwise all
    #[arg(value_parser = PICTURES.map(|picture| picture.name))]
    name: Option<String>,
}

/// One picture: the end of a motion in a scene.
struct Picture {
    /// Of the file in docs/pictures.
    name: &'static str,
    /// A folder of config/scenes.
    scene: &'static str,
    keys: &'static [Key],
}

const PICTURES: [Picture; 3] = [
    // The peg leans in the mouth of the hole: its lower edge on one wall, its side on the rim across.
    Picture {
        name: "peg_in_hole",
        scene: "peg_in_hole",
        keys: &[
            key(0.0, [0.69, 0.0, 24.0], [0.0; 3]),
            key(0.8, [0.69, 0.0, 17.0], [0.0, 3.0, 0.0]),
            key(2.0, [0.69, 0.0, 11.6], [0.0, 3.0, 0.0]),
            key(3.0, [-0.8, 0.0, 10.5], [0.0, 8.0, 0.0]),
            key(3.4, [-0.8, 0.0, 10.5], [0.0, 8.0, 0.0]),
        ],
    },
    // Figures 2 and 3 of the paper: slid over the top of the box and down over its edge.
    Picture {
        name: "tetra_on_box",
        scene: "tetra_on_box",
        keys: &[
            key(0.0, [-30.0, -10.0, 40.0], [20.0, 12.0, 0.0]),
            key(1.2, [0.0, -12.0, 28.0], [20.0, 12.0, 0.0]),
            key(2.4, [20.0, -12.0, 22.0], [20.0, 12.0, 0.0]),
            key(4.0, [45.0, -1.0, 21.5], [20.0, 12.0, 0.0]),
        ],
    },
    // Down to the floor, along it to the wall.
    Picture {
        name: "corner",
        scene: "corner",
        keys: &[
            key(0.0, [-20.0, -10.0, 30.0], [0.0; 3]),
            key(1.3, [-10.0, -5.0, 13.6], [0.0; 3]),
            key(2.8, [9.0, 4.0, 13.4], [0.0, 0.0, 12.0]),
            key(3.3, [9.0, 4.0, 13.4], [0.0, 0.0, 12.0]),
        ],
    },
];

/// Size in logical points; the viewer draws each as two by two pixels without a screen.
const SIZE: &str = "1600x900";
/// Takes two drawings of the same recording. Writes the picture if both are whole: the legend's first colour is in it,
/// and they are alike but for single pixels; the viewer may have drawn before it had read everything. Pixels are averaged
/// back to logical points: smooth lines, and files that a repository can hold.
const SETTLE: &str = "
import sys
from PIL import Image, ImageChops
first, second = (Image.open(name).convert('RGB') for name in sys.argv[1:3])
pixels = first.width * first.height
legend = sum(count for count, color in second.getcolors(pixels) if color == (0xD5, 0x3E, 0x0F))
other = ImageChops.difference(first, second).convert('L').point(lambda value: 255 if value > 32 else 0)
if legend < 500 or other.histogram()[255] > 0.001 * pixels:
    sys.exit(2)
size = second.width // 2, second.height // 2
second.resize(size, Image.Resampling.LANCZOS).save(sys.argv[3], optimize=True)
";
/// What `SETTLE` says of drawings that are not whole.
const UNSETTLED: i32 = 2;
/// How often a recording is drawn at most.
const ATTEMPTS: usize = 8;
/// How long one picture may take to draw on a slow processor.
const PATIENCE: Duration = Duration::from_secs(300);

/// Draws the pictures.
///
/// # Errors
/// What is needed cannot be brought, a motion cannot be replayed, or the viewer does not draw.
pub fn run(arguments: &Arguments) -> Result<ExitCode> {
    vulkan::require()?;
    let tools = env::bring_python_tools()?;
    let viewer = viewer::program(&tools)?;
    let executables = cargo_build::offline()?;
    let replay = executables.get("cspace-haptics")?;
    let folder = workspace::root().join("docs/pictures");
    fs::create_dir_all(&folder).with_context(|| format!("{}: cannot create the folder", folder.display()))?;
    let work = Temporary::create()?;
    let log = workspace::cache()?.join("pictures.log");
    let _ = fs::remove_file(&log);
    for picture in PICTURES.iter().filter(|p| arguments.name.as_deref().is_none_or(|name| name == p.name)) {
        let step = Step::begin(format!("picture {}", picture.name));
        let file = |suffix: &str| work.path().join(format!("{}{suffix}", picture.name));
        let (poses, recording) = (file(".csv"), file(".rrd"));
        motion::write_csv(&poses, picture.keys)?;
        let scene = workspace::root().join("config/scenes").join(picture.scene).join("scene.yaml");
        let mut command = Command::new(replay);
        command.arg("replay").arg("--scene").arg(scene).arg("--poses").arg(&poses);
        step.run(command.arg("--out").arg(file(".out.csv")).arg("--rrd").arg(&recording), &log)?;
        draw_settled(&tools, &viewer, &recording, &file(".png"))?;
        // The temporary folder may be on another file system: copied, not renamed.
        let target = folder.join(format!("{}.png", picture.name));
        fs::copy(file(".png"), &target).with_context(|| format!("{}: cannot write", target.display()))?;
        step.done();
        println!("{}", target.display());
    }
    Ok(ExitCode::SUCCESS)
}

/// Draws a recording until two drawings agree.
fn draw_settled(tools: &Path, viewer: &Path, recording: &Path, picture: &Path) -> Result<()> {
    let drawings = ["a.png", "b.png"].map(|name| recording.with_extension(name));
    draw(viewer, recording, &drawings[0])?;
    for attempt in 1..ATTEMPTS {
        draw(viewer, recording, &drawings[attempt % 2])?;
        let mut settle = Command::new(tools.join("bin/python"));
        settle.args(["-I", "-c", SETTLE]).args(&drawings).arg(picture);
        let output = settle.output().context("the interpreter of the tools cannot be started")?;
        if output.status.success() {
            return Ok(());
        }
        if output.status.code() != Some(UNSETTLED) {
            let said = String::from_utf8_lossy(&output.stderr);
            bail!("{}: {}", recording.display(), said.lines().last().unwrap_or("the drawings cannot be compared"));
        }
    }
    bail!("{}: the viewer draws it differently every time, {ATTEMPTS} times", recording.display())
}

/// Has the viewer draw a recording as it opens.
fn draw(viewer: &Path, recording: &Path, picture: &Path) -> Result<()> {
    // Else the drawing of the last attempt would pass for this one's.
    let _ = fs::remove_file(picture);
    let runtime = picture.parent().unwrap_or(Path::new("/tmp"));
    let mut command = Command::new(viewer);
    command
        .args(["--headless", "--bind", "127.0.0.1", "--port", "auto", "--window-size", SIZE, "--screenshot-to"])
        .args([picture, recording])
        // What it logs it also shows, over the views.
        .env("RUST_LOG", "off")
        // It asks for a folder of the session, which a container has not.
        .env("XDG_RUNTIME_DIR", runtime);
    let mut family = Family::new();
    let child = family.start("rerun", &command)?;
    let begun = Instant::now();
    while family.dead().is_none() {
        if begun.elapsed() > PATIENCE {
            bail!("{}: the viewer has not drawn it after {} s", recording.display(), PATIENCE.as_secs());
        }
        family.listen_for(Duration::from_millis(100));
    }
    // It may end well without a picture.
    if !picture.is_file() {
        bail!("{}: the viewer drew nothing: {}", recording.display(), family.children[child].last_words());
    }
    Ok(())
}
