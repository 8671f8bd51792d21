use crate::palette;
use crate::physical::ArrowScale;
use rerun::components::Radius;
use rerun::{Boxes2D, Points2D, RecordingStream, RecordingStreamResult};

/// The legend: a strip of coloured fields with their meaning beside them.
pub(crate) const LEGEND: &str = "/legend";

/// Distance of two columns and of two rows, in the view's own units.
const STEP: [f32; 2] = [20.0, 5.0];
const COLUMNS: usize = 5;

/// Corners of the legend, `[x, y]` from and to.
pub(crate) fn bounds() -> ([f64; 2], [f64; 2]) {
    let rows = 2.0;
    ([-2.0, f64::from(COLUMNS as f32 * STEP[0]) - 2.0], [-2.5, rows * f64::from(STEP[1]) - 2.5])
}

/// Explains every colour that the views use.
pub(crate) fn open(stream: &RecordingStream, scale: &ArrowScale) -> RecordingStreamResult<()> {
    let force = format!("force, {} mm per N", scale.force * 1e3);
    let torque = format!("torque, {} mm per N.m", scale.torque * 1e3);
    let entries: [(&str, palette::Rgb); 10] = [
        ("C-face in contact", palette::TOUCHING),
        ("Near of its pair", palette::NEAR),
        ("local subgraph", palette::LOCAL),
        ("other applicable C-face", palette::OTHER),
        ("obstacle", palette::OBSTACLE),
        ("HIP: pose of the hand", palette::HIP),
        ("SCP: pose that touches", palette::SCP),
        (&force, palette::FORCE),
        (&torque, palette::TORQUE),
        ("contact region, points", palette::TOUCHING),
    ];
    draw(stream, &entries)
}

/// The legend of a scene without a run.
pub(crate) fn open_overview(stream: &RecordingStream) -> RecordingStreamResult<()> {
    let entries = [
        ("part in the hand", palette::SCP),
        ("obstacle, by its convex pieces", palette::OBSTACLE),
        ("type A: face of A, vertex of B", palette::OTHER),
        ("type B: vertex of A, face of B", palette::NEAR),
        ("type C: edge of A, edge of B", palette::LOCAL),
        ("several contacts at once", palette::TOUCHING),
    ];
    draw(stream, &entries)
}

fn draw(stream: &RecordingStream, entries: &[(&str, palette::Rgb)]) -> RecordingStreamResult<()> {
    let place = |i: usize| [(i % COLUMNS) as f32 * STEP[0], (i / COLUMNS) as f32 * STEP[1]];
    let colors: Vec<_> = entries.iter().map(|(_, color)| palette::solid(*color)).collect();
    let half = [0.9_f32, 0.9];
    let fields = Boxes2D::from_centers_and_half_sizes((0..entries.len()).map(place), entries.iter().map(|_| half))
        .with_colors(colors.clone());
    stream.log_static(format!("{LEGEND}/fields"), &fields)?;
    let discs = Points2D::new((0..entries.len()).map(place))
        .with_colors(colors.clone())
        .with_radii([Radius::new_ui_points(7.0)]);
    stream.log_static(format!("{LEGEND}/discs"), &discs)?;
    let texts = Points2D::new((0..entries.len()).map(|i| [place(i)[0] + 8.5, place(i)[1]]))
        .with_labels(entries.iter().map(|(text, _)| *text))
        .with_colors(colors)
        .with_radii([Radius::new_ui_points(0.1)])
        .with_show_labels(true);
    stream.log_static(format!("{LEGEND}/texts"), &texts)
}
