use bag::msg::{ContactState, Header, PrincipalContact};
use bag::{FeatureBook, Segment, SegmentOptions, Segmenter, contact_to_msg};
use cspace::World;
use servo::{Config, TickRecord};
use spatial::Stamp;

/// `ContactState.EVENT_*`.
const ONGOING: u8 = 0;
const BEGIN: u8 = 1;
const END: u8 = 2;

/// Tells when a contact state begins and ends: the same segmentation that cuts a bag afterwards, so that what is seen
/// live and what is found offline agree.
#[derive(Debug)]
pub struct ContactEvents {
    frame_id: String,
    segmenter: Segmenter,
}

impl ContactEvents {
    /// For the features of a world.
    #[must_use]
    pub fn new(config: &Config, world: &World) -> Self {
        let options = SegmentOptions::from(&config.contacts);
        let segmenter = Segmenter::new(options, Some(FeatureBook::new(world)));
        Self { frame_id: config.frame_id.clone(), segmenter }
    }

    /// Takes a tick in; gives the end of the old state and the begin of the new one when a new one is confirmed. The
    /// begin comes last: it is the newest that a late joiner is given.
    pub fn add(&mut self, tick: &TickRecord) -> Vec<ContactState> {
        let Some(change) = self.segmenter.push(tick) else { return Vec::new() };
        let ended = change.ended.as_ref().map(|s| self.message(END, s, s.end, tick));
        ended.into_iter().chain([self.message(BEGIN, &change.began, tick.input.stamp, tick)]).collect()
    }

    /// The end of the present state, because the servo ends with tick `last`.
    pub fn finish(&mut self, last: &TickRecord) -> Option<ContactState> {
        self.segmenter.finish().map(|s| self.message(END, &s, s.end, last))
    }

    /// The present state.
    #[must_use]
    pub fn ongoing(&self, tick: &TickRecord) -> Option<ContactState> {
        self.segmenter.current().map(|s| self.message(ONGOING, s, tick.input.stamp, tick))
    }

    fn message(&self, event: u8, segment: &Segment, until: Stamp, tick: &TickRecord) -> ContactState {
        let s = &segment.statistics;
        let principal = |c: &bag::PrincipalContact| PrincipalContact {
            part_a: c.part_a,
            piece_b: c.piece_b,
            kind: c.kind as u8,
            features: c.features(),
        };
        ContactState {
            header: Header { stamp: tick.input.stamp.into(), frame_id: self.frame_id.clone() },
            event,
            index: segment.index,
            kind: segment.kind as u8,
            principal_contacts: segment.contacts.iter().map(principal).collect(),
            contacts: tick.formation.points().iter().map(contact_to_msg).collect(),
            begin: segment.begin.into(),
            duration: (until.0 - segment.begin.0).max(0) as f64 * 1e-9,
            depth: tick.depth,
            max_depth: s.max_depth,
            wrench: tick.law_wrench.into(),
            mean_force: s.mean_force(),
            max_force: s.max_force,
            mean_torque: s.mean_torque(),
            max_torque: s.max_torque,
            work: s.work,
        }
    }
}
