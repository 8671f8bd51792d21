//! Runs a tracker along a motion and compares every pose with parry.

use super::*;
use cspace::Tracker;

#[derive(Clone, Copy, Debug, Default)]
pub struct Tally {
    pub poses: u64,
    pub contacts: u64,
    /// Free read as contact or the reverse, touching (within rounding) set aside.
    pub wrong: u64,
    pub touching: u64,
    /// Depth off by more than 1e-12 of the size though not divergent, and parry's plane is not the worse one.
    pub depth_off: u64,
    pub divergent: u64,
    /// Divergent though the depth is the global one.
    pub unproven: u64,
    pub reseeded: u64,
    /// Parry found less than the true depth, shown by evaluating its answer.
    pub parry_off: u64,
    pub worst_planes: u32,
    pub planes: u64,
    pub worst_depth_error: f64,
}

impl Tally {
    pub fn add(&mut self, o: &Self) {
        self.poses += o.poses;
        self.contacts += o.contacts;
        self.wrong += o.wrong;
        self.touching += o.touching;
        self.depth_off += o.depth_off;
        self.divergent += o.divergent;
        self.unproven += o.unproven;
        self.reseeded += o.reseeded;
        self.parry_off += o.parry_off;
        self.worst_planes = self.worst_planes.max(o.worst_planes);
        self.planes += o.planes;
        self.worst_depth_error = self.worst_depth_error.max(o.worst_depth_error);
    }
}

/// Compares a tracker with parry at every pose; `report` sees what looks wrong.
pub fn judge(a: &Mesh, b: &Mesh, poses: &[Pose], mut report: impl FnMut(usize, &str)) -> Tally {
    let (pa, pb) = (polyhedron(a), polyhedron(b));
    let (sa, sb) = (parry_shape(a), parry_shape(b));
    let size = pa.size() + pb.size();
    let mut tracker = Tracker::new(pa.clone(), pb.clone());
    let mut tally = Tally::default();
    for (i, pose) in poses.iter().enumerate() {
        let t = tracker.step(pose);
        tally.poses += 1;
        tally.planes += u64::from(t.planes);
        tally.worst_planes = tally.worst_planes.max(t.planes);
        tally.reseeded += u64::from(t.reseeded);
        tally.divergent += u64::from(t.divergent);
        // Near's plane must be a supporting plane of the C-obstacle: its distance is then a lower bound of the truth.
        let support = plane_distance(&pa, &pb, pose, t.near.normal_w);
        if (support - t.distance).abs() > 1e-11 * size {
            tally.wrong += 1;
            report(i, &format!("not a supporting plane: {support} {t:?}"));
            continue;
        }
        let c = parry3d_f64::query::contact(&parry_pose(pose), &sa, &ParryPose::IDENTITY, &sb, 10.0 * size)
            .expect("supported");
        let Some(c) = c else {
            tally.parry_off += 1;
            continue;
        };
        let truth = c.dist;
        tally.contacts += u64::from(truth <= 0.0);
        if truth.abs() < 1e-11 * size || t.distance.abs() < 1e-11 * size {
            tally.touching += 1;
            if (truth - t.distance).abs() > 1e-9 * size && !t.divergent && truth < 0.0 {
                // Touching needs a plane at distance 0; where parry's own is none, its answer is not one.
                let n = -c.normal1;
                let theirs = plane_distance(&pa, &pb, pose, n).max(plane_distance(&pa, &pb, pose, -n));
                if theirs > t.distance + 1e-9 * size {
                    report(i, &format!("touching? parry {truth} ({theirs}) {t:?}"));
                    tally.wrong += 1;
                } else {
                    tally.parry_off += 1;
                }
            }
            continue;
        }
        if (truth > 0.0) != t.is_free() {
            // Whose is it? A supporting plane with f > 0 proves freedom.
            let n = -c.normal1;
            let proof = plane_distance(&pa, &pb, pose, n).max(plane_distance(&pa, &pb, pose, -n));
            if t.is_free() && support > 0.0 || truth > 0.0 && proof <= 0.0 {
                tally.parry_off += 1;
                report(i, &format!("parry wrong: {truth} proof {proof} {t:?}"));
            } else {
                tally.wrong += 1;
                report(i, &format!("free/contact: parry {truth} proof {proof} {t:?}"));
            }
            continue;
        }
        if !t.is_free() {
            let error = truth - t.distance;
            if t.divergent {
                tally.unproven += u64::from(error.abs() <= 1e-12 * size);
            } else if error.abs() > 1e-12 * size {
                if error < 0.0 {
                    // Ours is a supporting plane and nearer: parry's depth is not the smallest.
                    tally.parry_off += 1;
                } else {
                    let n = -c.normal1;
                    let theirs = plane_distance(&pa, &pb, pose, n).max(plane_distance(&pa, &pb, pose, -n));
                    if theirs > t.distance + 1e-12 * size {
                        tally.depth_off += 1;
                        tally.worst_depth_error = tally.worst_depth_error.max((theirs - t.distance) / size);
                        report(i, &format!("depth: parry {truth} ({theirs}) {t:?}"));
                    } else {
                        tally.parry_off += 1;
                    }
                }
            }
        }
    }
    tally
}

/// Pairs of every kind: `(name, A, B)`.
pub fn pairs() -> Vec<(&'static str, Mesh, Mesh)> {
    let cube = || cuboid(DVec3::splat(0.1));
    let plate = || cuboid(DVec3::new(0.4, 0.4, 0.004));
    let needle = || cuboid(DVec3::new(0.3, 0.003, 0.003));
    vec![
        ("tetrahedron/box", tetrahedron(0.05), cuboid(DVec3::new(0.1, 0.2, 0.08))),
        ("box/box", cuboid(DVec3::new(0.05, 0.1, 0.15)), cube()),
        ("cube/plate", cube(), plate()),
        ("plate/cube", plate(), cube()),
        ("plate/plate", plate(), plate()),
        ("prism3/prism5", prism(3, 0.05, 0.1), prism(5, 0.08, 0.03)),
        ("prism12/prism12", prism(12, 0.05, 0.08), prism(12, 0.05, 0.08)),
        ("prism64/box", prism(64, 0.05, 0.1), cuboid(DVec3::splat(0.12))),
        ("prism64/prism64", prism(64, 0.05, 0.1), prism(64, 0.06, 0.05)),
        ("needle/box", needle(), cube()),
        ("needle/plate", needle(), plate()),
        ("needle/needle", needle(), cuboid(DVec3::new(0.002, 0.2, 0.002))),
        ("tetrahedron/plate", tetrahedron(0.04), plate()),
        ("hull30/hull30", hull(30, DVec3::new(0.05, 0.08, 0.06), 1), hull(30, DVec3::splat(0.07), 2)),
        ("hull200/box", hull(200, DVec3::splat(0.05), 3), cube()),
        ("hull1000/hull1000", hull(1000, DVec3::splat(0.05), 4), hull(1000, DVec3::new(0.05, 0.07, 0.06), 5)),
        ("hull1000/plate", hull(1000, DVec3::new(0.05, 0.05, 0.02), 6), plate()),
        ("tiny box/box", scaled(cube(), 0.01), scaled(cuboid(DVec3::new(0.1, 0.05, 0.2)), 0.01)),
        ("huge box/prism", scaled(cube(), 1e4), scaled(prism(7, 0.05, 0.1), 1e4)),
        ("tiny box/huge box", scaled(cube(), 0.01), scaled(cube(), 1e4)),
    ]
}
