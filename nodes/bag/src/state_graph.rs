use crate::Segment;
use std::collections::BTreeMap;
use std::fmt::Write as _;

/// The contact states that a set of runs has visited, and the transitions between them.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct StateGraph {
    /// States by their label.
    pub states: BTreeMap<String, State>,
    /// Transitions, from and to, with their counts.
    pub transitions: BTreeMap<(String, String), u64>,
    /// Runs added.
    pub runs: u64,
}

/// A node of the graph.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct State {
    /// Formation of the whole body, as CSV files name it.
    pub formation: &'static str,
    /// How often it was entered.
    pub visits: u64,
    /// Runs that begin in it.
    pub begins: u64,
    /// Runs that end in it.
    pub ends: u64,
    /// Time spent in it, s.
    pub time: f64,
    /// Time integral of the force's norm, N.s.
    pub force_time: f64,
    /// Largest force, N.
    pub max_force: f64,
}

impl State {
    /// Mean norm of the force, N.
    #[must_use]
    pub fn mean_force(&self) -> f64 {
        if self.time > 0.0 { self.force_time / self.time } else { 0.0 }
    }
}

impl StateGraph {
    /// Adds a run.
    pub fn add(&mut self, segments: &[Segment]) {
        self.runs += 1;
        for (i, segment) in segments.iter().enumerate() {
            let state = self.states.entry(segment.label()).or_default();
            let s = &segment.statistics;
            state.formation = segment.kind.name();
            state.visits += 1;
            state.begins += u64::from(i == 0);
            state.ends += u64::from(i + 1 == segments.len());
            state.time += s.time;
            state.force_time += s.force_time;
            state.max_force = state.max_force.max(s.max_force);
        }
        for pair in segments.windows(2) {
            *self.transitions.entry((pair[0].label(), pair[1].label())).or_default() += 1;
        }
    }

    /// The graph for Graphviz.
    #[must_use]
    pub fn to_dot(&self) -> String {
        let quote = |text: &str| serde_json::Value::from(text).to_string();
        let mut dot = String::from("digraph contact_states {\n  rankdir=LR;\n  node [shape=box];\n");
        for (label, s) in &self.states {
            let text = format!(
                "{}\n{}\n{} visits, {:.3} s, {:.3} N",
                s.formation,
                label.replace('|', "\n"),
                s.visits,
                s.time,
                s.mean_force()
            );
            let _ = writeln!(dot, "  {} [label={}];", quote(label), quote(&text));
        }
        for ((from, to), count) in &self.transitions {
            let _ = writeln!(dot, "  {} -> {} [label=\"{count}\"];", quote(from), quote(to));
        }
        dot.push_str("}\n");
        dot
    }

    /// The graph as JSON: `runs`, `states` and `transitions`.
    #[must_use]
    pub fn to_json(&self) -> String {
        let states: Vec<_> = self
            .states
            .iter()
            .map(|(label, s)| {
                serde_json::json!({
                    "state": label, "formation": s.formation, "visits": s.visits, "begins": s.begins, "ends": s.ends,
                    "time_s": s.time, "mean_force_n": s.mean_force(), "max_force_n": s.max_force,
                })
            })
            .collect();
        let transitions: Vec<_> = self
            .transitions
            .iter()
            .map(|((from, to), count)| serde_json::json!({"from": from, "to": to, "count": count}))
            .collect();
        let graph = serde_json::json!({"runs": self.runs, "states": states, "transitions": transitions});
        format!("{graph:#}\n")
    }
}
