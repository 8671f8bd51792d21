//! `track` as a user runs it: what it writes, and how it refuses what it cannot use.

use std::path::PathBuf;
use std::process::{Command, Output};

const CUBE: &str = "v -1 -1 -1\nv 1 -1 -1\nv -1 1 -1\nv 1 1 -1\nv -1 -1 1\nv 1 -1 1\nv -1 1 1\nv 1 1 1\n\
                    f 1 3 4 2\nf 5 6 8 7\nf 1 2 6 5\nf 3 7 8 4\nf 1 5 7 3\nf 2 4 8 6\n";
const POSES: &str = "t,x,y,z,qx,qy,qz,qw\n0,0.1,0.2,1.9,0,0,0,1\n0.001,0.1,0.2,1.9,0,0,0,1\n0.002,0.1,0.2,3,0,0,0,1\n";

struct Folder(tempfile::TempDir);

impl Folder {
    /// Good input; a test spoils one file.
    fn new() -> Self {
        let folder = Self(tempfile::tempdir().unwrap());
        for (name, text) in [("a.obj", CUBE), ("b.obj", CUBE), ("p.csv", POSES)] {
            folder.write(name, text);
        }
        folder
    }

    fn path(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    fn write(&self, name: &str, text: impl AsRef<[u8]>) {
        std::fs::write(self.path(name), text).unwrap();
    }

    fn track(&self, out: &str) -> Output {
        self.command(out).output().unwrap()
    }

    fn command(&self, out: &str) -> Command {
        let mut command = Command::new(env!("CARGO_BIN_EXE_cspace-haptics"));
        command.args(["track", "--time", "--moving"]).arg(self.path("a.obj"));
        command.arg("--fixed").arg(self.path("b.obj")).arg("--poses").arg(self.path("p.csv"));
        command.arg("--out").arg(self.path(out));
        command
    }

    fn names(&self) -> Vec<String> {
        let entries = self.0.path().read_dir().unwrap();
        let mut names: Vec<_> = entries.map(|e| e.unwrap().file_name().into_string().unwrap()).collect();
        names.sort();
        names
    }

    /// Exit 1, one line that starts with the file (and line), nothing written.
    fn refused(&self, out: &str, place: &str, reason: &str) {
        let before = self.names();
        let output = self.track(out);
        let stderr = String::from_utf8(output.stderr).unwrap();
        assert_eq!(output.status.code(), Some(1), "{stderr}");
        assert_eq!(stderr.lines().count(), 1, "{stderr}");
        let start = format!("error: {}/{place}: ", self.0.path().display());
        assert!(stderr.starts_with(&start), "{stderr} should start with {start}");
        assert!(stderr.contains(reason), "{stderr} should say {reason}");
        assert!(!stderr.contains(".cspace-haptics-"), "{stderr} names a temporary file");
        assert!(output.stdout.is_empty());
        assert_eq!(self.names(), before, "something was written");
    }
}

#[test]
fn one_row_a_pose_and_the_time_of_a_step() {
    let folder = Folder::new();
    let output = folder.track("o.csv");
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let text = std::fs::read_to_string(folder.path("o.csv")).unwrap();
    let rows: Vec<&str> = text.lines().collect();
    assert_eq!(rows[0], "t,distance,type,feature_a,feature_b,nx,ny,nz,formation,contacts,reseeded,divergent");
    assert_eq!(rows.len(), 4);
    let field = |row: usize, i: usize| rows[row].split(',').nth(i).unwrap().to_owned();
    let number = |row: usize, i: usize| field(row, i).parse::<f64>().unwrap();
    // Two cubes of 2 m lie flat on each other by 0.1 m, then part by 1 m. Ties are broken by 2e-13 of the size.
    for (row, distance, formation, contacts) in
        [(1, -0.1, "face-face", "4"), (2, -0.1, "face-face", "4"), (3, 1.0, "free", "0")]
    {
        assert!((number(row, 1) - distance).abs() < 1e-12, "{}", rows[row]);
        assert!((number(row, 7) - 1.0).abs() < 1e-12, "{}", rows[row]);
        assert_eq!((field(row, 8).as_str(), field(row, 9).as_str()), (formation, contacts));
        assert_eq!((field(row, 10).as_str(), field(row, 11).as_str()), (if row == 1 { "1" } else { "0" }, "0"));
    }
    let time = String::from_utf8(output.stdout).unwrap();
    let keys: Vec<&str> = time.split_whitespace().map(|w| w.split('=').next().unwrap()).collect();
    assert_eq!(keys, ["step_ns", "mean", "p50", "p99", "max", "n"], "{time}");
    assert!(time.trim_end().ends_with("n=3"), "{time}");
}

/// As root the pipe's link was replaced by a file: `--out /dev/stdout | ...` gave nothing, nor did anything after it.
#[test]
fn standard_output_is_written_to_and_stays_what_it_is() {
    let folder = Folder::new();
    assert!(folder.track("o.csv").status.success());
    let rows = std::fs::read_to_string(folder.path("o.csv")).unwrap();
    let link = folder.path("link.csv");
    std::os::unix::fs::symlink("/proc/self/fd/1", &link).unwrap();
    let piped = String::from_utf8(folder.track("link.csv").stdout).unwrap();
    assert!(piped.starts_with(&format!("{rows}step_ns ")), "{piped}");
    assert!(link.is_symlink());

    // `>> kept.csv`: what is there stays.
    folder.write("kept.csv", "before\n");
    let kept = std::fs::OpenOptions::new().append(true).open(folder.path("kept.csv")).unwrap();
    assert!(folder.command("link.csv").stdout(kept).status().unwrap().success());
    let kept = std::fs::read_to_string(folder.path("kept.csv")).unwrap();
    assert!(kept.starts_with(&format!("before\n{rows}step_ns ")), "{kept}");
}

#[test]
fn bad_meshes_are_refused_with_their_line() {
    let without = |line: &str| CUBE.replace(line, "");
    let cases: Vec<(&str, String, u64, &str)> = vec![
        ("empty", String::new(), 1, ""),
        ("no faces", CUBE.split('f').next().unwrap().into(), 1, ""),
        ("open", without("f 2 4 8 6\n"), 0, "open"),
        ("dented", CUBE.replace("v 1 1 1\n", "v 0.2 0.2 0.2\n"), 0, ""),
        ("flat", CUBE.replace(" 1\n", " -1\n"), 0, ""),
        ("not a number", CUBE.replace("v 1 1 1\n", "v 1 nan 1\n"), 8, "finite"),
        ("infinite", CUBE.replace("v 1 1 1\n", "v 1 inf 1\n"), 8, "finite"),
        ("index out of range", CUBE.replace("f 2 4 8 6", "f 2 4 9 6"), 14, "9"),
        ("index zero", CUBE.replace("f 2 4 8 6", "f 2 4 0 6"), 14, "0"),
        ("inside out", CUBE.replace("f 2 4 8 6", "f 6 8 4 2"), 0, ""),
        ("truncated vertex", CUBE.replace("v 1 1 1\n", "v 1 1\n"), 8, ""),
        ("truncated face", CUBE.replace("f 2 4 8 6\n", "f 2 4"), 14, ""),
    ];
    for (what, text, line, reason) in cases {
        for name in ["a.obj", "b.obj"] {
            let folder = Folder::new();
            folder.write(name, &text);
            // Where several lines are at fault, which one is named is a matter of taste.
            if line > 0 {
                folder.refused("o.csv", &format!("{name}:{line}"), reason);
            } else {
                let output = folder.track("o.csv");
                let stderr = String::from_utf8(output.stderr).unwrap();
                let number = stderr.split(&format!("{name}:")).nth(1).and_then(|s| s.split(':').next()).unwrap_or("");
                let line: u64 = number.parse().unwrap_or_else(|_| panic!("{what}: {stderr} names no line"));
                folder.refused("o.csv", &format!("{name}:{line}"), reason);
            }
        }
    }
}

/// A turned cube of triangles in six significant digits: no two triangles of a face are in one plane any more.
#[test]
fn faces_that_are_bent_by_the_digits_of_the_file_alone_are_plane() {
    let folder = Folder::new();
    let turn = spatial::DQuat::from_rotation_z(0.7) * spatial::DQuat::from_rotation_x(1.1);
    let mut text = String::new();
    for line in CUBE.lines() {
        let words: Vec<&str> = line.split(' ').collect();
        if words[0] == "v" {
            let [x, y, z] = [1, 2, 3].map(|i| words[i].parse::<f64>().unwrap());
            let v = turn * spatial::DVec3::new(x, y, z);
            text += &format!("v {:.5} {:.5} {:.5}\n", v.x, v.y, v.z);
        } else {
            let [a, b, c, d] = [1, 2, 3, 4].map(|i| words[i]);
            text += &format!("f {a} {b} {c}\nf {a} {c} {d}\n");
        }
    }
    folder.write("a.obj", text);
    let q = turn.inverse();
    folder.write("p.csv", format!("t,x,y,z,qx,qy,qz,qw\n0,0,0,2.5,{},{},{},{}\n", q.x, q.y, q.z, q.w));
    let output = folder.track("o.csv");
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let rows = std::fs::read_to_string(folder.path("o.csv")).unwrap();
    let distance: f64 = rows.lines().nth(1).unwrap().split(',').nth(1).unwrap().parse().unwrap();
    assert!((distance - 0.5).abs() < 2e-5, "{distance}");
}

#[test]
fn bad_poses_are_refused_with_their_line() {
    let cases = [
        ("t,x,y,z,qx,qy,qz,qw\n", 1, "no poses"),
        ("t,x,y,z\n0,0,0,0\n", 1, "header"),
        ("t,x,y,z,qx,qy,qz,qw\n0,0,0,3,0,0,0,2\n", 2, "norm"),
        ("t,x,y,z,qx,qy,qz,qw\n0,0,0,3,0,0,0,1\n-1,0,0,3,0,0,0,1\n", 3, "back"),
        ("t,x,y,z,qx,qy,qz,qw\n0,0,0,3,0,0,0,1\n1,0,0,3,0,0", 3, "fields"),
        ("t,x,y,z,qx,qy,qz,qw\n0,0,nan,3,0,0,0,1\n", 2, "finite"),
        ("t,x,y,z,qx,qy,qz,qw\n0,0,zero,3,0,0,0,1\n", 2, "number"),
    ];
    for (text, line, reason) in cases {
        let folder = Folder::new();
        folder.write("p.csv", text);
        folder.refused("o.csv", &format!("p.csv:{line}"), reason);
    }
}

#[test]
fn unreadable_files_are_refused_by_name() {
    for name in ["a.obj", "b.obj", "p.csv"] {
        let folder = Folder::new();
        folder.write(name, b"\xff\xfe\x00\x01");
        folder.refused("o.csv", &format!("{name}:1"), "UTF-8");
        std::fs::remove_file(folder.path(name)).unwrap();
        folder.refused("o.csv", name, "cannot be read");
        std::fs::create_dir(folder.path(name)).unwrap();
        folder.refused("o.csv", name, "cannot be read");
    }
}

#[test]
fn an_output_that_cannot_be_written_is_named_as_the_user_named_it() {
    let folder = Folder::new();
    folder.refused("missing/o.csv", "missing/o.csv", "make its folder first");
    std::fs::create_dir(folder.path("folder")).unwrap();
    folder.refused("folder", "folder", "folder");
}
