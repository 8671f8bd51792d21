//! A scripted run: a hand at a given pose, the contact found by exhaustive search, force by the paper's equations (1), (2).

#![allow(dead_code, missing_docs)]

use cspace::{FixedPart, Polyhedron, World, c_face_polygons, contact_point};
use glam::{DQuat, DVec3};
use haptics::{ContactFormation, ContactPoint, FormationKind, Gains};
use inspect::{Options, Recorder, Subject};
use rerun::StoreKind;
use rerun::log::{Chunk, LogMsg};
use servo::{Health, TickInput, TickRecord};
use spatial::{Pose, Stamp, Twist, Wrench};
use std::collections::BTreeMap;
use std::sync::Arc;
use std::time::Duration;

pub const STIFFNESS: f64 = 1000.0;
/// No disk is slower.
pub const PATIENCE: Duration = Duration::from_secs(30);

/// Records to memory and returns the messages.
pub fn record(subject: &Subject, ticks: &[TickRecord]) -> Vec<LogMsg> {
    let (mut recorder, storage) = Recorder::in_memory(subject.clone(), &Options::default()).expect("memory takes all");
    for tick in ticks {
        recorder.tick(tick).expect("a finite record");
    }
    recorder.finish(PATIENCE).expect("memory is quick");
    storage.take()
}

/// The chunks of one store by entity.
pub fn chunks(messages: &[LogMsg], kind: StoreKind) -> BTreeMap<String, Vec<Chunk>> {
    let mut by_entity: BTreeMap<String, Vec<Chunk>> = BTreeMap::new();
    for message in messages {
        if let LogMsg::ArrowMsg(store, arrow) = message
            && store.kind() == kind
        {
            let chunk = Chunk::from_arrow_msg(arrow).expect("our own chunk");
            by_entity.entry(chunk.entity_path().to_string()).or_default().push(chunk);
        }
    }
    by_entity
}

pub fn cuboid(half: DVec3, center: DVec3) -> Polyhedron {
    let corner = |i: u32| DVec3::new(f64::from(i & 1), f64::from(i >> 1 & 1), f64::from(i >> 2 & 1));
    let corners: Vec<DVec3> = (0..8).map(|i| center + half * (2.0 * corner(i) - 1.0)).collect();
    let faces = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    Polyhedron::from_faces(&corners, &faces.map(|f| f.to_vec())).expect("a box")
}

/// A peg over a plate, beside a wall.
pub fn peg_on_plate() -> Subject {
    let piece = |half, center, obstacle| FixedPart { polyhedron: Arc::new(cuboid(half, center)), obstacle };
    let world = World {
        moving: vec![Arc::new(cuboid(DVec3::new(0.008, 0.005, 0.015), DVec3::ZERO))],
        fixed: vec![
            piece(DVec3::new(0.04, 0.03, 0.005), DVec3::new(0.0, 0.0, -0.005), 0),
            piece(DVec3::new(0.005, 0.03, 0.01), DVec3::new(0.035, 0.0, 0.01), 1),
        ],
    };
    let mut subject = Subject::new("peg on plate", Arc::new(world));
    subject.moving_names = vec!["peg".into()];
    subject.fixed_names = vec!["plate".into(), "wall".into()];
    subject
}

/// The record of tick `sequence` with the hand at `hip`.
pub fn tick(world: &World, sequence: u64, hip: Pose) -> TickRecord {
    let stamp = Stamp(sequence as i64 * 1_000_000);
    let mut formation = ContactFormation::FREE;
    let mut proxy = hip;
    for (part, a) in world.moving.iter().enumerate() {
        for (piece, fixed) in world.fixed.iter().enumerate() {
            let faces = c_face_polygons(a, &fixed.polyhedron, hip.rotation);
            let near = faces.iter().max_by(|p, q| p.distance(hip.translation).total_cmp(&q.distance(hip.translation)));
            let Some(near) = near else { continue };
            let distance = near.distance(hip.translation);
            if distance >= 0.0 {
                continue;
            }
            proxy.translation -= near.normal_w * distance;
            let kind = if near.contacts.len() > 2 { FormationKind::FaceFace } else { FormationKind::VertexFace };
            formation.kind = formation.kind.max(kind);
            for contact in near.contacts.iter().take(8) {
                let point_w = contact_point(*contact, a, &fixed.polyhedron, &hip);
                let (part_a, piece_b) = (part as u32, piece as u32);
                formation.push(ContactPoint {
                    part_a,
                    piece_b,
                    contact: *contact,
                    point_w,
                    normal_w: near.normal_w,
                    distance,
                    kind,
                });
            }
        }
    }
    let wrench = Wrench::new((proxy.translation - hip.translation) * STIFFNESS, DVec3::ZERO);
    let sample = device::Sample { sequence: sequence + 1, stamp, pose: hip, connected: true, ..Default::default() };
    let input = TickInput {
        sequence,
        stamp,
        dt: 1e-3,
        sample,
        gains: Gains::default(),
        enabled: true,
        reset_count: 0,
        outside: Health::GOOD,
        remote: Wrench::ZERO,
    };
    TickRecord {
        input,
        hip,
        twist: Twist::ZERO,
        proxy,
        depth: hip.translation.distance(proxy.translation),
        formation,
        law_wrench: wrench,
        out_wrench: wrench,
        energy: 1e-4,
        health: Health::GOOD,
        wakeup_ns: 20_000 + (sequence as u32 * 7919) % 10_000,
        compute_ns: 3_000 + (sequence as u32 * 104_729) % 1_000,
    }
}

/// `ticks` ticks: down onto the plate, along it to the wall, turned, up again; a bad sample in the middle.
pub fn run(subject: &Subject, ticks: u64) -> Vec<TickRecord> {
    let records = (0..ticks).map(|sequence| {
        let s = sequence as f64 / ticks as f64;
        let z = 0.025 - 0.012 * (std::f64::consts::PI * s).sin();
        let x = -0.02 + 0.045 * s;
        let tilt = if s < 0.5 { 0.0 } else { 0.4 * (s - 0.5) };
        let mut record =
            tick(&subject.world, sequence, Pose::new(DVec3::new(x, 0.002, z), DQuat::from_rotation_y(tilt)));
        if sequence == ticks / 2 {
            record.health.set(Health::INVALID);
        }
        record
    });
    records.collect()
}

/// A ball of about `faces` triangles.
pub fn ball(faces: usize, radius: f64, center: DVec3) -> Arc<Polyhedron> {
    let n = faces / 2 + 2;
    let golden = std::f64::consts::PI * (3.0 - 5f64.sqrt());
    let spiral = (0..n).map(|i| {
        let z = 1.0 - (2.0 * i as f64 + 1.0) / n as f64;
        let (s, c) = (golden * i as f64).sin_cos();
        DVec3::new((1.0 - z * z).sqrt() * c, (1.0 - z * z).sqrt() * s, z) * radius + center
    });
    let (vertices, triangles) = parry3d_f64::transformation::convex_hull(&spiral.collect::<Vec<_>>());
    let faces: Vec<Vec<u32>> = triangles.iter().map(|t| t.to_vec()).collect();
    Arc::new(Polyhedron::from_faces(&vertices, &faces).expect("a ball"))
}
