use crate::sample_count::SampleCount;
use crate::servo_loop::ServoLoop;
use crate::{Commands, LoopStatus, TickInput, TickRecord};
use device::HapticDevice;
use realtime::{GrantReport, LatestReader, LatestWriter, RingReader, ThreadSetup, latest, ring_prefaulted};
use serde::{Deserialize, Serialize};
use spatial::Wrench;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc;
use std::thread::JoinHandle;

/// How the loop runs.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct LoopConfig {
    /// Ticks a second, 250 to 10,000.
    pub rate_hz: f64,
    /// What the servo thread asks of the system.
    pub thread: ThreadSetup,
    /// Records that each ring holds: how long ROS or the pictures may stall without loss.
    pub ring_capacity: usize,
}

impl Default for LoopConfig {
    fn default() -> Self {
        Self { rate_hz: 1000.0, thread: ThreadSetup::default(), ring_capacity: 4096 }
    }
}

/// Why the loop could not be started, or ended.
#[derive(Debug, thiserror::Error)]
pub enum LoopError {
    /// The rate is out of range.
    #[error("rate_hz = {0} must be 250 to 10000")]
    Rate(f64),
    /// The rings' capacity is out of range.
    #[error("ring_capacity = {0} must be 16 to 65536")]
    Capacity(usize),
    /// The system gave no thread.
    #[error("cannot start the servo thread: {0}")]
    Thread(#[from] std::io::Error),
    /// The thread panicked; the device was left without force.
    #[error("the servo thread panicked: {0}")]
    Panicked(String),
}

/// The ends of a running loop that its neighbours hold. Take what you need out of it; dropping an end harms nothing.
#[derive(Debug)]
pub struct Servo {
    /// Stops the loop; dropping it stops the loop too.
    pub handle: ServoHandle,
    /// What to do: written whole, read once a tick.
    pub commands: LatestWriter<Commands>,
    /// Every tick, for ROS and the bag.
    pub records: RingReader<TickRecord>,
    /// Every tick, for the pictures.
    pub pictures: RingReader<TickRecord>,
    /// Counters and histograms, published twice a second.
    pub status: LatestReader<LoopStatus>,
}

/// Stops and joins the servo thread.
#[derive(Debug)]
pub struct ServoHandle {
    stop: Arc<AtomicBool>,
    thread: Option<JoinHandle<Result<LoopStatus, LoopError>>>,
    grants: GrantReport,
}

impl ServoHandle {
    /// What the system granted the thread.
    #[must_use]
    pub fn grants(&self) -> &GrantReport {
        &self.grants
    }

    /// Asks the loop to stop; the device is without force within 2 ms. Does not wait.
    pub fn stop(&self) {
        self.stop.store(true, Ordering::Release); // pairs with the load in `ServoLoop::sleep`
    }

    /// Whether the thread still runs.
    #[must_use]
    pub fn is_running(&self) -> bool {
        self.thread.as_ref().is_some_and(|t| !t.is_finished())
    }

    /// Stops the loop, waits for its end, and gives the final counters.
    ///
    /// # Errors
    /// The thread panicked.
    pub fn join(mut self) -> Result<LoopStatus, LoopError> {
        self.finish().unwrap_or_else(|| Ok(LoopStatus::default()))
    }

    fn finish(&mut self) -> Option<Result<LoopStatus, LoopError>> {
        self.stop();
        let thread = self.thread.take()?;
        Some(thread.join().unwrap_or_else(|panic| Err(LoopError::Panicked(message(&*panic)))))
    }
}

impl Drop for ServoHandle {
    fn drop(&mut self) {
        self.finish();
    }
}

fn message(panic: &(dyn std::any::Any + Send)) -> String {
    let text = panic.downcast_ref::<String>().map(String::as_str);
    text.or_else(|| panic.downcast_ref::<&str>().copied()).unwrap_or("no message").to_owned()
}

/// Starts the loop on a thread of its own: reads `device`, runs `step` (the pure tick), writes the wrench, and tells
/// the rings. Returns once the thread is set up and about to start.
///
/// # Errors
/// A number of the configuration is out of range, or the system gives no thread. What the thread may not have
/// (`SCHED_FIFO`, locked memory) is no error: see [`ServoHandle::grants`].
pub fn spawn<S>(
    device: Box<dyn HapticDevice>,
    step: S,
    initial: Commands,
    config: &LoopConfig,
) -> Result<Servo, LoopError>
where
    S: FnMut(&TickInput) -> TickRecord + Send + 'static,
{
    if !(config.rate_hz >= 250.0 && config.rate_hz <= 10_000.0) {
        return Err(LoopError::Rate(config.rate_hz));
    }
    if !(16..=65_536).contains(&config.ring_capacity) {
        return Err(LoopError::Capacity(config.ring_capacity));
    }
    let (commands, commands_reader) = latest(&initial);
    let (status_cell, status) = latest(&LoopStatus::default());
    let (records_writer, records) = ring_prefaulted(config.ring_capacity, &TickRecord::default());
    let (pictures_writer, pictures) = ring_prefaulted(config.ring_capacity, &TickRecord::default());
    let mut servo_loop = ServoLoop {
        device,
        step,
        commands: commands_reader,
        records: records_writer,
        pictures: pictures_writer,
        status_cell,
        status: LoopStatus::default(),
        samples: SampleCount::default(),
        period_ns: (1e9 / config.rate_hz).round() as i64,
    };
    let stop = Arc::new(AtomicBool::new(false));
    let (tell_grants, hear_grants) = mpsc::sync_channel(1);
    let (setup, stop_in_thread) = (config.thread, Arc::clone(&stop));
    let thread = std::thread::Builder::new().name("servo".into()).spawn(move || {
        // The only receiver waits for exactly this message; it cannot be gone.
        let _ = tell_grants.send(setup.apply());
        match catch_unwind(AssertUnwindSafe(|| servo_loop.run(&stop_in_thread))) {
            Ok(()) => Ok(servo_loop.status),
            Err(panic) => {
                servo_loop.device.write(&Wrench::ZERO);
                Err(LoopError::Panicked(message(&*panic)))
            }
        }
    })?;
    let grants = hear_grants.recv().map_err(|_| LoopError::Panicked("during its set-up".into()))?;
    Ok(Servo { handle: ServoHandle { stop, thread: Some(thread), grants }, commands, records, pictures, status })
}
