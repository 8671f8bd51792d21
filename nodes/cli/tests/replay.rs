//! `replay` and `scene check` as a user runs them.

use std::path::{Path, PathBuf};
use std::process::{Command, Output};

const HEADER: &str =
    "t,depth,formation,contacts,scp_x,scp_y,scp_z,fx,fy,fz,tx,ty,tz,out_fx,out_fy,out_fz,out_tx,out_ty,out_tz,health";
const POSE_HEADER: &str = "t,x,y,z,qx,qy,qz,qw";

fn scene() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../config/scenes/peg_in_hole/scene.yaml")
}

fn run(args: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_cspace-haptics")).args(args).output().unwrap()
}

/// The peg comes down into the plate beside its hole, 2 mm deep, and leaves again.
fn motion() -> String {
    let mut text = format!("{POSE_HEADER}\n");
    for i in 0..1500 {
        let t = f64::from(i) * 1e-3;
        let z = 0.016 - 0.0015 * (1.0 - (std::f64::consts::TAU * t / 1.5).cos());
        text += &format!("{t:.3},0.018,0.0,{z},0.0,0.0,0.0,1.0\n");
    }
    text
}

fn text(path: &Path) -> &str {
    path.to_str().unwrap()
}

struct Folder(tempfile::TempDir);

impl Folder {
    fn new() -> Self {
        let folder = Self(tempfile::tempdir().unwrap());
        std::fs::write(folder.path("p.csv"), motion()).unwrap();
        folder
    }

    fn path(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    fn replay(&self, out: &str, more: &[&str]) -> Output {
        let (scene, poses, out) = (scene(), self.path("p.csv"), self.path(out));
        let mut args = vec!["replay", "--scene", text(&scene), "--poses", text(&poses), "--out", text(&out)];
        args.extend(more);
        run(&args)
    }

    fn read(&self, name: &str) -> String {
        std::fs::read_to_string(self.path(name)).unwrap()
    }
}

fn numbers(row: &str) -> Vec<f64> {
    row.split(',').map(|f| f.parse().unwrap_or(f64::NAN)).collect()
}

#[test]
fn every_law_renders_the_wall_and_says_so_in_the_columns_agreed() {
    for law in ["paper", "pstar", "blended", "proxy"] {
        let folder = Folder::new();
        let output = folder.replay("o.csv", &["--law", law]);
        assert!(output.status.success(), "{law}: {}", String::from_utf8_lossy(&output.stderr));
        assert!(output.stdout.is_empty() && output.stderr.is_empty());
        let csv = folder.read("o.csv");
        let mut lines = csv.lines();
        assert_eq!(lines.next(), Some(HEADER));
        let rows: Vec<Vec<f64>> = lines.map(numbers).collect();
        assert_eq!(rows.len(), 1500);
        for (i, row) in rows.iter().enumerate() {
            assert_eq!(row.len(), 20);
            assert!((row[0] - i as f64 * 1e-3).abs() < 1e-15);
            let depth = row[1];
            assert!(depth >= 0.0);
            // 1 N/mm, straight up; the law's wrench is the hand's.
            assert!((row[9] - 1000.0 * depth).abs() < 1e-6, "{law} row {i}: {row:?}");
            assert!(row[7].abs() + row[8].abs() < 1e-6);
            assert_eq!(row[19], 0.0, "health");
        }
        let deepest = rows[750].clone();
        assert!((deepest[1] - 0.002).abs() < 1e-9 && (deepest[6] - 0.015).abs() < 1e-6, "{deepest:?}");
        assert!((deepest[15] - 2.0).abs() < 0.05, "after the ramp the device gets it: {deepest:?}");
        assert_eq!(rows[0][15], 0.0);
        assert!(csv.lines().nth(751).unwrap().contains(",face-face,"), "{law}");
    }
}

#[test]
fn the_same_motion_gives_the_same_bytes_and_so_does_its_bag() {
    let folder = Folder::new();
    let bag = folder.path("bag");
    assert!(folder.replay("a.csv", &["--bag-out", text(&bag)]).status.success());
    assert!(folder.replay("b.csv", &[]).status.success());
    assert!(folder.read("a.csv") == folder.read("b.csv"));
    let out = folder.path("c.csv");
    let output = run(&["replay", "--bag", text(&bag), "--out", text(&out)]);
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    assert_eq!(String::from_utf8_lossy(&output.stdout), "1500 ticks, all identical to the recorded ones\n");
    assert!(folder.read("a.csv") == folder.read("c.csv"));
    // The same motion under another law: the same hand, another answer, and it says so.
    let output = run(&["replay", "--bag", text(&bag), "--out", text(&out), "--law", "paper"]);
    let said = String::from_utf8_lossy(&output.stdout).into_owned();
    assert!(output.status.success() && said.contains(" differ from the recorded ones, first at tick "), "{said}");
}

/// Times that are no whole nanoseconds (7 * 0.001 is 0.007, 9 * 0.001 is 0.009000000000000001) came back rounded.
#[test]
fn times_come_back_from_a_bag_as_they_stood_in_the_csv() {
    let folder = Folder::new();
    let steps = [1e-3, 1.0 / 3e3, 0.0, 1e-4 * std::f64::consts::PI];
    for (name, step) in steps.iter().enumerate() {
        let row = |i: u32| format!("{:?},0.018,0.0,0.016,0.0,0.0,0.0,1.0\n", f64::from(i) * step);
        std::fs::write(folder.path("p.csv"), format!("{POSE_HEADER}\n{}", (0..400).map(row).collect::<String>()))
            .unwrap();
        let (bag, out) = (folder.path(&format!("bag{name}")), folder.path("c.csv"));
        assert!(folder.replay("a.csv", &["--bag-out", text(&bag)]).status.success());
        assert!(run(&["replay", "--bag", text(&bag), "--out", text(&out)]).status.success());
        assert!(folder.read("a.csv") == folder.read("c.csv"), "{step}");
    }
}

#[test]
fn time_is_one_line() {
    let folder = Folder::new();
    let output = folder.replay("o.csv", &["--time"]);
    let said = String::from_utf8_lossy(&output.stdout).into_owned();
    let words: Vec<&str> = said.split_whitespace().collect();
    assert_eq!(said.lines().count(), 1);
    assert_eq!(words.len(), 6, "{said}");
    for (word, prefix) in words.iter().zip(["step_ns", "mean=", "p50=", "p99=", "max=", "n=1500"]) {
        assert!(word.starts_with(prefix), "{said}");
    }
}

#[test]
fn bad_input_is_one_line_with_exit_code_1_and_leaves_nothing_behind() {
    let folder = Folder::new();
    std::fs::write(folder.path("nan.csv"), format!("{POSE_HEADER}\n0,0,0,0,0,0,0,1\n1,nan,0,0,0,0,0,1\n")).unwrap();
    std::fs::write(folder.path("params.yaml"), "/**:\n  ros__parameters:\n    gains: {stiffness: .nan}\n").unwrap();
    std::fs::create_dir(folder.path("empty")).unwrap();
    let scene = scene();
    let (scene, p, nan, params, none, empty) = (
        text(&scene),
        folder.path("p.csv"),
        folder.path("nan.csv"),
        folder.path("params.yaml"),
        folder.path("none"),
        folder.path("empty"),
    );
    let (p, nan, params, none, empty) = (text(&p), text(&nan), text(&params), text(&none), text(&empty));
    let out = folder.path("o.csv");
    let table: &[(&[&str], &str)] = &[
        (&["--scene", scene, "--poses", nan], "nan.csv:3: "),
        (&["--scene", scene, "--poses", none], "none: "),
        (&["--scene", none, "--poses", p], "none: "),
        (&["--scene", p, "--poses", p], "p.csv"),
        (&["--scene", scene, "--poses", p, "--params", params], "params.yaml: "),
        (&["--scene", scene, "--bag", none], "none"),
        (&["--bag", empty], "empty"),
    ];
    for (args, reason) in table {
        let mut all = vec!["replay", "--out", text(&out)];
        all.extend(*args);
        let output = run(&all);
        let said = String::from_utf8_lossy(&output.stderr).into_owned();
        assert_eq!(output.status.code(), Some(1), "{args:?}: {said}");
        assert!(said.starts_with("error: ") && said.contains(reason) && said.lines().count() == 1, "{args:?}: {said}");
        assert!(!out.exists());
    }
    let names = std::fs::read_dir(folder.0.path()).unwrap().map(|e| e.unwrap().file_name()).collect::<Vec<_>>();
    assert_eq!(names.len(), 4, "nothing half-written: {names:?}");
}

#[test]
fn help_tells_every_column_and_health_bit() {
    let help = |command: &str| String::from_utf8(run(&[command, "--help"]).stdout).unwrap();
    for name in HEADER.split(',').filter(|n| !["fy", "fz", "tx", "ty"].contains(n) && !n.starts_with("out_")) {
        assert!(help("replay").contains(name), "{name}");
    }
    for (bit, name) in servo::Health::NAMES {
        assert!(help("replay").contains(&format!("{} {name}", bit.0)), "{name}");
    }
    let folder = Folder::new();
    let (a, out) = (folder.path("a.obj"), folder.path("o.csv"));
    std::fs::copy(scene().with_file_name("peg.obj"), &a).unwrap();
    let poses = folder.path("p.csv");
    let files = [text(&a), text(&a), text(&poses), text(&out)];
    let args = ["track", "--moving", files[0], "--fixed", files[1], "--poses", files[2], "--out", files[3]];
    assert!(run(&args).status.success());
    for name in folder.read("o.csv").lines().next().unwrap().split(',') {
        assert!(help("track").contains(name), "{name}");
    }
}

#[test]
fn usage_errors_have_exit_code_2() {
    for args in [
        &["replay"][..],
        &["replay", "--out", "o.csv", "--poses", "p.csv"],
        &["replay", "--out", "o.csv", "--scene", "s", "--poses", "p", "--bag", "b"],
        &["replay", "--out", "o.csv", "--scene", "s", "--poses", "p", "--law", "magic"],
        &["scene"],
        &["scene", "check"],
        &["nonsense"],
        &[],
    ] {
        assert_eq!(run(args).status.code(), Some(2), "{args:?}");
    }
}

#[test]
fn scene_check_says_what_a_scene_is_made_of() {
    let output = run(&["scene", "check", text(&scene())]);
    let said = String::from_utf8_lossy(&output.stdout).into_owned();
    assert!(output.status.success());
    assert!(said.contains("fixed hole.obj: 5 convex, 30 faces") && said.ends_with("ok\n"), "{said}");
    let output = run(&["scene", "check", "/nowhere/scene.yaml"]);
    assert_eq!(output.status.code(), Some(1));
    assert!(String::from_utf8_lossy(&output.stderr).starts_with("error: /nowhere/scene.yaml: "));
}
