//! Bags that are cut off, flipped or empty: recovered as far as they are intact, never a panic.

mod support;

use bag::msg::TickBatch;
use bag::{BagInfo, BagOptions, BagReader, BagWriter, Compression, Qos, Ticks};
use rand::{RngExt, SeedableRng};
use servo::TickRecord;
use std::path::{Path, PathBuf};
use std::time::Duration;

/// Ticks a chunk holds here.
const CHUNK: usize = 25;

/// A bag of 200 ticks in eight chunks; its file and the ticks.
fn bag(dir: &Path, compression: Compression) -> (PathBuf, Vec<TickRecord>) {
    let path = dir.join("run");
    let ticks = support::ticks(200, 21);
    // Chunks end where the test says, not where a slow machine makes them.
    let options = BagOptions { compression, flush_interval: Duration::MAX, ..BagOptions::default() };
    let mut writer = BagWriter::create(&path, options).unwrap();
    let topic = writer.add::<TickBatch>("/s/ticks", &[Qos::RELIABLE]).unwrap();
    for chunk in ticks.chunks(CHUNK) {
        for tick in chunk {
            let batch = TickBatch { version: 1, ticks: vec![bag::tick_to_msg(tick)], ..TickBatch::default() };
            writer.write_message(topic, tick.input.stamp, &batch).unwrap();
        }
        writer.flush().unwrap();
    }
    writer.finish().unwrap();
    (path.join("run_0.mcap"), ticks)
}

/// Reads what there is; every tick that comes back must be one that was written, in order. How many came back?
fn recovered(file: &Path, written: &[TickRecord]) -> (usize, bool) {
    let Ok(reader) = BagReader::open(file) else { return (0, false) };
    let Ok(mut ticks) = Ticks::new(&reader, None) else { return (0, false) };
    let mut found = 0;
    let mut last = None;
    for tick in ticks.by_ref().filter_map(Result::ok) {
        let sequence = tick.input.sequence;
        assert_eq!(tick, written[sequence as usize]);
        assert!(last.is_none_or(|l| sequence > l), "tick {sequence} twice or out of order");
        last = Some(sequence);
        found += 1;
    }
    (found, ticks.damage().is_empty())
}

#[test]
fn a_bag_cut_off_anywhere_gives_back_all_chunks_before_the_cut() {
    for compression in [Compression::None, Compression::Zstd(1)] {
        let dir = tempfile::tempdir().unwrap();
        let (file, ticks) = bag(dir.path(), compression);
        let bytes = std::fs::read(&file).unwrap();
        let chunks = mcap::Summary::read(&bytes).unwrap().unwrap().chunk_indexes;
        let ends: Vec<u64> = chunks.iter().map(|c| c.chunk_start_offset + c.chunk_length).collect();
        let mut cuts: Vec<usize> = (0..bytes.len()).step_by(997).collect();
        // Around the ends of all records that matter, byte by byte.
        for &end in ends.iter().chain(&[0, 8, bytes.len() as u64 - 1]) {
            cuts.extend((end.saturating_sub(12)..(end + 12).min(bytes.len() as u64)).map(|c| c as usize));
        }
        for cut in cuts {
            let cut_off = dir.path().join("cut.mcap");
            std::fs::write(&cut_off, &bytes[..cut]).unwrap();
            let (found, unharmed) = recovered(&cut_off, &ticks);
            let whole = ends.iter().filter(|&&e| e <= cut as u64).count() * CHUNK;
            assert!(found >= whole, "cut at {cut}: {found} ticks, {whole} are in whole chunks");
            assert!(!unharmed, "cut at {cut}: nobody was told");
        }
    }
}

#[test]
fn a_thousand_flipped_bits_cost_at_most_a_chunk_each_and_never_a_panic() {
    for compression in [Compression::None, Compression::Zstd(1)] {
        let dir = tempfile::tempdir().unwrap();
        let (file, ticks) = bag(dir.path(), compression);
        let good = std::fs::read(&file).unwrap();
        let mut rng = rand_pcg::Pcg64Mcg::seed_from_u64(1000);
        for _ in 0..500 {
            let mut bytes = good.clone();
            let bit = rng.random_range(0..bytes.len() * 8);
            bytes[bit / 8] ^= 1 << (bit % 8);
            std::fs::write(&file, &bytes).unwrap();
            let (found, _) = recovered(&file, &ticks);
            // The channel and its schema stand in the first chunk and in the summary: one of them is always intact.
            assert!(found >= ticks.len() - CHUNK, "bit {bit}: {found} ticks");
        }
    }
}

#[test]
fn flipped_bits_in_index_and_summary_cost_nothing() {
    for compression in [Compression::None, Compression::Zstd(1)] {
        let dir = tempfile::tempdir().unwrap();
        let (file, ticks) = bag(dir.path(), compression);
        let good = std::fs::read(&file).unwrap();
        let chunks = mcap::Summary::read(&good).unwrap().unwrap().chunk_indexes;
        let last = chunks.iter().map(|c| c.chunk_start_offset + c.chunk_length).max().unwrap() as usize;
        let mut rng = rand_pcg::Pcg64Mcg::seed_from_u64(31);
        for _ in 0..500 {
            let mut bytes = good.clone();
            let bit = rng.random_range(last * 8..bytes.len() * 8);
            bytes[bit / 8] ^= 1 << (bit % 8);
            std::fs::write(&file, &bytes).unwrap();
            assert_eq!(recovered(&file, &ticks).0, ticks.len(), "bit {bit}, the last chunk ends at byte {last}");
            assert_eq!(BagInfo::read(&file).unwrap().messages(), ticks.len() as u64, "bit {bit}");
        }
    }
}

#[test]
fn many_flipped_bits_at_once_never_panic_and_never_give_a_wrong_tick() {
    let dir = tempfile::tempdir().unwrap();
    let (file, ticks) = bag(dir.path(), Compression::Zstd(1));
    let good = std::fs::read(&file).unwrap();
    let mut rng = rand_pcg::Pcg64Mcg::seed_from_u64(77);
    for round in 0..200 {
        let mut bytes = good.clone();
        for _ in 0..1 + round / 4 {
            let bit = rng.random_range(0..bytes.len() * 8);
            bytes[bit / 8] ^= 1 << (bit % 8);
        }
        std::fs::write(&file, &bytes).unwrap();
        recovered(&file, &ticks);
    }
}

#[test]
fn damaged_metadata_does_not_matter() {
    let dir = tempfile::tempdir().unwrap();
    let (file, ticks) = bag(dir.path(), Compression::Zstd(1));
    let folder = file.parent().unwrap();
    let metadata = folder.join("metadata.yaml");
    let good = std::fs::read(&metadata).unwrap();
    let mut rng = rand_pcg::Pcg64Mcg::seed_from_u64(5);
    for _ in 0..300 {
        let mut bytes = good.clone();
        let bit = rng.random_range(0..bytes.len() * 8);
        bytes[bit / 8] ^= 1 << (bit % 8);
        std::fs::write(&metadata, &bytes).unwrap();
        match BagReader::open(folder) {
            Ok(_) => assert_eq!(recovered(folder, &ticks).0, ticks.len()),
            // A bit in `storage_identifier: mcap` makes it another storage.
            Err(e) => assert!(e.to_string().contains("only MCAP is read"), "{e}"),
        }
    }
    std::fs::remove_file(&metadata).unwrap();
    assert_eq!(recovered(folder, &ticks), (ticks.len(), true));
}

#[test]
fn a_file_that_is_missing_is_named() {
    let dir = tempfile::tempdir().unwrap();
    let path = dir.path().join("run");
    let options = BagOptions { max_file_duration: Some(Duration::from_millis(50)), ..BagOptions::default() };
    let mut writer = BagWriter::create(&path, options).unwrap();
    let topic = writer.add::<TickBatch>("/s/ticks", &[Qos::RELIABLE]).unwrap();
    for tick in support::ticks(150, 6) {
        let batch = TickBatch { version: 1, ticks: vec![bag::tick_to_msg(&tick)], ..TickBatch::default() };
        writer.write_message(topic, tick.input.stamp, &batch).unwrap();
    }
    writer.finish().unwrap();
    let whole = BagInfo::read(&path).unwrap();
    assert!(whole.complete && whole.missing_files.is_empty() && whole.files.len() == 3);
    std::fs::remove_file(path.join("run_1.mcap")).unwrap();
    let rest = BagInfo::read(&path).unwrap();
    assert_eq!((rest.complete, rest.messages()), (false, 100));
    assert_eq!(rest.missing_files, ["run_1.mcap"]);
}

#[test]
fn empty_things_are_told_apart() {
    let dir = tempfile::tempdir().unwrap();
    let reason = |p: &Path| BagReader::open(p).unwrap_err().to_string();
    assert!(reason(&dir.path().join("none")).contains("cannot open the bag"));
    assert!(reason(dir.path()).ends_with("there is no .mcap file in this folder, so it is no bag"));

    std::fs::write(dir.path().join("x.db3"), b"SQLite format 3").unwrap();
    assert!(reason(dir.path()).contains("stored as sqlite3; only MCAP is read"));

    let file = dir.path().join("empty.mcap");
    std::fs::write(&file, b"").unwrap();
    let info = BagInfo::read(&file).unwrap();
    assert_eq!((info.messages(), info.complete, info.damage[0].what), (0, false, "the file is empty"));

    let path = dir.path().join("bag");
    BagWriter::create(&path, BagOptions::default()).unwrap().finish().unwrap();
    let info = BagInfo::read(&path).unwrap();
    assert_eq!((info.messages(), info.complete, info.damage.len()), (0, true, 0));
    let error = bag::read_ticks(&path, None).unwrap_err().to_string();
    assert!(error.ends_with("the bag has no topic of cspace_haptics_msgs/msg/TickBatch"), "{error}");
}
