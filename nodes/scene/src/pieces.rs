use crate::cut::cut_into_convex;
use crate::hull::{approximate, hull};
use crate::scene_file::Convexity;
use crate::{Mesh, MeshError};
use cspace::{Polyhedron, PolyhedronError};

/// The convex pieces of a mesh, and what had to be done to it, if anything.
pub fn convex_pieces(mesh: &Mesh, convexity: Convexity) -> Result<(Vec<Polyhedron>, Option<String>), MeshError> {
    match convexity {
        Convexity::Exact => Ok((vec![polyhedron(mesh)?], None)),
        Convexity::Hull => {
            let hull = hull(&mesh.vertices).map_err(MeshError::whole)?;
            Ok((vec![polyhedron(&hull)?], polyhedron(mesh).is_err().then(|| "taken by its convex hull".into())))
        }
        Convexity::Auto => decomposed(mesh),
    }
}

/// As it is if convex; else its separate bodies, each as it is if convex, cut exactly, or approximated.
fn decomposed(mesh: &Mesh) -> Result<(Vec<Polyhedron>, Option<String>), MeshError> {
    let refused = match Polyhedron::from_faces(&mesh.vertices, &mesh.faces) {
        Ok(whole) => return Ok((vec![whole], None)),
        Err(e) => e,
    };
    // First as the file has them: bodies that touch share positions, but not their vertices.
    let welded = mesh.welded();
    match convex_bodies(mesh).or_else(|| convex_bodies(&welded)) {
        Some(pieces) if pieces.len() == 1 => Ok((pieces, None)),
        Some(pieces) => {
            let note = format!("{} convex bodies", pieces.len());
            Ok((pieces, Some(note)))
        }
        None => solid(&welded, refused),
    }
}

/// The bodies of the mesh, if every one is convex.
fn convex_bodies(mesh: &Mesh) -> Option<Vec<Polyhedron>> {
    mesh.components().iter().map(|b| Polyhedron::from_faces(&b.vertices, &b.faces).ok()).collect()
}

fn solid(mesh: &Mesh, refused: PolyhedronError) -> Result<(Vec<Polyhedron>, Option<String>), MeshError> {
    let nothing = |e: PolyhedronError| MeshError::whole(e.to_string());
    if !closed(mesh) || mesh.volume() <= 0.0 {
        // Nothing can be decomposed that has no inside; the polyhedron's own complaint says where.
        return Err(nothing(refused));
    }
    // Bodies that touch or overlap are solids of their own; only together they may have cavities.
    let bodies = mesh.components();
    let solids = if bodies.iter().all(|b| b.volume() > 0.0) { bodies } else { vec![mesh.clone()] };
    let (mut pieces, mut exact) = (Vec::new(), true);
    // A piece's own complaint would speak of faces that the file does not have.
    let either =
        || MeshError::whole(format!("{refused}; it cannot be cut into convex pieces either: try `convex: hull`"));
    for solid in &solids {
        let meshes = cut_into_convex(solid).or_else(|| {
            exact = false;
            approximate(solid)
        });
        for piece in &meshes.ok_or_else(either)? {
            let convex = polyhedron(piece).or_else(|_| polyhedron(&hull(&piece.vertices).map_err(MeshError::whole)?));
            pieces.push(convex.map_err(|_| either())?);
        }
    }
    if pieces.is_empty() {
        return Err(nothing(refused));
    }
    let how = if exact { "cut into" } else { "too intricate to cut exactly: APPROXIMATED by" };
    let n = pieces.len();
    Ok((pieces, Some(format!("not convex: {how} {n} convex pieces"))))
}

fn polyhedron(mesh: &Mesh) -> Result<Polyhedron, MeshError> {
    let first = match Polyhedron::from_faces(&mesh.vertices, &mesh.faces) {
        Ok(p) => return Ok(p),
        Err(e) => e,
    };
    // Exporters repeat vertices; indices in the message are those of the file.
    let welded = mesh.welded();
    Polyhedron::from_faces(&welded.vertices, &welded.faces).map_err(|_| MeshError::whole(first.to_string()))
}

/// Every edge has two faces that run along it in opposite directions.
fn closed(mesh: &Mesh) -> bool {
    let mut edges = std::collections::HashMap::new();
    for face in &mesh.faces {
        for (i, &a) in face.iter().enumerate() {
            let b = face[(i + 1) % face.len()];
            *edges.entry((a.min(b), a.max(b))).or_insert(0i64) += if a < b { 1 } else { -1 };
        }
    }
    edges.values().all(|n| *n == 0)
}
