//! What goes into a bag comes out of it, bit for bit, and other readers agree.

mod support;

use bag::msg::{ContactState, LocalCSpace, Message, PoseStamped, ServoHealth, TickBatch, TickRecord};
use bag::{BagOptions, BagReader, BagWriter, Catalog, Compression, Qos, cdr, read_poses, read_ticks, write_ticks};
use spatial::{DVec3, Pose, Stamp};
use std::time::Duration;

#[test]
fn ticks_come_back_bit_for_bit() {
    let dir = tempfile::tempdir().unwrap();
    let path = dir.path().join("run");
    let ticks = support::ticks(500, 1);
    write_ticks(&path, &support::scene(), &support::configuration(), &ticks).unwrap();
    let log = read_ticks(&path, None).unwrap();
    assert_eq!(log.ticks, ticks);
    assert_eq!((log.missing, log.damage.len()), (0, 0));
    let scene = log.scene.unwrap();
    assert_eq!((scene.yaml, scene.files), (support::scene().yaml, support::scene().files));
    assert_eq!(log.configuration.unwrap().yaml, support::configuration().yaml);
}

#[test]
fn the_same_ticks_make_the_same_bytes_however_long_it_takes() {
    let dir = tempfile::tempdir().unwrap();
    let ticks = support::ticks(500, 8);
    let bytes = |name: &str, pause: Duration| {
        let path = dir.path().join(name).join("run");
        let slow = ticks.iter().inspect(|t| {
            if t.input.sequence == 250 {
                std::thread::sleep(pause);
            }
        });
        write_ticks(&path, &support::scene(), &support::configuration(), slow).unwrap();
        ["run_0.mcap", "metadata.yaml"].map(|file| std::fs::read(path.join(file)).unwrap())
    };
    let longer_than_a_recorder_waits = BagOptions::default().flush_interval * 2;
    assert!(bytes("quick", Duration::ZERO) == bytes("slow", longer_than_a_recorder_waits));
}

#[test]
fn numbers_that_are_not_numbers_come_back_too() {
    let mut tick = support::ticks(1, 2)[0];
    tick.input.gains.proxy_speed = f64::INFINITY;
    tick.input.sample.pose.translation = DVec3::new(f64::NAN, -0.0, f64::NEG_INFINITY);
    let message = bag::tick_to_msg(&tick);
    let bytes = cdr::encode(&message).unwrap();
    let back = bag::tick_from_msg(&cdr::decode::<TickRecord>(&bytes).unwrap()).unwrap();
    let bits = |p: Pose| p.translation.to_array().map(f64::to_bits);
    assert_eq!(bits(back.input.sample.pose), bits(tick.input.sample.pose));
    assert_eq!(back.input.gains.proxy_speed, f64::INFINITY);
}

#[test]
fn the_crate_mcap_reads_the_same_messages() {
    let dir = tempfile::tempdir().unwrap();
    let ticks = support::ticks(300, 3);
    for (name, compression) in [("packed", Compression::Zstd(1)), ("plain", Compression::None)] {
        let path = dir.path().join(name);
        let options = BagOptions { compression, chunk_size: 30_000, ..BagOptions::default() };
        let mut writer = BagWriter::create(&path, options).unwrap();
        let topic = writer.add::<TickBatch>("/s/ticks", &[Qos::RELIABLE]).unwrap();
        for tick in &ticks {
            let batch = TickBatch { ticks: vec![bag::tick_to_msg(tick)], version: 1, ..TickBatch::default() };
            writer.write_message(topic, tick.input.stamp, &batch).unwrap();
        }
        writer.finish().unwrap();
        let bytes = std::fs::read(path.join(format!("{name}_0.mcap"))).unwrap();
        let summary = mcap::Summary::read(&bytes).unwrap().unwrap();
        assert_eq!(summary.stats.as_ref().unwrap().message_count, 300);
        assert!(summary.chunk_indexes.len() > 3, "{} chunks", summary.chunk_indexes.len());
        let mut seen = 0;
        for (message, tick) in mcap::MessageStream::new(&bytes).unwrap().zip(&ticks) {
            let message = message.unwrap();
            assert_eq!((message.channel.topic.as_str(), message.log_time), ("/s/ticks", tick.input.stamp.0 as u64));
            let batch: TickBatch = cdr::decode(&message.data).unwrap();
            assert_eq!(bag::tick_from_msg(&batch.ticks[0]).unwrap(), *tick);
            seen += 1;
        }
        assert_eq!(seen, 300);
        // Through the index, as players do.
        for chunk in &summary.chunk_indexes {
            let indexed: usize = summary.read_message_indexes(&bytes, chunk).unwrap().values().map(Vec::len).sum();
            assert_eq!(indexed, summary.stream_chunk(&bytes, chunk).unwrap().count());
        }
    }
}

#[test]
fn a_bag_written_by_the_crate_mcap_is_read() {
    let dir = tempfile::tempdir().unwrap();
    for (name, compression, chunked) in [
        ("zstd.mcap", Some(mcap::Compression::Zstd), true),
        ("lz4.mcap", Some(mcap::Compression::Lz4), true),
        ("plain.mcap", None, true),
        ("loose.mcap", None, false),
    ] {
        let path = dir.path().join(name);
        let options = mcap::WriteOptions::new().compression(compression).profile("ros2").use_chunks(chunked);
        let mut writer = options.create(std::fs::File::create(&path).unwrap()).unwrap();
        let schema = writer.add_schema(PoseStamped::NAME, "ros2msg", b"").unwrap();
        let channel = writer.add_channel(schema, "/hand/pose", "cdr", &Default::default()).unwrap();
        let poses: Vec<PoseStamped> = (0..50)
            .map(|i| {
                let mut pose = PoseStamped::default();
                pose.header.stamp = Stamp(support::EPOCH + i * 1_000_000).into();
                pose.pose.position.x = i as f64;
                pose
            })
            .collect();
        for (i, pose) in poses.iter().enumerate() {
            let header = mcap::records::MessageHeader {
                channel_id: channel,
                sequence: i as u32,
                log_time: i as u64,
                publish_time: i as u64,
            };
            writer.write_to_known_channel(&header, &cdr::encode(pose).unwrap()).unwrap();
        }
        writer.finish().unwrap();
        let log = read_poses(&path, None).unwrap();
        assert_eq!((log.topic.as_str(), log.poses.len(), log.damage.len()), ("/hand/pose", 50, 0), "{name}");
        for (i, (stamp, pose)) in log.poses.iter().enumerate() {
            assert_eq!((stamp.0, pose.translation.x), (support::EPOCH + i as i64 * 1_000_000, i as f64), "{name}");
        }
    }
}

#[test]
fn files_are_split_by_size_and_by_time() {
    let dir = tempfile::tempdir().unwrap();
    let ticks = support::ticks(400, 4);
    let by_size = BagOptions { max_file_size: Some(40_000), chunk_size: 10_000, ..BagOptions::default() };
    let by_time = BagOptions { max_file_duration: Some(Duration::from_millis(100)), ..BagOptions::default() };
    for (name, options, files) in [("size", by_size, 3..40), ("time", by_time, 4..5)] {
        let path = dir.path().join(name);
        let mut writer = BagWriter::create(&path, options).unwrap();
        let topic = writer.add::<TickBatch>("/s/ticks", &[Qos::RELIABLE]).unwrap();
        for tick in &ticks {
            let batch = TickBatch { ticks: vec![bag::tick_to_msg(tick)], version: 1, ..TickBatch::default() };
            writer.write_message(topic, tick.input.stamp, &batch).unwrap();
        }
        writer.finish().unwrap();
        let reader = BagReader::open(&path).unwrap();
        assert!(files.contains(&reader.files().count()), "{name}: {} files", reader.files().count());
        assert!(reader.is_complete());
        assert_eq!(reader.promised_messages(), Some(400));
        assert_eq!(read_ticks(&path, None).unwrap().ticks, ticks);
    }
}

#[test]
fn an_unfinished_bag_is_complete_up_to_the_last_flush() {
    let dir = tempfile::tempdir().unwrap();
    let path = dir.path().join("run");
    let ticks = support::ticks(20, 5);
    let mut writer = BagWriter::create(&path, BagOptions::default()).unwrap();
    assert!(BagReader::open(&path).unwrap().is_complete());
    let topic = writer.add::<TickBatch>("/s/ticks", &[Qos::RELIABLE]).unwrap();
    for (i, tick) in ticks.iter().enumerate() {
        let batch = TickBatch { ticks: vec![bag::tick_to_msg(tick)], version: 1, ..TickBatch::default() };
        writer.write_message(topic, tick.input.stamp, &batch).unwrap();
        writer.flush().unwrap();
        let reader = BagReader::open(&path).unwrap();
        assert!(reader.is_complete());
        assert_eq!(reader.promised_messages(), Some(i as u64 + 1));
        assert_eq!(reader.messages().count(), i + 1);
        let bytes = std::fs::read(path.join("run_0.mcap")).unwrap();
        assert_eq!(mcap::Summary::read(&bytes).unwrap().unwrap().stats.unwrap().message_count, i as u64 + 1);
    }
}

/// The structures here must have the fields of the .msg files in their order, else other readers see garbage.
#[test]
fn structures_follow_the_definitions() {
    fn check<M: Message + Default>() {
        let json = serde_json::to_string(&M::default()).unwrap();
        let file = M::NAME.rsplit('/').next().unwrap();
        let text =
            std::fs::read_to_string(format!("{}/../../msgs/msg/{file}.msg", env!("CARGO_MANIFEST_DIR"))).unwrap();
        let fields = bag::parse_fields(M::NAME, &text).unwrap();
        let value: serde_json::Map<String, serde_json::Value> = serde_json::from_str(&json).unwrap();
        assert_eq!(value.len(), fields.len(), "{}", M::NAME);
        let mut rest = json.as_str();
        for field in &fields {
            let key = format!("\"{}\":", field.name);
            let at =
                rest.find(&key).unwrap_or_else(|| panic!("{}: {} is missing or out of order", M::NAME, field.name));
            rest = &rest[at + key.len()..];
        }
    }
    check::<bag::msg::BasicContact>();
    check::<bag::msg::CFace>();
    check::<bag::msg::ContactPoint>();
    check::<ContactState>();
    check::<bag::msg::DeviceSample>();
    check::<bag::msg::Gains>();
    check::<LocalCSpace>();
    check::<bag::msg::PrincipalContact>();
    check::<bag::msg::SceneDescription>();
    check::<bag::msg::SceneFile>();
    check::<bag::msg::ServoConfiguration>();
    check::<ServoHealth>();
    check::<TickBatch>();
    check::<TickRecord>();
}

#[test]
fn an_unknown_type_and_a_folder_in_use_are_refused_with_the_reason() {
    let error = Catalog::built_in().describe("no_such/msg/Thing").unwrap_err().to_string();
    assert!(error.starts_with("no_such/msg/Thing: this type is not known"), "{error}");
    let dir = tempfile::tempdir().unwrap();
    let error = BagWriter::create(dir.path(), BagOptions::default()).unwrap_err().to_string();
    assert!(error.ends_with("exists already; name a new folder for the bag"), "{error}");
}

#[test]
fn log_times_never_run_back_when_the_clock_does() {
    let dir = tempfile::tempdir().unwrap();
    let path = dir.path().join("run");
    let mut writer = BagWriter::create(&path, BagOptions::default()).unwrap();
    let topic = writer.add::<bag::msg::Text>("/t", &[Qos::RELIABLE]).unwrap();
    let clock = [5, 6, 2, 3, 7];
    for (i, time) in clock.into_iter().enumerate() {
        let text = bag::msg::Text { data: i.to_string() };
        writer.write_message(topic, Stamp(time), &text).unwrap();
    }
    writer.finish().unwrap();
    let bytes = std::fs::read(path.join("run_0.mcap")).unwrap();
    let times: Vec<_> =
        mcap::MessageStream::new(&bytes).unwrap().map(|m| m.unwrap()).map(|m| (m.log_time, m.publish_time)).collect();
    assert_eq!(times, [(5, 5), (6, 6), (6, 2), (6, 3), (7, 7)]);
}
