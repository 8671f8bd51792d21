//! docs/pictures/stability.png.

use crate::table::name;
use crate::{LAWS, PERIODS, Row};
use epaint_default_fonts::UBUNTU_LIGHT;
use haptics::LawKind;
use plotters::prelude::*;
use servo::MotionKind;
use std::error::Error;
use std::fs::File;
use std::io::BufWriter;
use std::path::Path;

const SIZE: (u32, u32) = (1500, 1150);
type Area<'a> = DrawingArea<BitMapBackend<'a>, plotters::coord::Shift>;

fn colour(law: LawKind) -> RGBColor {
    match law {
        LawKind::Paper => RGBColor(213, 94, 0),
        LawKind::Pstar => RGBColor(230, 159, 0),
        LawKind::Blended => RGBColor(0, 114, 178),
        LawKind::Proxy => RGBColor(0, 130, 90),
    }
}

/// Laws that agree lie on one another: the later, the thinner and the smaller.
fn width(law: LawKind) -> u32 {
    10 - 2 * LAWS.iter().position(|l| *l == law).unwrap_or(0) as u32
}

/// Draws translation and rotation for both grips.
pub fn draw(rows: &[Row], file: &Path) -> Result<(), Box<dyn Error>> {
    plotters::style::register_font("sans-serif", FontStyle::Normal, UBUNTU_LIGHT).map_err(|_| "the font is damaged")?;
    let mut pixels = vec![0; (SIZE.0 * SIZE.1 * 3) as usize];
    {
        let root = BitMapBackend::with_buffer(&mut pixels, SIZE).into_drawing_area();
        root.fill(&WHITE)?;
        let panels = root.split_evenly((2, 2));
        let motions = [(MotionKind::Translation, 1e2..2e5), (MotionKind::Rotation, 1.0..4e2)];
        for (i, panel) in panels.iter().enumerate() {
            let (motion, range) = motions[i / 2].clone();
            let grip = if i % 2 == 0 { "soft" } else { "stiff" };
            let of_panel =
                |r: &&Row| r.cell.motion == motion && r.cell.grip.name == grip && r.without.largest.is_finite();
            draw_panel(panel, &rows.iter().filter(of_panel).collect::<Vec<_>>(), motion, grip, range)?;
        }
        root.present()?;
    }
    let mut encoder = png::Encoder::new(BufWriter::new(File::create(file)?), SIZE.0, SIZE.1);
    encoder.set_color(png::ColorType::Rgb);
    encoder.set_compression(png::Compression::High);
    encoder.write_header()?.write_image_data(&pixels)?;
    Ok(())
}

fn draw_panel(
    area: &Area<'_>,
    rows: &[&Row],
    motion: MotionKind,
    grip: &str,
    range: std::ops::Range<f64>,
) -> Result<(), Box<dyn Error>> {
    let (what, unit) = match motion {
        MotionKind::Translation => ("Pressing on a floor", "N/m"),
        MotionKind::Rotation => ("Rocking on a floor", "N.m/rad"),
    };
    let mut chart = ChartBuilder::on(area)
        .caption(format!("{what}, {grip} grip"), ("sans-serif", 26))
        .margin(12)
        .x_label_area_size(50)
        .y_label_area_size(95)
        .build_cartesian_2d(
            (0.2..2.5).log_scale().with_key_points(PERIODS.map(|s| s * 1e3).to_vec()),
            range.log_scale(),
        )?;
    chart
        .configure_mesh()
        .x_desc("time of a tick, ms")
        .y_desc(format!("largest stable stiffness, {unit}"))
        .x_labels(8)
        .y_labels(8)
        .y_label_formatter(&|y| if *y >= 1000.0 { format!("{} 000", y / 1000.0) } else { y.to_string() })
        .label_style(("sans-serif", 18))
        .light_line_style(RGBColor(235, 235, 235))
        .draw()?;
    for law in LAWS {
        let of_law: Vec<&&Row> = rows.iter().filter(|r| r.cell.law == law).collect();
        if of_law.is_empty() {
            continue;
        }
        let points = |f: &dyn Fn(&Row) -> f64| of_law.iter().map(|r| (r.cell.period * 1e3, f(r))).collect::<Vec<_>>();
        let (without, with) = (points(&|r| r.without.largest), points(&|r| r.with.largest));
        let (style, w) = (colour(law), width(law));
        chart
            .draw_series(LineSeries::new(with.clone(), style.stroke_width(w / 2)))?
            .label(format!("{}, with passivity control", name(law)))
            .legend(move |(x, y)| PathElement::new([(x, y), (x + 28, y)], style.stroke_width(w / 2)));
        chart.draw_series(with.into_iter().map(|p| Circle::new(p, w, style.filled())))?;
        chart
            .draw_series(DashedLineSeries::new(without.clone(), 3, 6, style.stroke_width(w / 2)))?
            .label(format!("{}, without", name(law)))
            .legend(move |(x, y)| {
                EmptyElement::at((x, y))
                    + Circle::new((3, 0), 2, style.filled())
                    + Circle::new((14, 0), 2, style.filled())
                    + Circle::new((25, 0), 2, style.filled())
            });
        chart.draw_series(without.into_iter().map(|p| TriangleMarker::new(p, w + 1, style.filled())))?;
    }
    // The prediction knows no law; `proxy` stands for all.
    let one: Vec<&&Row> = rows.iter().filter(|r| r.cell.law == LawKind::Proxy).collect();
    for (k, f) in [|r: &Row| r.with.predicted, |r: &Row| r.without.predicted].into_iter().enumerate() {
        let points: Vec<_> = one.iter().map(|r| (r.cell.period * 1e3, f(r))).collect();
        let line = chart.draw_series(DashedLineSeries::new(points, 14, 8, BLACK.stroke_width(2)))?;
        if k == 0 {
            line.label("predicted by the check at start").legend(|(x, y)| {
                EmptyElement::at((x, y))
                    + PathElement::new([(0, 0), (11, 0)], BLACK.stroke_width(2))
                    + PathElement::new([(17, 0), (28, 0)], BLACK.stroke_width(2))
            });
        }
    }
    chart
        .configure_series_labels()
        .position(SeriesLabelPosition::LowerLeft)
        .background_style(WHITE.mix(0.85))
        .border_style(RGBColor(200, 200, 200))
        .legend_area_size(40)
        .label_font(("sans-serif", 16))
        .draw()?;
    Ok(())
}
