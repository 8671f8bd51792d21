use super::*;
use crate::Bounds;

/// A peg 16 x 10 x 30 mm, A's origin in its middle, over a hole of 16.25 x 10.21 mm in a plate 9 mm thick with a floor.
const PEG: DVec3 = DVec3::new(0.008, 0.005, 0.015);
const HOLE: DVec3 = DVec3::new(0.008_125, 0.005_105, 0.0);
const DEPTH: f64 = 0.009;
const STIFFNESS: f64 = 1000.0;

/// A stand-in for the real laws: each of the peg's lower corners, and points along its lower half, pushed out of the plate
/// the shortest way.
fn wrench_of_plate(pose: &Pose) -> Wrench {
    let mut sum = Wrench::ZERO;
    for corner in 0..4 {
        for height in [-1.0, -0.8, -0.6, -0.4] {
            let sign = |bit: usize| if corner >> bit & 1 == 1 { 1.0 } else { -1.0 };
            let p_a = PEG * DVec3::new(sign(0), sign(1), height);
            let p = pose.transform_point(p_a);
            let push = push_out(p);
            let force = push * (STIFFNESS / 4.0);
            sum = sum + Wrench::new(force, (p - pose.translation).cross(force));
        }
    }
    sum
}

fn push_out(p: DVec3) -> DVec3 {
    if p.z >= 0.0 {
        return DVec3::ZERO;
    }
    let beside = DVec3::new(p.x.abs() - HOLE.x, p.y.abs() - HOLE.y, 0.0).max(DVec3::ZERO);
    let back = DVec3::new(-p.x.signum() * beside.x, -p.y.signum() * beside.y, 0.0);
    if back.length() < -p.z { back + DVec3::Z * (-DEPTH - p.z).max(0.0) } else { DVec3::Z * -p.z }
}

fn plan() -> OperatorPlan {
    let seated = Pose::new(DVec3::Z * (PEG.z - DEPTH), Pose::IDENTITY.rotation);
    OperatorPlan::insertion(seated, DVec3::NEG_Z * PEG.z, DVec3::Z, DEPTH, DVec3::new(0.012, 0.004, 0.0))
}

/// Poses of ten seconds at `period_ns`, with the wrench felt.
fn run(config: OperatorConfig, period_ns: i64) -> Vec<Sample> {
    let mut operator = SimulatedOperator::new(config, plan()).unwrap();
    (0..10_000_000_000 / period_ns)
        .map(|n| {
            let sample = operator.read(Stamp(1_700_000_000_000_000_000 + n * period_ns));
            operator.write(&wrench_of_plate(&sample.pose));
            sample
        })
        .collect()
}

fn tip_height(sample: &Sample) -> f64 {
    sample.pose.transform_point(DVec3::NEG_Z * PEG.z).z
}

#[test]
fn inserts_the_peg_whatever_the_seed() {
    for seed in 0..40 {
        let samples = run(OperatorConfig { seed, ..Default::default() }, 1_000_000);
        let lowest = samples.iter().map(tip_height).fold(f64::INFINITY, f64::min);
        assert!(lowest < -DEPTH + 1e-4, "seed {seed}: the tip reached {lowest}");
        assert!(lowest > -DEPTH - 0.004, "seed {seed}: through the floor, {lowest}");
        let highest = samples[6000..].iter().map(tip_height).fold(0.0, f64::max);
        assert!(highest > 0.01, "seed {seed}: not withdrawn, {highest}");
    }
}

#[test]
fn feels_the_plate_before_it_finds_the_hole() {
    let samples = run(OperatorConfig::default(), 1_000_000);
    let pressed = samples.iter().filter(|s| tip_height(s) < 0.002 && s.pose.translation.x > 0.008).count();
    assert!(pressed > 300, "{pressed} ms on the plate");
}

#[test]
fn the_same_seed_moves_bit_for_bit_alike_and_another_does_not() {
    let one = run(OperatorConfig::default(), 1_000_000);
    assert_eq!(one, run(OperatorConfig::default(), 1_000_000));
    let other = run(OperatorConfig { seed: 2, ..Default::default() }, 1_000_000);
    assert_ne!(one[500].pose, other[500].pose);
}

#[test]
fn inserts_at_every_rate_of_the_loop() {
    for period_ns in [4_000_000, 250_000, 100_000] {
        let lowest = run(OperatorConfig::default(), period_ns).iter().map(tip_height).fold(f64::INFINITY, f64::min);
        assert!(lowest < -DEPTH + 1e-4, "period {period_ns} ns: the tip reached {lowest}");
    }
}

#[test]
fn a_clock_step_moves_nothing_far() {
    let mut operator = SimulatedOperator::new(OperatorConfig::default(), plan()).unwrap();
    let mut now = 0;
    for _ in 0..500 {
        now += 1_000_000;
        operator.read(Stamp(now));
    }
    for step in [3_600_000_000_000, -7_200_000_000_000, i64::MAX / 2, i64::MIN / 2] {
        let before = operator.pose();
        operator.read(Stamp(now + step));
        assert!((operator.pose().translation - before.translation).length() < 0.02);
    }
}

#[test]
fn a_wrench_that_is_no_number_is_not_felt() {
    let mut operator = SimulatedOperator::new(OperatorConfig::default(), plan()).unwrap();
    operator.write(&Wrench::new(DVec3::splat(f64::NAN), DVec3::ZERO));
    operator.read(Stamp(0));
    assert!(operator.read(Stamp(10_000_000)).pose.is_valid());
}

#[test]
fn a_bad_plan_is_refused_by_waypoint() {
    let mut bad = plan();
    bad.waypoints[2].duration = f64::NAN;
    let error = SimulatedOperator::new(OperatorConfig::default(), bad).unwrap_err();
    assert!(error.to_string().contains("waypoint 2"), "{error}");
    let empty = OperatorPlan { waypoints: vec![], ..plan() };
    assert!(SimulatedOperator::new(OperatorConfig::default(), empty).is_err());
}

#[test]
fn a_survey_goes_below_the_top_of_any_obstacle_and_comes_up_again() {
    let moving = Bounds { min: DVec3::splat(-0.02), max: DVec3::splat(0.03) };
    let fixed = Bounds { min: DVec3::new(-0.1, -0.1, -0.05), max: DVec3::new(0.1, 0.1, 0.01) };
    let plan = OperatorPlan::survey(moving, fixed);
    let period = plan.duration();
    let mut operator = SimulatedOperator::new(OperatorConfig::default(), plan).unwrap();
    let heights: Vec<f64> = (0..(period * 1e3) as i64)
        .map(|n| operator.read(Stamp(n * 1_000_000)).pose.translation.z + moving.min.z - fixed.max.z)
        .collect();
    assert!(heights.iter().any(|h| *h < -0.003) && heights.iter().any(|h| *h > 0.02));
}
