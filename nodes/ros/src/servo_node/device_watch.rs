use crate::Host;
use device::SpaceMouseMonitor;

/// Tells when a device that may come and go does so. Without it a hand at an unplugged device would find a node that is
/// ready and does nothing.
#[derive(Debug, Default)]
pub struct DeviceWatch {
    monitor: Option<SpaceMouseMonitor>,
    told: Told,
}

/// What is new of a device.
#[derive(Debug, PartialEq, Eq)]
enum News {
    /// Why it is not there.
    Gone(String),
    /// It is there again.
    Back,
}

impl DeviceWatch {
    /// Watches a SpaceMouse.
    #[must_use]
    pub fn of(monitor: SpaceMouseMonitor) -> Self {
        Self { monitor: Some(monitor), told: Told::default() }
    }

    /// Says what has changed since the last call; to be called now and then, not from the servo thread.
    pub fn tell(&mut self, host: &Host) {
        match self.news() {
            Some(News::Gone(why)) => host.warn(&format!("no device: {why}; it is looked for until it is there")),
            Some(News::Back) => host.say("the device is there"),
            None => {}
        }
    }

    fn news(&mut self) -> Option<News> {
        let notes = self.monitor.as_ref()?.notes();
        self.told.change(notes.trouble)
    }
}

/// The trouble that was told last.
#[derive(Debug, Default)]
struct Told(Option<String>);

impl Told {
    fn change(&mut self, trouble: Option<String>) -> Option<News> {
        if trouble == self.0 {
            return None;
        }
        self.0.clone_from(&trouble);
        Some(trouble.map_or(News::Back, News::Gone))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn trouble_is_told_once_and_so_is_its_end() {
        let mut told = Told::default();
        let trouble = |text: &str| Some(text.to_owned());
        assert_eq!(told.change(None), None);
        assert_eq!(told.change(trouble("unplugged")), Some(News::Gone("unplugged".into())));
        assert_eq!(told.change(trouble("unplugged")), None);
        assert_eq!(told.change(trouble("no permission")), Some(News::Gone("no permission".into())));
        assert_eq!(told.change(None), Some(News::Back));
        assert_eq!(told.change(None), None);
        assert_eq!(DeviceWatch::default().news(), None);
    }
}
