//! Throws random and mutated HID reports at the SpaceMouse decoder, as long as asked:
//! `cargo run --release -p device --example fuzz_reports -- [SECONDS] [SEED]`. A panic or a broken property ends it.

use device::spacemouse::Report;
use rand::{Rng, RngExt, SeedableRng};
use rand_pcg::Pcg64;
use std::time::{Duration, Instant};

/// Sound reports of both formats, to be mutated.
const CORPUS: [&[u8]; 5] = [
    &[1, 0x5e, 1, 0xa2, 0xfe, 0, 0],
    &[2, 0, 0, 0x9c, 0xff, 0x64, 0],
    &[1, 0x5e, 1, 0xa2, 0xfe, 0, 0, 5, 0, 0xfb, 0xff, 0, 0],
    &[3, 2, 0, 0, 0x80],
    &[0x17, 0x5b, 0],
];

fn main() {
    let mut args = std::env::args().skip(1).map(|a| a.parse::<u64>().expect("seconds and seed are whole numbers"));
    let seconds = args.next().unwrap_or(10);
    let seed = args.next().unwrap_or(1);
    let mut rng = Pcg64::seed_from_u64(seed);
    let (start, mut sound, mut garbage) = (Instant::now(), 0u64, 0u64);
    let mut bytes = Vec::new();
    while start.elapsed() < Duration::from_secs(seconds) {
        for _ in 0..100_000 {
            make(&mut bytes, &mut rng);
            match Report::decode(&bytes) {
                Ok(report) => {
                    check(&report, &bytes);
                    sound += 1;
                }
                Err(refused) => {
                    assert!(refused.length == bytes.len() && (bytes.is_empty() || bytes[0] <= 3), "{bytes:02x?}");
                    garbage += 1;
                }
            }
        }
    }
    println!("seed {seed}: {sound} reports decoded, {garbage} refused, none broke in {seconds} s");
}

fn make(bytes: &mut Vec<u8>, rng: &mut Pcg64) {
    bytes.clear();
    if rng.random::<bool>() {
        bytes.extend_from_slice(CORPUS[rng.next_u32() as usize % CORPUS.len()]);
        for _ in 0..rng.next_u32() % 4 {
            let at = rng.next_u32() as usize % bytes.len();
            bytes[at] = rng.next_u32() as u8;
        }
        let length = rng.next_u32() as usize % (bytes.len() + 4);
        bytes.resize(length, rng.next_u32() as u8);
    } else {
        bytes.resize(rng.next_u32() as usize % 70, 0);
        rng.fill_bytes(bytes);
        if let Some(id) = bytes.first_mut() {
            *id %= 5;
        }
    }
}

/// What was decoded says the same bytes again.
fn check(report: &Report, bytes: &[u8]) {
    let said: Vec<u8> = match report {
        Report::Translation(axes) | Report::Rotation(axes) => axes.iter().flat_map(|a| a.to_le_bytes()).collect(),
        Report::Motion(axes) => axes.iter().flat_map(|a| a.to_le_bytes()).collect(),
        Report::Buttons(mask) => mask.to_le_bytes()[..(bytes.len() - 1).min(4)].to_vec(),
        Report::Other(id) => {
            assert_eq!(*id, bytes[0]);
            return;
        }
    };
    assert_eq!(said, bytes[1..=said.len()], "{report:?}");
}
