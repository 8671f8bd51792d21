use crate::palette;
use crate::slice::{PairSlice, Role};
use crate::subject::Subject;
use cspace::CFacePolygon;
use glam::DVec3;
use rerun::{GraphEdges, GraphNodes, RecordingStream, RecordingStreamResult, Rgba32};

/// The applicability subgraph of the pair nearest to `x` (paper, Figure 3).
pub(crate) const APPLICABILITY: &str = "/graph/applicability";

/// Radii of the map, in the view's units. Labels are wider than high, and the view folds them when it is zoomed out.
const RADIUS: [f32; 2] = [150.0, 85.0];

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
        let places = map(&pair.faces, pair.faces[pair.near].normal_w);
        let mut ids: Vec<String> = (0..pair.faces.len()).map(|i| format!("n{i}")).collect();
        let mut labels: Vec<&str> = shown.iter().map(|(text, _)| text.as_str()).collect();
        let mut colors: Vec<Rgba32> = pair.roles.iter().map(|role| palette::solid(color(*role))).collect();
        let mut positions = places;
        ids.push("title".into());
        colors.push(palette::solid(palette::PLAIN));
        positions.push([0.0, -RADIUS[1] * 2.3]);
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
    let [contact] = face.contacts[..] else { return format!("{} contacts", face.contacts.len()) };
    let (a, b) = contact.features();
    match contact.type_letter() {
        'A' => format!("A f{a}-v{b}"),
        'B' => format!("B v{a}-f{b}"),
        _ => format!("C e{a}-e{b}"),
    }
}

/// Places the faces by their normals: the Gauss sphere around Near, unrolled by Lambert's equal-area projection. The
/// graph of a convex polyhedron drawn so has Near in the middle, its neighbours around it, and no crossings but at the rim.
fn map(faces: &[CFacePolygon], middle: DVec3) -> Vec<[f32; 2]> {
    let up = if middle.z.abs() < 0.9 { DVec3::Z } else { DVec3::Y };
    let right = up.cross(middle).normalize();
    let up = middle.cross(right);
    let place = |n: DVec3| {
        let stretch = (2.0 / (1.0 + middle.dot(n)).max(1e-3)).sqrt();
        let at = DVec3::new(n.dot(right), -n.dot(up), 0.0) * stretch;
        // The far pole is a circle: keep it on the map.
        let at = if at.length() < 1e-6 && middle.dot(n) < 0.0 { DVec3::Y * 2.0 } else { at };
        [at.x as f32 * RADIUS[0], at.y as f32 * RADIUS[1]]
    };
    faces.iter().map(|f| place(f.normal_w)).collect()
}
