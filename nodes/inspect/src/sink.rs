use crate::InspectError;
use rerun::{RecordingStream, RecordingStreamBuilder};
use std::path::PathBuf;
use std::time::Duration;

/// The application id of every recording: viewers keep one layout per application.
pub(crate) const APPLICATION: &str = "cspace_haptics";

/// Where a recording goes.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Sink {
    /// An `.rrd` file.
    File(PathBuf),
    /// A running viewer, here or on another machine: `HOST:PORT` or `rerun+http://HOST:PORT/proxy`.
    Viewer(String),
}

impl Sink {
    /// Opens it. A file is created at once, so that a path that cannot be written is an error before any work is done;
    /// a viewer need not be there.
    pub(crate) fn open(&self) -> Result<RecordingStream, InspectError> {
        match self {
            Self::File(path) => {
                let failed = |reason: String| InspectError::File { path: path.clone(), reason };
                // rerun reports a bad path late and on its own thread.
                std::fs::File::create(path).map_err(|e| failed(e.to_string()))?;
                // Few large chunks: a chunk costs 1 to 2 kB of description in the file.
                let stream = builder(Duration::from_secs(2)).save(path);
                stream.map_err(|e| failed(e.to_string()))
            }
            Self::Viewer(address) => {
                let failed = |reason: String| InspectError::Address { address: address.clone(), reason };
                let stream = builder(Duration::from_millis(30)).connect_grpc_opts(proxy_url(address)?);
                stream.map_err(|e| failed(e.to_string()))
            }
        }
    }

    /// Whether it could be opened as it is written, before anything is sent: the address of a viewer has a port. A file is
    /// tried by opening it.
    ///
    /// # Errors
    /// It is no address.
    pub fn check(&self) -> Result<(), InspectError> {
        match self {
            Self::File(_) => Ok(()),
            Self::Viewer(address) => proxy_url(address).map(|_| ()),
        }
    }

    /// Its name in messages.
    pub(crate) fn name(&self) -> String {
        match self {
            Self::File(path) => path.display().to_string(),
            Self::Viewer(address) => address.clone(),
        }
    }

    /// The most bytes a second that C-face polygons may take; see `Budget`.
    pub(crate) fn polygon_bytes_per_second(&self) -> f64 {
        match self {
            Self::File(_) => 45e3,
            Self::Viewer(_) => 4e6,
        }
    }

    /// Frames of the two 3D views a second of robot time.
    pub(crate) fn frames_per_second(&self) -> f64 {
        match self {
            Self::File(_) => 30.0,
            Self::Viewer(_) => 60.0,
        }
    }
}

pub(crate) fn builder(flush_tick: Duration) -> RecordingStreamBuilder {
    let batcher = rerun::log::ChunkBatcherConfig { flush_tick, ..rerun::log::ChunkBatcherConfig::DEFAULT };
    RecordingStreamBuilder::new(APPLICATION).batcher_config(batcher)
}

fn proxy_url(address: &str) -> Result<String, InspectError> {
    let refuse = |reason: &str| Err(InspectError::Address { address: address.into(), reason: reason.into() });
    if address.contains("://") {
        return Ok(address.into());
    }
    match address.rsplit_once(':') {
        Some((host, port)) if !host.is_empty() && port.parse::<u16>().is_ok_and(|p| p > 0) => {
            Ok(format!("rerun+http://{address}/proxy"))
        }
        _ => refuse("no port"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_address_is_a_host_and_a_port_or_a_url() {
        assert_eq!(proxy_url("127.0.0.1:9876").unwrap(), "rerun+http://127.0.0.1:9876/proxy");
        assert_eq!(proxy_url("rerun+http://lab:1/proxy").unwrap(), "rerun+http://lab:1/proxy");
        for bad in ["", "lab", ":9876", "lab:", "lab:0", "lab:99999"] {
            assert!(proxy_url(bad).is_err(), "{bad} was taken");
            assert!(Sink::Viewer(bad.into()).check().is_err(), "{bad} was taken");
        }
    }

    #[test]
    fn a_path_that_cannot_be_written_is_refused_at_once() {
        let error = Sink::File("/nonexistent/folder/a.rrd".into()).open().unwrap_err().to_string();
        assert!(error.starts_with("/nonexistent/folder/a.rrd: cannot write"), "{error}");
    }
}
