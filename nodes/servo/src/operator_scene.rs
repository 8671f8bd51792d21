use cspace::World;
use device::{Bounds, OperatorPlan};
use spatial::{DVec3, Pose};

/// What a simulated operator does in a scene: inserts A where its box drops into a pocket of the obstacles from above
/// (towards -z), else touches, slides and lifts. `None` if the world lacks a part or an obstacle.
///
/// Works on the boxes of the convex pieces: good enough to aim a hand by, and the hand errs on purpose anyway.
#[must_use]
pub fn operator_plan(world: &World) -> Option<OperatorPlan> {
    let moving = Bounds::around(world.moving.iter().flat_map(|p| p.vertices().iter().copied()))?;
    let pieces: Vec<Bounds> =
        world.fixed.iter().filter_map(|p| Bounds::around(p.polyhedron.vertices().iter().copied())).collect();
    let fixed = Bounds::around(pieces.iter().flat_map(|b| [b.min, b.max]))?;
    Some(match deepest_pocket(&pieces, &fixed, moving.size()) {
        Some(bottom) => insertion(moving, fixed, bottom),
        None => OperatorPlan::survey(moving, fixed),
    })
}

fn insertion(moving: Bounds, fixed: Bounds, bottom: DVec3) -> OperatorPlan {
    let tip_a = moving.center().with_z(moving.min.z);
    let seated = Pose::new(bottom - tip_a, Pose::IDENTITY.rotation);
    // Beside the hole but still on the plate, towards its wider side.
    let room =
        |low: f64, high: f64, half: f64| if high > -low { (high - half).max(0.0) } else { (low + half).min(0.0) };
    let half = moving.size() * 0.5;
    let x = room(fixed.min.x - bottom.x, fixed.max.x - bottom.x, half.x);
    let y = room(fixed.min.y - bottom.y, fixed.max.y - bottom.y, half.y);
    let reach = |room: f64, wish: f64| room.clamp(-wish, wish);
    let slide = DVec3::new(reach(x, (1.5 * half.x).max(0.004)), reach(y, 0.5 * half.y), 0.0);
    OperatorPlan::insertion(seated, tip_a, DVec3::Z, fixed.max.z - bottom.z, slide)
}

/// The middle of the floor of the deepest place that a box of `size` drops into without touching a wall.
fn deepest_pocket(pieces: &[Bounds], fixed: &Bounds, size: DVec3) -> Option<DVec3> {
    let xs = gap_middles(pieces, size.x, |p| p.x);
    let ys = gap_middles(pieces, size.y, |p| p.y);
    let mut deepest: Option<DVec3> = None;
    for &x in &xs {
        for &y in &ys {
            let floor = floor_below(pieces, fixed, DVec3::new(x, y, 0.0), size);
            if deepest.is_none_or(|d| floor < d.z) {
                deepest = Some(DVec3::new(x, y, floor));
            }
        }
    }
    deepest.filter(|d| d.z < fixed.max.z - 1e-3)
}

/// Middles of gaps between two pieces along one axis that are wider than `width`, but not by so much that a slide would
/// not meet the walls.
fn gap_middles(pieces: &[Bounds], width: f64, along: impl Fn(DVec3) -> f64) -> Vec<f64> {
    let mut middles = Vec::new();
    for a in pieces {
        for b in pieces {
            let gap = along(b.min) - along(a.max);
            if gap >= width && gap < 1.5 * width {
                middles.push(0.5 * (along(b.min) + along(a.max)));
            }
        }
    }
    middles.sort_by(f64::total_cmp);
    middles.dedup();
    middles
}

/// How low a box of `size` sinks at `center`: the highest top of the pieces under it, or the underside of everything.
fn floor_below(pieces: &[Bounds], fixed: &Bounds, center: DVec3, size: DVec3) -> f64 {
    let (low, high) = (center - size * 0.5, center + size * 0.5);
    let under = |p: &&Bounds| p.min.x < high.x && low.x < p.max.x && p.min.y < high.y && low.y < p.max.y;
    pieces.iter().filter(under).map(|p| p.max.z).fold(fixed.min.z, f64::max)
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::path::Path;

    fn plan(scene: &str) -> OperatorPlan {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("../../config/scenes/{scene}/scene.yaml"));
        operator_plan(&scene::Scene::load(&path).unwrap().world).unwrap()
    }

    #[test]
    fn finds_the_holes_of_the_task_board() {
        for scene in ["peg_in_hole", "peg_4x4"] {
            let plan = plan(scene);
            let lowest =
                plan.waypoints.iter().map(|w| w.pose.transform_point(plan.tip_a)).min_by(|a, b| a.z.total_cmp(&b.z));
            let lowest = lowest.unwrap();
            assert!(lowest.truncate().length() < 1e-9 && lowest.z < -0.009, "{scene}: {lowest}");
            let beside = plan.start.transform_point(plan.tip_a);
            assert!(beside.z > 0.0 && beside.truncate().length() > 0.003, "{scene}: {beside}");
        }
    }

    #[test]
    fn surveys_where_there_is_no_hole() {
        let plan = plan("tetra_on_box");
        assert!(plan.start.translation.z > 0.02);
        assert!(plan.waypoints.iter().all(|w| w.pose.transform_point(plan.tip_a).z > -0.02));
        plan.check().unwrap();
    }
}
