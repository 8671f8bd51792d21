//! Contact states of scripted motions whose sequence is known by construction: every state found, boundaries within
//! 3 ms, nothing else.

#[path = "support/scripted.rs"]
mod scripted;

use bag::{FeatureBook, Segment, SegmentOptions, Segmenter, StateGraph, segments};
use cspace::{FixedPart, World};
use haptics::{Gains, LawKind};
use scripted::{LAWS, Leg, check, cuboid, run};
use servo::TickRecord;
use spatial::{DQuat, DVec3, Stamp};
use std::sync::Arc;

/// A 40 mm cube over a floor at z = 0 of two slabs that meet at x = 0, one obstacle, 200 mm wide in y, from x = -0.1 to
/// 0.1; a wall, another obstacle, stands at x = 0.1.
fn world() -> World {
    let fixed = |obstacle, low, high| FixedPart { polyhedron: Arc::new(cuboid(low, high)), obstacle };
    World {
        moving: vec![Arc::new(cuboid([-0.02; 3], [0.02; 3]))],
        fixed: vec![
            fixed(0, [-0.1, -0.1, -0.02], [0.0, 0.1, 0.0]),
            fixed(0, [0.0, -0.1, -0.02], [0.1, 0.1, 0.0]),
            fixed(1, [0.1, -0.1, -0.02], [0.12, 0.1, 0.08]),
        ],
    }
}

/// Tilted about y by 10 degrees, the lower edge of the cube is this far below and beside its centre.
fn tilted() -> (DQuat, DVec3) {
    let rotation = DQuat::from_rotation_y(10f64.to_radians());
    (rotation, rotation * DVec3::new(0.02, 0.0, -0.02))
}

#[test]
fn a_face_slides_along_the_floor_into_the_corner_and_up_the_wall() {
    for law in LAWS {
        // Down 5 mm in 0.1 s from 4.9 mm above the floor, along it to the wall, up, away.
        let legs: &[Leg] = &[
            ([-0.05, 0.0, 0.0199], 100),
            ([-0.05, 0.0, 0.0199], 100),
            ([0.0801, 0.0, 0.0199], 1301),
            ([0.0801, 0.0, 0.0199], 100),
            ([0.0801, 0.0, 0.0249], 50),
            ([0.0801, 0.0, 0.0249], 100),
            ([0.0701, 0.0, 0.0249], 100),
            ([0.0701, 0.0, 0.0249], 100),
        ];
        let ticks = run(&world(), law, DQuat::IDENTITY, [-0.05, 0.0, 0.0249], legs);
        let found = check(
            &world(),
            &format!("{law:?}"),
            &ticks,
            &[
                ("free", 0, 0.0),
                ("face-face", 1, 0.098),
                ("face-face", 2, 1.5),
                ("face-face", 1, 1.602),
                ("free", 0, 1.752),
            ],
        );
        // The seam between the slabs is no event, and the features keep their names.
        let labels: Vec<String> = found.iter().map(Segment::label).collect();
        assert!(found[2].contacts.contains(&found[1].contacts[0]), "{law:?}: {labels:?}");
        assert!(found[2].contacts.contains(&found[3].contacts[0]), "{law:?}: {labels:?}");
        assert!(found[1].statistics.max_depth > 0.9e-4 && found[1].statistics.mean_force() > 0.0);
    }
}

#[test]
fn an_edge_lands_on_the_floor_and_slides_along_it() {
    let (rotation, corner) = tilted();
    for law in LAWS {
        // The edge along y lands at x = -0.05, slides 40 mm towards the rim and back, 0.1 mm deep.
        let at = |x: f64, z: f64| [x - corner.x, 0.0, z - corner.z];
        let legs: &[Leg] = &[
            (at(-0.05, -1e-4), 102),
            (at(-0.05, -1e-4), 98),
            (at(-0.09, -1e-4), 400),
            (at(-0.05, -1e-4), 400),
            (at(-0.05, 5e-3), 102),
            (at(-0.05, 5e-3), 98),
        ];
        let ticks = run(&world(), law, rotation, at(-0.05, 5e-3), legs);
        let found = check(
            &world(),
            &format!("{law:?}"),
            &ticks,
            &[("free", 0, 0.0), ("edge-face", 1, 0.1), ("free", 0, 1.002)],
        );
        assert!(found[1].label().starts_with("A0.edge"), "{}", found[1].label());
    }
}

#[test]
fn a_face_slides_over_the_rim_until_it_is_free() {
    // In the proxy the cube tips over the rim as soon as its middle has passed it, as far as the coupling gives; the hand
    // holds it flush until its trailing edge has left.
    for law in LAWS {
        // 50 mm/s; the trailing edge of the cube passes the rim when the centre is at x = -0.12.
        let legs: &[Leg] = &[([-0.07, 0.0, 0.0199], 102), ([-0.07, 0.0, 0.0199], 98), ([-0.13, 0.0, 0.0199], 1200)];
        let ticks = run(&world(), law, DQuat::IDENTITY, [-0.07, 0.0, 0.025], legs);
        let found =
            check(&world(), &format!("{law:?}"), &ticks, &[("free", 0, 0.0), ("face-face", 1, 0.1), ("free", 0, 1.2)]);
        assert_eq!(found[1].label(), "A0.face0-B0.face1", "the faces keep their names: {law:?}");
    }
}

#[test]
fn an_edge_slides_over_the_side_until_it_is_free() {
    for law in LAWS {
        let (rotation, foot) = tilted();
        let at = |y: f64, z: f64| [-0.05 - foot.x, y, z - foot.z];
        // 100 mm/s along the edge; its last end passes the side of the floor when the middle is at y = 0.12.
        let legs: &[Leg] = &[(at(0.07, -1e-4), 102), (at(0.07, -1e-4), 98), (at(0.13, -1e-4), 600)];
        let ticks = run(&world(), law, rotation, at(0.07, 5e-3), legs);
        check(&world(), &format!("{law:?}"), &ticks, &[("free", 0, 0.0), ("edge-face", 1, 0.1), ("free", 0, 0.7)]);
    }
}

#[test]
fn a_vertex_lands_on_the_floor() {
    let rotation = DQuat::from_rotation_x(0.3) * DQuat::from_rotation_y(0.4);
    let low = (0..8)
        .map(|i| {
            let side = |axis: usize| if i >> axis & 1 == 0 { -0.02 } else { 0.02 };
            rotation * DVec3::new(side(0), side(1), side(2))
        })
        .min_by(|a, b| a.z.total_cmp(&b.z))
        .unwrap();
    for law in LAWS {
        let at = |z: f64| [-0.05 - low.x, -low.y, z - low.z];
        let legs: &[Leg] = &[(at(-1e-4), 102), (at(-1e-4), 98), (at(5e-3), 102), (at(5e-3), 98)];
        let ticks = run(&world(), law, rotation, at(5e-3), legs);
        check(&world(), &format!("{law:?}"), &ticks, &[("free", 0, 0.0), ("vertex-face", 1, 0.1), ("free", 0, 0.202)]);
    }
}

#[test]
fn work_against_the_floor_is_that_of_a_spring() {
    // Pressed 1 mm into the floor and held: the hand has done k d^2 / 2.
    let legs: &[Leg] = &[([-0.05, 0.0, 0.019], 1000), ([-0.05, 0.0, 0.019], 100)];
    let ticks = run(&world(), LawKind::Paper, DQuat::IDENTITY, [-0.05, 0.0, 0.021], legs);
    let found = segments(&ticks, SegmentOptions::default(), Some(FeatureBook::new(&world())));
    let spring = 0.5 * Gains::default().stiffness * 1e-6;
    let work = found.last().unwrap().statistics.work;
    assert!((work - spring).abs() < 0.01 * spring, "{work} J, a spring takes {spring} J");
}

#[test]
fn flicker_is_part_of_the_state_that_it_interrupts() {
    let touch = run(&world(), LawKind::Paper, DQuat::IDENTITY, [-0.05, 0.0, 0.0199], &[([-0.05, 0.0, 0.0199], 1)])[0];
    let free = run(&world(), LawKind::Paper, DQuat::IDENTITY, [-0.05, 0.0, 0.05], &[([-0.05, 0.0, 0.05], 1)])[0];
    let stamped = |pattern: &[(TickRecord, u64)]| -> Vec<TickRecord> {
        let ticks = pattern.iter().flat_map(|(t, n)| std::iter::repeat_n(*t, *n as usize));
        let numbered = ticks.zip(0..).map(|(mut t, i)| {
            (t.input.sequence, t.input.stamp) = (i, Stamp(i as i64 * 1_000_000));
            t
        });
        numbered.collect()
    };
    // 19 ms are less than the debounce of 20 ms, 20 ms are not.
    let ticks = stamped(&[(free, 50), (touch, 19), (free, 50), (touch, 1), (free, 2), (touch, 20), (free, 60)]);
    let found = segments(&ticks, SegmentOptions::default(), None);
    let spans: Vec<_> = found.iter().map(|s| (s.kind.name(), s.begin.0 / 1_000_000, s.end.0 / 1_000_000)).collect();
    assert_eq!(spans, [("free", 0, 122), ("face-face", 122, 142), ("free", 142, 201)]);
    assert_eq!(found.iter().map(|s| s.statistics.ticks).collect::<Vec<_>>(), [122, 20, 60]);

    // Online: the change is told as soon as it is certain, with the true begin.
    let mut segmenter = Segmenter::new(SegmentOptions::default(), None);
    let told: Vec<_> =
        ticks.iter().filter_map(|t| segmenter.push(t).map(|c| (t.input.sequence, c.began.begin.0))).collect();
    assert_eq!(told, [(19, 0), (141, 122_000_000), (161, 142_000_000)]);
    assert_eq!(segmenter.current().map(|s| s.index), Some(2));
}

#[test]
fn a_contact_that_chatters_is_one_state_from_its_first_touch_on() {
    let at = |z: f64| run(&world(), LawKind::Paper, DQuat::IDENTITY, [-0.05, 0.0, z], &[([-0.05, 0.0, z], 1)])[0];
    let (touch, free) = (at(0.0199), at(0.05));
    let corner =
        run(&world(), LawKind::Paper, DQuat::IDENTITY, [0.0801, 0.0, 0.0199], &[([0.0801, 0.0, 0.0199], 1)])[0];
    // Two ticks of three on the floor alone, one in the corner as well, after a long time without contact; then for good.
    let chatter = (0..90).map(|i| if i % 3 == 2 { corner } else { touch });
    let pattern = std::iter::repeat_n(free, 50).chain(chatter).chain(std::iter::repeat_n(corner, 40));
    let ticks: Vec<TickRecord> = pattern
        .zip(0..)
        .map(|(mut t, i)| {
            (t.input.sequence, t.input.stamp) = (i, Stamp(i as i64 * 1_000_000));
            t
        })
        .collect();
    let found = segments(&ticks, SegmentOptions::default(), Some(FeatureBook::new(&world())));
    let spans: Vec<_> = found
        .iter()
        .map(|s| (s.contacts.len(), s.begin.0 / 1_000_000, s.end.0 / 1_000_000, s.statistics.ticks))
        .collect();
    assert_eq!(spans, [(0, 0, 50, 50), (1, 50, 139, 89), (2, 139, 179, 41)]);
    // Touch and go, faster than the debounce, is no contact.
    let bouncing = (0..120).map(|i| if i % 12 == 0 { touch } else { free }).zip(0..).map(|(mut t, i)| {
        (t.input.sequence, t.input.stamp) = (i, Stamp(i as i64 * 1_000_000));
        t
    });
    let found = segments(&bouncing.collect::<Vec<_>>(), SegmentOptions::default(), None);
    assert_eq!(found.iter().map(|s| s.label()).collect::<Vec<_>>(), ["free"]);
}

#[test]
fn the_graph_counts_states_and_transitions_over_runs() {
    let legs: &[Leg] = &[([-0.05, 0.0, 0.0199], 100), ([-0.05, 0.0, 0.0199], 100), ([-0.05, 0.0, 0.03], 100)];
    let ticks = run(&world(), LawKind::Paper, DQuat::IDENTITY, [-0.05, 0.0, 0.03], legs);
    let found = segments(&ticks, SegmentOptions::default(), Some(FeatureBook::new(&world())));
    let mut graph = StateGraph::default();
    graph.add(&found);
    graph.add(&found);
    let touching = found[1].label();
    assert_eq!(graph.states["free"].visits, 4);
    assert_eq!((graph.states["free"].begins, graph.states["free"].ends), (2, 2));
    assert_eq!(graph.transitions[&("free".to_owned(), touching.clone())], 2);
    let json: serde_json::Value = serde_json::from_str(&graph.to_json()).unwrap();
    assert_eq!(json["runs"], 2);
    assert_eq!(json["transitions"].as_array().unwrap().len(), 2);
    assert!(graph.to_dot().contains(&format!("\"free\" -> \"{touching}\" [label=\"2\"];")));
}
