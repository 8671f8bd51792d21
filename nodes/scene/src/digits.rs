//! How far the digits of a file leave its vertices open.

use crate::Mesh;
use spatial::DVec3;

/// A vertex of a face lies at most this many steps of the file's last digit off its plane: it is rounded itself, by 0.87
/// at most, and so are those through which the plane was laid.
const STEPS: f64 = 4.0;
/// Fewer digits than these are somebody's own numbers, not rounded ones.
const LEAST_DIGITS: i32 = 5;

/// How far a vertex of the mesh may lie off the plane of a face for what its digits say, in their unit; `None` where the
/// coordinates are too short to be rounded ones.
pub fn left_open(mesh: &Mesh) -> Option<f64> {
    last_digit(&mesh.vertices).map(|step| STEPS * step)
}

/// The step of the last digit that the coordinates were written with, in their unit; `None` where they are too short to
/// be rounded ones.
fn last_digit(vertices: &[DVec3]) -> Option<f64> {
    let numbers = || vertices.iter().flat_map(|v| v.to_array()).filter(|x| *x != 0.0);
    let largest = numbers().fold(0.0, |most: f64, x| most.max(x.abs()));
    // Single precision, written in binary or with the nine digits that it takes.
    if numbers().all(|x| (x - f64::from(x as f32)).abs() <= 5.1e-9 * x.abs()) {
        return Some(largest * f64::from(f32::EPSILON));
    }
    let (mut decimals, mut digits) = (i32::MIN, 0);
    for x in numbers() {
        // `1.2345e-2`: the shortest text that reads back.
        let text = format!("{:e}", x.abs());
        let (mantissa, exponent) = text.split_once('e')?;
        let written = mantissa.len() as i32 - i32::from(mantissa.contains('.'));
        digits = digits.max(written);
        decimals = decimals.max(written - 1 - exponent.parse::<i32>().ok()?);
    }
    let leading = largest.log10().floor() as i32;
    // Files with a fixed number of decimals and files with a fixed number of digits: the coarser is what they agree on.
    (digits >= LEAST_DIGITS).then(|| 10f64.powi((-decimals).max(leading + 1 - digits)))
}
