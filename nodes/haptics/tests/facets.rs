//! A flat face that a mesh gives as two facets which bend by its rounding, or bulge a little, feels as the flat one does.

mod support;

use cspace::Polyhedron;
use haptics::{Gains, LawKind, RenderLaw, Renderer};
use spatial::{DVec3, Pose, Wrench};
use support::{cuboid, mm, pose, world};

/// A box, one lower corner of which is lifted by `bulge` metres: its bottom is two triangles then.
fn bent(half: DVec3, bulge: f64) -> Polyhedron {
    let mut corners: Vec<DVec3> =
        (0..8).map(|i| half * DVec3::from_array([0, 1, 2].map(|k| if i >> k & 1 == 0 { -1.0 } else { 1.0 }))).collect();
    corners[0].z += bulge;
    let faces = [
        vec![0, 2, 1],
        vec![3, 1, 2],
        vec![4, 5, 7, 6],
        vec![0, 1, 5, 4],
        vec![2, 6, 7, 3],
        vec![0, 4, 6, 2],
        vec![1, 3, 7, 5],
    ];
    Polyhedron::from_faces(&corners, &faces).expect("a polyhedron")
}

/// Lying flat, then rocking, over the border of the plate.
fn path() -> impl Iterator<Item = Pose> {
    (0..2000).map(|i| {
        let s = f64::from(i) * 1e-3;
        let rocks = if s < 0.8 { 0.0 } else { (s - 0.8).min(0.2) * 0.1 };
        let (tilt, roll) = (rocks * (9.0 * s).sin(), rocks * (7.0 * s).cos());
        pose(
            7.3 + 11.0 * (2.1 * s).sin(),
            3.1 + 4.0 * (2.7 * s).cos(),
            4.7 + 0.4 * (5.0 * s).sin(),
            tilt,
            roll,
            0.2 * s,
        )
    })
}

fn wrenches(moving: Polyhedron, law: LawKind) -> Vec<Wrench> {
    let plate = cuboid(mm(-30.0, -30.0, -10.0), mm(14.0, 30.0, 0.0));
    let mut r = Renderer::new(world(moving, vec![plate]));
    let gains = Gains { law, ..Gains::default() };
    path().map(|p| r.render(&p, &gains, 1e-3).wrench).collect()
}

#[test]
fn a_flat_face_in_two_facets_feels_flat() {
    let half = mm(12.0, 8.0, 5.0);
    // Of contacts that take place together `paper` and `pstar` know only to within a millionth of the size.
    let bulges: [(LawKind, &[f64]); 3] = [
        (LawKind::Paper, &[1e-9, 5e-9]),
        (LawKind::Pstar, &[1e-9, 5e-9]),
        (LawKind::Blended, &[1e-9, 5e-9, 1e-7, 1e-6, 5e-6]),
    ];
    for (law, bulges) in bulges {
        let flat = wrenches(bent(half, 0.0), law);
        let peak_f = flat.iter().map(|w| w.force.length()).fold(0.0, f64::max);
        let peak_t = flat.iter().map(|w| w.torque.length()).fold(0.0, f64::max);
        assert!(peak_f > 0.5 && peak_t > 2e-3, "{law:?}: {peak_f} {peak_t}");
        for bulge in bulges {
            let found = wrenches(bent(half, *bulge), law);
            let off = |of: fn(&Wrench) -> DVec3| {
                found.iter().zip(&flat).map(|(w, e)| (of(w) - of(e)).length()).fold(0.0, f64::max)
            };
            let (df, dt) = (off(|w| w.force) / peak_f, off(|w| w.torque) / peak_t);
            // As much as the corner's depth differs.
            let most = 2.0 * bulge / 0.7e-3;
            println!("{law:?}, bulge of {bulge:e} m: force {df:.1e}, torque {dt:.1e} of the peak");
            assert!(df <= most && dt <= 5.0 * most, "{law:?}, bulge {bulge:e}: {df} {dt}");
        }
    }
}

/// The same of the plate below: its top bends along its diagonal.
#[test]
fn a_plate_in_two_facets_feels_flat() {
    let half = mm(20.0, 15.0, 5.0);
    let tool = || cuboid(mm(-9.0, -7.0, -6.0), mm(9.0, 7.0, 6.0));
    let run = |bulge: f64, law: LawKind| -> Vec<Wrench> {
        // Upside down.
        let body = bent(half, bulge);
        let corners: Vec<DVec3> = body.vertices().iter().map(|v| DVec3::new(v.x, -v.y, -v.z)).collect();
        let faces: Vec<Vec<_>> =
            body.faces().map(|f| body.face_vertices(f).iter().map(|v| v.0 as _).collect()).collect();
        let plate = Polyhedron::from_faces(&corners, &faces).expect("a plate");
        let mut r = Renderer::new(world(tool(), vec![plate]));
        let gains = Gains { law, ..Gains::default() };
        let up = mm(0.0, 0.0, 6.0);
        path().map(|p| r.render(&Pose::new(p.translation + up, p.rotation), &gains, 1e-3).wrench).collect()
    };
    for (law, bulge) in [(LawKind::Pstar, 5e-9), (LawKind::Blended, 5e-9), (LawKind::Blended, 1e-6)] {
        let (flat, found) = (run(0.0, law), run(bulge, law));
        let peak = flat.iter().map(|w| w.torque.length()).fold(0.0, f64::max);
        let off = found.iter().zip(&flat).map(|(w, e)| (w.torque - e.torque).length()).fold(0.0, f64::max) / peak;
        println!("{law:?}, bulge of {bulge:e} m: torque {off:.1e} of the peak");
        assert!(peak > 5e-4 && off <= 20.0 * bulge / 0.7e-3, "{law:?}, bulge {bulge:e}: {off}");
    }
}
