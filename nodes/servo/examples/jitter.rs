//! Wake-up latency of the servo loop beside `cyclictest` (Debian: rt-tests), in turns, on the same machine and in the
//! same minute: `cargo run --release -p servo --example jitter -- [SECONDS] [SCENE.yaml]`.

use device::{OperatorConfig, SimulatedOperator};
use realtime::{LatencyHistogram, LatencySummary};
use servo::{Commands, Config, LoopConfig, LoopStatus, Tick, operator_plan, spawn};
use std::error::Error;
use std::path::Path;
use std::process::Command;
use std::time::Duration;

const TURNS: u32 = 4;

fn main() -> Result<(), Box<dyn Error>> {
    let mut args = std::env::args().skip(1);
    let seconds: u32 = args.next().map_or(Ok(20), |s| s.parse())?;
    let scene = args.next().unwrap_or_else(|| "config/scenes/peg_in_hole/scene.yaml".into());
    let turn_s = (seconds / TURNS).max(1);
    for rate_hz in [1000.0, 4000.0] {
        let (mut peer, mut peer_late) = (LatencyHistogram::new(), 0);
        let mut own = Vec::new();
        for _ in 0..TURNS {
            peer_late += cyclictest(rate_hz, turn_s, &mut peer)?;
            own.push(servo_loop(rate_hz, turn_s, Path::new(&scene))?);
        }
        report(rate_hz, &peer.summary(), peer_late, &own);
    }
    Ok(())
}

fn servo_loop(rate_hz: f64, seconds: u32, scene: &Path) -> Result<LoopStatus, Box<dyn Error>> {
    let scene = scene::Scene::load(scene)?;
    let plan = operator_plan(&scene.world).ok_or("the scene is empty")?;
    let mut config = Config::default();
    config.realtime.rate = rate_hz;
    let mut tick = Tick::new(&scene, &config);
    let operator = Box::new(SimulatedOperator::new(OperatorConfig::default(), plan)?);
    let on = Commands { enabled: true, ..Commands::default() };
    let settings = LoopConfig { rate_hz, ..LoopConfig::default() };
    let mut servo = spawn(operator, move |input| tick.step(input), on, &settings)?;
    if !servo.handle.grants().all_granted() {
        println!("{}", servo.handle.grants());
    }
    for _ in 0..seconds * 50 {
        std::thread::sleep(Duration::from_millis(20));
        while servo.records.pop().is_some() {}
        while servo.pictures.pop().is_some() {}
    }
    Ok(servo.handle.join()?)
}

/// Adds `cyclictest`'s histogram to `into`; how many wake-ups were late by a period or more.
fn cyclictest(rate_hz: f64, seconds: u32, into: &mut LatencyHistogram) -> Result<u64, Box<dyn Error>> {
    let period_us = (1e6 / rate_hz) as u64;
    let interval = period_us.to_string();
    let duration = format!("{seconds}s");
    let output = Command::new("cyclictest")
        .args(["-q", "-m", "-p", "80", "-t", "1", "-i", &interval, "-D", &duration, "-h", "50000"])
        .output()
        .map_err(|e| format!("cyclictest: {e} (Debian: apt install rt-tests)"))?;
    let mut late = 0;
    for line in String::from_utf8(output.stdout)?.lines().filter(|l| !l.starts_with('#')) {
        let mut words = line.split_whitespace().map(str::parse::<u64>);
        if let (Some(Ok(us)), Some(Ok(count))) = (words.next(), words.next()) {
            (0..count).for_each(|_| into.record(us * 1000));
            late += if us >= period_us { count } else { 0 };
        }
    }
    Ok(late)
}

fn report(rate_hz: f64, peer: &LatencySummary, peer_late: u64, own: &[LoopStatus]) {
    let merged = |part: fn(&LoopStatus) -> &LatencyHistogram| {
        let mut all = LatencyHistogram::new();
        own.iter().for_each(|status| all.add(part(status)));
        all.summary()
    };
    let (wakeup, compute) = (merged(|s| &s.wakeup), merged(|s| &s.compute));
    let late: u64 = own.iter().map(|s| s.late_ticks).sum();
    println!("{rate_hz} Hz");
    println!("  wake-up, cyclictest   {peer}; late by a period or more: {peer_late}");
    println!("  wake-up, servo loop   {wakeup}; late by a period or more: {late}");
    println!("  wake-up to wrench     {compute}");
    println!(
        "  servo / cyclictest    p50 {:.2}, p99 {:.2}, p99.9 {:.2}",
        wakeup.p50_ns as f64 / peer.p50_ns as f64,
        wakeup.p99_ns as f64 / peer.p99_ns as f64,
        wakeup.p999_ns as f64 / peer.p999_ns as f64
    );
}
