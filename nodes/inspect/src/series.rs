use crate::clock::Clock;
use crate::palette;
use rerun::{RecordingStream, RecordingStreamResult, Rgba32, Scalars, SeriesLines};
use servo::TickRecord;

/// Rows that go out in one call: half a second at 1 kHz.
const BATCH: usize = 500;

/// One plot: its entity, and what each of its lines is called and how it looks.
pub(crate) struct Plot {
    /// Entity, with the unit in its name.
    pub entity: &'static str,
    /// Title of the view.
    pub title: &'static str,
    lines: &'static [(&'static str, palette::Rgb)],
    value: fn(&TickRecord, &mut Vec<f64>),
}

/// What the servo itself took.
pub(crate) const TIMES: &str = "/series/time_us";

/// All plots, top to bottom.
pub(crate) const PLOTS: &[Plot] = &[
    Plot {
        entity: "/series/force_N",
        title: "Force on the hand [N], axes of W",
        lines: &[("Fx [N]", palette::AXES[0]), ("Fy [N]", palette::AXES[1]), ("Fz [N]", palette::AXES[2])],
        value: |r, out| out.extend(r.out_wrench.force.to_array()),
    },
    Plot {
        entity: "/series/torque_mNm",
        title: "Torque on the hand [mN.m], about A's origin",
        lines: &[("Tx [mN.m]", palette::AXES[0]), ("Ty [mN.m]", palette::AXES[1]), ("Tz [mN.m]", palette::AXES[2])],
        value: |r, out| out.extend(r.out_wrench.torque.to_array().map(|t| t * 1e3)),
    },
    Plot {
        entity: "/series/depth_mm",
        title: "Penetration of the hand's pose [mm]",
        lines: &[("depth [mm]", palette::TOUCHING)],
        value: |r, out| out.push(r.depth * 1e3),
    },
    Plot {
        entity: "/series/energy_mJ",
        title: "Energy put in by the hand, less stored [mJ]",
        lines: &[("energy [mJ]", palette::SCP)],
        value: |r, out| out.push(r.energy * 1e3),
    },
    Plot {
        entity: TIMES,
        title: "Servo tick [us]",
        lines: &[("wake-up late by [us]", palette::OTHER), ("computing [us]", palette::NEAR)],
        value: |r, out| out.extend([f64::from(r.wakeup_ns) * 1e-3, f64::from(r.compute_ns) * 1e-3]),
    },
];

/// Every tick's numbers, sent as columns: one call per plot and `BATCH` ticks instead of one per number.
pub(crate) struct Series {
    ticks: Vec<i64>,
    nanos: Vec<i64>,
    values: Vec<Vec<f64>>,
}

impl Series {
    /// Declares names and colours of the lines.
    pub(crate) fn open(stream: &RecordingStream) -> RecordingStreamResult<Self> {
        for plot in PLOTS {
            let colors: Vec<Rgba32> = plot.lines.iter().map(|(_, color)| palette::solid(*color)).collect();
            let names: Vec<&str> = plot.lines.iter().map(|(name, _)| *name).collect();
            stream.log_static(
                plot.entity,
                &SeriesLines::new().with_colors(colors).with_names(names).with_widths([1.5]),
            )?;
        }
        let values = PLOTS.iter().map(|plot| Vec::with_capacity(BATCH * plot.lines.len())).collect();
        Ok(Self { ticks: Vec::with_capacity(BATCH), nanos: Vec::with_capacity(BATCH), values })
    }

    pub(crate) fn push(
        &mut self,
        stream: &RecordingStream,
        clock: &Clock,
        record: &TickRecord,
    ) -> RecordingStreamResult<()> {
        self.ticks.push(record.input.sequence as i64);
        self.nanos.push(record.input.stamp.0);
        for (plot, values) in PLOTS.iter().zip(&mut self.values) {
            (plot.value)(record, values);
        }
        if self.ticks.len() == BATCH { self.flush(stream, clock) } else { Ok(()) }
    }

    pub(crate) fn flush(&mut self, stream: &RecordingStream, clock: &Clock) -> RecordingStreamResult<()> {
        let rows = self.ticks.len();
        if rows == 0 {
            return Ok(());
        }
        for (plot, values) in PLOTS.iter().zip(&mut self.values) {
            let times = clock.columns(&self.ticks, &self.nanos);
            let width = plot.lines.len();
            let scalars = Scalars::new(values.drain(..)).columns(std::iter::repeat_n(width, rows))?;
            stream.send_columns(plot.entity, times, scalars)?;
        }
        self.ticks.clear();
        self.nanos.clear();
        Ok(())
    }
}
