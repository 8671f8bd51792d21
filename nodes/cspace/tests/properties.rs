//! What must not change the answer: swapping the bodies, moving both, scaling, splitting faces. And what the graph and
//! Near promise.

mod support;

use cspace::{BasicContact, ContactGraph, Polyhedron, Tracker, applicable_c_faces, contact_point};
use proptest::prelude::*;
use spatial::{DQuat, DVec3, Pose};
use std::sync::Arc;
use support::*;

fn shape(k: u64) -> Mesh {
    match k % 6 {
        0 => tetrahedron(0.6),
        1 => cuboid(DVec3::new(0.8, 1.2, 1.0)),
        2 => prism(3 + (k / 6 % 9) as u32, 0.7, 0.9),
        3 => cuboid(DVec3::new(1.5, 1.5, 0.03)),
        4 => hull(12 + (k / 6 % 20) as usize, DVec3::new(0.6, 0.8, 0.7), k),
        _ => cuboid(DVec3::new(1.8, 0.05, 0.04)),
    }
}

fn pose() -> impl Strategy<Value = Pose> {
    (prop::array::uniform3(-1.0..1.0f64), prop::array::uniform3(-3.0..3.0f64))
        .prop_map(|(x, r)| Pose::new(DVec3::from_array(x), DQuat::from_scaled_axis(DVec3::from_array(r)).normalize()))
}

/// Seeded globally: the depth is the global one unless the audit could not finish.
fn distance(a: &Arc<Polyhedron>, b: &Arc<Polyhedron>, pose: &Pose) -> (f64, bool) {
    let t = Tracker::new(a.clone(), b.clone()).seed(pose);
    (t.distance, t.divergent)
}

fn agree(p: (f64, bool), q: (f64, bool), tolerance: f64) -> bool {
    // When free, Near is a lower bound that depends on the way: only its sign is the same.
    p.1 || q.1 || (p.0 > 0.0 && q.0 > 0.0) || (p.0 - q.0).abs() <= tolerance
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 192, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn swapping_the_bodies_keeps_the_depth(i in 0u64..60, j in 0u64..60, p in pose()) {
        let (a, b) = (polyhedron(&shape(i)), polyhedron(&shape(j)));
        let (there, back) = (distance(&a, &b, &p), distance(&b, &a, &p.inverse()));
        prop_assert!(agree(there, back, 1e-11), "{there:?} {back:?}");
    }

    #[test]
    fn moving_both_bodies_keeps_the_depth(i in 0u64..60, j in 0u64..60, p in pose(), m in pose()) {
        let (a, b) = (polyhedron(&shape(i)), polyhedron(&shape(j)));
        let moved = Arc::new(b.transformed(&m, 1.0));
        let (there, back) = (distance(&a, &b, &p), distance(&a, &moved, &(m * p)));
        prop_assert!(agree(there, back, 1e-11), "{there:?} {back:?}");
    }

    #[test]
    fn scaling_scales_the_depth(i in 0u64..60, j in 0u64..60, p in pose(), k in -3i32..4) {
        let s = 10f64.powi(k);
        let (a, b) = (polyhedron(&shape(i)), polyhedron(&shape(j)));
        let big = (polyhedron(&scaled(shape(i), s)), polyhedron(&scaled(shape(j), s)));
        let (there, back) = (distance(&a, &b, &p), distance(&big.0, &big.1, &Pose::new(p.translation * s, p.rotation)));
        prop_assert!(agree(there, (back.0 / s, back.1), 1e-11), "{there:?} {back:?}");
    }

    #[test]
    fn splitting_faces_changes_nothing(i in 0u64..60, j in 0u64..60, p in pose()) {
        let split = |(v, f): Mesh| -> Mesh {
            (v, f.iter().flat_map(|f| (1..f.len() - 1).map(|i| vec![f[0], f[i], f[i + 1]])).collect())
        };
        let (a, b) = (polyhedron(&shape(i)), polyhedron(&shape(j)));
        let (sa, sb) = (polyhedron(&split(shape(i))), polyhedron(&split(shape(j))));
        prop_assert_eq!(sa.face_count(), a.face_count());
        let (there, back) = (distance(&a, &b, &p), distance(&sa, &sb, &p));
        prop_assert!(agree(there, back, 1e-11), "{there:?} {back:?}");
    }

    /// At a converged optimum with `f < 0` the surface contact point is a true touching configuration.
    #[test]
    fn the_surface_contact_point_touches(i in 0u64..60, j in 0u64..60, p in pose()) {
        let (a, b) = (polyhedron(&shape(i)), polyhedron(&shape(j)));
        let t = Tracker::new(a.clone(), b.clone()).seed(&p);
        if !t.is_free() {
            let scp = Pose::new(p.translation + t.near.normal_w * t.depth, p.rotation);
            prop_assert!(plane_distance(&a, &b, &scp, t.near.normal_w).abs() < 1e-11);
            let app = contact_point(t.near.contact, &a, &b, &scp);
            prop_assert!(b.contains(app, 1e-9), "App on B");
            prop_assert!(a.contains(scp.inverse().transform_point(app), 1e-9), "App on A");
        }
    }

    /// The facet neighbours are applicable, mutual, among the appendix's (type C: or across a vertex), and connect all
    /// facets of the C-obstacle.
    #[test]
    fn facet_neighbours_are_the_hulls(i in 0u64..30, j in 0u64..30, p in pose()) {
        let (a, b) = (polyhedron(&shape(i)), polyhedron(&shape(j)));
        let graph = ContactGraph::new(&a, &b);
        let facets: std::collections::BTreeSet<BasicContact> =
            applicable_c_faces(&a, &b, &p).iter().map(|f| f.contact).collect();
        let start = *facets.first().expect("a C-obstacle has facets");
        let mut seen = std::collections::BTreeSet::from([start]);
        let mut open = vec![start];
        while let Some(c) = open.pop() {
            let near = graph.facet_neighbors(c, &p);
            prop_assert!(near.len() >= 3, "{c:?} {near:?}");
            for n in near {
                prop_assert!(facets.contains(&n), "{c:?} -> {n:?} is not applicable");
                prop_assert!(graph.facet_neighbors(n, &p).contains(&c), "{c:?} -> {n:?} is one way");
                if seen.insert(n) {
                    open.push(n);
                }
            }
        }
        prop_assert_eq!(seen.len(), facets.len());
    }

    #[test]
    fn no_mesh_panics(v in prop::collection::vec(prop::array::uniform3(-2i8..3), 0..9),
                      f in prop::collection::vec(prop::collection::vec(0u32..10, 0..5), 0..9)) {
        let v: Vec<DVec3> = v.iter().map(|p| DVec3::from_array(p.map(f64::from))).collect();
        let _ = Polyhedron::from_faces(&v, &f);
    }
}

#[test]
fn the_papers_counts() {
    let (t, c) = (polyhedron(&tetrahedron(1.0)), polyhedron(&cuboid(DVec3::ONE)));
    assert_eq!(ContactGraph::new(&t, &c).node_count(), 128);
    assert_eq!(ContactGraph::new(&t, &c).nodes().count(), 128);
    assert_eq!(ContactGraph::new(&c, &c).node_count(), 240);
    let p = polyhedron(&prism(12, 1.0, 1.0));
    assert_eq!(ContactGraph::new(&p, &p).node_count(), 1968);
    let mut rng = random(5);
    for _ in 0..100 {
        let pose = Pose::new(DVec3::ZERO, rotation(&mut rng));
        let n = applicable_c_faces(&t, &c, &pose).len();
        assert!((19..=22).contains(&n), "{n}");
        assert_eq!(applicable_c_faces(&c, &c, &pose).len(), 30);
    }
}

/// Rosell and Vazquez 2004, section III and appendix: 128 nodes, |F_A||V_B| + |V_A||F_B| + |E_A||E_B|, and each
/// node's arcs by the appendix's three rules, counted by hand.
#[test]
fn rosell_vazquez_2004_appendix_neighbours_of_tetrahedron_and_box() {
    let (t, c) = (polyhedron(&tetrahedron(1.0)), polyhedron(&cuboid(DVec3::ONE)));
    let graph = ContactGraph::new(&t, &c);
    let mut of_type = [0; 3];
    for node in graph.nodes() {
        let neighbors = graph.neighbors(node);
        let (which, expected) = match node {
            // 3 faces and 3 vertices beside, 3 x 3 of type B, 3 x 3 of type C.
            BasicContact::TypeA { .. } => (0, 3 + 3 + 9 + 9),
            // 3 vertices and 4 faces beside, 3 x 4 of type C; 3 x 4 of type A by the first rule, from its other end.
            BasicContact::TypeB { .. } => (1, 3 + 4 + 12 + 12),
            // 4 edges beside each of the two; 2 x 2 of type A and 2 x 2 of type B from their ends.
            BasicContact::TypeC { .. } => (2, 4 + 4 + 4 + 4),
        };
        of_type[which] += 1;
        assert_eq!(neighbors.len(), expected, "{node:?}");
        assert!(!neighbors.contains(&node));
        let distinct: std::collections::BTreeSet<_> = neighbors.iter().collect();
        assert_eq!(distinct.len(), neighbors.len(), "{node:?} names a neighbour twice");
        for other in &neighbors {
            assert!(graph.neighbors(*other).contains(&node), "the arc from {node:?} to {other:?} has no way back");
        }
    }
    assert_eq!(of_type, [4 * 8, 4 * 6, 6 * 12]);
    assert_eq!(of_type.iter().sum::<usize>(), 128);
}
