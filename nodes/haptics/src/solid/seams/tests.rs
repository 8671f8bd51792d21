use super::*;
use crate::testing::cuboid;
use spatial::Pose;

#[test]
fn joint_of_two_boxes_is_flat_on_top_and_dead_inside() {
    // Two boxes side by side: [-1, 0] and [0, 1] in x, top at z = 0.
    let pieces = vec![
        Arc::new(cuboid(DVec3::new(-1.0, -1.0, -1.0), DVec3::new(0.0, 1.0, 0.0))),
        Arc::new(cuboid(DVec3::new(-0.2, -1.0, -1.0), DVec3::new(1.0, 1.0, 0.0))),
    ];
    let s = Seams::new(pieces);
    assert!(!s.is_alone(0));
    let on_joint = DVec3::new(0.0, 0.1, 0.0);
    assert!(s.is_felt(0, on_joint, DVec3::Z), "the top goes on across the joint");
    assert!(!s.is_felt(0, DVec3::new(0.0, 0.1, -0.3), DVec3::X), "the joint face is inside");
    assert!(!s.is_felt(0, on_joint, DVec3::new(0.1, 0.0, 1.0).normalize()), "the joint edge is flat");
    assert!(s.is_felt(0, DVec3::new(-1.0, 0.1, 0.0), DVec3::new(-0.1, 0.0, 1.0).normalize()), "a real edge");
    assert!(s.is_felt(1, DVec3::new(1.0, 0.0, -0.5), DVec3::X), "a real face");
    let covers: Vec<Cover> = (0..6).map(|f| s.cover(0, FaceId(f))).collect();
    assert_eq!(covers.iter().filter(|c| **c == Cover::Internal).count(), 1, "{covers:?}");
    assert_eq!(covers.iter().filter(|c| **c == Cover::Open).count(), 5, "{covers:?}");
}

#[test]
fn tops_of_one_height_are_flush_and_joints_are_not() {
    let s = Seams::new(vec![
        Arc::new(cuboid(DVec3::new(-1.0, -1.0, -1.0), DVec3::new(0.0, 1.0, 0.0))),
        Arc::new(cuboid(DVec3::new(0.0, -0.5, -2.0), DVec3::new(1.0, 0.5, 0.0))),
        Arc::new(cuboid(DVec3::new(3.0, -0.5, -2.0), DVec3::new(4.0, 0.5, -1e-3))),
    ]);
    for f in s.pieces[0].faces() {
        let normal = s.pieces[0].face_plane(f).normal;
        match s.flush(0, f) {
            [(1, g)] => assert!(normal == DVec3::Z && s.pieces[1].face_plane(*g).normal == DVec3::Z),
            others => assert!(normal != DVec3::Z && others.is_empty(), "{normal}: {others:?}"),
        }
    }
}

#[test]
fn a_face_ends_where_every_piece_falls_off_however_shallow_the_bevel() {
    // A plate with a bevel of 1 : 20 around its top, given twice, and cut across into two that overlap.
    let plate = |x: [f64; 2], rise: [f64; 2]| {
        let ring = |x: [f64; 2], y: f64, z: f64| {
            [(x[0], -y), (x[1], -y), (x[1], y), (x[0], y)].map(|(x, y)| DVec3::new(x, y, z))
        };
        let corners = [ring(x, 1.0, -0.025), ring([x[0] + rise[0], x[1] - rise[1]], 0.5, 0.0)].concat();
        let faces = [[3, 2, 1, 0], [4, 5, 6, 7], [0, 1, 5, 4], [1, 2, 6, 5], [2, 3, 7, 6], [3, 0, 4, 7]];
        Arc::new(Polyhedron::from_faces(&corners, &faces.map(|f| f.to_vec())).expect("a plate"))
    };
    let whole = || plate([-1.0, 1.0], [0.5, 0.5]);
    let twice = Seams::new(vec![whole(), whole()]);
    let cut = Seams::new(vec![plate([-1.0, 0.2], [0.5, 0.0]), plate([0.0, 1.0], [0.0, 0.5])]);
    let mut ends = 0;
    for (seams, piece) in [(&twice, 0), (&twice, 1), (&cut, 0), (&cut, 1)] {
        let p = &seams.pieces[piece];
        let top = p.faces().find(|f| p.face_plane(*f).normal.z > 0.999).unwrap();
        let ring = p.face_vertices(top);
        for side in 0..ring.len() {
            let [from, to] = side_ends(p, top, side);
            let middle = from.lerp(to, 0.4);
            let joint = middle.x.abs() < 0.3 && middle.y.abs() < 0.4;
            assert_eq!(seams.goes_on(piece, top, side, middle), joint, "piece {piece}, {middle}");
            ends += usize::from(!joint);
        }
    }
    assert_eq!(ends, 4 + 4 + 3 + 3);
}

#[test]
fn a_wall_covers_a_part_of_the_floor() {
    let s = Seams::new(vec![
        Arc::new(cuboid(DVec3::new(-1.0, -1.0, -1.0), DVec3::new(1.0, 1.0, 0.0))),
        Arc::new(cuboid(DVec3::new(0.5, -1.0, 0.0), DVec3::new(1.0, 1.0, 1.0))),
    ]);
    let covers: Vec<Cover> = (0..6).map(|f| s.cover(0, FaceId(f))).collect();
    assert_eq!(covers.iter().filter(|c| **c == Cover::Partial).count(), 1, "{covers:?}");
    let top = FaceId(covers.iter().position(|c| *c == Cover::Partial).unwrap() as u32);
    assert!(s.is_covered(0, top, DVec3::new(0.7, 0.0, 0.0)) && !s.is_covered(0, top, DVec3::new(0.2, 0.0, 0.0)));
}

#[test]
fn a_face_that_two_pieces_cover_together_is_internal() {
    // A floor of three: the side of the second at x = 0 lies in the first up to y = 0.1, and in the third beyond.
    let tile = |x: [f64; 2], y: [f64; 2]| Arc::new(cuboid(DVec3::new(x[0], y[0], -1.0), DVec3::new(x[1], y[1], 0.0)));
    let s =
        Seams::new(vec![tile([-1.0, 0.2], [-1.0, 0.1]), tile([0.0, 1.0], [-1.0, 0.3]), tile([-1.0, 1.0], [0.1, 1.0])]);
    for piece in 0..3 {
        let p = &s.pieces[piece];
        for f in p.faces() {
            let n = p.face_plane(f).normal;
            let point = p.vertex(p.face_vertices(f)[0]).dot(n) * n;
            let outer = n.z != 0.0 || (point.length() - 1.0).abs() < 1e-12;
            assert_eq!(s.cover(piece, f) == Cover::Internal, !outer, "piece {piece}, normal {n}, at {point}");
        }
    }
}

#[test]
fn on_an_edge_what_is_felt_is_what_is_felt_at_the_point() {
    // A floor in two pieces that overlap, a wall on it, and a plate that leans into both.
    let leaning = Pose::from_xyz_rpy(DVec3::new(0.3, 0.2, 0.1), DVec3::new(0.4, -0.7, 0.3));
    let s = Seams::new(vec![
        Arc::new(cuboid(DVec3::new(-1.0, -1.0, -1.0), DVec3::new(0.2, 1.0, 0.0))),
        Arc::new(cuboid(DVec3::new(0.0, -1.0, -1.0), DVec3::new(1.0, 1.0, 0.0))),
        Arc::new(cuboid(DVec3::new(0.5, -0.5, 0.0), DVec3::new(0.7, 1.0, 1.0))),
        Arc::new(cuboid(DVec3::new(-0.5, -0.5, -0.1), DVec3::new(0.5, 0.5, 0.1)).transformed(&leaning, 1.0)),
    ]);
    let (mut felt, mut unfelt) = (0, 0);
    for piece in 0..4 {
        let p = &s.pieces[piece];
        for e in p.edges() {
            let [a, b] = p.edge(e).vertices.map(|v| p.vertex(v));
            let [f, g] = p.edge(e).faces.map(|f| p.face_plane(f).normal);
            for (i, j) in (0..=20).flat_map(|i| (0..=4).map(move |j| (i, j))) {
                let (at, normal) = (a.lerp(b, f64::from(i) / 20.0), f.lerp(g, f64::from(j) / 4.0).normalize());
                let expected = s.is_felt(piece, at, normal);
                assert_eq!(s.is_felt_on_edge(piece, e, || at, normal), expected, "piece {piece}, {at}, {normal}");
                *(if expected { &mut felt } else { &mut unfelt }) += 1;
            }
        }
    }
    assert!(felt > 1000 && unfelt > 1000, "{felt} {unfelt}");
}

#[test]
fn pieces_apart_are_alone() {
    let s = Seams::new(vec![
        Arc::new(cuboid(DVec3::ZERO, DVec3::ONE)),
        Arc::new(cuboid(DVec3::new(1.1, 0.0, 0.0), DVec3::new(2.0, 1.0, 1.0))),
    ]);
    assert!(s.is_alone(0) && s.is_alone(1));
}
