//! What `replay` takes from bags of poses, and what it leaves behind when something is wrong.

use bag::msg::{Header, PoseStamped};
use bag::{BagOptions, BagWriter, Qos};
use spatial::{DQuat, DVec3, Pose, Stamp};
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

fn scene() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../config/scenes/peg_in_hole/scene.yaml")
}

fn replay(args: &[&Path]) -> Output {
    let mut command = Command::new(env!("CARGO_BIN_EXE_cspace-haptics"));
    command.arg("replay").args(args).output().unwrap()
}

fn error(output: &Output) -> String {
    let said = String::from_utf8_lossy(&output.stderr).into_owned();
    assert_eq!(output.status.code(), Some(1), "{said}");
    assert!(said.starts_with("error: ") && said.lines().count() == 1, "{said}");
    said
}

fn names(folder: &Path) -> Vec<String> {
    let mut names: Vec<_> =
        folder.read_dir().unwrap().map(|e| e.unwrap().file_name().to_string_lossy().into_owned()).collect();
    names.sort();
    names
}

/// Someone's bag: the peg goes down on `/left/tool`, stays up on `/right/tool`. The left hand's poses as CSV.
fn two_arms(dir: &Path) -> String {
    let mut csv = "t,x,y,z,qx,qy,qz,qw\n".to_owned();
    let mut writer = BagWriter::create(dir, BagOptions::default()).unwrap();
    let topics = ["/left/tool", "/right/tool"].map(|t| writer.add::<PoseStamped>(t, &[Qos::SENSOR_DATA]).unwrap());
    for i in 0..100i64 {
        let stamp = Stamp(1_000_000_000 + i * 1_000_000);
        for (k, &topic) in topics.iter().enumerate() {
            let z = if k == 0 { 0.016 - 2e-5 * i as f64 } else { 0.02 };
            let pose = Pose::new(DVec3::new(0.018, 0.0, z), DQuat::from_rotation_z(0.3 + 0.001 * i as f64));
            if k == 0 {
                let (p, q) = (pose.translation, pose.rotation);
                let t = stamp.0 as f64 / 1e9;
                csv += &format!("{t:?},{:?},{:?},{:?},{:?},{:?},{:?},{:?}\n", p.x, p.y, p.z, q.x, q.y, q.z, q.w);
            }
            let header = Header { stamp: stamp.into(), frame_id: "world".into() };
            writer.write_message(topic, stamp, &PoseStamped { header, pose: pose.into() }).unwrap();
        }
    }
    writer.finish().unwrap();
    csv
}

#[test]
fn of_several_topics_of_poses_one_is_chosen_by_name() {
    let folder = tempfile::tempdir().unwrap();
    let (bag, out, scene) = (folder.path().join("arms"), folder.path().join("o.csv"), scene());
    std::fs::write(folder.path().join("p.csv"), two_arms(&bag)).unwrap();
    let p = Path::new;
    let run = |more: &[&Path]| {
        let mut args = vec![p("--scene"), scene.as_path(), p("--bag"), bag.as_path(), p("--out"), out.as_path()];
        args.extend(more);
        replay(&args)
    };
    let said = error(&run(&[]));
    assert!(said.contains("poses on several topics; choose one of /left/tool, /right/tool (--topic)"), "{said}");
    let said = error(&run(&[p("--topic"), p("/none")]));
    assert!(said.contains("no poses on /none; choose one of /left/tool, /right/tool (--topic)"), "{said}");
    assert!(!out.exists());
    for (topic, touches) in [("/left/tool", true), ("/right/tool", false)] {
        let output = run(&[p("--topic"), p(topic)]);
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
        let csv = std::fs::read_to_string(&out).unwrap();
        assert_eq!(csv.lines().count(), 101);
        assert_eq!(csv.contains(",face-face,"), touches, "{topic}");
        if touches {
            // The same poses from a bag and from a file are the same motion, bit for bit.
            let (poses, same) = (folder.path().join("p.csv"), folder.path().join("same.csv"));
            let output = replay(&[p("--scene"), &scene, p("--poses"), &poses, p("--out"), &same]);
            assert!(output.status.success());
            assert!(std::fs::read_to_string(&same).unwrap() == csv);
        }
    }
}

#[test]
fn outputs_are_whole_or_not_there_and_errors_name_the_users_file() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name);
    let (poses, scene, bag) = (at("p.csv"), scene(), at("bag"));
    let text =
        "t,x,y,z,qx,qy,qz,qw\n0,0,0,0.02,0,0,0,1\n0.001,0,0,0.02,0,0,0,1\n0.001,9e9,0,-9e9,0,0,0,1\n1,0,0,0,1,0,0,0\n";
    std::fs::write(&poses, text).unwrap();
    std::fs::create_dir(at("taken")).unwrap();
    let p = Path::new;
    let run = |out: &Path, bag: &Path| {
        let (scene, poses) = (scene.as_path(), poses.as_path());
        replay(&[p("--scene"), scene, p("--poses"), poses, p("--out"), out, p("--bag-out"), bag])
    };
    for (out, bag, reason) in [
        (at("no/o.csv"), bag.clone(), "no/o.csv: cannot be written: No such file or directory"),
        (at("taken"), bag.clone(), "taken: is a folder, not a file to write"),
        (at("p.csv"), bag.clone(), "p.csv: is read by this command: name another file to write"),
        (at("o.csv"), at("taken"), "taken: exists already; name a new folder for the bag"),
        (at("o.csv"), at("p.csv/bag"), "p.csv/bag: cannot be written: "),
    ] {
        let said = error(&run(&out, &bag));
        assert!(said.contains(reason) && !said.contains(".cspace-haptics-"), "{said}");
        assert_eq!(names(folder.path()), ["p.csv", "taken"], "{said}");
        assert_eq!(std::fs::read_to_string(&poses).unwrap(), text);
    }
    // Jumps and moments twice are motions like others; they show in the health.
    let output = run(&at("o.csv"), &bag);
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    assert_eq!(names(folder.path()), ["bag", "o.csv", "p.csv", "taken"]);
    assert_eq!(names(&bag), ["bag_0.mcap", "metadata.yaml"]);
}

#[test]
fn nothing_that_is_read_and_nothing_else_that_is_written_is_written_over() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name);
    for name in ["scene.yaml", "peg.obj", "hole.obj"] {
        std::fs::copy(scene().with_file_name(name), at(name)).unwrap();
    }
    std::fs::write(at("p.csv"), "t,x,y,z,qx,qy,qz,qw\n0,0,0,0.02,0,0,0,1\n0.001,0,0,0.02,0,0,0,1\n").unwrap();
    let texts = || ["scene.yaml", "peg.obj", "hole.obj", "p.csv"].map(|n| std::fs::read(at(n)).unwrap());
    let before = texts();
    let run = |motion: [&str; 2], more: &[&str]| {
        let args: Vec<PathBuf> = ["--scene", "scene.yaml", motion[0], motion[1]]
            .iter()
            .chain(more)
            .map(|a| if a.starts_with("--") { PathBuf::from(a) } else { at(a) })
            .collect();
        replay(&args.iter().map(PathBuf::as_path).collect::<Vec<_>>())
    };
    let csv = ["--poses", "p.csv"];
    for more in [
        ["--out", "peg.obj"].as_slice(),
        &["--out", "./hole.obj"],
        &["--out", "o.csv", "--bag-out", "o.csv"],
        #[cfg(feature = "inspect")]
        &["--out", "o.csv", "--rrd", "p.csv"],
        #[cfg(feature = "inspect")]
        &["--out", "o.csv", "--rrd", "./o.csv"],
    ] {
        let said = error(&run(csv, more));
        assert!(said.contains("is read by this command") || said.contains("is to be written twice"), "{said}");
        assert!(texts() == before && names(folder.path()) == ["hole.obj", "p.csv", "peg.obj", "scene.yaml"], "{said}");
    }
    assert!(run(csv, &["--out", "o.csv", "--bag-out", "bag"]).status.success());
    let said = error(&run(["--bag", "bag"], &["--out", "bag/bag_0.mcap"]));
    assert!(said.contains("is read by this command"), "{said}");
    assert!(run(["--bag", "bag"], &["--out", "bag/again.csv"]).status.success());
}

/// Interrupted in the midst of a long motion, it leaves nothing behind: neither outputs nor files of other names.
#[test]
fn an_interrupted_run_leaves_nothing_half_written() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name);
    // Long enough to be interrupted.
    let row = |i: u32| format!("{},0.018,{},0.0148,0,0,0,1\n", f64::from(i) * 1e-3, f64::from(i % 97) * 1e-5);
    let rows: String = (0..400_000).map(row).collect();
    std::fs::write(at("p.csv"), format!("t,x,y,z,qx,qy,qz,qw\n{rows}")).unwrap();
    let mut command = Command::new(env!("CARGO_BIN_EXE_cspace-haptics"));
    command.args(["replay", "--scene"]).arg(scene()).arg("--poses").arg(at("p.csv"));
    let mut child = command.arg("--out").arg(at("o.csv")).arg("--bag-out").arg(at("bag")).spawn().unwrap();
    // The temporary file is there as soon as ticks are rendered.
    while names(folder.path()).len() < 2 {
        assert_eq!(child.try_wait().unwrap(), None, "it was over before it could be interrupted");
        std::thread::sleep(std::time::Duration::from_millis(2));
    }
    let kill = Command::new("kill").args(["-TERM", &child.id().to_string()]).status().unwrap();
    assert!(kill.success());
    assert_eq!(child.wait().unwrap().code(), Some(128 + 15));
    assert_eq!(names(folder.path()), ["p.csv"]);
}

#[test]
fn a_file_that_is_no_bag_is_told_and_a_damaged_bag_is_looked_into() {
    let folder = tempfile::tempdir().unwrap();
    let (csv, bag) = (folder.path().join("p.csv"), folder.path().join("bag"));
    std::fs::write(&csv, two_arms(&bag)).unwrap();
    let info = |path: &Path| {
        Command::new(env!("CARGO_BIN_EXE_cspace-haptics")).args(["bag", "info"]).arg(path).output().unwrap()
    };
    let said = error(&info(&csv));
    assert!(said.contains("p.csv: nothing in it is MCAP"), "{said}");
    let file = bag.join("bag_0.mcap");
    let mut data = std::fs::read(&file).unwrap();
    data[..8].fill(0);
    std::fs::write(&file, data).unwrap();
    let said = String::from_utf8(info(&bag).stdout).unwrap();
    assert!(said.contains("damage    bag_0.mcap at byte 0") && said.contains("/left/tool"), "{said}");
}

#[test]
fn a_bag_without_motion_says_what_is_damaged() {
    let folder = tempfile::tempdir().unwrap();
    let (bag, out) = (folder.path().join("bag"), folder.path().join("o.csv"));
    two_arms(&bag);
    let file = bag.join("bag_0.mcap");
    let mut data = std::fs::read(&file).unwrap();
    data.truncate(200);
    std::fs::write(&file, data).unwrap();
    let said = error(&replay(&[Path::new("--bag"), &bag, Path::new("--out"), &out]));
    assert!(said.contains("TickBatch or geometry_msgs/msg/PoseStamped; damage: bag_0.mcap at byte "), "{said}");
    assert!(!out.exists());
}
