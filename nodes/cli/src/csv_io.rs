//! Pose files: `t,x,y,z,qx,qy,qz,qw`.

use crate::failure::Failure;
use spatial::{DQuat, DVec3, Pose};
use std::path::Path;

/// The header of a pose file: seconds, metres, unit quaternion; the pose of A in W.
pub const POSE_HEADER: &str = "t,x,y,z,qx,qy,qz,qw";

/// A quaternion's norm may be off by this much (files with seven digits); it is normalised.
const NORM_TOLERANCE: f64 = 1e-6;

/// A pose and its time, s.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StampedPose {
    /// Seconds.
    pub t: f64,
    /// A in W.
    pub pose: Pose,
}

/// A text file as a whole; bytes that are not UTF-8 are refused with their line.
pub fn read_text(path: &Path) -> Result<String, Failure> {
    let bytes = std::fs::read(path).map_err(|e| Failure::file(path, format!("cannot be read: {e}")))?;
    String::from_utf8(bytes).map_err(|e| {
        let good = &e.as_bytes()[..e.utf8_error().valid_up_to()];
        let line = 1 + good.iter().filter(|b| **b == b'\n').count() as u64;
        Failure::line(path, line, "not a text file (bytes that are not UTF-8)")
    })
}

/// Reads a pose file; every error names its line.
pub fn read_poses(path: &Path) -> Result<Vec<StampedPose>, Failure> {
    parse_poses(&read_text(path)?).map_err(|(line, reason)| Failure::line(path, line, reason))
}

fn parse_poses(text: &str) -> Result<Vec<StampedPose>, (u64, String)> {
    let text = text.strip_prefix('\u{feff}').unwrap_or(text);
    let mut lines = text.lines().zip(1u64..);
    let header = lines.next().map_or("", |(l, _)| l);
    if !header.split(',').map(str::trim).eq(POSE_HEADER.split(',')) {
        return Err((1, format!("the header must be {POSE_HEADER}, it is {header:.60?}")));
    }
    let mut out: Vec<StampedPose> = Vec::new();
    let mut blank = None;
    for (line, number) in lines {
        if line.trim().is_empty() {
            blank.get_or_insert(number);
            continue;
        }
        if let Some(blank) = blank {
            return Err((blank, "an empty line between poses".into()));
        }
        let sample = parse_row(line).map_err(|reason| (number, reason))?;
        if let Some(last) = out.last()
            && sample.t < last.t
        {
            return Err((number, format!("time runs back from {:?} s to {:?} s", last.t, sample.t)));
        }
        out.push(sample);
    }
    if out.is_empty() {
        return Err((1, "no poses".into()));
    }
    Ok(out)
}

fn parse_row(line: &str) -> Result<StampedPose, String> {
    let mut values = [0.0f64; 8];
    let mut count = 0;
    for (i, field) in line.split(',').enumerate() {
        if let Some(slot) = values.get_mut(i) {
            let name = POSE_HEADER.split(',').nth(i).unwrap_or_default();
            let text = field.trim();
            *slot = text.parse().map_err(|_| format!("{name}: {text:.40?} is not a number"))?;
            if !slot.is_finite() {
                return Err(format!("{name}: {text:.40?} is not a finite number"));
            }
        }
        count = i + 1;
    }
    if count != 8 {
        return Err(format!("{count} fields instead of 8"));
    }
    let [t, x, y, z, qx, qy, qz, qw] = values;
    let rotation = DQuat::from_xyzw(qx, qy, qz, qw);
    let norm = rotation.length();
    if !((norm - 1.0).abs() <= NORM_TOLERANCE) {
        return Err(format!("the quaternion's norm is {norm:?}, not 1"));
    }
    let translation = DVec3::new(x, y, z);
    if translation.abs().max_element() > 1e12 {
        return Err("the position is more than 1e12 m away".into());
    }
    Ok(StampedPose { t, pose: with_unit_rotation(Pose::new(translation, rotation)) })
}

/// Files round: a rotation that is nearly one is made one, wherever the pose comes from.
pub fn with_unit_rotation(pose: Pose) -> Pose {
    Pose { rotation: pose.rotation * (1.0 / pose.rotation.length()), ..pose }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn reads_what_it_should() {
        let text = "\u{feff}t, x,y,z,qx,qy,qz,qw\r\n0,1,2,3,0,0,0,1\r\n0.5, -1e-3 ,0,0,0,0,1,0\r\n\r\n";
        let poses = parse_poses(text).unwrap();
        assert_eq!(poses.len(), 2);
        assert_eq!(poses[0].pose, Pose::new(DVec3::new(1.0, 2.0, 3.0), DQuat::IDENTITY));
        assert_eq!(poses[1].pose.translation.x, -1e-3);
    }

    #[test]
    fn errors_name_their_line() {
        let h = POSE_HEADER;
        for (text, line) in [
            (String::new(), 1),
            ("x,y\n".into(), 1),
            (format!("{h}\n"), 1),
            (format!("{h}\n0,0,0,0,0,0,0,1\n1,0,0\n"), 3),
            (format!("{h}\n0,0,0,0,0,0,0,1,9\n"), 2),
            (format!("{h}\n0,nan,0,0,0,0,0,1\n"), 2),
            (format!("{h}\n0,0,inf,0,0,0,0,1\n"), 2),
            (format!("{h}\n0,,0,0,0,0,0,1\n"), 2),
            (format!("{h}\n0,0,0,0,0,0,0,1.1\n"), 2),
            (format!("{h}\n0,0,0,0,0,0,0,0\n"), 2),
            (format!("{h}\n1,0,0,0,0,0,0,1\n0.9,0,0,0,0,0,0,1\n"), 3),
            (format!("{h}\n0,0,0,0,0,0,0,1\n\n1,0,0,0,0,0,0,1\n"), 3),
        ] {
            assert_eq!(parse_poses(&text).unwrap_err().0, line, "{text:?}");
        }
    }
}
