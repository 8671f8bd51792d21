use super::link::{HidBus, HidLink, LinkLost};
use hidapi::{DeviceInfo, HidApi, HidDevice};
use std::time::Duration;

/// Vendor and product numbers of the devices that speak these reports.
const PRODUCTS: [(u16, &[u16]); 2] = [
    (0x046d, &[0xc625, 0xc626, 0xc627, 0xc629, 0xc62b]),
    (0x256f, &[0xc62e, 0xc632, 0xc633, 0xc635, 0xc638, 0xc63a, 0xc641, 0xc652]),
];

/// The system's hidraw devices.
#[derive(Default)]
pub(super) struct Hidraw {
    api: Option<HidApi>,
}

fn is_space_mouse(info: &DeviceInfo) -> bool {
    PRODUCTS.iter().any(|(vendor, products)| info.vendor_id() == *vendor && products.contains(&info.product_id()))
}

impl Hidraw {
    fn refreshed(&mut self) -> Result<&HidApi, hidapi::HidError> {
        if let Some(api) = &mut self.api {
            api.refresh_devices()?;
        } else {
            self.api = Some(HidApi::new()?);
        }
        self.api.as_ref().ok_or(hidapi::HidError::InitializationError)
    }
}

impl HidBus for Hidraw {
    fn open(&mut self) -> Result<Box<dyn HidLink>, String> {
        let api = self.refreshed().map_err(|e| format!("HID devices cannot be listed: {e}"))?;
        let Some(info) = api.device_list().find(|info| is_space_mouse(info)) else {
            return Err("no SpaceMouse is plugged in".into());
        };
        let device = info.open_device(api).map_err(|e| {
            format!(
                "SpaceMouse {:04x}:{:04x} at {} cannot be opened: {e}; install config/udev/60-cspace-haptics.rules and plug it in again",
                info.vendor_id(),
                info.product_id(),
                info.path().to_string_lossy()
            )
        })?;
        Ok(Box::new(device))
    }
}

impl HidLink for HidDevice {
    fn read(&mut self, report: &mut [u8], timeout: Duration) -> Result<usize, LinkLost> {
        let timeout_ms = i32::try_from(timeout.as_millis()).unwrap_or(i32::MAX);
        self.read_timeout(report, timeout_ms).map_err(|e| LinkLost(e.to_string()))
    }

    fn write(&mut self, report: &[u8]) -> Result<(), LinkLost> {
        HidDevice::write(self, report).map(|_| ()).map_err(|e| LinkLost(e.to_string()))
    }
}
