use crate::{Failure, Outcome};
use spatial::{DQuat, DVec3, Pose};
use std::path::Path;

const HEADER: &str = "t,x,y,z,qx,qy,qz,qw";

/// Poses to replay, with their times in seconds: a bag's folder, or a CSV file with the header `t,x,y,z,qx,qy,qz,qw`
/// (s, m, unit quaternion).
///
/// # Errors
/// The file and line that is at fault, and why.
pub fn read_pose_file(name: &str) -> Outcome<Vec<(f64, Pose)>> {
    if name.is_empty() {
        return Err(Failure::new("parameter `device.file` is not set: name a pose CSV file or a bag to replay"));
    }
    let path = Path::new(name);
    if path.is_dir() {
        let log = bag::read_poses(path, None).map_err(|e| Failure::new(e.to_string()))?;
        let start = log.poses.first().map_or(0, |(t, _)| t.0);
        return Ok(log.poses.iter().map(|(t, pose)| ((t.0 - start) as f64 * 1e-9, *pose)).collect());
    }
    let text = std::fs::read_to_string(path).map_err(|e| Failure::new(format!("{name}: {e}")))?;
    parse(name, &text)
}

fn parse(name: &str, text: &str) -> Outcome<Vec<(f64, Pose)>> {
    let mut lines = text.lines().enumerate();
    if lines.next().map(|(_, l)| l.trim()) != Some(HEADER) {
        return Err(Failure::new(format!("{name}:1: the header must be {HEADER}")));
    }
    lines
        .filter(|(_, line)| !line.trim().is_empty())
        .map(|(i, line)| row(line).map_err(|e| Failure::new(format!("{name}:{}: {e}", i + 1))))
        .collect()
}

fn row(line: &str) -> Result<(f64, Pose), String> {
    let numbers = line
        .split(',')
        .map(|field| field.trim().parse::<f64>().map_err(|_| format!("`{}` is not a number", field.trim())))
        .collect::<Result<Vec<_>, _>>()?;
    let [t, x, y, z, qx, qy, qz, qw] = numbers[..] else {
        return Err(format!("{} fields, need 8", numbers.len()));
    };
    let pose = Pose::new(DVec3::new(x, y, z), DQuat::from_xyzw(qx, qy, qz, qw));
    if !t.is_finite() || !pose.is_valid() {
        return Err("not finite, or the quaternion is not of unit length".into());
    }
    Ok((t, pose))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn reads_rows_and_names_the_line_at_fault() {
        let good = format!("{HEADER}\n0,0,0,1,0,0,0,1\n\n0.5,1,2,3,0,0,1,0\n");
        assert_eq!(parse("p", &good).unwrap()[1].0, 0.5);
        for (bad, reason) in [
            ("t,x\n", "p:1"),
            ("", "p:1"),
            (&format!("{HEADER}\n0,0,0,0,0,0,0\n"), "p:2: 7 fields"),
            (&format!("{HEADER}\n0,0,0,0,0,0,0,2\n"), "p:2: not finite"),
            (&format!("{HEADER}\n0,0,x,0,0,0,0,1\n"), "p:2: `x`"),
        ] {
            assert!(parse("p", bad).unwrap_err().to_string().contains(reason), "{bad:?}");
        }
    }
}
