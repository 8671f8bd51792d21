use super::*;

fn cube_vertices() -> Vec<DVec3> {
    (0..8).map(|i| DVec3::new(f64::from(i & 1), f64::from(i >> 1 & 1), f64::from(i >> 2 & 1))).collect()
}

fn cube_faces() -> Vec<Vec<u32>> {
    vec![vec![0, 2, 3, 1], vec![4, 5, 7, 6], vec![0, 1, 5, 4], vec![2, 6, 7, 3], vec![0, 4, 6, 2], vec![1, 3, 7, 5]]
}

fn triangulated(faces: &[Vec<u32>]) -> Vec<Vec<u32>> {
    faces.iter().flat_map(|f| (1..f.len() - 1).map(|i| vec![f[0], f[i], f[i + 1]])).collect()
}

#[test]
fn triangles_of_a_cube_merge_into_six_squares() {
    for faces in [cube_faces(), triangulated(&cube_faces())] {
        let p = Polyhedron::from_faces(&cube_vertices(), &faces).unwrap();
        assert_eq!((p.face_count(), p.edge_count(), p.vertex_count()), (6, 12, 8));
        assert!((p.inner_radius() - 0.5).abs() < 1e-3 && p.center().distance(DVec3::splat(0.5)) < 1e-3);
    }
}

#[test]
fn a_vertex_inside_a_face_or_on_an_edge_vanishes() {
    let mut v = cube_vertices();
    v.push(DVec3::new(0.5, 0.5, 0.0)); // 8: middle of the bottom
    v.push(DVec3::new(0.5, 0.0, 1.0)); // 9: middle of an edge of the top
    let mut f = cube_faces();
    f[0] = vec![0, 2, 8];
    f.extend([vec![2, 3, 8], vec![3, 1, 8], vec![1, 0, 8]]);
    f[1] = vec![4, 9, 5, 7, 6];
    f[2] = vec![0, 1, 5, 9, 4];
    let p = Polyhedron::from_faces(&v, &f).unwrap();
    assert_eq!((p.face_count(), p.edge_count(), p.corner_ids().count()), (6, 12, 8));
    assert!(p.vertex_edges(VertexId(9)).is_empty());
}

#[test]
fn operators_agree_with_each_other() {
    let p = Polyhedron::from_faces(&cube_vertices(), &cube_faces()).unwrap();
    for f in p.faces() {
        let ring = p.face_vertices(f);
        for i in 0..ring.len() {
            let e = p.edge(p.face_edges(f)[i]);
            let ends = [ring[i], ring[(i + 1) % ring.len()]];
            let g = p.face_faces(f)[i];
            assert!(e.vertices == ends && e.faces == [f, g] || e.vertices == [ends[1], ends[0]] && e.faces == [g, f]);
        }
    }
    for v in p.corner_ids() {
        let (edges, faces) = (p.vertex_edges(v), p.vertex_faces(v));
        for i in 0..edges.len() {
            let j = (i + 1) % edges.len();
            assert!(
                p.edge(edges[i]).vertices.contains(&v) && p.edge(edges[i]).vertices.contains(&p.vertex_vertices(v)[i])
            );
            assert!(p.face_edges(faces[i]).contains(&edges[i]) && p.face_edges(faces[i]).contains(&edges[j]));
        }
    }
    for e in p.edges() {
        assert_eq!(p.edge_edges(e).len(), 4);
    }
}

#[test]
fn errors_name_the_culprit() {
    let (v, f) = (cube_vertices(), cube_faces());
    let build = |v: &[DVec3], f: &[Vec<u32>]| Polyhedron::from_faces(v, f).unwrap_err();
    assert_eq!(build(&[], &[]), PolyhedronError::Empty);
    let mut bad = v.clone();
    bad[3].y = f64::NAN;
    assert_eq!(build(&bad, &f), PolyhedronError::NotFinite { vertex: 3 });
    let mut bad = f.clone();
    bad[2][1] = 8;
    assert_eq!(build(&v, &bad), PolyhedronError::IndexOutOfRange { face: 2, vertex: 8, count: 8 });
    assert!(matches!(build(&v, &f[..5]), PolyhedronError::Open { .. }));
    let mut bad = f.clone();
    bad[4].reverse();
    assert!(matches!(build(&v, &bad), PolyhedronError::NotOriented { .. }));
    let inward: Vec<Vec<u32>> = f.iter().map(|f| f.iter().rev().copied().collect()).collect();
    assert!(matches!(build(&v, &inward), PolyhedronError::InsideOut { .. }));
    let mut dented = v.clone();
    dented[7] = DVec3::splat(0.4);
    assert!(matches!(build(&dented, &triangulated(&f)), PolyhedronError::NotConvex { .. }));
    let flat: Vec<DVec3> = v.iter().map(|v| DVec3::new(v.x, v.y, 0.0)).collect();
    assert!(Polyhedron::from_faces(&flat, &f).is_err());
    let two_sided = [vec![0, 1, 3], vec![0, 3, 1]];
    assert!(matches!(build(&v, &two_sided), PolyhedronError::Flat { .. }));
    let mut two_bodies = v.clone();
    two_bodies.extend(v.iter().map(|v| *v + DVec3::splat(5.0)));
    let mut faces = f.clone();
    faces.extend(f.iter().map(|f| f.iter().map(|i| i + 8).collect()));
    assert!(matches!(build(&two_bodies, &faces), PolyhedronError::NotOneBody { .. }));
}

#[test]
fn size_does_not_matter() {
    for scale in [1e-6, 1e-3, 1.0, 1e3, 1e9] {
        let v: Vec<DVec3> = cube_vertices().iter().map(|v| *v * scale).collect();
        let p = Polyhedron::from_faces(&v, &triangulated(&cube_faces())).unwrap();
        assert_eq!(p.face_count(), 6);
    }
}
