use crate::applicability::ApplicabilityGraph;
use crate::blueprint;
use crate::budget::Budget;
use crate::clock::Clock;
use crate::contact_states::ContactStates;
use crate::cspace_view::CSpaceView;
use crate::events::Events;
use crate::eye::Eyes;
use crate::pairs::Pairs;
use crate::physical::ArrowScale;
use crate::series::Series;
use crate::sink::Sink;
use crate::slice::slice;
use crate::subject::Subject;
use crate::{InspectError, legend, physical};
use rerun::{RecordingStream, RecordingStreamResult};
use servo::TickRecord;
use spatial::DQuat;
use std::time::Duration;

/// How a recording is made.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Options {
    /// Frames of the two 3D views and of the graph a second of robot time; `None`: 30 to a file, 60 to a viewer.
    pub frames_per_second: Option<f64>,
    /// Where the 3D views look from; `None`: so that everything is in the picture.
    pub eyes: Option<Eyes>,
    /// Force and torque (N, N.m) whose arrows are about four times as long as the part in the hand.
    pub full_scale: (f64, f64),
    /// C-obstacles farther from `x` than this many times the part's size are left out.
    pub reach: f64,
}

impl Default for Options {
    fn default() -> Self {
        Self { frames_per_second: None, eyes: None, full_scale: (10.0, 0.5), reach: 2.0 }
    }
}

/// Turns tick records into a rerun recording.
///
/// Every tick goes into the series, as columns of 500 rows. The 3D views and the graphs are drawn at 30 frames a second
/// of robot time to a file and 60 to a viewer; the C-face polygons only when they changed, within a budget of 45 kB/s to
/// a file and 4 MB/s to a viewer. Changes of formation and health are never left out.
///
/// Calls may block while the disk or the viewer is slow: where that must not be, use [`crate::Feed`].
pub struct Recorder {
    stream: RecordingStream,
    subject: Subject,
    name: String,
    scale: ArrowScale,
    frame_nanos: i64,
    reach: f64,
    eyes: Option<Eyes>,
    pairs: Pairs,
    clock: Option<Clock>,
    last_frame: Option<i64>,
    series: Series,
    events: Events,
    states: ContactStates,
    cspace: CSpaceView,
    graph: ApplicabilityGraph,
}

impl Recorder {
    /// Opens the sink and sends what does not move; the layout follows with the first tick, which it is made for.
    ///
    /// # Errors
    /// The file cannot be written, or the address is not one. A viewer that is not there is no error.
    pub fn new(subject: Subject, sink: &Sink, options: &Options) -> Result<Self, InspectError> {
        let rates = (sink.frames_per_second(), sink.polygon_bytes_per_second());
        Ok(Self::on(sink.open()?, sink.name(), subject, rates, options)?)
    }

    /// Records to memory, at the rates of a file: for tests.
    ///
    /// # Errors
    /// rerun refused the layout or the bodies.
    #[doc(hidden)]
    pub fn in_memory(
        subject: Subject,
        options: &Options,
    ) -> Result<(Self, rerun::sink::MemorySinkStorage), InspectError> {
        let file = Sink::File(std::path::PathBuf::new());
        let (stream, storage) = crate::sink::builder(Duration::from_secs(2)).memory()?;
        let rates = (file.frames_per_second(), file.polygon_bytes_per_second());
        Ok((Self::on(stream, "memory".into(), subject, rates, options)?, storage))
    }

    /// Records on a stream that is open already.
    pub(crate) fn on(
        stream: RecordingStream,
        name: String,
        subject: Subject,
        (frames, bytes): (f64, f64),
        options: &Options,
    ) -> RecordingStreamResult<Self> {
        let size = subject.moving_size();
        let scale = ArrowScale::new(size, options.full_scale.0, options.full_scale.1);
        legend::open(&stream, &scale)?;
        physical::open(&stream, &subject)?;
        let pairs = Pairs::new(&subject.world);
        let frames = options.frames_per_second.unwrap_or(frames).clamp(0.1, 1000.0);
        Ok(Self {
            series: Series::open(&stream)?,
            events: Events::open(&stream)?,
            cspace: CSpaceView::open(&stream, Budget::new(bytes))?,
            states: ContactStates::default(),
            graph: ApplicabilityGraph::default(),
            stream,
            subject,
            name,
            scale,
            frame_nanos: (1e9 / frames) as i64,
            reach: options.reach * size,
            eyes: options.eyes,
            pairs,
            clock: None,
            last_frame: None,
        })
    }

    /// Records one tick.
    ///
    /// # Errors
    /// rerun refused the data; the recording goes on.
    pub fn tick(&mut self, record: &TickRecord) -> Result<(), InspectError> {
        let clock = match self.clock {
            Some(clock) => clock,
            None => {
                let rotation = if record.proxy.is_valid() { record.proxy.rotation } else { DQuat::IDENTITY };
                // A tick that was timed takes time.
                self.lay_out(rotation, record.compute_ns > 0 || record.wakeup_ns > 0)?;
                *self.clock.insert(Clock::new(record))
            }
        };
        self.series.push(&self.stream, &clock, record)?;
        clock.set(&self.stream, record);
        self.events.push(&self.stream, &self.subject, record)?;
        self.states.push(&self.stream, &self.subject, record)?;
        if self.is_due(record.input.stamp.0) {
            self.frame(record)?;
        }
        Ok(())
    }

    /// Sends the layout for a run that begins with A turned by `rotation`.
    fn lay_out(&mut self, rotation: DQuat, timed: bool) -> RecordingStreamResult<()> {
        let eyes = self.eyes.unwrap_or_else(|| Eyes::of(&self.subject, rotation));
        self.cspace.look_from(&eyes.cspace);
        blueprint::send_run(&self.stream, &eyes, timed)
    }

    /// Whether a frame is due at `now` (ns). A stamp that runs backwards draws at once and starts the count anew.
    fn is_due(&mut self, now: i64) -> bool {
        let due = self.last_frame.is_none_or(|last| now < last || now - last >= self.frame_nanos);
        if due {
            self.last_frame = Some(now);
        }
        due
    }

    fn frame(&mut self, record: &TickRecord) -> RecordingStreamResult<()> {
        // Numbers that are not finite have no place in a picture; their tick stands in the series and the log.
        if !(record.hip.is_valid() && record.proxy.is_valid() && record.out_wrench.is_finite()) {
            return Ok(());
        }
        physical::frame(&self.stream, record, &self.scale)?;
        let slices = slice(&self.subject.world, &mut self.pairs, &record.proxy, &record.formation, self.reach);
        let now = record.input.stamp.as_secs_f64();
        self.cspace.frame(&self.stream, record, &slices, &self.scale, now)?;
        self.graph.frame(&self.stream, &self.subject, &slices)
    }

    /// Sends what is left and waits until it is taken, `timeout` at most.
    ///
    /// # Errors
    /// Not everything was taken in time.
    pub fn finish(mut self, timeout: Duration) -> Result<(), InspectError> {
        match self.clock {
            Some(clock) => self.series.flush(&self.stream, &clock)?,
            None => self.lay_out(DQuat::IDENTITY, true)?,
        }
        self.stream.flush_with_timeout(timeout).map_err(|e| InspectError::flush(self.name, &e))
    }
}
