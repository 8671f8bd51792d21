//! kill -9 of a process that records: the bag opens and lacks at most the last second.

mod support;

use bag::msg::TickBatch;
use bag::{BagOptions, BagReader, BagWriter, Qos, Ticks};
use rand::{RngExt, SeedableRng};
use spatial::Stamp;
use std::io::{BufRead, BufReader};
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

const DIR: &str = "BAG_TEST_DIR";
const BATCH: u64 = 10;

/// Not a test by itself: the process that gets killed. Says after every batch how many ticks it has handed to the writer,
/// and when it began and ended to, ms by its own clock.
#[test]
#[ignore = "started by the test below"]
fn writer_process() {
    let Ok(dir) = std::env::var(DIR) else { return };
    let mut bag = BagWriter::create(dir.as_ref(), BagOptions::default()).unwrap();
    let topic = bag.add::<TickBatch>("/haptic_servo/ticks", &[Qos::RELIABLE]).unwrap();
    let template = support::ticks(1000, 7);
    let start = Instant::now();
    for batch in 0.. {
        let ticks: Vec<_> = (0..BATCH)
            .map(|i| {
                let mut tick = template[((batch * BATCH + i) % 1000) as usize];
                tick.input.sequence = batch * BATCH + i;
                bag::tick_to_msg(&tick)
            })
            .collect();
        let message = TickBatch { version: 1, ticks, ..TickBatch::default() };
        let stamp = Stamp(support::EPOCH + batch as i64 * 10_000_000);
        let began = start.elapsed().as_millis();
        bag.write_message(topic, stamp, &message).unwrap();
        println!("\nwritten {} {began} {}", (batch + 1) * BATCH, start.elapsed().as_millis());
        let next = Duration::from_millis(10) * (batch as u32 + 1);
        std::thread::sleep(next.saturating_sub(start.elapsed()));
    }
}

struct Killed(Child);

impl Drop for Killed {
    fn drop(&mut self) {
        let _ = self.0.kill();
        let _ = self.0.wait();
    }
}

/// Starts the writer, kills it after `life`, and tells the ticks it said it had written by then, and by one second before
/// its last write began.
///
/// That second is the writer's: what it loses is what it got since it last flushed, and neither it nor we can help it if
/// the machine lets it stand still before the kill.
fn killed_writer(dir: &std::path::Path, life: Duration) -> (u64, u64) {
    let mut child = Command::new(std::env::current_exe().unwrap())
        .args(["--exact", "writer_process", "--ignored", "--nocapture"])
        .env(DIR, dir)
        .stdout(Stdio::piped())
        .stderr(Stdio::null())
        .spawn()
        .unwrap();
    let out = BufReader::new(child.stdout.take().unwrap());
    let mut child = Killed(child);
    // Ticks, begin and end of each write, ms.
    let mut said: Vec<[u64; 3]> = Vec::new();
    let mut killed = false;
    for line in out.lines().map_while(Result::ok) {
        let Some(numbers) = line.strip_prefix("written ") else { continue };
        let numbers: Vec<u64> = numbers.split(' ').filter_map(|n| n.parse().ok()).collect();
        // The kill may cut the last line short.
        said.extend(<[u64; 3]>::try_from(numbers));
        if !killed && said.last().is_some_and(|[_, _, end]| u128::from(*end) >= life.as_millis()) {
            killed = true;
            child.0.kill().unwrap();
        }
    }
    assert!(killed, "the writer lives until it is killed");
    let [written, last_begun, _] = *said.last().unwrap();
    let second_before = said.iter().take_while(|[_, _, end]| end + 1000 <= last_begun).last().map_or(0, |s| s[0]);
    (written, second_before)
}

#[test]
fn a_killed_recorder_leaves_a_bag_that_lacks_at_most_the_last_second() {
    let dir = tempfile::tempdir().unwrap();
    let mut rng = rand_pcg::Pcg64Mcg::seed_from_u64(11);
    for i in 0..4 {
        let path = dir.path().join(format!("run{i}"));
        let (written, least) = killed_writer(&path, Duration::from_millis(rng.random_range(1200..2200)));
        let reader = BagReader::open(&path).unwrap();
        let mut ticks = Ticks::new(&reader, None).unwrap();
        let found = ticks.by_ref().map(Result::unwrap).count() as u64;
        assert_eq!(ticks.missing(), 0);
        // The kill may come between writing a batch and saying so.
        let most = written + BATCH;
        assert!((least..=most).contains(&found), "{found} of {written} ticks, {least} a second before");
        // A kill within the write itself is possible but needs tens of microseconds out of 400 ms.
        if reader.is_complete() {
            let bytes = std::fs::read(path.join(format!("run{i}_0.mcap"))).unwrap();
            assert_eq!(mcap::Summary::read(&bytes).unwrap().unwrap().stats.unwrap().message_count * 10, found);
        }
    }
}
