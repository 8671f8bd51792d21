use crate::Mesh;
use parry3d_f64::transformation::try_convex_hull;
use parry3d_f64::transformation::vhacd::{VHACD, VHACDParameters};
use parry3d_f64::transformation::voxelization::FillMode;
use spatial::DVec3;

/// The convex hull of points, as triangles.
pub fn hull(points: &[DVec3]) -> Result<Mesh, String> {
    let size = Mesh { vertices: points.to_vec(), faces: Vec::new() }.size();
    let (vertices, triangles) = try_convex_hull(points).map_err(|e| format!("no convex hull: {e}"))?;
    let mesh = Mesh { vertices, faces: triangles.iter().map(|t| t.to_vec()).collect() };
    // Flat point sets come back as two-sided sheets.
    if mesh.volume() > 1e-12 * size.powi(3) { Ok(mesh) } else { Err("no convex hull: the points are coplanar".into()) }
}

/// Convex pieces that together come near to the solid: an approximation, for what cannot be cut exactly. `None` if there
/// are none, as of a surface that crosses itself.
pub fn approximate(solid: &Mesh) -> Option<Vec<Mesh>> {
    let triangles: Vec<[u32; 3]> =
        solid.faces.iter().flat_map(|f| (1..f.len() - 1).map(|i| [f[0], f[i], f[i + 1]])).collect();
    let parameters = VHACDParameters {
        resolution: 96,
        concavity: 0.002,
        max_convex_hulls: 64,
        fill_mode: FillMode::FloodFill { detect_cavities: true },
        ..Default::default()
    };
    let parts = quietly(|| {
        VHACD::decompose(&parameters, &solid.vertices, &triangles, true)
            .compute_exact_convex_hulls(&solid.vertices, &triangles)
    })?;
    let pieces: Vec<Mesh> = parts.iter().filter_map(|(vertices, _)| hull(vertices).ok()).collect();
    (!pieces.is_empty()).then_some(pieces)
}

/// `None` where `work` panics, as the decomposition does where it finds no hull of a part. What it says then is for its
/// makers; what others say meanwhile is lost, which is little while a scene is read.
fn quietly<T>(work: impl FnOnce() -> T) -> Option<T> {
    let hook = std::panic::take_hook();
    std::panic::set_hook(Box::new(|_| {}));
    let outcome = std::panic::catch_unwind(std::panic::AssertUnwindSafe(work));
    std::panic::set_hook(hook);
    outcome.ok()
}
