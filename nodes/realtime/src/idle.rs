use crate::Grant;
use std::fs::File;
use std::io::Write;
use std::sync::Mutex;

/// Open as long as the process lives: closing it gives the request back.
static REQUEST: Mutex<Option<File>> = Mutex::new(None);

const PATH: &str = "/dev/cpu_dma_latency";
const HOW: &str =
    "a udev rule `KERNEL==\"cpu_dma_latency\", GROUP=\"realtime\", MODE=\"0660\"` and the user in that group";

/// Asks the kernel to keep processors out of idle states that take time to leave (PM QoS, 0 us): the wake-up of a
/// sleeping loop is else tens of microseconds later on many machines. For the whole process, until it ends.
pub(crate) fn stay_awake() -> Grant {
    let mut request = REQUEST.lock().unwrap_or_else(std::sync::PoisonError::into_inner);
    if request.is_some() {
        return Grant::Granted;
    }
    let opened = File::options().write(true).open(PATH).and_then(|mut file| {
        file.write_all(&0i32.to_ne_bytes())?;
        Ok(file)
    });
    match opened {
        Ok(file) => {
            *request = Some(file);
            Grant::Granted
        }
        Err(e) => Grant::Refused { reason: format!("{PATH}: {e}"), remedy: HOW },
    }
}
