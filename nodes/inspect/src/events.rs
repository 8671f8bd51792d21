use crate::palette;
use crate::subject::Subject;
use haptics::{ContactFormation, FormationKind};
use rerun::archetypes::{StateChange, StateConfiguration};
use rerun::{RecordingStream, RecordingStreamResult, TextLog, TextLogLevel};
use servo::{Health, TickRecord};

/// Log of contact formations and health.
pub(crate) const EVENTS: &str = "/events";
/// Lane of the contact formation.
pub(crate) const FORMATION: &str = "/state/formation";
/// Lane of the health.
pub(crate) const HEALTH: &str = "/state/health";

const KINDS: [FormationKind; 5] = [
    FormationKind::Free,
    FormationKind::VertexFace,
    FormationKind::EdgeEdge,
    FormationKind::EdgeFace,
    FormationKind::FaceFace,
];

/// What happened, when: one line and one state at every change.
#[derive(Default)]
pub(crate) struct Events {
    formation: Option<String>,
    kind: Option<FormationKind>,
    health: Option<Health>,
}

impl Events {
    pub(crate) fn open(stream: &RecordingStream) -> RecordingStreamResult<Self> {
        let colors = palette::FORMATIONS.map(palette::solid);
        let states = StateConfiguration::new().with_values(KINDS.map(FormationKind::name)).with_colors(colors);
        stream.log_static(FORMATION, &states)?;
        Ok(Self::default())
    }

    /// Logs what changed since the last call. The stream's time is set.
    pub(crate) fn push(
        &mut self,
        stream: &RecordingStream,
        subject: &Subject,
        record: &TickRecord,
    ) -> RecordingStreamResult<()> {
        // While nothing touches there is nothing to describe: no string is made.
        let unchanged = self.kind == Some(FormationKind::Free) && record.formation.kind == FormationKind::Free;
        if !unchanged {
            let formation = describe(subject, &record.formation);
            if self.formation.as_ref() != Some(&formation) {
                let level =
                    if record.formation.kind == FormationKind::Free { TextLogLevel::DEBUG } else { TextLogLevel::INFO };
                let color = palette::ink(palette::FORMATIONS[record.formation.kind as usize]);
                stream.log(EVENTS, &TextLog::new(formation.as_str()).with_level(level).with_color(color))?;
                self.formation = Some(formation);
            }
        }
        if self.kind != Some(record.formation.kind) {
            stream.log(FORMATION, &StateChange::single(record.formation.kind.name()))?;
            self.kind = Some(record.formation.kind);
        }
        if self.health != Some(record.health) {
            let (text, level) = health_line(record.health);
            // Good health from the start is no event.
            if self.health.is_some() || record.health != Health::GOOD {
                stream.log(EVENTS, &TextLog::new(format!("health: {text}")).with_level(level))?;
            }
            stream.log(HEALTH, &StateChange::single(text))?;
            self.health = Some(record.health);
        }
        Ok(())
    }
}

fn health_line(health: Health) -> (String, &'static str) {
    let level = if health.any(Health::ZERO_FORCE) {
        TextLogLevel::ERROR
    } else if health == Health::GOOD {
        TextLogLevel::INFO
    } else {
        TextLogLevel::WARN
    };
    (health.to_string(), level)
}

/// The formation and the obstacles it is with: `face-face with plate (4 contacts)`.
pub(crate) fn describe(subject: &Subject, formation: &ContactFormation) -> String {
    let mut with: Vec<String> = Vec::new();
    for point in formation.points() {
        let piece = point.piece_b as usize;
        if piece < subject.world.fixed.len() {
            let name = subject.obstacle_name(piece);
            if !with.contains(&name) {
                with.push(name);
            }
        }
    }
    with.sort_unstable();
    match formation.points().len() {
        0 => formation.kind.name().into(),
        1 => format!("{} with {} (1 contact)", formation.kind.name(), with.join(", ")),
        n => format!("{} with {} ({n} contacts)", formation.kind.name(), with.join(", ")),
    }
}
