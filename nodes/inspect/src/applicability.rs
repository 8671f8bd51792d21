use crate::palette;
use crate::slice::{PairSlice, Role};
use crate::subject::Subject;
use cspace::{BasicContact, CFacePolygon};
use glam::DVec3;
use rerun::{GraphEdges, GraphNodes, RecordingStream, RecordingStreamResult, Rgba32};

/// The applicability subgraph of the pair nearest to `x` (paper, Figure 3).
pub(crate) const APPLICABILITY: &str = "/graph/applicability";

/// Radii of the innermost ring, in the view's units. Labels are wider than high, and the view folds them when it is
/// zoomed out.
const RING: [f32; 2] = [115.0, 46.0];

/// Draws the applicability subgraph. Remembers what is drawn.
#[derive(Default)]
pub(crate) struct ApplicabilityGraph {
    drawn: Option<Vec<(String, Role)>>,
}

impl ApplicabilityGraph {
    /// Logs the graph of the nearest pair when its nodes or their roles changed. The stream's time is set.
    pub(crate) fn frame(
        &mut self,
        stream: &RecordingStream,
        subject: &Subject,
        slices: &[PairSlice],
    ) -> RecordingStreamResult<()> {
        let touches = |s: &PairSlice| s.roles.contains(&Role::Touching);
        let nearest = slices
            .iter()
            .min_by(|p, q| touches(q).cmp(&touches(p)).then(p.distance.abs().total_cmp(&q.distance.abs())));
        let Some(pair) = nearest else { return Ok(()) };
        let title = format!("{} / {}", subject.moving_name(pair.part), subject.piece_name(pair.piece));
        let mut shown: Vec<(String, Role)> = pair.faces.iter().map(label).zip(pair.roles.iter().copied()).collect();
        shown.push((title, Role::Other));
        if self.drawn.as_ref() == Some(&shown) {
            return Ok(());
        }
        let places = map(&pair.faces, pair.near);
        let top = places.iter().map(|p| p[1]).fold(0.0, f32::min);
        let mut ids: Vec<String> = (0..pair.faces.len()).map(|i| format!("n{i}")).collect();
        let mut labels: Vec<&str> = shown.iter().map(|(text, _)| text.as_str()).collect();
        let mut colors: Vec<Rgba32> = pair.roles.iter().map(|role| palette::ink(color(*role))).collect();
        let mut positions = places;
        ids.push("title".into());
        colors.push(palette::ink(palette::PLAIN));
        positions.push([0.0, top - 30.0]);
        labels.truncate(ids.len());
        let nodes = GraphNodes::new(ids.iter().map(String::as_str))
            .with_positions(positions)
            .with_labels(labels)
            .with_colors(colors);
        stream.log(APPLICABILITY, &nodes)?;
        let mut edges = Vec::new();
        for i in 0..pair.faces.len() {
            for j in i + 1..pair.faces.len() {
                if pair.faces[i].is_neighbor(&pair.faces[j]) {
                    edges.push((ids[i].as_str(), ids[j].as_str()));
                }
            }
        }
        stream.log(APPLICABILITY, &GraphEdges::new(edges).with_undirected_edges())?;
        self.drawn = Some(shown);
        Ok(())
    }
}

fn color(role: Role) -> palette::Rgb {
    match role {
        Role::Touching => palette::TOUCHING,
        Role::Near => palette::NEAR,
        Role::Local => palette::LOCAL,
        Role::Other => palette::OTHER,
    }
}

/// Type and features, A's first: `B v3-f1`.
fn label(face: &CFacePolygon) -> String {
    let [contact] = face.contacts[..] else {
        return principal(&face.contacts);
    };
    let (a, b) = contact.features();
    match contact.type_letter() {
        'A' => format!("A f{a}-v{b}"),
        'B' => format!("B v{a}-f{b}"),
        _ => format!("C e{a}-e{b}"),
    }
}

/// The features that lie in each other where several contacts take place on one C-face: `edge-face e4-f1`, A's first.
fn principal(contacts: &[BasicContact]) -> String {
    let of = |letter: char| contacts.iter().find(|c| c.type_letter() == letter).map(BasicContact::features);
    match (of('A'), of('B'), of('C')) {
        (Some((face_a, _)), Some((_, face_b)), _) => format!("face-face f{face_a}-f{face_b}"),
        (Some((face_a, _)), None, Some((_, edge_b))) => format!("face-edge f{face_a}-e{edge_b}"),
        (None, Some((_, face_b)), Some((edge_a, _))) => format!("edge-face e{edge_a}-f{face_b}"),
        _ => format!("{} contacts", contacts.len()),
    }
}

/// Places the faces on rings around Near, one ring for each step on the graph, in the order of their normals' bearing:
/// no two labels fall together, however thin the C-faces between them.
fn map(faces: &[CFacePolygon], near: usize) -> Vec<[f32; 2]> {
    let middle = faces[near].normal_w;
    let up = if middle.z.abs() < 0.9 { DVec3::Z } else { DVec3::Y };
    let right = up.cross(middle).normalize();
    let up = middle.cross(right);
    let bearing = |i: usize| faces[i].normal_w.dot(up).atan2(faces[i].normal_w.dot(right));
    let mut places = vec![[0.0; 2]; faces.len()];
    let mut reach = 0.0;
    for mut ring in rings(faces, near).into_iter().skip(1) {
        // The labels of more than six need a wider ring.
        reach = f32::max(reach + 1.0, ring.len() as f32 / 6.0);
        ring.sort_by(|&i, &j| bearing(i).total_cmp(&bearing(j)));
        let turn = std::f64::consts::TAU / ring.len() as f64;
        // The ring as a whole is turned to where its members really are.
        let (sin, cos) = ring
            .iter()
            .enumerate()
            .map(|(k, &i)| (bearing(i) - turn * k as f64).sin_cos())
            .fold((0.0, 0.0), |sum, (sin, cos)| (sum.0 + sin, sum.1 + cos));
        let start = sin.atan2(cos);
        for (k, i) in ring.into_iter().enumerate() {
            let (sin, cos) = (start + turn * k as f64).sin_cos();
            let radius = RING.map(|r| r * reach);
            places[i] = [radius[0] * cos as f32, -radius[1] * sin as f32];
        }
    }
    places
}

/// The faces by their number of steps from Near.
fn rings(faces: &[CFacePolygon], near: usize) -> Vec<Vec<usize>> {
    let mut rings = vec![vec![near]];
    let mut left: Vec<usize> = (0..faces.len()).filter(|&i| i != near).collect();
    while !left.is_empty() {
        let last = &rings[rings.len() - 1];
        let (next, rest): (Vec<_>, Vec<_>) =
            left.iter().partition(|&&i| last.iter().any(|&j| faces[i].is_neighbor(&faces[j])));
        // Faces that no step reaches cannot be on a closed hull; they are put outside.
        let stuck = next.is_empty();
        rings.push(if stuck { rest.clone() } else { next });
        left = if stuck { Vec::new() } else { rest };
    }
    rings
}
