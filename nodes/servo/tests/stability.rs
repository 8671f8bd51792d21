//! Some cells of docs/stability.md: what the passivity controller is good for, and what the check at start is worth.

#[path = "stability/cell.rs"]
#[allow(dead_code, reason = "the bench uses all of it")]
mod cell;
#[path = "stability/hand.rs"]
mod hand;
#[path = "stability/press.rs"]
mod press;
#[path = "stability/rig.rs"]
#[allow(dead_code, reason = "the bench uses all of it")]
mod rig;
#[path = "stability/search.rs"]
mod search;

use cell::{Cell, NO_ENERGY};
use haptics::LawKind;
use press::{Task, press};
use rig::{GRIPS, cube_over_floor};
use servo::MotionKind;

fn cell(motion: MotionKind, grip: usize, period: f64) -> Cell {
    Cell { law: LawKind::Proxy, grip: GRIPS[grip], period, motion }
}

#[test]
fn passivity_control_doubles_the_stable_stiffness_and_the_check_knows_both_limits() {
    let world = cube_over_floor();
    for c in [cell(MotionKind::Translation, 0, 1e-3), cell(MotionKind::Translation, 1, 2e-3)] {
        let [without, with] = [false, true].map(|passivity| {
            let (largest, predicted) = (c.largest(&world, passivity).0, c.predicted(passivity));
            assert!((predicted / largest - 1.0).abs() < 0.2, "{c:?}, {passivity}: {predicted} said, {largest} found");
            largest
        });
        assert!(with >= 2.0 * without, "{c:?}: {without} without, {with} with control");
    }
}

#[test]
fn rocking_ends_where_the_check_says_and_twice_as_far_with_control() {
    let world = cube_over_floor();
    let c = cell(MotionKind::Rotation, 0, 2e-3);
    let limit = c.predicted(false);
    let rests =
        |stiffness, passivity| press(&world, &c.rig(), &c.gains(stiffness, passivity), c.freedom(), Task::Press).stable;
    assert!(rests(0.8 * limit, false));
    assert!(!rests(1.2 * limit, false));
    assert!(rests(2.0 * limit, true));
}

#[test]
fn as_stiff_as_the_check_allows_the_hand_is_given_no_energy() {
    let world = cube_over_floor();
    for (grip, period) in [(0, 0.25e-3), (0, 0.5e-3), (0, 2e-3), (1, 0.25e-3), (1, 1e-3), (1, 2e-3)] {
        let c = cell(MotionKind::Translation, grip, period);
        let allowed = c.predicted_passive();
        assert!(allowed > 2.0 * c.predicted(false), "{c:?}: {allowed} N/m");
        for task in [Task::Press, Task::Tap] {
            let given = |stiffness, passivity| {
                press(&world, &c.rig(), &c.gains(stiffness, passivity), c.freedom(), task).energy
            };
            assert!(given(allowed, false) > 1e-3, "{c:?}, {task:?}: passive without control");
            for share in [0.6, 0.75, 0.9, 1.0] {
                let energy = given(share * allowed, true);
                assert!(energy <= NO_ENERGY, "{c:?}, {task:?}, {share} of {allowed} N/m: {energy} J");
            }
        }
    }
}

#[test]
fn a_hand_that_rocks_and_rests_on_an_encoder_step_feels_no_hum() {
    let world = cube_over_floor();
    for grip in [0, 1] {
        let c = cell(MotionKind::Rotation, grip, 1e-3);
        let out = press(&world, &c.rig(), &c.gains(1.0, true), c.freedom(), Task::Press);
        // Up to ten steps of 5e-5 N.m: what one encoder step is worth, and its damping.
        assert!(out.stable && out.torque < 5e-4 && out.energy <= NO_ENERGY, "{c:?}: {out:?}");
    }
}
