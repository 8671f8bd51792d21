use crate::clock::{ROBOT_TIME, TICK};
use crate::eye::{Eye, Eyes};
use crate::layout::{Node, View, send};
use crate::sink::APPLICATION;
use crate::{applicability, contact_states, cspace_view, events, legend, physical, series};
use rerun::external::re_sdk_types::blueprint::archetypes::{
    Background, LineGrid3D, PlotLegend, TextLogColumns, TimePanelBlueprint, VisibleTimeRanges, VisualBounds2D,
};
use rerun::external::re_sdk_types::blueprint::components::{BackgroundKind, Corner2D, PanelState, PlayState};
use rerun::external::re_sdk_types::blueprint::datatypes::{TextLogColumn, TextLogColumnKind};
use rerun::external::re_sdk_types::datatypes::{TimeInt, TimeRange, TimeRangeBoundary, Utf8, VisibleTimeRange};
use rerun::{RecordingStream, RecordingStreamResult, Transform3D};

/// Length of the trail of `x` in the C-space view.
const TRAIL_SECONDS: i64 = 3;

/// A 3D view of what is below `root`. Tiny bodies are enlarged by a transform of the root, seen from outside it: their
/// own coordinates stay metres.
fn view_3d(stream: &RecordingStream, title: &str, root: &str, eye: &Eye) -> RecordingStreamResult<View> {
    let enlargement = eye.enlargement();
    let view = if enlargement == 1.0 {
        View::new("3D", title, root)
    } else {
        stream.log_static(root, &Transform3D::from_scale(enlargement as f32))?;
        View::new("3D", title, "/").showing(root)
    };
    let view = view
        .with("EyeControls3D", eye.controls())
        .with("LineGrid3D", LineGrid3D::new().with_visible(false))
        // Of no colour of its own it is white in the viewer's light theme and black in the dark one.
        .with("Background", Background::new(BackgroundKind::SolidColor));
    Ok(view)
}

fn legend_view() -> View {
    let (x_range, y_range) = legend::bounds();
    let range = rerun::external::re_sdk_types::datatypes::Range2D { x_range: x_range.into(), y_range: y_range.into() };
    let bounds = VisualBounds2D::new(rerun::external::re_sdk_types::blueprint::components::VisualBounds2D(range));
    View::new("2D", "Legend", legend::LEGEND).with("VisualBounds2D", bounds)
}

fn log_view() -> View {
    let column = rerun::external::re_sdk_types::blueprint::datatypes::TimelineColumn {
        visible: true.into(),
        timeline: ROBOT_TIME.into(),
    };
    // When and what: all come from one entity, and the colour says the kind.
    let body = TextLogColumn { visible: true.into(), kind: TextLogColumnKind::Body };
    let columns = TextLogColumns::new()
        .with_timeline_columns([rerun::external::re_sdk_types::blueprint::components::TimelineColumn(column)])
        .with_text_log_columns([rerun::external::re_sdk_types::blueprint::components::TextLogColumn(body)]);
    View::new("TextLog", "Events", events::EVENTS).with("TextLogColumns", columns)
}

/// Opens at the newest moment: the series are whole, and a live recording is followed.
fn time_panel() -> TimePanelBlueprint {
    TimePanelBlueprint::new()
        .with_state(PanelState::Collapsed)
        .with_timeline(ROBOT_TIME)
        .with_play_state(PlayState::Following)
}

/// The last seconds of the trail, on both time lines.
fn trail_range() -> VisibleTimeRanges {
    let back = |timeline: &str, length: i64| {
        rerun::external::re_sdk_types::blueprint::components::VisibleTimeRange(VisibleTimeRange {
            timeline: Utf8::from(timeline),
            range: TimeRange {
                start: TimeRangeBoundary::CursorRelative(TimeInt(-length)),
                end: TimeRangeBoundary::CursorRelative(TimeInt(0)),
            },
        })
    };
    VisibleTimeRanges::new([back(ROBOT_TIME, TRAIL_SECONDS * 1_000_000_000), back(TICK, TRAIL_SECONDS * 1000)])
}

/// Sends the layout of a run; `timed`: whether its ticks were timed, which those of a replayed motion are not.
pub(crate) fn send_run(stream: &RecordingStream, eyes: &Eyes, timed: bool) -> RecordingStreamResult<()> {
    let physical = view_3d(stream, "Physical space [m]", physical::ROOT, &eyes.physical)?;
    let cspace = view_3d(stream, "C-space at the present orientation [m]", cspace_view::ROOT, &eyes.cspace)?
        .entity(cspace_view::TRAIL, trail_range());
    let plots = series::PLOTS.iter().filter(|plot| timed || plot.entity != series::TIMES).map(|plot| {
        let legend = PlotLegend::new().with_corner(Corner2D::LeftTop);
        (1.0, Node::View(View::new("TimeSeries", plot.title, plot.entity).with("PlotLegend", legend)))
    });
    let lanes = View::new("StateTimeline", "Contact formation and health", "/state");
    let graphs = vec![
        Node::View(View::new("Graph", "Applicable C-faces of the nearest pair", applicability::APPLICABILITY)),
        Node::View(View::new("Graph", "Contact states of the run", contact_states::CONTACT_STATES)),
    ];
    let spaces = Node::Row(vec![(1.0, Node::View(physical)), (1.0, Node::View(cspace))]);
    let bottom = Node::Row(vec![(1.2, Node::Tabs(graphs)), (1.0, Node::View(log_view()))]);
    let left = Node::Column(vec![(5.4, spaces), (1.25, Node::View(legend_view())), (3.6, bottom)]);
    let mut right: Vec<(f32, Node)> = plots.collect();
    right.push((0.95, Node::View(lanes)));
    let root = Node::Row(vec![(2.7, left), (1.0, Node::Column(right))]);
    send(stream, APPLICATION, root, &time_panel())
}

/// Sends the layout of a scene without a run, its sweep on the time line `sweep`.
pub(crate) fn send_overview(stream: &RecordingStream, eyes: &Eyes, sweep: &str) -> RecordingStreamResult<()> {
    let physical = view_3d(stream, "Physical space [m]: parts and convex pieces", physical::ROOT, &eyes.physical)?;
    let cspace =
        view_3d(stream, "C-space [m]: C-obstacles at the orientation of the sweep", cspace_view::ROOT, &eyes.cspace)?;
    let spaces = Node::Row(vec![(1.0, Node::View(physical)), (1.0, Node::View(cspace))]);
    let root = Node::Column(vec![(8.0, spaces), (1.0, Node::View(legend_view()))]);
    let panel = TimePanelBlueprint::new().with_state(PanelState::Collapsed).with_timeline(sweep);
    send(stream, APPLICATION, root, &panel)
}
