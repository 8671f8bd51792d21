//! What `inspect` takes for a bag: whatever a recorder may have written.
#![cfg(feature = "inspect")]

use bag::msg::{SceneDescription, TickBatch};
use bag::{BagOptions, BagWriter, Qos, TickLog, read_ticks, tick_to_msg};
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

fn scene() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../config/scenes/corner/scene.yaml")
}

fn run(command: &str, args: &[&Path]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_cspace-haptics")).args(command.split(' ')).args(args).output().unwrap()
}

/// A short run and the scene that goes with it.
fn log(folder: &Path) -> TickLog {
    let (poses, csv, bag) = (folder.join("p.csv"), folder.join("o.csv"), folder.join("run"));
    let rows: String = (0..30).map(|i| format!("{},0,0,{},0,0,0,1\n", f64::from(i) * 1e-3, 0.05)).collect();
    std::fs::write(&poses, format!("t,x,y,z,qx,qy,qz,qw\n{rows}")).unwrap();
    let p = Path::new;
    let made = run("replay", &[p("--scene"), &scene(), p("--poses"), &poses, p("--out"), &csv, p("--bag-out"), &bag]);
    assert!(made.status.success(), "{}", String::from_utf8_lossy(&made.stderr));
    read_ticks(&bag, None).unwrap()
}

/// What a recorder writes that hears the ticks of each servo before its scene, if it hears that.
fn ticks_first(dir: &Path, log: &TickLog, servos: &[&str], with_scene: bool) {
    let mut writer = BagWriter::create(dir, BagOptions::default()).unwrap();
    for servo in servos {
        let topic = writer.add::<TickBatch>(&format!("{servo}/ticks"), &[Qos::RELIABLE]).unwrap();
        let ticks = log.ticks.iter().map(tick_to_msg).collect();
        let batch = TickBatch { ticks, version: servo::TickRecord::VERSION, ..TickBatch::default() };
        let stamp = log.ticks[0].input.stamp;
        writer.write_message(topic, stamp, &batch).unwrap();
        if with_scene {
            let topic = writer.add::<SceneDescription>(&format!("{servo}/scene"), &[Qos::RELIABLE]).unwrap();
            writer.write_message(topic, stamp, log.scene.as_ref().unwrap()).unwrap();
        }
    }
    writer.finish().unwrap();
}

#[test]
fn the_scene_may_stand_behind_the_ticks() {
    let folder = tempfile::tempdir().unwrap();
    let (bag, rrd) = (folder.path().join("bag"), folder.path().join("o.rrd"));
    ticks_first(&bag, &log(folder.path()), &["/haptic_servo"], true);
    let output = run("inspect", &[&bag, Path::new("--rrd"), &rrd]);
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    assert!(rrd.metadata().unwrap().len() > 10_000);
}

#[test]
fn of_several_servos_one_is_chosen_by_its_topic() {
    let folder = tempfile::tempdir().unwrap();
    let (bag, rrd) = (folder.path().join("bag"), folder.path().join("o.rrd"));
    ticks_first(&bag, &log(folder.path()), &["/left/haptic_servo", "/right/haptic_servo"], true);
    let output = run("inspect", &[&bag, Path::new("--rrd"), &rrd]);
    assert_eq!(output.status.code(), Some(1));
    assert!(String::from_utf8_lossy(&output.stderr).contains("(--topic)") && !rrd.exists());
    let chosen = [Path::new("--topic"), Path::new("/left/haptic_servo/ticks")];
    assert!(run("inspect", &[&[bag.as_path(), Path::new("--rrd"), &rrd], &chosen[..]].concat()).status.success());
    assert!(run("bag summary", &[&[bag.as_path()], &chosen[..]].concat()).status.success());
}

#[test]
fn a_bag_without_its_scene_is_drawn_in_the_one_that_is_named() {
    let folder = tempfile::tempdir().unwrap();
    let (bag, rrd) = (folder.path().join("bag"), folder.path().join("o.rrd"));
    ticks_first(&bag, &log(folder.path()), &["/haptic_servo"], false);
    let output = run("inspect", &[&bag, Path::new("--rrd"), &rrd]);
    let said = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(output.status.code() == Some(1) && said.contains("name one with --scene") && !rrd.exists(), "{said}");
    let output = run("inspect", &[&bag, Path::new("--rrd"), &rrd, Path::new("--scene"), &scene()]);
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
}

#[test]
fn a_recording_that_cannot_be_written_is_named_once() {
    let folder = tempfile::tempdir().unwrap();
    log(folder.path());
    let (rrd, out) = (folder.path().join("no/o.rrd"), folder.path().join("again.csv"));
    let (p, bag) = (Path::new, folder.path().join("run"));
    let output = run("replay", &[p("--bag"), &bag, p("--out"), &out, p("--rrd"), &rrd]);
    let said = String::from_utf8_lossy(&output.stderr).into_owned();
    assert_eq!((output.status.code(), said.matches("no/o.rrd").count()), (Some(1), 1), "{said}");
    assert!(!out.exists());
}

/// A recording that ended early (here: no ticks to draw) left a file that viewers open and show nothing of.
#[test]
fn a_recording_appears_whole_or_not_at_all_and_goes_where_a_pipe_leads() {
    let folder = tempfile::tempdir().unwrap();
    log(folder.path());
    let (bag, rrd, link) = (folder.path().join("run"), folder.path().join("o.rrd"), folder.path().join("link.rrd"));
    std::os::unix::fs::symlink("/proc/self/fd/1", &link).unwrap();
    let to = |rrd: &Path| run("inspect", &[&bag, Path::new("--rrd"), rrd]);
    assert!(to(&rrd).status.success());
    let whole = std::fs::metadata(&rrd).unwrap().len();
    let piped = to(&link).stdout;
    assert!(piped.starts_with(b"RRF") && piped.len().abs_diff(whole as usize) < 4096, "{} of {whole}", piped.len());

    // Cut in the middle: what was there stays, and nothing else is left behind.
    let mut data = std::fs::read(bag.join("run_0.mcap")).unwrap();
    data.truncate(200);
    std::fs::write(bag.join("run_0.mcap"), data).unwrap();
    let names = || folder.path().read_dir().unwrap().count();
    let before = names();
    assert_eq!(to(&rrd).status.code(), Some(1));
    assert_eq!(to(&folder.path().join("new.rrd")).status.code(), Some(1));
    assert_eq!((std::fs::metadata(&rrd).unwrap().len(), names()), (whole, before));
}
