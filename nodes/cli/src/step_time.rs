use std::fmt;
use std::hint::black_box;
use std::time::Instant;

/// The time of one step of a pure computation over a series of inputs, ns, on this thread, without I/O.
#[derive(Clone, Copy, Debug)]
pub struct StepTime {
    mean: f64,
    p50: f64,
    p99: f64,
    max: f64,
    n: usize,
}

/// Passes of which the best gives the mean.
const PASSES: usize = 5;

impl StepTime {
    /// Runs `step` over all inputs, from a copy of `fresh` each time. The mean is the best of five passes, each timed
    /// as a whole; the percentiles come from steps timed one by one, less the clock's own cost.
    pub fn measure<S: Clone, I, O>(fresh: &S, inputs: &[I], step: impl Fn(&mut S, &I) -> O) -> Self {
        Self::measure_from(|| fresh.clone(), inputs, step)
    }

    /// The same for a state that is made anew for each pass by `fresh`, which is not timed.
    pub fn measure_from<S, I, O>(fresh: impl Fn() -> S, inputs: &[I], step: impl Fn(&mut S, &I) -> O) -> Self {
        let n = inputs.len();
        let mut mean = f64::INFINITY;
        for _ in 0..PASSES {
            let mut state = fresh();
            let start = Instant::now();
            for input in inputs {
                black_box(step(&mut state, black_box(input)));
            }
            mean = mean.min(start.elapsed().as_nanos() as f64 / n.max(1) as f64);
        }
        let clock = clock_cost();
        let mut state = fresh();
        let mut single: Vec<f64> = Vec::with_capacity(n);
        for input in inputs {
            let start = Instant::now();
            black_box(step(&mut state, black_box(input)));
            single.push((start.elapsed().as_nanos() as f64 - clock).max(0.0));
        }
        single.sort_unstable_by(f64::total_cmp);
        let at = |q: f64| single.get(((n as f64 * q).ceil() as usize).saturating_sub(1)).copied().unwrap_or(0.0);
        Self { mean, p50: at(0.5), p99: at(0.99), max: at(1.0), n }
    }
}

/// Median time between two readings of the clock with nothing in between, ns.
fn clock_cost() -> f64 {
    let mut cost: Vec<u128> = (0..10_001)
        .map(|_| {
            let start = Instant::now();
            start.elapsed().as_nanos()
        })
        .collect();
    cost.sort_unstable();
    cost[cost.len() / 2] as f64
}

impl fmt::Display for StepTime {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { mean, p50, p99, max, n } = self;
        write!(f, "step_ns mean={mean:.1} p50={p50:.1} p99={p99:.1} max={max:.1} n={n}")
    }
}
