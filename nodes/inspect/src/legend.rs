use crate::palette;
use crate::physical::ArrowScale;
use rerun::components::Radius;
use rerun::{LineStrips2D, Points2D, RecordingStream, RecordingStreamResult};

/// The legend: a strip of coloured fields with their meaning beside them.
pub(crate) const LEGEND: &str = "/legend";

/// Half the width of a letter of a label in the view's own units, on a screen of 1600 points.
const HALF_LETTER: f32 = 0.27;
/// Distance of two columns and of two rows, in the view's own units.
const STEP: [f32; 2] = [20.0, 3.4];
const COLUMNS: usize = 5;

/// Corners of the legend, `[x, y]` from and to.
pub(crate) fn bounds() -> ([f64; 2], [f64; 2]) {
    ([-1.5, f64::from(COLUMNS as f32 * STEP[0]) - 1.5], [-1.8, 5.2])
}

/// Explains every colour that the views use.
pub(crate) fn open(stream: &RecordingStream, scale: &ArrowScale) -> RecordingStreamResult<()> {
    let force = format!("force, {} mm/N", millimetres(scale.force));
    let torque = format!("torque, {} mm/N.m", millimetres(scale.torque));
    let entries: [(&str, palette::Rgb); 10] = [
        ("C-face in contact", palette::TOUCHING),
        ("Near", palette::NEAR),
        ("local subgraph", palette::LOCAL),
        ("other applicable", palette::OTHER),
        ("obstacle", palette::OBSTACLE),
        ("HIP: hand", palette::HIP),
        ("SCP: part", palette::SCP),
        (&force, palette::FORCE),
        (&torque, palette::TORQUE),
        ("contact region", palette::TOUCHING),
    ];
    draw(stream, &entries)
}

/// Of a length in metres, without the last digits' rounding.
fn millimetres(length: f64) -> f64 {
    (length * 1e12).round() / 1e9
}

/// The legend of a scene without a run.
pub(crate) fn open_overview(stream: &RecordingStream) -> RecordingStreamResult<()> {
    let entries = [
        ("part in the hand", palette::SCP),
        ("obstacle, in pieces", palette::OBSTACLE),
        ("A: face, vertex", palette::OTHER),
        ("B: vertex, face", palette::NEAR),
        ("C: edge, edge", palette::LOCAL),
        ("several contacts", palette::TOUCHING),
    ];
    draw(stream, &entries)
}

fn draw(stream: &RecordingStream, entries: &[(&str, palette::Rgb)]) -> RecordingStreamResult<()> {
    let place = |i: usize| [(i % COLUMNS) as f32 * STEP[0], (i / COLUMNS) as f32 * STEP[1]];
    // Short thick lines make filled fields.
    let bar = |i: usize| [-0.6, 0.6].map(|x| [place(i)[0] + x, place(i)[1]]);
    let fields = LineStrips2D::new((0..entries.len()).map(bar))
        .with_colors(entries.iter().map(|(_, color)| palette::solid(*color)))
        .with_radii([Radius::new_ui_points(7.0)]);
    stream.log_static(format!("{LEGEND}/fields"), &fields)?;
    // A label stands below its point, in its middle: the points are moved so that it stands right of the field.
    let text = |i: usize| {
        let [x, y] = place(i);
        [x + 2.2 + HALF_LETTER * entries[i].0.chars().count() as f32, y - 1.35]
    };
    let texts = Points2D::new((0..entries.len()).map(text))
        .with_labels(entries.iter().map(|(text, _)| *text))
        .with_colors(entries.iter().map(|(_, color)| palette::ink(*color)))
        .with_radii([Radius::new_ui_points(0.1)])
        .with_show_labels(true);
    stream.log_static(format!("{LEGEND}/texts"), &texts)
}
