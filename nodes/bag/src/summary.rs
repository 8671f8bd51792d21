use servo::TickRecord;
use spatial::{DVec3, Stamp};
use std::fmt;

/// A stretch of ticks of one formation that lasts no longer than this, ns, is chatter between two others and not shown.
const CHATTER_NS: i64 = 20_000_000;
/// Lines of the time line at most.
const LINES: usize = 60;

/// What a recorded run came to: how many ticks, what was touched when, how deep, how hard, and how punctual it was.
#[derive(Clone, Debug)]
pub struct RunSummary {
    ticks: u64,
    first: Option<Stamp>,
    last: Stamp,
    states: Vec<State>,
    depth: f64,
    force: f64,
    torque: f64,
    device_force: f64,
    lowest: DVec3,
    highest: DVec3,
    part: Vec<DVec3>,
    /// Lowest z that a point of the part came to, metres, W, and the ticks it was there to within [`AT_REST`].
    bottom: (f64, u64),
    wakeup: Bins,
    compute: Bins,
}

/// Heights that differ by no more than this, metres, are one.
const AT_REST: f64 = 1e-4;

/// A stretch of one formation.
#[derive(Clone, Copy, Debug)]
struct State {
    begin: Stamp,
    end: Stamp,
    name: &'static str,
    depth: f64,
    force: f64,
}

impl Default for RunSummary {
    fn default() -> Self {
        Self {
            ticks: 0,
            first: None,
            last: Stamp::default(),
            states: Vec::new(),
            depth: 0.0,
            force: 0.0,
            torque: 0.0,
            device_force: 0.0,
            lowest: DVec3::INFINITY,
            highest: DVec3::NEG_INFINITY,
            part: Vec::new(),
            bottom: (f64::INFINITY, 0),
            wakeup: Bins::default(),
            compute: Bins::default(),
        }
    }
}

impl RunSummary {
    /// A summary that also says how low the part came: its vertices in its own frame, metres.
    #[must_use]
    pub fn of_part(vertices: Vec<DVec3>) -> Self {
        Self { part: vertices, ..Self::default() }
    }

    /// Takes in the next tick.
    pub fn add(&mut self, tick: &TickRecord) {
        let now = tick.input.stamp;
        let force = tick.law_wrench.force.length();
        self.ticks += 1;
        self.first.get_or_insert(now);
        self.last = now;
        self.depth = self.depth.max(tick.depth);
        self.force = self.force.max(force);
        self.torque = self.torque.max(tick.law_wrench.torque.length());
        self.device_force = self.device_force.max(tick.out_wrench.force.length());
        self.lowest = self.lowest.min(tick.proxy.translation);
        self.highest = self.highest.max(tick.proxy.translation);
        self.note_bottom(tick);
        self.wakeup.add(tick.wakeup_ns);
        self.compute.add(tick.compute_ns);
        let name = tick.formation.kind.name();
        match self.states.last_mut() {
            Some(state) if state.name == name => {
                state.end = now;
                state.depth = state.depth.max(tick.depth);
                state.force = state.force.max(force);
            }
            _ => {
                self.settle();
                if self.states.last().is_none_or(|state| state.name != name) {
                    self.states.push(State { begin: now, end: now, name, depth: tick.depth, force });
                }
            }
        }
    }

    fn note_bottom(&mut self, tick: &TickRecord) {
        let Some(z) = self.part.iter().map(|&p| tick.proxy.transform_point(p).z).reduce(f64::min) else { return };
        if z < self.bottom.0 - AT_REST {
            self.bottom = (z, 0);
        }
        self.bottom.0 = self.bottom.0.min(z);
        self.bottom.1 += u64::from(z <= self.bottom.0 + AT_REST);
    }

    /// Drops the newest stretch if it was chatter; its time goes to the one before.
    fn settle(&mut self) {
        if let [.., before, newest] = self.states.as_mut_slice()
            && newest.end.0 - newest.begin.0 < CHATTER_NS
        {
            before.end = newest.end;
            before.depth = before.depth.max(newest.depth);
            before.force = before.force.max(newest.force);
            self.states.pop();
        }
    }

    /// The ticks taken in.
    #[must_use]
    pub fn ticks(&self) -> u64 {
        self.ticks
    }
}

impl fmt::Display for RunSummary {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let begin = self.first.unwrap_or(self.last);
        let since = |at: Stamp| (at.0 - begin.0) as f64 * 1e-9;
        writeln!(f, "time recorded   {:.3} s", since(self.last))?;
        writeln!(f, "largest depth   {:.3} mm", self.depth * 1e3)?;
        writeln!(f, "largest force   {:.3} N by the law, {:.3} N at the device", self.force, self.device_force)?;
        writeln!(f, "largest torque  {:.4} N.m by the law", self.torque)?;
        if self.ticks > 0 {
            let (low, high) = (self.lowest * 1e3, self.highest * 1e3);
            writeln!(
                f,
                "contact pose    x {:.2} .. {:.2}, y {:.2} .. {:.2}, z {:.2} .. {:.2} mm",
                low.x, high.x, low.y, high.y, low.z, high.z
            )?;
        }
        if self.bottom.1 > 0 {
            let (z, ticks) = (self.bottom.0 * 1e3, self.bottom.1);
            writeln!(f, "part's lowest   z {z:.2} mm, within {} mm of it for {ticks} ticks", AT_REST * 1e3)?;
        }
        writeln!(f, "\ncontact formations (shorter than {} ms: left out)", CHATTER_NS / 1_000_000)?;
        writeln!(f, "      from       to  formation     depth mm   force N")?;
        for state in self.states.iter().take(LINES) {
            let (from, to) = (since(state.begin), since(state.end));
            let depth = state.depth * 1e3;
            writeln!(f, "  {from:8.3} {to:8.3}  {:<12} {depth:9.3} {:9.3}", state.name, state.force)?;
        }
        if self.states.len() > LINES {
            writeln!(f, "  and {} more", self.states.len() - LINES)?;
        }
        // Rendered offline, not run: nothing was timed.
        if self.compute.max_ns == 0 && self.wakeup.max_ns == 0 {
            return Ok(());
        }
        writeln!(f, "\ncomputing a tick\n{}\nlate at waking up\n{}", self.compute, self.wakeup)
    }
}

/// Counts times in octaves of microseconds.
#[derive(Clone, Debug, Default)]
struct Bins {
    /// `counts[i]`: below `2^i` us and not below half of that.
    counts: [u64; 24],
    total: u64,
    sum_ns: f64,
    max_ns: u32,
}

impl Bins {
    fn add(&mut self, ns: u32) {
        let octave = (32 - (ns / 1000).leading_zeros()) as usize;
        self.counts[octave.min(self.counts.len() - 1)] += 1;
        self.total += 1;
        self.sum_ns += f64::from(ns);
        self.max_ns = self.max_ns.max(ns);
    }
}

impl fmt::Display for Bins {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let mean = self.sum_ns / self.total.max(1) as f64 / 1e3;
        writeln!(f, "  mean {mean:.1} us, max {:.1} us", f64::from(self.max_ns) / 1e3)?;
        let Some(last) = self.counts.iter().rposition(|&count| count > 0) else { return Ok(()) };
        let first = self.counts.iter().position(|&count| count > 0).unwrap_or(last);
        let most = self.counts.iter().copied().max().unwrap_or(1).max(1);
        for (octave, &count) in self.counts.iter().enumerate().take(last + 1).skip(first) {
            // At least one mark for what is there at all.
            let bar = "#".repeat((count * 40).div_ceil(most) as usize);
            writeln!(f, "  < {:>8} us {count:>9}  {bar}", 1u64 << octave)?;
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use haptics::FormationKind;

    fn run(kinds: &[(FormationKind, usize)]) -> RunSummary {
        let mut summary = RunSummary::default();
        let mut tick = TickRecord::default();
        for &(kind, count) in kinds {
            for _ in 0..count {
                tick.input.stamp.0 += 1_000_000;
                tick.formation.kind = kind;
                summary.add(&tick);
            }
        }
        summary
    }

    #[test]
    fn states_shorter_than_the_chatter_are_left_out() {
        let summary = run(&[
            (FormationKind::Free, 100),
            (FormationKind::VertexFace, 50),
            (FormationKind::EdgeFace, 5),
            (FormationKind::VertexFace, 50),
            (FormationKind::FaceFace, 100),
        ]);
        let names: Vec<_> = summary.states.iter().map(|state| state.name).collect();
        assert_eq!(names, ["free", "vertex-face", "face-face"]);
        assert_eq!(summary.ticks(), 305);
        assert_eq!(summary.states[1].end.0 - summary.states[1].begin.0, 104_000_000);
    }

    #[test]
    fn the_part_rests_at_its_lowest() {
        let mut summary = RunSummary::of_part(vec![DVec3::ZERO, DVec3::new(0.0, 0.0, -0.5)]);
        let mut tick = TickRecord::default();
        for z in [1.0, 0.6, 0.5, 0.50005, 0.9] {
            tick.proxy.translation.z = z;
            summary.add(&tick);
        }
        assert_eq!(summary.bottom, (0.0, 2));
        assert!(summary.to_string().contains("part's lowest   z 0.00 mm"));
    }

    #[test]
    fn octaves_hold_their_bounds() {
        let mut bins = Bins::default();
        for ns in [0, 999, 1000, 1999, 2000, 3999, 4000, u32::MAX] {
            bins.add(ns);
        }
        assert_eq!(bins.counts[..4], [2, 2, 2, 1]);
        assert_eq!(bins.counts.iter().sum::<u64>(), 8);
        assert_eq!(bins.max_ns, u32::MAX);
    }

    #[test]
    fn only_ticks_that_were_run_have_times() {
        let mut summary = run(&[(FormationKind::Free, 3)]);
        assert!(!summary.to_string().contains("computing a tick"));
        summary.add(&TickRecord { compute_ns: 900, ..TickRecord::default() });
        assert!(summary.to_string().contains("computing a tick\n  mean 0.2 us, max 0.9 us\n"), "{summary}");
    }

    #[test]
    fn an_empty_run_prints() {
        assert!(RunSummary::default().to_string().contains("time recorded   0.000 s"));
    }
}
