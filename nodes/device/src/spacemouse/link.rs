use std::time::Duration;

/// Where HID devices are plugged in. The driver's thread owns it; tests bring their own.
pub trait HidBus: Send {
    /// Opens the first SpaceMouse there is.
    ///
    /// # Errors
    /// One line that says why there is none: nothing plugged in, or not permitted and what to do.
    fn open(&mut self) -> Result<Box<dyn HidLink>, String>;
}

/// An open HID device. Dropping it closes it.
pub trait HidLink {
    /// Waits at most `timeout` for an input report, which starts with its number; 0 bytes if none came.
    ///
    /// # Errors
    /// The device is gone.
    fn read(&mut self, report: &mut [u8], timeout: Duration) -> Result<usize, LinkLost>;

    /// Sends an output report, which starts with its number.
    ///
    /// # Errors
    /// The device is gone or refuses it.
    fn write(&mut self, report: &[u8]) -> Result<(), LinkLost>;
}

/// The device is gone: why, as the system says it.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("SpaceMouse lost: {0}")]
pub struct LinkLost(pub String);
