//! A peg and its hole: the contact states of an insertion whose sequence is known by construction.

#[path = "support/scripted.rs"]
mod scripted;

use cspace::{FixedPart, World};
use scripted::{LAWS, Leg, check, cuboid, run};
use spatial::DQuat;
use std::sync::Arc;

/// Half the clearance of the NIST task board's rectangular peg, x and y, metres.
const PLAY: [f64; 2] = [0.125e-3, 0.105e-3];

/// A peg of 16 x 10 x 30 mm over a plate of 9 mm with a hole and a floor under it; the plate, one obstacle, is cut into four
/// pieces. The plate's top is at z = 0.
fn world() -> World {
    let (x, y) = (8e-3 + PLAY[0], 5e-3 + PLAY[1]);
    let fixed = |low, high| FixedPart { polyhedron: Arc::new(cuboid(low, high)), obstacle: 0 };
    World {
        moving: vec![Arc::new(cuboid([-8e-3, -5e-3, -15e-3], [8e-3, 5e-3, 15e-3]))],
        fixed: vec![
            fixed([-0.03, -0.025, -9e-3], [-x, 0.025, 0.0]),
            fixed([x, -0.025, -9e-3], [0.03, 0.025, 0.0]),
            fixed([-x, -0.025, -9e-3], [x, -y, 0.0]),
            fixed([-x, y, -9e-3], [x, 0.025, 0.0]),
            fixed([-0.03, -0.025, -14e-3], [0.03, 0.025, -9e-3]),
        ],
    }
}

#[test]
fn a_peg_goes_along_one_wall_then_two_to_the_bottom_and_back() {
    // Pressed 0.1 mm into whatever is touched.
    const PRESS: f64 = 1e-4;
    let (x, y, bottom) = (PLAY[0] + PRESS, PLAY[1] + PRESS, 6e-3 - PRESS);
    let legs: &[Leg] = &[
        ([0.0, 0.0, 0.01], 400),
        ([0.0, 0.0, 0.01], 100),
        ([x, 0.0, 0.01], 100),
        ([x, 0.0, 0.01], 100),
        ([x, y, 0.01], 100),
        ([x, y, 0.01], 100),
        ([x, y, bottom], 300),
        ([x, y, bottom], 100),
        ([x, y, 0.01], 300),
        ([x, y, 0.01], 100),
        ([x, 0.0, 0.01], 100),
        ([x, 0.0, 0.01], 100),
        ([0.0, 0.0, 0.01], 100),
        ([0.0, 0.0, 0.02], 300),
    ];
    let (t_x, t_y, t_z) = (0.1 * PLAY[0] / x, 0.1 * PLAY[1] / y, 0.3 * 4e-3 / (4e-3 + PRESS));
    for law in LAWS {
        let ticks = run(&world(), law, DQuat::IDENTITY, [0.0, 0.0, 0.02], legs);
        check(
            &world(),
            &format!("{law:?}"),
            &ticks,
            &[
                ("free", 0, 0.0),
                ("face-face", 1, 0.5 + t_x),
                ("face-face", 2, 0.7 + t_y),
                ("face-face", 3, 0.9 + t_z),
                ("face-face", 2, 1.6 - t_z),
                ("face-face", 1, 1.8 - t_y),
                ("free", 0, 2.0 - t_x),
            ],
        );
    }
}

#[test]
fn a_peg_searches_over_the_plate_drops_into_the_hole_and_meets_the_bottom() {
    let z = 15e-3 - 1e-4;
    let legs: &[Leg] = &[
        ([-0.03, 0.0, z], 100),
        ([-0.03, 0.0, z], 100),
        ([0.0, 0.0, z], 600),
        ([0.0, 0.0, z], 100),
        ([0.0, 0.0, 0.01], 300),
        ([0.0, 0.0, 5.9e-3], 410),
        ([0.0, 0.0, 5.9e-3], 100),
    ];
    for law in LAWS {
        let ticks = run(&world(), law, DQuat::IDENTITY, [-0.03, 0.0, 17e-3], legs);
        // Over the hole: the peg's trailing edge passes the hole's left wall at x = -PLAY.
        let falls = 0.2 + 0.6 * (0.03 - PLAY[0]) / 0.03;
        let expected = [("free", 0, 0.0), ("face-face", 1, 0.0953), ("free", 0, falls), ("face-face", 1, 1.6)];
        check(&world(), &format!("{law:?}"), &ticks, &expected);
    }
}
