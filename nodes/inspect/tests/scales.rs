//! Scenes of every size and shape: the overview and a run are drawn in proportion.

mod support;

use cspace::{FixedPart, World};
use glam::DVec3;
use inspect::{Options, Recorder, Sink, Subject, record_overview};
use rerun::StoreKind;
use spatial::{DQuat, Pose};
use std::sync::Arc;
use support::{PATIENCE, ball, chunks, cuboid, record, tick};

/// A box in the hand above two obstacles, of which one has two pieces, all `scale` times the size of a hand.
fn subject(scale: f64) -> Subject {
    let v = |x: f64, y: f64, z: f64| DVec3::new(x, y, z) * scale;
    let piece = |half, center, obstacle| FixedPart { polyhedron: Arc::new(cuboid(half, center)), obstacle };
    let world = World {
        moving: vec![Arc::new(cuboid(v(0.1, 0.05, 0.2), DVec3::ZERO))],
        fixed: vec![
            piece(v(0.5, 0.5, 0.05), v(0.0, 0.0, -0.05), 0),
            piece(v(0.05, 0.5, 0.2), v(0.45, 0.0, 0.2), 0),
            piece(v(0.1, 0.1, 0.1), v(-0.3, -0.3, 0.1), 1),
        ],
    };
    Subject::new("odd", Arc::new(world))
}

#[test]
fn tiny_and_huge_scenes_take_as_much_as_others() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let mut sizes = Vec::new();
    for scale in [1e-3, 1.0, 1e3] {
        let subject = subject(scale);
        let overview = folder.path().join(format!("overview{scale}.rrd"));
        record_overview(&subject, &Sink::File(overview.clone()), PATIENCE).expect("the disk is quick");
        let run = folder.path().join(format!("run{scale}.rrd"));
        let mut recorder =
            Recorder::new(subject.clone(), &Sink::File(run.clone()), &Options::default()).expect("a folder of our own");
        for i in 0..200 {
            let hip = Pose::new(DVec3::new(0.0, 0.0, 0.19) * scale, DQuat::from_rotation_z(1e-3 * i as f64));
            recorder.tick(&tick(&subject.world, i, hip)).expect("a finite record");
        }
        recorder.finish(PATIENCE).expect("the disk is quick");
        sizes.push([overview, run].map(|file| std::fs::metadata(file).expect("written").len()));
    }
    for (i, size) in sizes.iter().enumerate() {
        for (bytes, usual) in size.iter().zip(&sizes[1]) {
            assert!(bytes * 2 > *usual && *bytes < 2 * usual, "scene {i}: {sizes:?}");
        }
    }
}

#[test]
fn the_viewer_gets_tiny_bodies_enlarged() {
    for (scale, enlarged) in [(1e-3, true), (1.0, false), (1e3, false)] {
        let subject = subject(scale);
        let hip = Pose::new(DVec3::new(0.0, 0.0, 0.3) * scale, DQuat::IDENTITY);
        let messages = record(&subject, &[tick(&subject.world, 0, hip)]);
        let recording = chunks(&messages, StoreKind::Recording);
        for root in ["/physical_m", "/cspace_m"] {
            let scaled = recording[root]
                .iter()
                .any(|chunk| chunk.components_identifiers().any(|component| component.as_str() == "Transform3D:scale"));
            assert_eq!(scaled, enlarged, "{root} at {scale}");
        }
    }
}

#[test]
fn the_overview_of_a_large_part_is_bounded() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let world = World {
        moving: vec![ball(2_000, 0.02, DVec3::ZERO)],
        fixed: vec![FixedPart { polyhedron: ball(400, 0.05, DVec3::ZERO), obstacle: 0 }],
    };
    let file = folder.path().join("overview.rrd");
    let subject = Subject::new("balls", Arc::new(world));
    record_overview(&subject, &Sink::File(file.clone()), PATIENCE).expect("the disk is quick");
    let bytes = std::fs::metadata(file).expect("written").len();
    assert!((1_000_000..60_000_000).contains(&bytes), "{bytes} bytes");
}
