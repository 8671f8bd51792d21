//! Rendering allocates nothing once built, whatever the law and the motion.
#![allow(unsafe_code, reason = "a counting allocator must implement an unsafe trait")]

mod support;

use cspace::Polyhedron;
use haptics::{Gains, LawKind, RenderLaw, Renderer};
use std::alloc::{GlobalAlloc, Layout, System};
use std::cell::Cell;
use support::{block, cuboid, mm, peg_in_hole, pose, world};

thread_local! {
    static ALLOCATIONS: Cell<u64> = const { Cell::new(0) };
}

struct Counting;

// SAFETY: every call is handed on to the system allocator unchanged; the counter is a thread-local without destructor.
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        let _ = ALLOCATIONS.try_with(|c| c.set(c.get() + 1));
        // SAFETY: the caller's own contract.
        unsafe { System.alloc(layout) }
    }

    unsafe fn dealloc(&self, pointer: *mut u8, layout: Layout) {
        // SAFETY: the caller's own contract.
        unsafe { System.dealloc(pointer, layout) }
    }

    unsafe fn realloc(&self, pointer: *mut u8, layout: Layout, size: usize) -> *mut u8 {
        let _ = ALLOCATIONS.try_with(|c| c.set(c.get() + 1));
        // SAFETY: the caller's own contract.
        unsafe { System.realloc(pointer, layout, size) }
    }
}

#[global_allocator]
static ALLOCATOR: Counting = Counting;

#[test]
fn rendering_does_not_allocate() {
    let before = ALLOCATIONS.with(Cell::get);
    let mut r = Renderer::new(peg_in_hole());
    assert!(ALLOCATIONS.with(Cell::get) > before, "the counter counts");
    for friction in [0.0, 0.3] {
        for law in [LawKind::Paper, LawKind::Pstar, LawKind::Blended, LawKind::Proxy] {
            let gains = Gains { law, friction_static: friction, friction_kinetic: friction, ..Gains::default() };
            let start = ALLOCATIONS.with(Cell::get);
            for i in 0..2000 {
                let t = f64::from(i) * 1e-3;
                let tilt = 0.2 * (5.0 * t).sin();
                let p =
                    pose(20.0 * (3.0 * t).sin(), 10.0 * (4.0 * t).cos(), 10.0 - 25.0 * (2.0 * t).sin(), tilt, tilt, t);
                r.render(&p, &gains, 1e-3);
            }
            r.reset();
            r.render(&pose(0.0, 0.0, 5.0, 0.1, 0.1, 0.1), &gains, 1e-3);
            assert_eq!(ALLOCATIONS.with(Cell::get), start, "{law:?}, friction {friction}");
        }
    }
}

/// More contacts than there is room for: a plate on a bed of spikes and pins, flat and on its corners.
#[test]
fn rendering_does_not_allocate_where_contacts_abound() {
    let place = |i: i32| mm(f64::from(i % 24) * 3.0, f64::from(i / 24) * 3.0, 0.0);
    let pin = |i: i32| cuboid(place(i) + mm(0.0, 0.0, -10.0), place(i) + mm(1.0, 1.0, 0.0));
    let spike = |i: i32| {
        let corners = [(0.0, 0.0, -10.0), (1.0, 0.0, -10.0), (1.0, 1.0, -10.0), (0.0, 1.0, -10.0), (0.5, 0.5, 0.0)];
        let faces = [vec![3, 2, 1, 0], vec![0, 1, 4], vec![1, 2, 4], vec![2, 3, 4], vec![3, 0, 4]];
        let corners = corners.map(|(x, y, z)| place(i) + mm(x, y, z));
        Polyhedron::from_faces(&corners, &faces).expect("a pyramid is a polyhedron")
    };
    let bed = (0..24 * 24).map(|i| if i % 8 == 0 { pin(i) } else { spike(i) }).collect();
    let mut r = Renderer::new(world(block(mm(80.0, 80.0, 10.0)), bed));
    for law in [LawKind::Paper, LawKind::Pstar, LawKind::Blended, LawKind::Proxy] {
        let gains = Gains { law, ..Gains::default() };
        let start = ALLOCATIONS.with(Cell::get);
        let mut most = 0;
        for i in 0..60 {
            let tilt = if i < 20 { 0.0 } else { 1e-3 * f64::from(i - 20) };
            let out = r.render(&pose(35.0, 36.0, 5.1 - 0.01 * f64::from(i), tilt, 0.7 * tilt, 0.0), &gains, 1e-3);
            most = most.max(out.dropped);
        }
        assert_eq!(ALLOCATIONS.with(Cell::get), start, "{law:?}");
        assert!(most > 0, "{law:?}");
    }
}
