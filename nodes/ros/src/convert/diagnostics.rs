use super::header;
use bag::msg::{Header, ServoHealth};
use r2r::diagnostic_msgs::msg::{DiagnosticArray, DiagnosticStatus, KeyValue};
use realtime::{LatencyHistogram, LatencySummary};
use servo::{Health, LoopStatus, TickRecord};
use spatial::Stamp;

/// Levels of `diagnostic_msgs/DiagnosticStatus`.
const OK: u8 = 0;
const WARN: u8 = 1;
const ERROR: u8 = 2;

/// Bits that say that something is wrong with the device or the numbers: no force.
const ERRORS: Health = Health(Health::ZERO_FORCE.0 & !Health::DEADMAN.0);
/// Bits that belong to ordinary work.
const NOTES: Health = Health(
    Health::SATURATED.0
        | Health::RESEEDED.0
        | Health::DIVERGENT.0
        | Health::INPUT_ONLY.0
        | Health::DEADMAN.0
        | Health::SEQUENCE.0,
);

/// What is known about the servo at one moment.
#[derive(Clone, Debug)]
pub struct ServoReport<'a> {
    /// The loop's counters.
    pub status: &'a LoopStatus,
    /// The newest tick.
    pub last: &'a TickRecord,
    /// Health bits since the last report.
    pub since: Health,
    /// What the system granted the thread, in words.
    pub grants: &'a str,
    /// Whether the thread runs under SCHED_FIFO.
    pub realtime: bool,
    /// Nominal period, s.
    pub period: f64,
    /// The law's name.
    pub law: &'a str,
}

impl ServoReport<'_> {
    /// As the servo's own health message.
    #[must_use]
    pub fn health_message(&self, at: Stamp, frame_id: &str) -> ServoHealth {
        let (s, last) = (self.status, self.last);
        let (wakeup, compute) = (s.wakeup.summary(), s.compute.summary());
        let ns = |x: u64| u32::try_from(x).unwrap_or(u32::MAX);
        ServoHealth {
            header: Header { stamp: at.into(), frame_id: frame_id.to_owned() },
            health: last.health.0,
            health_since: self.since.0,
            enabled: last.input.enabled,
            realtime: self.realtime,
            period: self.period,
            ticks: s.ticks,
            ticks_late: s.late_ticks,
            lost_ros: s.records_dropped,
            lost_pictures: s.pictures_dropped,
            samples_repeated: s.samples_repeated,
            samples_bad: s.samples_bad,
            wakeup_p50_ns: ns(wakeup.p50_ns),
            wakeup_p99_ns: ns(wakeup.p99_ns),
            wakeup_max_ns: ns(wakeup.max_ns),
            compute_p50_ns: ns(compute.p50_ns),
            compute_p99_ns: ns(compute.p99_ns),
            compute_max_ns: ns(compute.max_ns),
            energy: last.energy,
            depth: last.depth,
            force: last.out_wrench.force.length(),
        }
    }

    /// As `/diagnostics` wants it.
    #[must_use]
    pub fn diagnostics(&self, at: Stamp, node: &str, hardware: &str) -> DiagnosticArray {
        let s = self.status;
        let level = if self.since.any(ERRORS) {
            ERROR
        } else if self.since.0 & !NOTES.0 != 0 || s.records_dropped > 0 {
            WARN
        } else {
            OK
        };
        let mut values = vec![
            value("health", self.last.health),
            value("health since the last report", self.since),
            value("force enabled", self.last.input.enabled),
            value("law", self.law),
            value("contact formation", self.last.formation.kind.name()),
            value("depth (m)", format!("{:.3e}", self.last.depth)),
            value("force (N)", format!("{:.3}", self.last.out_wrench.force.length())),
            value("energy (J)", format!("{:.3e}", self.last.energy)),
            value("ticks", s.ticks),
            value("late ticks", s.late_ticks),
            value("skipped moments", s.skipped),
            value("records lost to ROS", s.records_dropped),
            value("records lost to pictures", s.pictures_dropped),
            value("clock steps", s.clock_steps),
            value("samples repeated or out of order", s.samples_repeated),
            value("samples lost or not finite", s.samples_bad),
            value("thread", self.grants),
        ];
        for (name, histogram) in [("wake-up", &s.wakeup), ("compute", &s.compute), ("period", &s.period)] {
            values.extend(times(name, histogram));
        }
        let status = DiagnosticStatus {
            level,
            name: format!("{}: servo", node.trim_start_matches('/')),
            message: if level == OK { "good".into() } else { self.since.to_string() },
            hardware_id: hardware.to_owned(),
            values,
        };
        DiagnosticArray { header: header(at, ""), status: vec![status] }
    }
}

fn value(key: &str, value: impl std::fmt::Display) -> KeyValue {
    KeyValue { key: key.to_owned(), value: value.to_string() }
}

fn times(name: &str, histogram: &LatencyHistogram) -> Vec<KeyValue> {
    let LatencySummary { p50_ns, p99_ns, p999_ns, max_ns, .. } = histogram.summary();
    [("p50", p50_ns), ("p99", p99_ns), ("p99.9", p999_ns), ("max", max_ns)]
        .map(|(q, ns)| value(&format!("{name} {q} (us)"), format!("{:.1}", ns as f64 * 1e-3)))
        .into()
}
