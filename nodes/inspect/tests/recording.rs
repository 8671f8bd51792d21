//! What a scripted run leaves in a recording: entities, components, time lines, counts, layout, size.

mod support;

use inspect::{Feed, Options, Recorder, Sink, record_overview};
use rerun::StoreKind;
use rerun::log::Chunk;
use rerun::log::LogMsg;
use std::collections::BTreeMap;
use std::path::Path;
use std::process::Command;
use support::{PATIENCE, chunks, record};

/// Rows of an entity that carry `component`, and whether all have both time lines.
fn rows(chunks: &BTreeMap<String, Vec<Chunk>>, entity: &str, component: &str) -> usize {
    let of_entity = chunks.get(entity).unwrap_or_else(|| panic!("no entity {entity} among {:?}", chunks.keys()));
    let with = |chunk: &&Chunk| chunk.components_identifiers().any(|c| c.as_str() == component);
    let mut count = 0;
    for chunk in of_entity.iter().filter(with) {
        let names: Vec<&str> = chunk.timelines().keys().map(|name| name.as_str()).collect();
        assert!(chunk.is_static() || (names.contains(&"tick") && names.contains(&"robot_time")), "{entity}: {names:?}");
        count += chunk.num_rows();
    }
    count
}

#[test]
fn a_run_leaves_every_tick_and_thirty_frames_a_second() {
    let subject = support::peg_on_plate();
    let messages = record(&subject, &support::run(&subject, 2000));
    let chunks = chunks(&messages, StoreKind::Recording);
    for series in ["force_N", "torque_mNm", "depth_mm", "energy_mJ", "time_us"] {
        let entity = format!("/series/{series}");
        assert_eq!(rows(&chunks, &entity, "Scalars:scalars"), 2000, "{entity}");
        assert_eq!(rows(&chunks, &entity, "SeriesLines:names"), 1, "{entity}");
    }
    // 2 s: a frame every 34th tick.
    for entity in ["/physical_m/hand", "/physical_m/proxy"] {
        assert_eq!(rows(&chunks, entity, "Transform3D:translation"), 59, "{entity}");
    }
    for entity in ["/cspace_m/hip", "/cspace_m/scp", "/cspace_m/trail"] {
        assert_eq!(rows(&chunks, entity, "Points3D:positions"), 59, "{entity}");
    }
    for role in ["touching", "near", "local", "other"] {
        let entity = format!("/cspace_m/c_faces/{role}");
        assert!((1..=59).contains(&rows(&chunks, &entity, "Mesh3D:vertex_positions")), "{entity}");
    }
    for entity in ["/physical_m/obstacles/plate", "/physical_m/obstacles/wall", "/physical_m/proxy/peg"] {
        assert_eq!(rows(&chunks, entity, "Mesh3D:vertex_positions"), 1, "{entity}");
    }
    assert!(rows(&chunks, "/graph/applicability", "GraphNodes:node_ids") >= 1);
    assert!(rows(&chunks, "/graph/contact_states", "GraphEdges:edges") >= 1);
    assert!(rows(&chunks, "/state/formation", "StateChange:state") >= 3);
    // Two health events: the bad sample and its end.
    assert!(rows(&chunks, "/events", "TextLog:text") >= 4);
    assert_eq!(rows(&chunks, "/state/health", "StateChange:state"), 3);
}

#[test]
fn the_layout_travels_with_the_recording() {
    let subject = support::peg_on_plate();
    let messages = record(&subject, &support::run(&subject, 10));
    let layout = chunks(&messages, StoreKind::Blueprint);
    // Two spaces, the legend, five plots, the lanes, two graphs and the events.
    assert_eq!(views(&layout), 12);
    assert!(layout.contains_key("/viewport") && layout.contains_key("/time_panel"));
    assert!(
        messages.iter().any(|m| matches!(m, LogMsg::BlueprintActivationCommand(_))),
        "the layout is not made active"
    );
}

fn views(layout: &BTreeMap<String, Vec<Chunk>>) -> usize {
    layout.keys().filter(|path| path.starts_with("/view/") && path.matches('/').count() == 2).count()
}

#[test]
fn a_motion_that_was_not_timed_has_no_plot_of_times() {
    let subject = support::peg_on_plate();
    let mut ticks = support::run(&subject, 10);
    for tick in &mut ticks {
        (tick.wakeup_ns, tick.compute_ns) = (0, 0);
    }
    assert_eq!(views(&chunks(&record(&subject, &ticks), StoreKind::Blueprint)), 11);
}

#[test]
fn a_recording_without_a_tick_has_a_layout() {
    assert_eq!(views(&chunks(&record(&support::peg_on_plate(), &[]), StoreKind::Blueprint)), 12);
}

#[test]
fn numbers_that_are_not_finite_do_not_reach_the_pictures() {
    let subject = support::peg_on_plate();
    let mut ticks = support::run(&subject, 200);
    for tick in &mut ticks[50..150] {
        tick.hip.translation.x = f64::NAN;
        tick.out_wrench.force.y = f64::INFINITY;
    }
    let chunks = chunks(&record(&subject, &ticks), StoreKind::Recording);
    assert_eq!(rows(&chunks, "/series/force_N", "Scalars:scalars"), 200);
    assert_eq!(rows(&chunks, "/physical_m/hand", "Transform3D:translation"), 3);
}

#[test]
fn the_same_run_makes_the_same_rows() {
    let subject = support::peg_on_plate();
    let ticks = support::run(&subject, 1000);
    let count = |messages: &[LogMsg]| -> BTreeMap<String, usize> {
        let chunks = chunks(messages, StoreKind::Recording);
        chunks.into_iter().map(|(entity, chunks)| (entity, chunks.iter().map(Chunk::num_rows).sum())).collect()
    };
    assert_eq!(count(&record(&subject, &ticks)), count(&record(&subject, &ticks)));
}

/// Writes a run to a file; returns its size, bytes.
fn write(path: &Path, ticks: u64) -> u64 {
    let subject = support::peg_on_plate();
    let sink = Sink::File(path.into());
    let mut recorder = Recorder::new(subject.clone(), &sink, &Options::default()).expect("a folder of our own");
    for tick in support::run(&subject, ticks) {
        recorder.tick(&tick).expect("a finite record");
    }
    recorder.finish(PATIENCE).expect("the disk is quick");
    std::fs::metadata(path).expect("written").len()
}

#[test]
fn ten_minutes_stay_below_150_megabytes() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    // The hand moves and turns all the time: more polygons change than in a real run.
    let bytes = write(&folder.path().join("run.rrd"), 30_000);
    println!("30 s of motion: {bytes} bytes, so {:.1} MB in 10 minutes", bytes as f64 * 20.0 * 1e-6);
    assert!(bytes * 20 < 150_000_000, "30 s took {bytes} bytes");
}

#[test]
fn the_history_of_a_servo_fits_when_it_comes_at_once() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let subject = support::peg_on_plate();
    let ticks = support::run(&subject, 10_000);
    let sink = Sink::File(folder.path().join("run.rrd"));
    let mut feed = Feed::start(subject, &sink, &Options::default()).expect("a folder of our own");
    assert!(ticks.iter().all(|tick| feed.tick(tick)), "ten seconds of ticks");
    assert_eq!(feed.dropped(), 0);
    feed.finish(PATIENCE).expect("the disk is quick");
}

#[test]
fn files_pass_the_viewers_own_check() {
    let Some(rerun) = std::env::var_os("RERUN_CLI") else {
        println!("SKIPPED: RERUN_CLI does not name rerun's command line program; `cargo xtask test` sets it");
        return;
    };
    let folder = tempfile::tempdir().expect("a temporary folder");
    let (run, overview) = (folder.path().join("run.rrd"), folder.path().join("overview.rrd"));
    write(&run, 2000);
    record_overview(&support::peg_on_plate(), &Sink::File(overview.clone()), PATIENCE).expect("the disk is quick");
    for file in [&run, &overview] {
        for check in ["verify", "stats"] {
            let output = Command::new(&rerun).args(["rrd", check]).arg(file).output().expect("RERUN_CLI can be run");
            let text = String::from_utf8_lossy(&output.stderr);
            assert!(output.status.success(), "rerun rrd {check}: {text}");
        }
    }
}
