//! Scenes that must be refused: one line, the right file and line, never a panic.

use scene::{Scene, SceneError};
use std::fs;

const GOOD: &str = "name: s\nmoving:\n  - mesh: a.obj\nfixed:\n  - mesh: a.obj\n";
const TETRA: &str = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n";

fn refusal(yaml: &[u8], mesh: &[u8], mesh_name: &str) -> SceneError {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("scene.yaml"), yaml).unwrap();
    fs::write(folder.path().join(mesh_name), mesh).unwrap();
    Scene::load(&folder.path().join("scene.yaml")).expect_err("must be refused")
}

#[test]
fn forbidden_scene_files_are_refused_with_their_line() {
    // (scene.yaml, line if one is known, a word of the reason)
    let table: &[(&str, Option<u64>, &str)] = &[
        ("", None, ""),
        ("hello", None, ""),
        ("[1, 2", None, ""),
        ("name: s\nmoving:\n  - mesh: a.obj\n", None, "fixed"),
        ("name: s\nmoving: []\nfixed:\n  - mesh: a.obj\n", None, "moving"),
        ("name: ''\nmoving:\n  - mesh: a.obj\nfixed:\n  - mesh: a.obj\n", None, "name"),
        ("name: s\ncolour: red\nmoving:\n  - mesh: a.obj\nfixed:\n  - mesh: a.obj\n", Some(2), "colour"),
        ("name: s\nmoving:\n  - mesh: a.obj\nfixed:\n  - mesh: a.obj\n    colour: red\n", Some(6), "colour"),
        ("name: s\nmoving:\n  - mesh: a.obj\nfixed:\n  - mesh: a.obj\n    pose: {xyz: [0, 0]}\n", Some(6), ""),
        (
            "name: s\nmoving:\n  - mesh: a.obj\nfixed:\n  - mesh: a.obj\n    pose: {xyz: [0, .nan, 0]}\n",
            Some(6),
            "finite",
        ),
        ("name: s\nmoving:\n  - mesh: a.obj\nfixed:\n  - mesh: a.obj\n    pose: {abc: [0, 0, 0]}\n", Some(6), "abc"),
        ("name: s\nmoving:\n  - mesh: a.obj\nfixed:\n  - mesh: a.obj\n    scale: 0\n", Some(6), "scale"),
        ("name: s\nmoving:\n  - mesh: a.obj\nfixed:\n  - mesh: a.obj\n    scale: -1\n", Some(6), "scale"),
        ("name: s\nmoving:\n  - mesh: a.obj\nfixed:\n  - mesh: a.obj\n    scale: .inf\n", Some(6), "scale"),
        ("name: s\nmoving:\n  - mesh: a.obj\nfixed:\n  - mesh: a.obj\n    scale: big\n", Some(6), ""),
        ("name: s\nmoving:\n  - mesh: a.obj\nfixed:\n  - mesh: a.obj\n    convex: maybe\n", Some(6), "maybe"),
        ("name: s\nmoving:\n  - mesh: a.obj\nfixed:\n  - mesh: a.obj\n    friction: -1\n", Some(6), "friction"),
        ("name: s\nmoving:\n  - mesh: a.obj\n    friction: 1\nfixed:\n  - mesh: a.obj\n", Some(4), "friction"),
        ("name: s\nmoving:\n  - mesh: none.obj\nfixed:\n  - mesh: a.obj\n", Some(3), "none.obj"),
        ("name: s\nmoving:\n  - mesh: ''\nfixed:\n  - mesh: a.obj\n", Some(3), "empty"),
        ("name: s\nmoving:\n  - mesh: .\nfixed:\n  - mesh: a.obj\n", Some(3), ""),
        ("name: s\nname: t\nmoving:\n  - mesh: a.obj\nfixed:\n  - mesh: a.obj\n", Some(2), "name"),
    ];
    for (yaml, line, word) in table {
        let error = refusal(yaml.as_bytes(), TETRA.as_bytes(), "a.obj");
        let text = error.to_string();
        assert!(error.file.ends_with("scene.yaml"), "{yaml:?}: {text}");
        assert_eq!(text.lines().count(), 1, "{yaml:?}: {text}");
        assert!(error.reason.contains(word), "{yaml:?}: {text}");
        if line.is_some() {
            assert_eq!(error.line, *line, "{yaml:?}: {text}");
        }
    }
    assert!(!refusal(b"\xff\xfe\x00", TETRA.as_bytes(), "a.obj").reason.is_empty());
}

#[test]
fn forbidden_meshes_are_refused_by_name() {
    let open = TETRA.rsplit_once("f ").unwrap().0;
    let inside_out = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 2 3\nf 1 4 2\nf 1 3 4\nf 2 4 3\n";
    let flat = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nf 1 2 4 3\nf 1 3 4 2\n";
    let nan = TETRA.replace("v 1 0 0", "v nan 0 0");
    let table: &[(&[u8], Option<u64>)] = &[
        (b"", None),
        (b"\xff\x00\xfe", None),
        (b"not a mesh", Some(1)),
        (open.as_bytes(), None),
        (inside_out.as_bytes(), None),
        (flat.as_bytes(), None),
        (nan.as_bytes(), Some(2)),
        (b"v 0 0 0\nf 1 1 9\n", Some(2)),
    ];
    for (mesh, line) in table {
        for convex in ["auto", "exact", "hull"] {
            // The hull closes what is open and turns what is inside out: that is what it is for.
            let hull_helps = [open.as_bytes(), inside_out.as_bytes()].contains(mesh);
            if convex == "hull" && hull_helps {
                continue;
            }
            let yaml =
                format!("{GOOD}    convex: {convex}\n").replace("moving:\n  - mesh: a.obj", "moving:\n  - mesh: b.obj");
            let folder = tempfile::tempdir().unwrap();
            fs::write(folder.path().join("scene.yaml"), yaml).unwrap();
            fs::write(folder.path().join("b.obj"), TETRA).unwrap();
            fs::write(folder.path().join("a.obj"), mesh).unwrap();
            let error = Scene::load(&folder.path().join("scene.yaml")).expect_err(convex);
            assert!(error.file.ends_with("a.obj"), "{error}");
            assert_eq!(error.to_string().lines().count(), 1);
            assert_eq!(error.line, *line, "{error}");
        }
    }
    for name in ["a.step", "a", "a.stl", "a.urdf"] {
        let error = refusal(GOOD.replace("a.obj", name).as_bytes(), b"garbage", name);
        assert!(error.file.ends_with(name), "{error}");
    }
}

#[test]
fn no_garbage_makes_it_panic() {
    // Every prefix of a good scene and mesh, and every mesh with one byte changed.
    for end in 0..GOOD.len() - 1 {
        let folder = tempfile::tempdir().unwrap();
        fs::write(folder.path().join("scene.yaml"), &GOOD[..end]).unwrap();
        fs::write(folder.path().join("a.obj"), TETRA).unwrap();
        let _ = Scene::load(&folder.path().join("scene.yaml"));
    }
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("scene.yaml"), GOOD).unwrap();
    for i in 0..TETRA.len() {
        for byte in [b'9', b'-', b' ', b'x', 0xff] {
            let mut mesh = TETRA.as_bytes().to_vec();
            mesh[i] = byte;
            fs::write(folder.path().join("a.obj"), &mesh).unwrap();
            let _ = Scene::load(&folder.path().join("scene.yaml"));
        }
    }
}

/// A brick whose corners were rounded onto each other's sides: the decomposition finds no hull of a part, and panicked.
#[test]
fn a_surface_that_crosses_itself_is_refused_in_the_files_words() {
    let corners = "v -1 -1 0\nv -1 0 0\nv 0 -1 1\nv 0 0 -1\nv 0 0 1\nv 0 1 1\nv 1 0 0\nv 1 1 0\n";
    let faces =
        "f 1 2 4\nf 1 4 3\nf 5 7 8\nf 5 8 6\nf 1 5 6\nf 1 6 2\nf 3 4 8\nf 3 8 7\nf 1 3 7\nf 1 7 5\nf 2 6 8\nf 2 8 4\n";
    let refused = refusal(GOOD.as_bytes(), format!("{corners}{faces}").as_bytes(), "a.obj");
    assert!(refused.reason.contains("it cannot be cut into convex pieces"), "{refused}");
}
