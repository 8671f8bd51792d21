//! CPU time of single ticks, by law: its percentiles, what the host's noise makes of them, and what the work itself asks.
//!
//! Three rows a case. `as run`: ticks as they come. `least of 5`: the same ticks rendered five times over, each by its
//! fastest time: the work, without most of what the host adds. `peer`: a loop of constant work, about as long as the
//! median tick, timed in turn with the ticks: its percentiles are the machine's, not the program's.

mod cases;

use cases::{CASES, Case, LAWS, led_there, trembling};
use haptics::LawKind;
use servo::TickRecord;
use std::hint::black_box;

const TICKS: usize = 40_000;
const PASSES: usize = 5;

fn main() {
    // Names of cases to measure; all if none is given.
    let wanted: Vec<String> = std::env::args().skip(1).filter(|a| !a.starts_with('-')).collect();
    let clock = clock_cost();
    for case in CASES.iter().filter(|c| wanted.is_empty() || wanted.iter().any(|w| w == c.name)) {
        for law in LAWS.into_iter().rev() {
            measure(case, law, clock);
        }
    }
}

fn measure(case: &Case, law: LawKind, clock: u64) {
    let inputs = trembling(case, law, TICKS);
    let mut contacts = Contacts::default();
    let mut all = Vec::with_capacity(PASSES * TICKS);
    let mut least = vec![u64::MAX; TICKS];
    let mut peer = Vec::with_capacity(PASSES * TICKS);
    let mut rounds = 1000;
    for pass in 0..PASSES {
        let mut tick = led_there(case, law);
        for (input, least) in inputs.iter().zip(&mut least) {
            let start = cpu_ns();
            let record = black_box(tick.step(black_box(input)));
            let spent = (cpu_ns() - start).saturating_sub(clock);
            all.push(spent);
            *least = spent.min(*least);
            if pass == 0 {
                contacts.count(&record);
            }
            let start = cpu_ns();
            black_box(constant_work(black_box(rounds)));
            let spent = (cpu_ns() - start).saturating_sub(clock);
            // Made as long as the median tick before the second pass, and counted from then on.
            if pass > 0 {
                peer.push(spent);
            }
        }
        if pass == 0 {
            let wanted = percentile(&mut all.clone(), 0.5);
            let mut tries: Vec<u64> = (0..1000).map(|_| timed(|| constant_work(black_box(1000))) - clock).collect();
            rounds = (1000.0 * wanted / percentile(&mut tries, 0.5)).max(1.0) as u32;
        }
    }
    println!("tick/{}/{law:?}: {}", case.name, contacts.summary());
    print_row("as run", &mut all);
    print_row("least of 5", &mut least);
    print_row("peer", &mut peer);
}

fn print_row(name: &str, times: &mut [u64]) {
    let [p50, p99, p999] = [0.5, 0.99, 0.999].map(|share| percentile(times, share));
    println!("  {name:<10} p50 {p50:6.2}  p99 {p99:6.2}  p99.9 {p999:6.2} us");
}

/// Microseconds.
fn percentile(times: &mut [u64], share: f64) -> f64 {
    let k = ((times.len() - 1) as f64 * share) as usize;
    *times.select_nth_unstable(k).1 as f64 * 1e-3
}

fn cpu_ns() -> u64 {
    let t = rustix::time::clock_gettime(rustix::time::ClockId::ThreadCPUTime);
    t.tv_sec as u64 * 1_000_000_000 + t.tv_nsec as u64
}

fn timed<T>(work: impl FnOnce() -> T) -> u64 {
    let start = cpu_ns();
    black_box(work());
    cpu_ns() - start
}

/// What two readings of the clock in a row take, ns.
fn clock_cost() -> u64 {
    let mut empty: Vec<u64> = (0..10_000).map(|_| timed(|| ())).collect();
    *empty.select_nth_unstable(5_000).1
}

/// A chain of square roots in registers: no memory, no branches to guess.
#[inline(never)]
fn constant_work(rounds: u32) -> f64 {
    (0..rounds).fold(2.0, |x: f64, _| (x + 1.0).sqrt())
}

/// How much was in contact.
#[derive(Default)]
struct Contacts {
    points: usize,
    /// Ticks with contact to so many pieces.
    pieces: [usize; 9],
}

impl Contacts {
    fn count(&mut self, record: &TickRecord) {
        let points = record.formation.points();
        self.points += points.len();
        let set = points.iter().fold(0u64, |set, p| set | 1 << (p.piece_b % 64));
        self.pieces[(set.count_ones() as usize).min(8)] += 1;
    }

    fn summary(&self) -> String {
        let shares: Vec<String> = (0..9)
            .filter(|n| self.pieces[*n] > 0)
            .map(|n| format!("{n} in {:.1} %", 100.0 * self.pieces[n] as f64 / TICKS as f64))
            .collect();
        format!("{:.1} contacts; pieces in contact: {}", self.points as f64 / TICKS as f64, shares.join(", "))
    }
}
