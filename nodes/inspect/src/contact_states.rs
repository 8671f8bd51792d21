use crate::palette;
use crate::subject::Subject;
use haptics::FormationKind;
use rerun::{GraphEdges, GraphNodes, RecordingStream, RecordingStreamResult};
use servo::TickRecord;
use std::collections::{BTreeMap, BTreeSet};

/// The graph of contact states of the run.
pub(crate) const CONTACT_STATES: &str = "/graph/contact_states";

/// A state counts once it has lasted this many ticks: chatter at an edge would make a graph of its own.
const SETTLED_TICKS: u32 = 20;
/// More states than this are not drawn: a graph that size says nothing.
const MAX_STATES: usize = 40;

/// Kind of the formation and the obstacles (by index) it is with.
type State = (FormationKind, Vec<u32>);

/// The contact states that a run went through, and the ways between them.
#[derive(Default)]
pub(crate) struct ContactStates {
    /// Every settled state with its column in its row and the time spent, s; the key orders the rows.
    states: BTreeMap<State, (usize, f64)>,
    ways: BTreeSet<(State, State)>,
    current: Option<State>,
    candidate: Option<(State, u32)>,
}

impl ContactStates {
    /// Takes a tick; logs the graph when the settled state changed. The stream's time is set.
    pub(crate) fn push(
        &mut self,
        stream: &RecordingStream,
        subject: &Subject,
        record: &TickRecord,
    ) -> RecordingStreamResult<()> {
        let state = state_of(subject, record);
        if self.current.as_ref() == Some(&state) {
            self.candidate = None;
            if let Some((_, seconds)) = self.states.get_mut(&state) {
                *seconds += record.input.dt;
            }
            return Ok(());
        }
        let ticks = match &self.candidate {
            Some((candidate, ticks)) if *candidate == state => ticks + 1,
            _ => 1,
        };
        if ticks < SETTLED_TICKS {
            self.candidate = Some((state, ticks));
            return Ok(());
        }
        self.candidate = None;
        self.settle(state, f64::from(ticks) * record.input.dt);
        self.log(stream, subject)
    }

    fn settle(&mut self, state: State, seconds: f64) {
        if !self.states.contains_key(&state) {
            if self.states.len() == MAX_STATES {
                return;
            }
            let column = self.states.keys().filter(|(kind, _)| *kind == state.0).count();
            self.states.insert(state.clone(), (column, 0.0));
        }
        if let Some((_, total)) = self.states.get_mut(&state) {
            *total += seconds;
        }
        if let Some(last) = self.current.replace(state.clone()) {
            self.ways.insert((last, state));
        }
    }

    fn log(&self, stream: &RecordingStream, subject: &Subject) -> RecordingStreamResult<()> {
        // One row per kind, free above and face-face below: reading down is going into contact.
        let rows: BTreeSet<FormationKind> = self.states.keys().map(|(kind, _)| *kind).collect();
        let mut nodes = Vec::new();
        for (state, (column, seconds)) in &self.states {
            let row = rows.iter().position(|kind| *kind == state.0).unwrap_or(0);
            let in_row = self.states.keys().filter(|(kind, _)| *kind == state.0).count();
            let position = [(*column as f32 - (in_row as f32 - 1.0) / 2.0) * 190.0, row as f32 * 80.0];
            let now = self.current.as_ref() == Some(state);
            let label = format!("{}{}\n{seconds:.2} s", if now { "▶ " } else { "" }, name(subject, state));
            let color = if now { palette::SCP } else { palette::FORMATIONS[state.0 as usize] };
            nodes.push((id(state), position, label, palette::ink(color)));
        }
        let drawn = GraphNodes::new(nodes.iter().map(|n| n.0.as_str()))
            .with_positions(nodes.iter().map(|n| n.1))
            .with_labels(nodes.iter().map(|n| n.2.as_str()))
            .with_colors(nodes.iter().map(|n| n.3));
        stream.log(CONTACT_STATES, &drawn)?;
        let ways: Vec<(String, String)> = self.ways.iter().map(|(from, to)| (id(from), id(to))).collect();
        stream.log(CONTACT_STATES, &GraphEdges::new(ways).with_directed_edges())
    }
}

fn state_of(subject: &Subject, record: &TickRecord) -> State {
    let fixed = &subject.world.fixed;
    let pieces = record.formation.points().iter().filter_map(|p| fixed.get(p.piece_b as usize));
    let obstacles: BTreeSet<u32> = pieces.map(|piece| piece.obstacle).collect();
    (record.formation.kind, obstacles.into_iter().collect())
}

fn name(subject: &Subject, (kind, obstacles): &State) -> String {
    let names = obstacles.iter().filter_map(|o| subject.world.fixed.iter().position(|f| f.obstacle == *o));
    let names: Vec<String> = names.map(|piece| subject.obstacle_name(piece)).collect();
    if names.is_empty() { kind.name().into() } else { format!("{}\n{}", kind.name(), names.join(", ")) }
}

fn id((kind, obstacles): &State) -> String {
    format!("{}:{obstacles:?}", kind.name())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ways_and_times_of_a_run() {
        let free = (FormationKind::Free, vec![]);
        let floor = (FormationKind::FaceFace, vec![0]);
        let mut states = ContactStates::default();
        states.settle(free.clone(), 0.5);
        states.settle(floor.clone(), 0.25);
        states.settle(free.clone(), 0.5);
        assert_eq!(states.states[&free].1, 1.0);
        assert_eq!(states.states[&floor].1, 0.25);
        assert_eq!(states.ways, BTreeSet::from([(free.clone(), floor.clone()), (floor, free)]));
    }
}
