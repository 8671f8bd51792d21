use bag::contact_to_msg;
use bag::msg::{ContactState, Header, PrincipalContact};
use haptics::{ContactPoint, FormationKind};
use servo::TickRecord;
use spatial::Stamp;

/// `ContactState.EVENT_*`.
const ONGOING: u8 = 0;
const BEGIN: u8 = 1;
const END: u8 = 2;

/// A pair of convex pieces and the principal contact between them.
type PairKind = (u32, u32, FormationKind);

/// Follows the contact state from tick to tick and says when one begins and ends. A state must last before it counts:
/// chattering between two of them is no new state.
#[derive(Debug)]
pub struct ContactEvents {
    frame_id: String,
    debounce_ns: i64,
    state: Option<State>,
    candidate: Option<(Vec<PairKind>, Stamp)>,
    index: u64,
}

#[derive(Debug)]
struct State {
    pairs: Vec<PairKind>,
    begin: Stamp,
    message: ContactState,
    ticks: u64,
    force_sum: f64,
    torque_sum: f64,
}

impl ContactEvents {
    /// States shorter than `debounce` seconds are not told.
    #[must_use]
    pub fn new(frame_id: &str, debounce: f64) -> Self {
        Self {
            frame_id: frame_id.to_owned(),
            debounce_ns: (debounce * 1e9) as i64,
            state: None,
            candidate: None,
            index: 0,
        }
    }

    /// Takes a tick in; gives the end of the old state and the begin of the new one when a new one is confirmed.
    pub fn add(&mut self, tick: &TickRecord) -> Vec<ContactState> {
        let now = tick.input.stamp;
        let pairs = pairs(tick);
        let mut told = Vec::new();
        if self.state.as_ref().is_some_and(|s| s.pairs == pairs) {
            self.candidate = None;
        } else {
            let since = match &self.candidate {
                Some((waiting, since)) if *waiting == pairs => *since,
                _ => now,
            };
            if self.state.is_none() || now.0 - since.0 >= self.debounce_ns {
                if let Some(old) = self.state.take() {
                    told.push(old.told(END, now, since));
                    self.index += 1;
                }
                let new = State::new(pairs, since, self.index, &self.frame_id);
                told.push(new.told_with(BEGIN, tick));
                self.state = Some(new);
                self.candidate = None;
            } else {
                self.candidate = Some((pairs, since));
            }
        }
        if let Some(state) = &mut self.state {
            state.count(tick);
        }
        told
    }

    /// The present state.
    #[must_use]
    pub fn ongoing(&self, tick: &TickRecord) -> Option<ContactState> {
        self.state.as_ref().map(|s| s.told_with(ONGOING, tick))
    }
}

impl State {
    fn new(pairs: Vec<PairKind>, begin: Stamp, index: u64, frame_id: &str) -> Self {
        let kind = pairs.iter().map(|p| p.2).max().unwrap_or_default();
        let principal_contacts = pairs
            .iter()
            .map(|&(part_a, piece_b, kind)| PrincipalContact {
                part_a,
                piece_b,
                kind: kind as u8,
                features: format!("part {part_a} - piece {piece_b}: {}", kind.name()),
            })
            .collect();
        let message = ContactState {
            header: Header { stamp: begin.into(), frame_id: frame_id.to_owned() },
            index,
            kind: kind as u8,
            principal_contacts,
            begin: begin.into(),
            ..ContactState::default()
        };
        Self { pairs, begin, message, ticks: 0, force_sum: 0.0, torque_sum: 0.0 }
    }

    fn count(&mut self, tick: &TickRecord) {
        let m = &mut self.message;
        let (force, torque) = (tick.law_wrench.force.length(), tick.law_wrench.torque.length());
        self.ticks += 1;
        self.force_sum += force;
        self.torque_sum += torque;
        m.mean_force = self.force_sum / self.ticks as f64;
        m.mean_torque = self.torque_sum / self.ticks as f64;
        m.max_force = m.max_force.max(force);
        m.max_torque = m.max_torque.max(torque);
        m.depth = tick.depth;
        m.max_depth = m.max_depth.max(tick.depth);
        m.wrench = tick.law_wrench.into();
        m.work -= tick.law_wrench.power(&tick.twist) * tick.input.dt;
        m.contacts = tick.formation.points().iter().map(contact_to_msg).collect();
    }

    fn told(&self, event: u8, now: Stamp, until: Stamp) -> ContactState {
        let mut m = self.message.clone();
        m.header.stamp = now.into();
        m.event = event;
        m.duration = (until.0 - self.begin.0).max(0) as f64 * 1e-9;
        m
    }

    fn told_with(&self, event: u8, tick: &TickRecord) -> ContactState {
        let now = tick.input.stamp;
        let mut m = self.told(event, now, now);
        m.depth = tick.depth;
        m.wrench = tick.law_wrench.into();
        m.contacts = tick.formation.points().iter().map(contact_to_msg).collect();
        m
    }
}

/// The pairs that touch, in order, each with its principal contact.
fn pairs(tick: &TickRecord) -> Vec<PairKind> {
    let key = |p: &ContactPoint| (p.part_a, p.piece_b, p.kind);
    let mut pairs: Vec<PairKind> = tick.formation.points().iter().map(key).collect();
    pairs.sort_unstable();
    pairs.dedup();
    pairs
}
