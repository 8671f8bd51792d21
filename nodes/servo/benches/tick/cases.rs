//! What the ticks are measured on: the peg over, in, and jammed in the paper's hole, and in a corner of five pieces.

use cspace::{FixedPart, Polyhedron, World};
use device::Sample;
use haptics::{Gains, LawKind, Renderer};
use scene::Scene;
use servo::{Config, Tick, TickInput};
use spatial::{DVec3, Pose, Stamp};
use std::path::Path;
use std::sync::Arc;

/// Where the hand trembles.
#[derive(Clone, Copy)]
pub struct Case {
    pub name: &'static str,
    /// The middle of its trembling, metres.
    place: DVec3,
    /// How far it has turned the peg there, rotation vector, radians.
    turn: DVec3,
    seated: bool,
    surroundings: Surroundings,
}

/// What stands there.
#[derive(Clone, Copy)]
enum Surroundings {
    /// The hole of four walls and a bottom.
    Hole,
    /// The corner that two cut walls and a bottom make.
    Corner,
    /// A plate of one piece, where the hole's bottom is.
    Plate,
}

/// `free` hovers. `plate` pushes 0.2 mm into a plate, the only obstacle. `corner` pushes to the bottom and into a corner, 0.2
/// mm deep, so that the peg leans on two walls and the bottom. `five` does the same in a corner of five pieces, two to a wall:
/// the hand is inside of all of them, and the proxy touches three to five. `jammed` also turns the peg about the vertical and
/// about an edge, farther than the hole's clearance lets it: the proxy stands against all four walls and the bottom, five
/// pieces at once.
pub const CASES: [Case; 5] = [
    pressed("free", DVec3::new(0.0, 0.0, 0.03), false, Surroundings::Hole),
    pressed("plate", DVec3::new(2e-4, 1.5e-4, 0.0058), true, Surroundings::Plate),
    pressed("corner", DVec3::new(2e-4, 1.5e-4, 0.0058), true, Surroundings::Hole),
    pressed("five", DVec3::new(2e-4, 1.5e-4, 0.0058), true, Surroundings::Corner),
    Case {
        name: "jammed",
        place: DVec3::new(0.0, 0.0, 0.0055),
        turn: DVec3::new(0.0, 0.05, 0.06),
        seated: true,
        surroundings: Surroundings::Hole,
    },
];

/// A case without a turn.
const fn pressed(name: &'static str, place: DVec3, seated: bool, surroundings: Surroundings) -> Case {
    Case { name, place, turn: DVec3::ZERO, seated, surroundings }
}

pub const LAWS: [LawKind; 4] = [LawKind::Paper, LawKind::Pstar, LawKind::Blended, LawKind::Proxy];

/// Ticks in which the part is led to its place.
const WAY: u64 = 500;

fn input(i: u64, pose: Pose, law: LawKind) -> TickInput {
    let stamp = Stamp(i as i64 * 1_000_000);
    let sample = Sample { sequence: i + 1, stamp, pose, connected: true, ..Default::default() };
    let gains = Gains { law, ..Gains::default() };
    TickInput { sequence: i, stamp, dt: 1e-3, sample, gains, enabled: true, ..Default::default() }
}

/// A tick that has been led to the case's place through the mouth of the hole, as a hand would have brought the part.
pub fn led_there(case: &Case, law: LawKind) -> Tick {
    let world = match case.surroundings {
        Surroundings::Hole => peg_in_hole(),
        Surroundings::Corner => among_boxes(&[
            ([8.125, -25.0, -9.0], [30.0, 0.0, 0.0]),
            ([8.125, 0.0, -9.0], [30.0, 25.0, 0.0]),
            ([-30.0, 5.105, -9.0], [0.0, 25.0, 0.0]),
            ([0.0, 5.105, -9.0], [8.125, 25.0, 0.0]),
            ([-30.0, -25.0, -14.0], [30.0, 25.0, -9.0]),
        ]),
        Surroundings::Plate => among_boxes(&[([-30.0, -25.0, -14.0], [30.0, 25.0, -9.0])]),
    };
    let mut tick = Tick::with_law(Box::new(Renderer::new(world)), &Config::default());
    let start = DVec3::Z * 0.03;
    for i in 0..WAY {
        let s = i as f64 / WAY as f64;
        let late = s.powi(8);
        let through = if case.seated {
            start.lerp(DVec3::Z * case.place.z, s) + case.place.with_z(0.0) * late
        } else {
            case.place
        };
        let pose = Pose::new(through, Pose::IDENTITY.rotation).moved(DVec3::ZERO, case.turn * late);
        tick.step(&input(i, pose, law));
    }
    tick
}

/// The inputs of `ticks` ticks of trembling there: 0.05 mm and 5 mrad at a few hertz.
pub fn trembling(case: &Case, law: LawKind, ticks: usize) -> Vec<TickInput> {
    let middle = Pose::new(case.place, Pose::IDENTITY.rotation).moved(DVec3::ZERO, case.turn);
    let at = |i: u64| {
        let phase = i as f64 * 0.01;
        let sway = DVec3::new(phase.sin(), phase.cos(), (1.3 * phase).sin()) * 5e-5;
        let turn = DVec3::new((0.7 * phase).sin(), 0.0, (0.9 * phase).cos()) * 5e-3;
        input(i, middle.moved(sway, turn), law)
    };
    (WAY..WAY + ticks as u64).map(at).collect()
}

fn peg_in_hole() -> Arc<World> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../config/scenes/peg_in_hole/scene.yaml");
    Scene::load(&path).expect("the repository's scene").world
}

/// The same peg among boxes, each given by two corners, millimetres.
fn among_boxes(boxes: &[([f64; 3], [f64; 3])]) -> Arc<World> {
    let fixed =
        boxes.iter().map(|(low, high)| FixedPart { polyhedron: Arc::new(cuboid(*low, *high)), obstacle: 0 }).collect();
    Arc::new(World { moving: vec![Arc::new(cuboid([-8.0, -5.0, -15.0], [8.0, 5.0, 15.0]))], fixed })
}

/// A box between two corners, millimetres.
fn cuboid(low: [f64; 3], high: [f64; 3]) -> Polyhedron {
    let corner =
        |i: usize| DVec3::from_array(std::array::from_fn(|k| if i >> k & 1 == 0 { low[k] } else { high[k] })) * 1e-3;
    let corners: Vec<DVec3> = (0..8).map(corner).collect();
    let faces = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    Polyhedron::from_faces(&corners, &faces.map(|f| f.to_vec())).expect("a box is a polyhedron")
}
