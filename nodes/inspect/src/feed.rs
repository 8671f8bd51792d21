use crate::{InspectError, Options, Recorder, Sink, Subject};
use servo::TickRecord;
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::mpsc::{Receiver, RecvTimeoutError, Sender, channel};
use std::time::Duration;

/// Records that wait at most: the ten seconds at 1 kHz that a servo tells to whoever joins late, and six more. They take
/// memory only while they wait.
const QUEUE: usize = 16_384;

/// A [`Recorder`] on a thread of its own. Who feeds it never waits: a record that finds the queue full is dropped and
/// counted, so a viewer that is absent, slow or stopped holds up nothing.
pub struct Feed {
    queue: Option<Sender<TickRecord>>,
    /// How many records are in the queue.
    waiting: Arc<AtomicUsize>,
    done: Receiver<Result<(), InspectError>>,
    sink: String,
    dropped: u64,
}

impl Feed {
    /// Opens the sink and starts the thread.
    ///
    /// # Errors
    /// As [`Recorder::new`].
    pub fn start(subject: Subject, sink: &Sink, options: &Options) -> Result<Self, InspectError> {
        let recorder = Recorder::new(subject, sink, options)?;
        let (queue, records) = channel();
        let (report, done) = channel();
        let waiting = Arc::new(AtomicUsize::new(0));
        let waiting_in = Arc::clone(&waiting);
        std::thread::Builder::new()
            .name("inspect".into())
            .spawn(move || {
                // The receiver may have given up waiting: then there is nobody to tell.
                let _ = report.send(run(recorder, &records, &waiting_in));
            })
            .map_err(|e| InspectError::Thread { reason: e.to_string() })?;
        Ok(Self { queue: Some(queue), waiting, done, sink: sink.name(), dropped: 0 })
    }

    /// Hands over one record. False if it was dropped.
    pub fn tick(&mut self, record: &TickRecord) -> bool {
        // A lone counter: the queue itself publishes the records, so relaxed is enough. Only this side adds to it.
        let room = self.waiting.load(Ordering::Relaxed) < QUEUE;
        self.waiting.fetch_add(usize::from(room), Ordering::Relaxed);
        let taken = room && self.queue.as_ref().is_some_and(|queue| queue.send(*record).is_ok());
        self.dropped += u64::from(!taken);
        taken
    }

    /// Records dropped so far.
    #[must_use]
    pub fn dropped(&self) -> u64 {
        self.dropped
    }

    /// Ends the recording and waits for it, `timeout` at most; then the thread is left to itself.
    ///
    /// # Errors
    /// The first error of the recording, or that it was not taken in time.
    pub fn finish(mut self, timeout: Duration) -> Result<(), InspectError> {
        self.queue = None;
        match self.done.recv_timeout(timeout) {
            Ok(result) => result,
            Err(RecvTimeoutError::Timeout) => {
                Err(InspectError::Flush { sink: self.sink, reason: "the viewer does not answer".into() })
            }
            Err(RecvTimeoutError::Disconnected) => {
                Err(InspectError::Flush { sink: self.sink, reason: "its thread ended".into() })
            }
        }
    }
}

fn run(mut recorder: Recorder, records: &Receiver<TickRecord>, waiting: &AtomicUsize) -> Result<(), InspectError> {
    let mut first_error = None;
    while let Ok(record) = records.recv() {
        waiting.fetch_sub(1, Ordering::Relaxed);
        if let Err(error) = recorder.tick(&record) {
            first_error.get_or_insert(error);
        }
    }
    let finished = recorder.finish(Duration::from_secs(5));
    first_error.map_or(finished, Err)
}
