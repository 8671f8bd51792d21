//! The real SpaceMouse driver on a virtual device of the kernel's uhid: plug, light, motion, button, unplug, plug again
//! in the other report format. Needs /dev/uhid: `tests/uhid/run.sh` brings it in a small virtual machine.

use device::{HapticDevice, Sample, SpaceMouse, SpaceMouseConfig};
use spatial::Stamp;
use std::error::Error;
use std::fs::File;
use std::io::{Read, Write};
use std::sync::mpsc::{Receiver, channel};
use std::time::{Duration, Instant};

/// What the kernel calls the events (linux/uhid.h).
const DESTROY: u32 = 1;
const OUTPUT: u32 = 6;
const CREATE2: u32 = 11;
const INPUT2: u32 = 12;
const USB: u16 = 3;
const DATA_MAX: usize = 4096;

/// Six axes in report 1, buttons in 3, the light in 4.
const COMBINED: &[u8] = &[
    0x05, 0x01, 0x09, 0x08, 0xa1, 0x01, // generic desktop, multi-axis controller
    0x85, 0x01, 0x16, 0xa2, 0xfe, 0x26, 0x5e, 0x01, 0x09, 0x30, 0x09, 0x31, 0x09, 0x32, 0x09, 0x33, 0x09, 0x34, 0x09,
    0x35, 0x75, 0x10, 0x95, 0x06, 0x81, 0x02, // report 1: six times 16 bit, -350 to 350
    0x85, 0x03, 0x05, 0x09, 0x19, 0x01, 0x29, 0x10, 0x15, 0x00, 0x25, 0x01, 0x75, 0x01, 0x95, 0x10, 0x81,
    0x02, // report 3: 16 buttons
    0x85, 0x04, 0x05, 0x08, 0x09, 0x4b, 0x75, 0x08, 0x95, 0x01, 0x91, 0x02, // report 4: the light
    0xc0,
];

/// Three axes in report 1 and three in report 2.
const SPLIT: &[u8] = &[
    0x05, 0x01, 0x09, 0x08, 0xa1, 0x01, 0x85, 0x01, 0x16, 0xa2, 0xfe, 0x26, 0x5e, 0x01, 0x09, 0x30, 0x09, 0x31, 0x09,
    0x32, 0x75, 0x10, 0x95, 0x03, 0x81, 0x02, // report 1: translation
    0x85, 0x02, 0x09, 0x33, 0x09, 0x34, 0x09, 0x35, 0x75, 0x10, 0x95, 0x03, 0x81, 0x02, // report 2: rotation
    0xc0,
];

/// A virtual device, unplugged when dropped.
struct Virtual {
    uhid: File,
    outputs: Receiver<Vec<u8>>,
}

impl Virtual {
    fn plug(vendor: u32, product: u32, descriptor: &[u8]) -> Result<Self, Box<dyn Error>> {
        let mut uhid = File::options().read(true).write(true).open("/dev/uhid")?;
        let mut event = CREATE2.to_ne_bytes().to_vec();
        let mut name = [0u8; 128 + 64 + 64];
        name[..18].copy_from_slice(b"virtual SpaceMouse");
        event.extend(name);
        event.extend(u16::try_from(descriptor.len())?.to_ne_bytes());
        event.extend(USB.to_ne_bytes());
        [vendor, product, 0, 0].iter().for_each(|n| event.extend(n.to_ne_bytes()));
        event.extend(descriptor);
        event.resize(4 + 256 + 4 + 16 + DATA_MAX, 0);
        uhid.write_all(&event)?;
        let (tell, outputs) = channel();
        let mut reader = uhid.try_clone()?;
        std::thread::spawn(move || {
            let mut bytes = [0; 4 + DATA_MAX + 512];
            while let Ok(n) = reader.read(&mut bytes) {
                if n >= 4 + DATA_MAX + 2 && bytes[..4] == OUTPUT.to_ne_bytes() {
                    let size = usize::from(u16::from_ne_bytes([bytes[4 + DATA_MAX], bytes[5 + DATA_MAX]]));
                    if tell.send(bytes[4..4 + size.min(DATA_MAX)].to_vec()).is_err() {
                        return;
                    }
                }
            }
        });
        Ok(Self { uhid, outputs })
    }

    fn report(&mut self, bytes: &[u8]) -> Result<(), Box<dyn Error>> {
        let mut event = INPUT2.to_ne_bytes().to_vec();
        event.extend(u16::try_from(bytes.len())?.to_ne_bytes());
        event.extend(bytes);
        Ok(self.uhid.write_all(&event)?)
    }
}

impl Drop for Virtual {
    fn drop(&mut self) {
        // Gone already, if that fails.
        let _ = self.uhid.write_all(&DESTROY.to_ne_bytes());
    }
}

/// Reads every millisecond until `done`, while `act` keeps the device busy.
fn until(
    mouse: &mut SpaceMouse,
    what: &str,
    mut act: impl FnMut() -> Result<(), Box<dyn Error>>,
    done: impl Fn(&Sample) -> bool,
) -> Result<Sample, Box<dyn Error>> {
    let start = Instant::now();
    loop {
        act()?;
        let sample = mouse.read(Stamp(1 + start.elapsed().as_nanos() as i64));
        if done(&sample) {
            println!("  {what}: after {:.0} ms", start.elapsed().as_secs_f64() * 1e3);
            return Ok(sample);
        }
        if start.elapsed() > Duration::from_secs(20) {
            return Err(format!("waited 20 s for: {what}; {:?}", mouse.monitor().notes()).into());
        }
        std::thread::sleep(Duration::from_millis(1));
    }
}

fn main() -> Result<(), Box<dyn Error>> {
    let mut mouse = SpaceMouse::start(SpaceMouseConfig::default())?;
    let nothing = || Ok(());
    until(&mut mouse, "no device at first", nothing, |s| !s.connected)?;

    println!("256f:c635, combined reports");
    let mut device = Virtual::plug(0x256f, 0xc635, COMBINED)?;
    until(&mut mouse, "plugged in", nothing, |s| s.connected)?;
    let light = device.outputs.recv_timeout(Duration::from_secs(20))?;
    println!("  light report {light:02x?}");
    if light != [4, 1] {
        return Err("the light was not switched on".into());
    }
    let push = [1, 0x5e, 1, 0, 0, 0xa2, 0xfe, 0, 0, 0, 0, 0, 0];
    until(
        &mut mouse,
        "moves right and up",
        || device.report(&push),
        |s| s.pose.translation.x.min(s.pose.translation.z) > 0.005,
    )?;
    device.report(&[3, 2, 0])?;
    until(&mut mouse, "second button", nothing, |s| s.buttons == 2)?;
    drop(device);
    let lost = until(&mut mouse, "unplugged", nothing, |s| !s.connected)?;

    // A SpaceExplorer: for a SpaceNavigator (c626) the kernel waits for hid-logitech, which is not in the small machine.
    println!("046d:c627, split reports");
    let mut device = Virtual::plug(0x046d, 0xc627, SPLIT)?;
    let back = until(&mut mouse, "plugged in again", nothing, |s| s.connected)?;
    if (back.pose.translation - lost.pose.translation).length() > 0.02 {
        return Err("the pose jumped while it was unplugged".into());
    }
    let turn = [2, 0, 0, 0, 0, 0x5e, 1];
    until(&mut mouse, "turns about down", || device.report(&turn), |s| s.twist.angular.z < -0.3)?;
    let forward = [1, 0, 0, 0xa2, 0xfe, 0, 0];
    until(&mut mouse, "moves forward", || device.report(&forward), |s| s.twist.linear.y > 0.05)?;
    until(&mut mouse, "let go", nothing, |s| s.twist.linear.length() < 1e-6)?;
    println!("virtual SpaceMouse: passed");
    Ok(())
}
