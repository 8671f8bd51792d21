use crate::FeatureBook;
use crate::principal_contact::{PrincipalContact, principal_contacts};
use haptics::FormationKind;
use servo::TickRecord;
use servo::config::ContactsConfig;
use spatial::Stamp;

/// When a change of contact counts as one; a servo's parameters `contacts.*`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SegmentOptions {
    /// A state that lasts less is none, s.
    pub debounce: f64,
    /// A contact begins once it is this deep, metres; it ends when it is gone.
    pub min_depth: f64,
}

impl From<&ContactsConfig> for SegmentOptions {
    fn from(c: &ContactsConfig) -> Self {
        Self { debounce: c.debounce, min_depth: c.min_depth }
    }
}

impl Default for SegmentOptions {
    fn default() -> Self {
        Self::from(&ContactsConfig::default())
    }
}

/// A stretch of time in one contact state.
#[derive(Clone, Debug, PartialEq)]
pub struct Segment {
    /// Counts segments from 0.
    pub index: u64,
    /// Its first tick.
    pub begin: Stamp,
    /// The first tick behind it; of a segment that lasts, its newest tick.
    pub end: Stamp,
    /// The highest of the principal contacts.
    pub kind: FormationKind,
    /// The principal contacts in a fixed order: the state's name.
    pub contacts: Vec<PrincipalContact>,
    /// Force, torque, work, depth.
    pub statistics: Statistics,
}

impl Segment {
    /// The principal contacts as one text, `|` between them; `free` if there is none.
    #[must_use]
    pub fn label(&self) -> String {
        if self.contacts.is_empty() {
            return "free".to_owned();
        }
        self.contacts.iter().map(ToString::to_string).collect::<Vec<_>>().join("|")
    }

    /// Duration, s.
    #[must_use]
    pub fn duration(&self) -> f64 {
        (self.end.0 - self.begin.0) as f64 * 1e-9
    }
}

/// What a hand felt in a state; of the law's wrench, torque about A's origin.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Statistics {
    /// Ticks in the state.
    pub ticks: u64,
    /// Their time, s.
    pub time: f64,
    /// Integral of the force's norm, N.s; over `time` it is the mean.
    pub force_time: f64,
    /// Largest norm of the force, N.
    pub max_force: f64,
    /// Integral of the torque's norm, N.m.s.
    pub torque_time: f64,
    /// Largest norm of the torque, N.m.
    pub max_torque: f64,
    /// Largest depth, metres.
    pub max_depth: f64,
    /// Work that the hand has done against the wrench, J; `< 0` where the contact gave energy back.
    pub work: f64,
}

impl Statistics {
    /// Mean norm of the force over time, N.
    #[must_use]
    pub fn mean_force(&self) -> f64 {
        if self.time > 0.0 { self.force_time / self.time } else { 0.0 }
    }

    /// Mean norm of the torque over time, N.m.
    #[must_use]
    pub fn mean_torque(&self) -> f64 {
        if self.time > 0.0 { self.torque_time / self.time } else { 0.0 }
    }

    fn add(&mut self, tick: &TickRecord) {
        let (dt, wrench) = (tick.input.dt.max(0.0), &tick.law_wrench);
        let (force, torque) = (wrench.force.length(), wrench.torque.length());
        self.ticks += 1;
        self.time += dt;
        self.force_time += force * dt;
        self.torque_time += torque * dt;
        self.max_force = self.max_force.max(force);
        self.max_torque = self.max_torque.max(torque);
        self.max_depth = self.max_depth.max(tick.depth);
        self.work -= wrench.power(&tick.twist) * dt;
    }

    fn merge(&mut self, other: &Self) {
        self.ticks += other.ticks;
        self.time += other.time;
        self.force_time += other.force_time;
        self.torque_time += other.torque_time;
        self.max_force = self.max_force.max(other.max_force);
        self.max_torque = self.max_torque.max(other.max_torque);
        self.max_depth = self.max_depth.max(other.max_depth);
        self.work += other.work;
    }
}

/// A change of state that has been confirmed.
#[derive(Clone, Debug, PartialEq)]
pub struct Change {
    /// The state that is over; `None` at the very beginning.
    pub ended: Option<Segment>,
    /// The state that began, `debounce` ago.
    pub began: Segment,
}

/// Cuts a run into contact states while it goes on: a tick in, a confirmed change out.
///
/// A state counts once it was seen for the debounce time while the old one was not; it then begins where it was first seen.
/// What flickers for less than the debounce time belongs to the state that comes back: the old one, or the one that is
/// about to begin. What lies between an old state and the next belongs to none.
#[derive(Clone, Debug)]
pub struct Segmenter {
    options: SegmentOptions,
    book: Option<FeatureBook>,
    current: Option<Segment>,
    /// States seen since the current one was seen last, none of them longer ago than the debounce time.
    candidates: Vec<Segment>,
    /// The first tick that was not in the current state since it was seen last.
    left: Option<Stamp>,
    /// What happened since then, but for the candidates.
    between: Statistics,
    /// Contacts of the last tick.
    held: Vec<PrincipalContact>,
    next_index: u64,
}

impl Segmenter {
    /// A segmenter; with the scene's geometry faces that lie in one plane count as one.
    #[must_use]
    pub fn new(options: SegmentOptions, book: Option<FeatureBook>) -> Self {
        Self {
            options,
            book,
            current: None,
            candidates: Vec::new(),
            left: None,
            between: Statistics::default(),
            held: Vec::new(),
            next_index: 0,
        }
    }

    /// The state that lasts, if one was confirmed.
    #[must_use]
    pub fn current(&self) -> Option<&Segment> {
        self.current.as_ref()
    }

    /// Takes in the next tick.
    pub fn push(&mut self, tick: &TickRecord) -> Option<Change> {
        let contacts = self.contacts(tick);
        let stamp = tick.input.stamp;
        if let Some(current) = self.current.as_mut().filter(|c| c.contacts == contacts) {
            // Back again: what flickered was part of it.
            current.statistics.merge(&std::mem::take(&mut self.between));
            self.candidates.drain(..).for_each(|c| current.statistics.merge(&c.statistics));
            current.statistics.add(tick);
            current.end = stamp;
            self.left = None;
            return None;
        }
        self.left.get_or_insert(stamp);
        let at = self.candidate(contacts, stamp);
        let candidate = &mut self.candidates[at];
        candidate.statistics.add(tick);
        candidate.end = stamp;
        // A tick stands for its period; the tolerance keeps twenty ticks of 1 ms from being less than 20 ms.
        if candidate.statistics.time < self.options.debounce * (1.0 - 1e-9) {
            return None;
        }
        let mut began = self.candidates.swap_remove(at);
        began.index = self.next_index;
        // What flickered since it was first seen is part of it.
        let from = began.begin;
        let since = self.candidates.drain(..).filter(|c| c.begin >= from);
        since.for_each(|c| began.statistics.merge(&c.statistics));
        let ended = self.close();
        self.next_index += 1;
        self.current = Some(began.clone());
        Some(Change { ended, began })
    }

    /// The place of the candidate of these contacts, new if it was not seen lately.
    fn candidate(&mut self, contacts: Vec<PrincipalContact>, stamp: Stamp) -> usize {
        let (debounce, between) = (self.options.debounce, &mut self.between);
        self.candidates.retain(|c| {
            let lately = (stamp.0.saturating_sub(c.end.0)) as f64 * 1e-9 <= debounce;
            if !lately {
                between.merge(&c.statistics);
            }
            lately
        });
        if let Some(at) = self.candidates.iter().position(|c| c.contacts == contacts) {
            return at;
        }
        let kind = contacts.iter().map(|c| c.kind).max().unwrap_or_default();
        let statistics = Statistics::default();
        let index = self.next_index;
        self.candidates.push(Segment { index, begin: stamp, end: stamp, kind, contacts, statistics });
        self.candidates.len() - 1
    }

    /// Ends the run: the last state, if one was confirmed.
    pub fn finish(&mut self) -> Option<Segment> {
        self.candidates.clear();
        self.held.clear();
        self.close()
    }

    fn close(&mut self) -> Option<Segment> {
        self.between = Statistics::default();
        let left = self.left.take();
        self.current.take().map(|c| Segment { end: left.unwrap_or(c.end), ..c })
    }

    /// The principal contacts of a tick, debounced in depth: a new one needs a hand that is deep enough. (Not the depth of
    /// the contact by itself: laws that hold a proxy state distances at the proxy, where they vanish.)
    fn contacts(&mut self, tick: &TickRecord) -> Vec<PrincipalContact> {
        let rotations = [tick.proxy.rotation, tick.hip.rotation];
        let mut contacts = principal_contacts(&tick.formation, rotations, self.book.as_ref());
        if tick.depth < self.options.min_depth {
            contacts.retain(|c| self.held.contains(c));
        }
        self.held.clone_from(&contacts);
        contacts
    }
}

/// All segments of a run.
pub fn segments<'t>(
    ticks: impl IntoIterator<Item = &'t TickRecord>,
    options: SegmentOptions,
    book: Option<FeatureBook>,
) -> Vec<Segment> {
    let mut segmenter = Segmenter::new(options, book);
    let mut found: Vec<Segment> =
        ticks.into_iter().filter_map(|t| segmenter.push(t)).filter_map(|change| change.ended).collect();
    found.extend(segmenter.finish());
    found
}
