use crate::msg::{Message, PoseStamped};
use crate::{BagError, BagReader, Damage, cdr};
use spatial::{Pose, Stamp};
use std::path::Path;

/// The poses of a bag.
#[derive(Clone, Debug, Default)]
pub struct PoseLog {
    /// The topic they come from.
    pub topic: String,
    /// When and where; ordered by time.
    pub poses: Vec<(Stamp, Pose)>,
    /// What of the bag could not be read.
    pub damage: Vec<Damage>,
}

/// Reads the poses (`geometry_msgs/msg/PoseStamped`) of anyone's bag in `dir`. `topic` chooses between several topics;
/// `None` if there is one, or one that ends in `/pose`. The time is that of the header, or that of recording if the header has none.
///
/// # Errors
/// If the bag cannot be opened, holds no poses or several topics of them, or a message is damaged.
pub fn read_poses(dir: &Path, topic: Option<&str>) -> Result<PoseLog, BagError> {
    let reader = BagReader::open(dir)?;
    let candidates = reader.topics_of(PoseStamped::NAME);
    let name = |i: usize| reader.topics()[i].name.as_str();
    let chosen: Vec<usize> = match topic {
        Some(t) => candidates.iter().copied().filter(|&i| name(i) == t).collect(),
        None if candidates.len() > 1 => candidates.iter().copied().filter(|&i| name(i).ends_with("/pose")).collect(),
        None => candidates.clone(),
    };
    let [chosen] = chosen[..] else {
        let names = candidates.iter().map(|&i| name(i)).collect::<Vec<_>>().join(", ");
        let reason = if candidates.is_empty() {
            reader.absent(&[PoseStamped::NAME])
        } else {
            match topic {
                Some(t) => format!("no poses on {t}; choose one of {names} (--topic)"),
                None => format!("the bag has poses on several topics; choose one of {names} (--topic)"),
            }
        };
        return Err(BagError::format(dir, reason));
    };
    let mut log = PoseLog { topic: name(chosen).to_owned(), ..PoseLog::default() };
    let mut messages = reader.messages();
    for message in messages.by_ref().filter(|m| m.topic == chosen) {
        let pose: PoseStamped = cdr::decode(&message.data)?;
        let header = Stamp::from(pose.header.stamp);
        let stamp = if header == Stamp::default() { message.stamp } else { header };
        log.poses.push((stamp, pose.pose.into()));
    }
    log.damage = messages.damage().to_vec();
    log.poses.sort_by_key(|(stamp, _)| *stamp);
    Ok(log)
}
