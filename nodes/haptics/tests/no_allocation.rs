//! Rendering allocates nothing once built, whatever the law and the motion.
#![allow(unsafe_code, reason = "a counting allocator must implement an unsafe trait")]

mod support;

use haptics::{Gains, LawKind, RenderLaw, Renderer};
use std::alloc::{GlobalAlloc, Layout, System};
use std::cell::Cell;
use support::{peg_in_hole, pose};

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
