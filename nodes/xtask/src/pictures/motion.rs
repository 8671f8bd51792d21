//! Motions of a hand through key poses, as the CSV that `cspace-haptics replay` reads.

use anyhow::{Context, Result};
use std::fmt::Write;
use std::fs;
use std::path::Path;

/// Ticks a second.
const RATE: u32 = 1000;

/// Where the hand is at a time; it comes to rest there.
#[derive(Clone, Copy, Debug)]
pub struct Key {
    /// Seconds from the beginning.
    pub time: f64,
    /// Origin of A in W, millimetres.
    pub position: [f64; 3],
    /// Rotation of A in W: axis times angle, degrees.
    pub rotation: [f64; 3],
}

/// A key in one line.
pub const fn key(time: f64, position: [f64; 3], rotation: [f64; 3]) -> Key {
    Key { time, position, rotation }
}

/// Writes the poses `t,x,y,z,qx,qy,qz,qw` (seconds, metres) of a motion through `keys`, whose times rise.
///
/// # Errors
/// The file cannot be written.
pub fn write_csv(path: &Path, keys: &[Key]) -> Result<()> {
    let mut csv = String::from("t,x,y,z,qx,qy,qz,qw\n");
    let end = keys.last().map_or(0.0, |key| key.time);
    let ticks = (end * f64::from(RATE)).round() as u32;
    for tick in 0..=ticks {
        let time = f64::from(tick) / f64::from(RATE);
        let [x, y, z, qx, qy, qz, qw] = pose(keys, time);
        writeln!(csv, "{time},{x},{y},{z},{qx},{qy},{qz},{qw}").context("a string takes everything")?;
    }
    fs::write(path, csv).with_context(|| format!("{}: cannot write", path.display()))
}

/// Position in metres and unit quaternion at a time.
fn pose(keys: &[Key], time: f64) -> [f64; 7] {
    let after = keys.iter().position(|key| time <= key.time).unwrap_or(keys.len() - 1);
    let (a, b) = (keys[after.saturating_sub(1)], keys[after]);
    let u = if b.time > a.time { ((time - a.time) / (b.time - a.time)).clamp(0.0, 1.0) } else { 1.0 };
    // From rest to rest.
    let u = u * u * (3.0 - 2.0 * u);
    let between = |a: [f64; 3], b: [f64; 3]| [0, 1, 2].map(|i| a[i] + (b[i] - a[i]) * u);
    let [x, y, z] = between(a.position, b.position).map(|p| p / 1000.0);
    let vector = between(a.rotation, b.rotation).map(f64::to_radians);
    let angle = vector.iter().map(|v| v * v).sum::<f64>().sqrt();
    let scale = if angle < 1e-12 { 0.5 } else { (angle / 2.0).sin() / angle };
    let [qx, qy, qz] = vector.map(|v| v * scale);
    [x, y, z, qx, qy, qz, (angle / 2.0).cos()]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn passes_through_its_keys() {
        let keys = [key(0.0, [1.0, 2.0, 3.0], [0.0; 3]), key(1.0, [3.0, 2.0, 1.0], [0.0, 0.0, 90.0])];
        let half = std::f64::consts::FRAC_1_SQRT_2;
        let close = |a: [f64; 7], b: [f64; 7]| a.iter().zip(b).all(|(a, b)| (a - b).abs() < 1e-12);
        assert!(close(pose(&keys, 0.0), [0.001, 0.002, 0.003, 0.0, 0.0, 0.0, 1.0]));
        assert!(close(pose(&keys, 1.0), [0.003, 0.002, 0.001, 0.0, 0.0, half, half]));
        assert!(close(pose(&keys, 9.0), pose(&keys, 1.0)));
        assert!((pose(&keys, 0.5)[0] - 0.002).abs() < 1e-12);
    }
}
