use super::link::{HidBus, HidLink};
use super::report::Report;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex};
use std::time::{Duration, Instant};
use triple_buffer::Input;

/// What the driver's thread knows of the cap.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct CapState {
    /// Raw counts: translation, rotation; right, backward, down.
    pub(super) axes: [i16; 6],
    pub(super) buttons: u32,
    /// The device is open and its last report was a sound one.
    pub(super) connected: bool,
    /// Rises as long as the thread lives.
    pub(super) heartbeat: u64,
}

/// Counters and the last trouble, for people.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct DriverNotes {
    /// Reports decoded.
    pub reports: u64,
    /// Reports that were garbage.
    pub garbage: u64,
    /// How often a device was opened.
    pub plugged: u64,
    /// Why there is no device now, in one line; `None` if there is one.
    pub trouble: Option<String>,
}

/// The thread that owns the HID device: may block, allocate and log, so that the servo thread need not.
pub(super) struct Driver {
    pub(super) bus: Box<dyn HidBus>,
    pub(super) cell: Input<CapState>,
    pub(super) notes: Arc<Mutex<DriverNotes>>,
    pub(super) led: bool,
}

const LED_ON: [u8; 2] = [4, 1];
const LED_OFF: [u8; 2] = [4, 0];
/// Longest wait for a report: the heartbeat's period.
const READ: Duration = Duration::from_millis(10);
/// Between two looks for a device, in steps that see the stop flag.
const LOOK_STEPS: u32 = 25;
/// A deflected cap reports every 8 to 16 ms; one that falls silent is taken as let go.
const SILENCE: Duration = Duration::from_millis(250);

impl Driver {
    /// Looks for a device, reads it until it is gone, and looks again.
    pub(super) fn run(&mut self, stop: &AtomicBool) {
        let mut state = CapState::default();
        while !stop.load(Ordering::Relaxed) {
            match self.bus.open() {
                Ok(mut link) => {
                    self.note(|n| {
                        n.plugged += 1;
                        n.trouble = None;
                    });
                    let trouble = self.serve(&mut *link, &mut state, stop);
                    self.note(|n| n.trouble = trouble);
                }
                Err(trouble) => self.note(|n| n.trouble = Some(trouble)),
            }
            state = CapState { heartbeat: state.heartbeat, ..CapState::default() };
            for _ in 0..LOOK_STEPS {
                if stop.load(Ordering::Relaxed) {
                    break;
                }
                self.publish(&mut state);
                std::thread::sleep(READ);
            }
        }
    }

    /// Reads until the device is gone (then why) or the driver shall stop.
    fn serve(&mut self, link: &mut dyn HidLink, state: &mut CapState, stop: &AtomicBool) -> Option<String> {
        if self.led {
            // A device without a light refuses; nothing depends on it.
            let _ = link.write(&LED_ON);
        }
        state.connected = true;
        let mut bytes = [0; Report::MAX_LENGTH];
        let mut last_motion = Instant::now();
        while !stop.load(Ordering::Relaxed) {
            match link.read(&mut bytes, READ) {
                Ok(0) => {}
                Ok(n) => {
                    if self.take(&bytes[..n.min(bytes.len())], state) {
                        last_motion = Instant::now();
                    }
                }
                Err(lost) => return Some(lost.to_string()),
            }
            if last_motion.elapsed() > SILENCE {
                state.axes = [0; 6];
            }
            self.publish(state);
        }
        if self.led {
            let _ = link.write(&LED_OFF);
        }
        None
    }

    /// Takes one report; true if it told of the cap's motion.
    fn take(&mut self, bytes: &[u8], state: &mut CapState) -> bool {
        let report = Report::decode(bytes);
        self.note(|n| {
            n.reports += u64::from(report.is_ok());
            n.garbage += u64::from(report.is_err());
        });
        state.connected = report.is_ok();
        match report {
            Ok(Report::Motion(axes)) => state.axes = axes,
            Ok(Report::Translation(axes)) => state.axes[..3].copy_from_slice(&axes),
            Ok(Report::Rotation(axes)) => state.axes[3..].copy_from_slice(&axes),
            Ok(Report::Buttons(mask)) => state.buttons = mask,
            Ok(Report::Other(_)) => {}
            Err(_) => state.axes = [0; 6],
        }
        matches!(report, Ok(Report::Motion(_) | Report::Translation(_) | Report::Rotation(_)))
    }

    fn publish(&mut self, state: &mut CapState) {
        state.heartbeat += 1;
        self.cell.write(*state);
    }

    fn note(&self, change: impl FnOnce(&mut DriverNotes)) {
        change(&mut self.notes.lock().unwrap_or_else(std::sync::PoisonError::into_inner));
    }
}
