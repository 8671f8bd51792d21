//! A ROS domain of our own.

use anyhow::{Context, Result, bail};
use std::fs::File;
use std::net::{Ipv4Addr, UdpSocket};

/// Domains whose ports lie below the system's ephemeral ones, but for 0, where everybody else is.
const DOMAINS: std::ops::RangeInclusive<u16> = 1..=101;

/// A domain that nobody else uses, held against other demos and tests until dropped.
pub struct Domain {
    /// `ROS_DOMAIN_ID`.
    pub id: u16,
    _lock: File,
}

/// Takes the domain `wanted`, or any free one.
///
/// # Errors
/// The wanted one is out of range or in use, or all are.
pub fn take(wanted: Option<u16>) -> Result<Domain> {
    if let Some(id) = wanted {
        if !DOMAINS.contains(&id) {
            bail!("--domain {id}: out of range {} .. {}", DOMAINS.start(), DOMAINS.end());
        }
        return try_take(id)?
            .with_context(|| format!("--domain {id}: in use; choose another, or none to have a free one chosen"));
    }
    let count = DOMAINS.end() - DOMAINS.start() + 1;
    // Different processes begin at different places, so that they seldom meet.
    let begin = (std::process::id() % u32::from(count)) as u16;
    for step in 0..count {
        let id = DOMAINS.start() + (begin + step * 37) % count;
        if let Some(domain) = try_take(id)? {
            return Ok(domain);
        }
    }
    bail!("no ROS domain from {} to {} is free", DOMAINS.start(), DOMAINS.end())
}

fn try_take(id: u16) -> Result<Option<Domain>> {
    let path = std::env::temp_dir().join(format!("cspace-haptics-domain-{id}.lock"));
    // A lock file of another user cannot be opened: then the domain is not ours either.
    let Ok(lock) = File::options().create(true).append(true).open(&path) else { return Ok(None) };
    if lock.try_lock().is_err() {
        return Ok(None);
    }
    Ok(is_silent(id).then_some(Domain { id, _lock: lock }))
}

/// Whether no participant holds the ports of the domain (DDSI-RTPS 9.6.1.1: 7400 + 250 domain + 10 + 2 participant).
fn is_silent(id: u16) -> bool {
    let base = 7400 + 250 * id;
    (0..8).all(|participant| UdpSocket::bind((Ipv4Addr::UNSPECIFIED, base + 10 + 2 * participant)).is_ok())
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::sync::Mutex;

    /// One test at a time: the domain that one has just left would be the other's next.
    static TURN: Mutex<()> = Mutex::new(());

    #[test]
    fn a_domain_is_taken_once() {
        let _turn = TURN.lock();
        let first = take(None).unwrap();
        assert!(take(Some(first.id)).is_err());
        let second = take(None).unwrap();
        assert_ne!(first.id, second.id);
        let id = first.id;
        drop(first);
        assert_eq!(take(Some(id)).unwrap().id, id);
    }

    #[test]
    fn a_domain_with_a_participant_is_in_use() {
        let _turn = TURN.lock();
        let mut domain = take(None).unwrap();
        let id = domain.id;
        let _participant = UdpSocket::bind((Ipv4Addr::LOCALHOST, 7410 + 250 * id)).unwrap();
        domain.id = 0;
        drop(domain);
        let error = take(Some(id)).err().unwrap().to_string();
        assert!(error.contains("in use"), "{error}");
    }

    #[test]
    fn a_domain_out_of_range_is_refused() {
        assert!(take(Some(0)).is_err());
        assert!(take(Some(102)).is_err());
    }
}
