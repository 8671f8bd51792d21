//! What is drawn fits together: the SCP on the C-faces in contact and within them, the force along their normals.

mod support;

use glam::DVec3;
use inspect::Subject;
use rerun::StoreKind;
use rerun::log::Chunk;
use spatial::{DQuat, Pose};
use std::collections::BTreeMap;
use std::sync::Arc;
use support::{ball, chunks, peg_on_plate, record, run, tick};

/// Drawn numbers are `f32`: this much is lost of centimetres.
const SINGLE: f64 = 2e-7;

/// The rows of a component by tick, each a list of vectors.
fn vectors(chunks: &[Chunk], component: &'static str) -> BTreeMap<i64, Vec<DVec3>> {
    let vector = |v: [f32; 3]| DVec3::from_array(v.map(f64::from));
    let mut rows = BTreeMap::new();
    for chunk in chunks {
        let ticks = chunk.iter_component_indices("tick".into(), component.into()).map(|(tick, _)| tick.as_i64());
        let values = chunk.iter_slices::<[f32; 3]>(component.into());
        rows.extend(ticks.zip(values.map(|row| row.iter().map(|v| vector(*v)).collect())));
    }
    rows
}

/// The triangles of a mesh by tick, as indices of its corners.
fn indices(chunks: &[Chunk]) -> BTreeMap<i64, Vec<[usize; 3]>> {
    let mut rows = BTreeMap::new();
    for chunk in chunks {
        let component = "Mesh3D:triangle_indices";
        let ticks = chunk.iter_component_indices("tick".into(), component.into()).map(|(tick, _)| tick.as_i64());
        let values = chunk.iter_slices::<[u32; 3]>(component.into());
        rows.extend(ticks.zip(values.map(|row| row.iter().map(|t| t.map(|i| i as usize)).collect())));
    }
    rows
}

type Triangle = [DVec3; 3];

/// What is drawn of the C-faces of one role by tick: triangles and the normal of each C-face.
fn polygons(recording: &BTreeMap<String, Vec<Chunk>>, role: &str) -> BTreeMap<i64, Vec<(Vec<Triangle>, DVec3)>> {
    let mesh = &recording[&format!("/cspace_m/c_faces/{role}")];
    let corners = vectors(mesh, "Mesh3D:vertex_positions");
    let normals = vectors(mesh, "Mesh3D:vertex_normals");
    let triangles = indices(mesh);
    // The triangles of one C-face follow each other and have its normal.
    let split = |tick: &i64| {
        let (corners, normals) = (&corners[tick], &normals[tick]);
        let mut polygons: Vec<(Vec<Triangle>, DVec3)> = Vec::new();
        for triangle in &triangles[tick] {
            let (points, normal) = (triangle.map(|i| corners[i]), normals[triangle[0]]);
            match polygons.last_mut() {
                Some((area, n)) if *n == normal => area.push(points),
                _ => polygons.push((vec![points], normal)),
            }
        }
        polygons
    };
    corners.keys().map(|tick| (*tick, split(tick))).collect()
}

/// How far a point lies outside of all triangles, which run counter-clockwise around `normal`; `<= 0` within.
fn outside(point: DVec3, triangles: &[Triangle], normal: DVec3) -> f64 {
    let beyond = |t: &Triangle| {
        let sides = (0..3).map(|i| (t[i], t[(i + 1) % 3]));
        let beyond = sides.map(|(from, to)| (point - from).dot((to - from).cross(normal).normalize_or_zero()));
        beyond.fold(f64::NEG_INFINITY, f64::max)
    };
    triangles.iter().map(beyond).fold(f64::INFINITY, f64::min)
}

#[test]
fn the_scp_lies_on_the_c_faces_in_contact_and_the_force_leaves_them_along_their_normals() {
    let subject = peg_on_plate();
    let mut ticks = run(&subject, 3000);
    // In and out of the corner of plate and wall.
    ticks.extend((0..1000u32).map(|i| {
        let z = if i / 100 % 2 == 0 { 0.0142 } else { 0.03 };
        let hip = Pose::new(DVec3::new(0.0225 + 1e-6 * f64::from(i), 0.002, z), DQuat::IDENTITY);
        tick(&subject.world, 3000 + u64::from(i), hip)
    }));
    let recording = chunks(&record(&subject, &ticks), StoreKind::Recording);
    let scp = vectors(&recording["/cspace_m/scp"], "Points3D:positions");
    let hip = vectors(&recording["/cspace_m/hip"], "Points3D:positions");
    let force = vectors(&recording["/cspace_m/force"], "Arrows3D:vectors");
    let origin = vectors(&recording["/cspace_m/force"], "Arrows3D:origins");
    let (mut single, mut several) = (0, 0);
    for (tick, touching) in polygons(&recording, "touching") {
        let (scp, hip) = (scp[&tick][0], hip[&tick][0]);
        for (area, normal) in &touching {
            let on_it = area[0][0];
            assert!((scp - on_it).dot(*normal).abs() < SINGLE, "tick {tick}: the SCP is off the C-face's plane");
            assert!(outside(scp, area, *normal) < SINGLE, "tick {tick}: the SCP is beside the C-face");
            assert!((hip - on_it).dot(*normal) < SINGLE, "tick {tick}: the HIP is outside");
        }
        let Some(&force) = force[&tick].first() else { continue };
        assert!(origin[&tick][0].distance(scp) < SINGLE, "tick {tick}: the force does not start at the SCP");
        if let [(_, normal)] = touching[..] {
            single += 1;
            let sine = force.normalize().cross(normal).length();
            assert!(force.dot(normal) > 0.0 && sine < 1e-5, "tick {tick}: {force} is not along {normal}");
        } else {
            // Of several it has a part along each, and nothing else: floor and wall are square.
            several += 1;
            let along: f64 = touching.iter().map(|(_, n)| force.dot(*n).powi(2)).sum();
            assert!((along / force.length_squared() - 1.0).abs() < 1e-5, "tick {tick}");
        }
    }
    assert!(single > 5 && several > 1, "{single} pictures with one contact, {several} with more: nothing was tested");
}

/// A ball of `faces` faces that turns above a larger one.
fn large(faces: usize) {
    let world = cspace::World {
        moving: vec![ball(faces, 0.02, DVec3::ZERO)],
        fixed: vec![cspace::FixedPart { polyhedron: ball(faces, 0.05, DVec3::ZERO), obstacle: 0 }],
    };
    let subject = Subject::new("balls", Arc::new(world));
    let free = cspace::World { moving: Vec::new(), fixed: Vec::new() };
    let ticks: Vec<_> = (0..600u32)
        .map(|i| {
            let turn = DQuat::from_rotation_x(1e-3 * f64::from(i));
            tick(&free, i.into(), Pose::new(DVec3::new(0.0, 0.01, 0.0695), turn))
        })
        .collect();
    let begun = std::time::Instant::now();
    let messages = record(&subject, &ticks);
    let frames = 600.0 / 34.0;
    println!("{faces} faces: {:.1} ms a frame", begun.elapsed().as_secs_f64() * 1e3 / frames);
    let recording = chunks(&messages, StoreKind::Recording);
    let near = polygons(&recording, "near");
    assert!(!near.is_empty());
    let others: usize = polygons(&recording, "other").values().map(Vec::len).max().unwrap_or(0);
    assert!((100..=200).contains(&others), "{others} C-faces around Near");
    assert!(polygons(&recording, "local").values().all(|faces| !faces.is_empty()));
}

#[test]
fn a_part_of_2_000_faces_is_drawn_around_near() {
    large(2_000);
}

#[test]
fn a_part_of_20_000_faces_is_drawn_around_near() {
    large(20_000);
}
