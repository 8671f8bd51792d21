//! Ticks alone, for an instruction counter: `cargo run --release -p servo --example tick_cost -- [case] [law] [ticks]`, under
//! `valgrind --tool=callgrind --toggle-collect='*all_ticks*'`.

#[path = "../benches/tick/cases.rs"]
mod cases;

use cases::{CASES, LAWS, led_there, trembling};
use servo::{Tick, TickInput};
use std::hint::black_box;

/// What is to be counted.
#[inline(never)]
fn all_ticks(tick: &mut Tick, inputs: &[TickInput]) {
    for input in inputs {
        black_box(tick.step(black_box(input)));
    }
}

fn main() {
    let mut args = std::env::args().skip(1);
    let case = args.next().unwrap_or_else(|| "jammed".into());
    let law = args.next().unwrap_or_else(|| "proxy".into());
    let ticks = args.next().and_then(|a| a.parse().ok()).unwrap_or(2000);
    for c in CASES.iter().filter(|c| c.name == case) {
        for l in LAWS.into_iter().filter(|l| format!("{l:?}").eq_ignore_ascii_case(&law)) {
            let inputs = trembling(c, l, ticks);
            all_ticks(&mut led_there(c, l), &inputs);
        }
    }
}
