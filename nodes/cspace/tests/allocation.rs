//! A step allocates nothing, on any path: shallow, deep, jumping, released, reseeded; nor does a body of many pairs.

mod support;

use cspace::{BodyTracker, FixedPart, Tracker, World};
use spatial::{DVec3, Pose};
use std::alloc::{GlobalAlloc, Layout, System};
use std::cell::Cell;
use std::sync::Arc;
use support::motions::{MOTIONS, motion};
use support::*;

struct Counting;

thread_local! {
    static COUNT: Cell<u64> = const { Cell::new(0) };
}

// SAFETY: every call goes to the system allocator unchanged; the counter is a const-initialised thread-local `Cell`,
// which neither allocates nor is shared.
#[allow(unsafe_code)]
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        let _ = COUNT.try_with(|c| c.set(c.get() + 1));
        // SAFETY: the caller's promise about `layout` is handed on.
        unsafe { System.alloc(layout) }
    }

    unsafe fn dealloc(&self, pointer: *mut u8, layout: Layout) {
        // SAFETY: `pointer` came from `System.alloc` with this layout.
        unsafe { System.dealloc(pointer, layout) }
    }
}

#[global_allocator]
static ALLOCATOR: Counting = Counting;

fn allocations(mut work: impl FnMut()) -> u64 {
    let before = COUNT.with(Cell::get);
    work();
    COUNT.with(Cell::get) - before
}

#[test]
fn a_step_allocates_nothing() {
    assert!(allocations(|| drop(std::hint::black_box(vec![1u8; 100]))) > 0, "the counter counts");
    let shapes = [
        (cuboid(DVec3::new(0.05, 0.1, 0.15)), cuboid(DVec3::splat(0.1))),
        (cuboid(DVec3::splat(0.1)), cuboid(DVec3::new(0.4, 0.4, 0.004))),
        (hull(200, DVec3::splat(0.05), 3), prism(12, 0.05, 0.1)),
    ];
    for (a, b) in shapes {
        let (pa, pb) = (polyhedron(&a), polyhedron(&b));
        let (reach, thin) = (pa.size() + pb.size(), pa.inner_radius() + pb.inner_radius());
        let free = |p: &Pose| Tracker::new(pa.clone(), pb.clone()).seed(p).is_free();
        for (k, m) in MOTIONS.iter().enumerate() {
            let poses = motion(m, 200, reach, thin, &mut random(k as u64), &free);
            let mut tracker = Tracker::new(pa.clone(), pb.clone());
            let count = allocations(|| {
                for pose in &poses {
                    std::hint::black_box(tracker.step(pose));
                }
            });
            assert_eq!(count, 0, "{m}");
        }
    }
}

#[test]
fn a_body_among_many_pieces_allocates_nothing() {
    let piece = polyhedron(&cuboid(DVec3::splat(0.04)));
    let fixed = (0..400u32)
        .map(|i| {
            let at = DVec3::new(f64::from(i % 20), f64::from(i / 20), 0.0) * 0.05;
            FixedPart {
                polyhedron: Arc::new(piece.transformed(&Pose::new(at, glam::DQuat::IDENTITY), 1.0)),
                obstacle: i,
            }
        })
        .collect();
    let world = World { moving: vec![polyhedron(&prism(6, 0.06, 0.05)), polyhedron(&tetrahedron(0.03))], fixed };
    let mut tracker = BodyTracker::new(Arc::new(world), 0.01);
    let mut rng = random(9);
    let poses: Vec<Pose> = (0..2000)
        .map(|i| {
            let s = f64::from(i) * 0.002;
            let at = DVec3::new(0.5 + 0.6 * s.cos(), 0.5 + 0.6 * (1.7 * s).sin(), 0.04 + 0.03 * (5.0 * s).sin());
            Pose::new(at, if i % 500 == 0 { rotation(&mut rng) } else { glam::DQuat::from_rotation_z(s) })
        })
        .collect();
    let mut pairs = 0;
    let count = allocations(|| {
        for pose in &poses {
            pairs += tracker.step(pose).len();
        }
    });
    assert_eq!(count, 0);
    assert!(pairs > 1000, "{pairs} pairs");
}
