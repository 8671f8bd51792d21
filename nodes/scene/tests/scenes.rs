//! Scenes of the repository and what the decomposition makes of meshes.

use scene::{Bundle, Scene};
use std::path::{Path, PathBuf};

fn config(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../config/scenes").join(name).join("scene.yaml")
}

/// A scene made of the given mesh files; the first one moves, the entry text is appended to the second.
fn scene_of(meshes: &[(&str, String)], fixed_entry: &str) -> Result<Scene, scene::SceneError> {
    let folder = tempfile::tempdir().unwrap();
    for (name, text) in meshes {
        std::fs::write(folder.path().join(name), text).unwrap();
    }
    let (moving, fixed) = (meshes[0].0, meshes[1].0);
    let yaml = format!("name: s\nmoving:\n  - mesh: {moving}\nfixed:\n  - mesh: {fixed}\n{}", indent(fixed_entry));
    std::fs::write(folder.path().join("scene.yaml"), yaml).unwrap();
    Scene::load(&folder.path().join("scene.yaml"))
}

fn indent(text: &str) -> String {
    text.lines().map(|l| format!("    {l}\n")).collect()
}

const TETRA: &str = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n";

/// A plate with a blind hole, one solid: outside [-2, 2]^2 x [0, 2], hole [-1, 1]^2 down to z = 1.
fn blind_hole() -> String {
    let mut text = String::new();
    for (h, z) in [(2.0, 0.0), (2.0, 2.0), (1.0, 1.0), (1.0, 2.0)] {
        for (x, y) in [(-h, -h), (h, -h), (h, h), (-h, h)] {
            text += &format!("v {x} {y} {z}\n");
        }
    }
    text += "f 1 4 3 2\nf 9 10 11 12\n";
    for i in 1..=4 {
        let j = i % 4 + 1;
        text += &format!("f {i} {j} {} {}\n", 4 + j, 4 + i);
        text += &format!("f {} {} {} {}\n", 8 + j, 8 + i, 12 + i, 12 + j);
        text += &format!("f {} {} {} {}\n", 4 + i, 4 + j, 12 + j, 12 + i);
    }
    text
}

#[test]
fn the_repositorys_scenes_load() {
    let scene = Scene::load(&config("peg_in_hole")).unwrap();
    assert_eq!((scene.name.as_str(), scene.world.moving.len(), scene.world.fixed.len()), ("peg_in_hole", 1, 5));
    assert!(scene.world.fixed.iter().all(|p| p.obstacle == 0));
    assert_eq!(Scene::load(&config("peg_4x4")).unwrap().world.fixed.len(), 5);
    let tetra = Scene::load(&config("tetra_on_box")).unwrap();
    assert_eq!((tetra.world.moving[0].face_count(), tetra.world.fixed[0].polyhedron.face_count()), (4, 6));
    assert!(tetra.moving[0].note.is_none());
}

#[test]
fn a_bundle_builds_the_same_scene_without_the_files() {
    let bundle = Bundle::read(&config("peg_in_hole")).unwrap();
    let moved = Bundle { path: "/nowhere/scene.yaml".into(), ..bundle.clone() };
    let (a, b) = (Scene::build(bundle).unwrap(), Scene::build(moved).unwrap());
    for (p, q) in a.world.fixed.iter().zip(&b.world.fixed) {
        assert_eq!(p.polyhedron.vertices(), q.polyhedron.vertices());
    }
}

#[test]
fn a_blind_hole_is_cut_exactly_and_leaves_the_hole_empty() {
    let scene = scene_of(&[("a.obj", TETRA.into()), ("b.obj", blind_hole())], "").unwrap();
    assert_eq!(scene.world.fixed.len(), 5);
    let note = scene.fixed[0].note.as_deref().unwrap();
    assert!(note.contains("cut into 5"), "{note}");
    for i in 0..20 {
        for j in 0..20 {
            for k in 0..20 {
                let p = spatial::DVec3::new(
                    f64::from(i) * 0.2 - 1.91,
                    f64::from(j) * 0.2 - 1.91,
                    f64::from(k) * 0.1 + 0.05,
                );
                let in_hole = p.x.abs() < 1.0 && p.y.abs() < 1.0 && p.z > 1.0;
                let pieces = scene.world.fixed.iter().filter(|f| f.polyhedron.contains(p, 0.0)).count();
                assert_eq!(pieces, usize::from(!in_hole), "{p}");
            }
        }
    }
}

#[test]
fn convex_exact_refuses_and_hull_covers() {
    let error = scene_of(&[("a.obj", TETRA.into()), ("b.obj", blind_hole())], "convex: exact").unwrap_err();
    assert!(error.file.ends_with("b.obj") && error.to_string().lines().count() == 1, "{error}");
    let scene = scene_of(&[("a.obj", TETRA.into()), ("b.obj", blind_hole())], "convex: hull").unwrap();
    assert_eq!(scene.world.fixed.len(), 1);
    assert_eq!(scene.world.fixed[0].polyhedron.face_count(), 6);
}

#[test]
fn bodies_that_touch_stay_apart_though_they_share_positions() {
    // Two unit boxes side by side, then the same with all faces' vertices separate (as exporters write them).
    let mut shared = String::new();
    let mut soup = String::new();
    let (mut n, mut m) = (0, 0);
    for x in [0.0, 1.0] {
        let corner = |i: u32| [x + f64::from(i & 1), f64::from(i >> 1 & 1), f64::from(i >> 2)];
        for i in 0..8 {
            let [a, b, c] = corner(i);
            shared += &format!("v {a} {b} {c}\n");
        }
        for f in [[0, 4, 6, 2], [1, 3, 7, 5], [0, 1, 5, 4], [2, 6, 7, 3], [0, 2, 3, 1], [4, 5, 7, 6]] {
            shared += &format!("f {} {} {} {}\n", f[0] + n + 1, f[1] + n + 1, f[2] + n + 1, f[3] + n + 1);
            for i in f {
                let [a, b, c] = corner(i);
                soup += &format!("v {a} {b} {c}\n");
            }
            soup += &format!("f {} {} {} {}\n", m + 1, m + 2, m + 3, m + 4);
            m += 4;
        }
        n += 8;
    }
    let boxes = scene_of(&[("a.obj", TETRA.into()), ("b.obj", shared)], "").unwrap();
    assert_eq!(boxes.world.fixed.len(), 2);
    let volume: f64 = boxes.world.fixed.iter().map(|f| f.polyhedron.size()).sum();
    assert!(volume > 1.0);
    // The soup's inner walls cancel: nothing tells it from one box, or it is cut into two; it must fill the same space.
    let welded = scene_of(&[("a.obj", TETRA.into()), ("b.obj", soup)], "").unwrap();
    for (p, inside) in [((0.5, 0.5, 0.5), true), ((1.5, 0.5, 0.5), true), ((2.1, 0.5, 0.5), false)] {
        let p = spatial::DVec3::new(p.0, p.1, p.2);
        assert_eq!(welded.world.fixed.iter().any(|f| f.polyhedron.contains(p, 0.0)), inside, "{p}");
    }
}

#[test]
fn pose_and_scale_of_an_entry_place_the_mesh() {
    let entry = "pose: {xyz: [1, 2, 3], rpy: [0, 0, 1.5707963267948966]}\nscale: 0.001\nfriction: 0.3";
    let scene = scene_of(&[("a.obj", TETRA.into()), ("b.obj", TETRA.into())], entry).unwrap();
    let v = scene.world.fixed[0].polyhedron.vertices();
    assert!(v.iter().any(|v| (*v - spatial::DVec3::new(1.0, 2.001, 3.0)).length() < 1e-15), "{v:?}");
    assert_eq!(scene.frictions(), vec![Some(0.3)]);
}

#[test]
fn an_stl_and_a_urdf_are_meshes_too() {
    let stl = "solid t\nfacet\nouter loop\nvertex 0 0 0\nvertex 0 1 0\nvertex 1 0 0\nendloop\nendfacet\nfacet\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 0 1\nendloop\nendfacet\nfacet\nouter loop\nvertex 0 0 0\nvertex 0 0 1\nvertex 0 1 0\nendloop\nendfacet\nfacet\nouter loop\nvertex 1 0 0\nvertex 0 1 0\nvertex 0 0 1\nendloop\nendfacet\nendsolid\n";
    let urdf = r#"<robot name="r"><link name="l">
        <collision><geometry><box size="1 1 1"/></geometry></collision>
        <collision><origin xyz="0 0 2"/><geometry><mesh filename="a.stl"/></geometry></collision></link></robot>"#;
    let scene = scene_of(&[("a.stl", stl.into()), ("b.urdf", urdf.into())], "scale: 2").unwrap();
    assert_eq!(scene.world.moving[0].face_count(), 4);
    assert_eq!(scene.world.fixed.len(), 2);
    let top = scene.world.fixed[1].polyhedron.vertices().iter().map(|v| v.z).fold(0.0, f64::max);
    assert!((top - 6.0).abs() < 1e-12);
    assert!(scene.bundle.files.contains_key("b.urdf#a.stl"));
}

#[test]
fn a_mesh_too_intricate_to_cut_is_approximated_and_says_so() {
    // A torus: curved everywhere, 48 x 24 quads split into triangles.
    let (n, m) = (64u32, 32u32);
    let mut text = String::new();
    for i in 0..n {
        let u = std::f64::consts::TAU * f64::from(i) / f64::from(n);
        for j in 0..m {
            let v = std::f64::consts::TAU * f64::from(j) / f64::from(m);
            let r = 1.0 + 0.3 * v.cos();
            text += &format!("v {} {} {}\n", r * u.cos(), r * u.sin(), 0.3 * v.sin());
        }
    }
    let at = |i: u32, j: u32| (i % n) * m + j % m + 1;
    for i in 0..n {
        for j in 0..m {
            text += &format!("f {} {} {}\n", at(i, j), at(i + 1, j), at(i + 1, j + 1));
            text += &format!("f {} {} {}\n", at(i, j), at(i + 1, j + 1), at(i, j + 1));
        }
    }
    let scene = scene_of(&[("a.obj", TETRA.into()), ("b.obj", text)], "").unwrap();
    assert!(scene.fixed[0].note.as_deref().unwrap().contains("APPROXIMATED"));
    assert!(scene.world.fixed.len() > 4);
    assert!(scene.world.fixed.iter().all(|f| !f.polyhedron.contains(spatial::DVec3::ZERO, 0.0)), "the hole is open");
}

/// Six decimals bend the triangles of a turned face out of its plane: an L came in slivers, a brick in five pieces.
#[test]
fn a_turned_solid_of_triangles_written_with_six_decimals_is_cut_at_its_joint_alone() {
    let turn = spatial::DQuat::from_rotation_z(0.7) * spatial::DQuat::from_rotation_x(1.1);
    let corners = [(0.0, 0.0), (0.06, 0.0), (0.06, 0.02), (0.02, 0.02), (0.02, 0.05), (0.0, 0.05)];
    let mut text = String::new();
    for z in [0.0, 0.03] {
        for (x, y) in corners {
            let v = turn * spatial::DVec3::new(x, y, z);
            text += &format!("v {:.6} {:.6} {:.6}\n", v.x, v.y, v.z);
        }
    }
    for [a, b, c] in [[1, 2, 3], [1, 3, 4], [1, 4, 5], [1, 5, 6]] {
        text += &format!("f {c} {b} {a}\nf {} {} {}\n", a + 6, b + 6, c + 6);
    }
    for i in 1..=6 {
        let j = i % 6 + 1;
        text += &format!("f {i} {j} {}\nf {i} {} {}\n", j + 6, j + 6, i + 6);
    }
    let scene = scene_of(&[("tetra.obj", TETRA.into()), ("l.obj", text)], "").unwrap();
    assert_eq!(scene.fixed[0].note.as_deref(), Some("not convex: cut into 2 convex pieces"));
    assert!(scene.world.fixed.iter().all(|piece| piece.polyhedron.face_count() == 6));
}
