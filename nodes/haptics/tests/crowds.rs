//! Among obstacles that overlap at random the surface contact point stays a sane one. Depth by parry, an independent oracle.

mod support;

use haptics::{Gains, LawKind, RenderLaw, Renderer};
use spatial::DVec3;
use support::random::{crowd, wandering};
use support::{cuboid, mm, penetration, pose, world};

#[test]
fn scp_touches_near_the_hand() {
    for law in [LawKind::Paper, LawKind::Proxy] {
        let gains = Gains { law, proxy_speed: f64::INFINITY, ..Gains::default() };
        let (mut ticks, mut far, mut inside, mut loose) = (0, 0, 0, 0);
        for seed in 0..40 {
            let w = crowd(seed);
            let mut r = Renderer::new(w.clone());
            let motion = wandering(seed, 25.0, 1.0);
            for i in 0..4000 {
                let hand = motion(f64::from(i));
                let out = r.render(&hand, &gains, 1e-3);
                if out.depth <= 0.0 || i % 7 != 0 {
                    continue;
                }
                let way = out.proxy.translation - hand.translation;
                let depth = penetration(&w, &out.proxy);
                ticks += 1;
                inside += u32::from(depth > 1e-7);
                loose += u32::from(depth < -1e-3);
                if law == LawKind::Paper {
                    assert!((out.wrench.force - way * gains.stiffness).length() < 1e-9 * (1.0 + way.length()));
                    assert!(way.length() < 0.04, "seed {seed} tick {i}: {way}");
                    far += u32::from(way.length() > 3.0 * out.depth);
                }
            }
        }
        println!("{law:?}: {ticks} ticks in contact, {far} farther than 3 depths, {inside} inside, {loose} off");
        assert!(ticks > 10_000);
        // Up to a centimetre deep in several obstacles at once, some orientations leave no way out along their planes.
        let wedged = if law == LawKind::Paper { ticks / 150 } else { 0 };
        assert!(inside <= wedged && loose <= ticks / 1000 && far <= ticks / 100, "{law:?}");
    }
}

#[test]
fn planes_that_meet_far_beyond_their_faces_do_not_throw_the_scp_away() {
    // Between two walls that lean by half a degree, a block 0.2 mm too wide: the planes meet 11 mm up, the walls end at 4 mm.
    let lean = |side: f64| {
        let wall = cuboid(mm(0.0, -30.0, -40.0), mm(20.0, 30.0, 4.0));
        let at =
            if side > 0.0 { pose(5.0, 0.0, 0.0, 0.0, 0.0087, 0.0) } else { pose(-5.0, 0.0, 0.0, 0.0, -0.0087, 0.0) };
        let flipped = if side > 0.0 { wall } else { cuboid(mm(-20.0, -30.0, -40.0), mm(0.0, 30.0, 4.0)) };
        support::random::placed(&flipped, &at)
    };
    let block = cuboid(mm(-5.1, -5.0, -1.0), mm(5.1, 5.0, 1.0));
    let w = world(block, vec![lean(1.0), lean(-1.0)]);
    for law in [LawKind::Paper, LawKind::Pstar, LawKind::Blended] {
        let mut r = Renderer::new(w.clone());
        let gains = Gains { law, ..Gains::default() };
        for i in 0..=600 {
            let hand = pose(0.0, 0.0, 6.0 - 0.01 * f64::from(i), 0.0, 0.0, 0.0);
            let out = r.render(&hand, &gains, 1e-3);
            let way = out.proxy.translation - hand.translation;
            assert!(way.length() < 7e-3 && penetration(&w, &out.proxy) < 1e-7, "{law:?} tick {i}: {way}");
            if out.depth > 1e-6 {
                assert!(penetration(&w, &out.proxy) > -1e-7, "{law:?} tick {i}: {way}");
                assert!(way.dot(DVec3::Z) >= -1e-12, "{law:?} tick {i}: {way}");
            }
        }
    }
}
