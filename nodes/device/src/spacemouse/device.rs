use super::config::{SpaceMouseConfig, SpaceMouseError};
use super::driver::{CapState, Driver, DriverNotes};
use super::hid::Hidraw;
use super::link::HidBus;
use super::motion::Motion;
use crate::{DeviceSpec, HapticDevice, Sample};
use spatial::{DVec3, Stamp, Wrench};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex};
use std::thread::JoinHandle;
use triple_buffer::Output;

/// A SpaceMouse as a haptic device that shows no force.
///
/// Its thread finds the device, reads it, and finds it again when it was unplugged; the pose stays where it was
/// meanwhile, and samples say that they are not connected.
#[derive(Debug)]
pub struct SpaceMouse {
    spec: DeviceSpec,
    cell: Output<CapState>,
    motion: Motion,
    sequence: u64,
    last_read: Option<Stamp>,
    heartbeat: u64,
    alive_at: Stamp,
    notes: Arc<Mutex<DriverNotes>>,
    stop: Arc<AtomicBool>,
    thread: Option<JoinHandle<()>>,
}

/// Tells people how the driver fares; not for the servo thread.
#[derive(Clone, Debug)]
pub struct SpaceMouseMonitor(Arc<Mutex<DriverNotes>>);

impl SpaceMouseMonitor {
    /// Counters and the last trouble.
    #[must_use]
    pub fn notes(&self) -> DriverNotes {
        self.0.lock().unwrap_or_else(std::sync::PoisonError::into_inner).clone()
    }
}

/// The driver's thread publishes at least every 10 ms while it waits; silent for longer, it hangs, and samples age.
const HUNG_NS: i64 = 200_000_000;
/// The longest time that one read moves the pose by.
const MOST_S: f64 = 0.05;

impl SpaceMouse {
    /// Starts the driver on the system's hidraw devices. A device need not be plugged in yet.
    ///
    /// # Errors
    /// A number of the configuration is out of range, or the system gives no thread.
    pub fn start(config: SpaceMouseConfig) -> Result<Self, SpaceMouseError> {
        Self::on(Box::new(Hidraw::default()), config)
    }

    /// The same on a bus of the caller's.
    ///
    /// # Errors
    /// As [`SpaceMouse::start`].
    pub fn on(bus: Box<dyn HidBus>, config: SpaceMouseConfig) -> Result<Self, SpaceMouseError> {
        config.check()?;
        let (input, cell) = triple_buffer::triple_buffer(&CapState::default());
        let notes = Arc::new(Mutex::new(DriverNotes::default()));
        let stop = Arc::new(AtomicBool::new(false));
        let mut driver = Driver { bus, cell: input, notes: Arc::clone(&notes), led: config.led };
        let stop_in_thread = Arc::clone(&stop);
        let thread =
            std::thread::Builder::new().name("spacemouse".into()).spawn(move || driver.run(&stop_in_thread))?;
        let spec = DeviceSpec {
            name: "spacemouse".into(),
            workspace: DVec3::splat(config.reach),
            max_force: 0.0,
            max_torque: 0.0,
            max_stiffness: 0.0,
            resolution: config.speed * 1e-3 / 350.0,
            mass: 0.0,
            damping: 0.0,
        };
        Ok(Self {
            spec,
            cell,
            motion: Motion::new(config),
            sequence: 0,
            last_read: None,
            heartbeat: 0,
            alive_at: Stamp(0),
            notes,
            stop,
            thread: Some(thread),
        })
    }

    /// For diagnostics.
    #[must_use]
    pub fn monitor(&self) -> SpaceMouseMonitor {
        SpaceMouseMonitor(Arc::clone(&self.notes))
    }
}

impl HapticDevice for SpaceMouse {
    fn spec(&self) -> &DeviceSpec {
        &self.spec
    }

    fn read(&mut self, now: Stamp) -> Sample {
        let state = *self.cell.read();
        let dt = self.last_read.map_or(0.0, |last| now.0.saturating_sub(last.0) as f64 * 1e-9).clamp(0.0, MOST_S);
        self.last_read = Some(now);
        if state.heartbeat != self.heartbeat || now < self.alive_at {
            self.heartbeat = state.heartbeat;
            self.alive_at = now;
        }
        let hung = now.0.saturating_sub(self.alive_at.0) > HUNG_NS;
        let axes = if state.connected && !hung { state.axes } else { [0; 6] };
        self.motion.advance(&axes, dt);
        if !hung {
            self.sequence += 1;
        }
        Sample {
            sequence: self.sequence,
            stamp: if hung { self.alive_at } else { now },
            pose: self.motion.pose,
            twist: self.motion.twist,
            has_twist: true,
            buttons: state.buttons,
            connected: state.connected,
        }
    }

    /// Shows nothing: the device has no motors.
    fn write(&mut self, _wrench: &Wrench) {}
}

impl Drop for SpaceMouse {
    fn drop(&mut self) {
        self.stop.store(true, Ordering::Relaxed);
        if let Some(thread) = self.thread.take() {
            // It panicked, then; its samples have said so by ageing.
            let _ = thread.join();
        }
    }
}
