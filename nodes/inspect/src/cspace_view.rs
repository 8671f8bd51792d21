use crate::budget::Budget;
use crate::eye::Eye;
use crate::palette;
use crate::physical::{ArrowScale, arrow};
use crate::slice::{PairSlice, Role};
use crate::surface::Surface;
use crate::union::{self, Obstacle};
use glam::DVec3;
use rerun::components::Radius;
use rerun::{Clear, LineStrips3D, Points3D, RecordingStream, RecordingStreamResult};
use servo::TickRecord;

/// Root of the C-space view: positions of A's frame in W, metres, at the present orientation of the proxy.
pub(crate) const ROOT: &str = "/cspace_m";
/// The trail of `x`: one point a frame, of which the view shows the last seconds.
pub(crate) const TRAIL: &str = "/cspace_m/trail";
const HIP: &str = "/cspace_m/hip";
const SCP: &str = "/cspace_m/scp";
const PROJECTION: &str = "/cspace_m/projection";
const FORCE: &str = "/cspace_m/force";
const LEADERS: &str = "/cspace_m/leaders";

/// Entity, colour, alpha of the fill, alpha and width (screen points) of the edges for each role.
struct Look {
    role: Role,
    entity: &'static str,
    color: palette::Rgb,
    fill: f32,
    edge: f32,
    width: f32,
}

const LOOKS: [Look; 4] = [
    Look {
        role: Role::Touching,
        entity: "/cspace_m/c_faces/touching",
        color: palette::TOUCHING,
        fill: 0.72,
        edge: 1.0,
        width: 3.0,
    },
    Look { role: Role::Near, entity: "/cspace_m/c_faces/near", color: palette::NEAR, fill: 0.5, edge: 1.0, width: 2.2 },
    Look {
        role: Role::Local,
        entity: "/cspace_m/c_faces/local",
        color: palette::LOCAL,
        fill: 0.28,
        edge: 0.9,
        width: 1.4,
    },
    Look {
        role: Role::Other,
        entity: "/cspace_m/c_faces/other",
        color: palette::OTHER,
        fill: 0.1,
        edge: 0.45,
        width: 0.8,
    },
];

/// The C-space view. Remembers what is drawn: polygons go out again only when they changed.
pub(crate) struct CSpaceView {
    drawn: [Surface; 4],
    budget: Budget,
    /// Length of labels' leaders, metres.
    leader: f64,
    /// Where the view is looked at from at first, metres.
    eye: DVec3,
}

impl CSpaceView {
    pub(crate) fn open(stream: &RecordingStream, budget: Budget) -> RecordingStreamResult<Self> {
        stream.log_static(ROOT, &rerun::ViewCoordinates::RIGHT_HAND_Z_UP())?;
        Ok(Self { drawn: Default::default(), budget, leader: 0.0, eye: DVec3::ZERO })
    }

    /// Where the view is looked at from: labels are put aside accordingly.
    pub(crate) fn look_from(&mut self, eye: &Eye) {
        self.leader = 0.17 * eye.position.distance(eye.target);
        self.eye = eye.position;
    }

    /// Draws one frame at time `now` (s). The stream's time is set.
    pub(crate) fn frame(
        &mut self,
        stream: &RecordingStream,
        record: &TickRecord,
        slices: &[PairSlice],
        scale: &ArrowScale,
        now: f64,
    ) -> RecordingStreamResult<()> {
        self.polygons(stream, slices, now)?;
        self.markers(stream, record, scale)
    }

    fn polygons(&mut self, stream: &RecordingStream, slices: &[PairSlice], now: f64) -> RecordingStreamResult<()> {
        let obstacles: Vec<Obstacle<'_>> = slices.iter().map(obstacle).collect();
        let surfaces: [Surface; 4] = union::surfaces(&obstacles, Role::Near as usize);
        let changed: Vec<usize> = (0..4).filter(|&i| surfaces[i] != self.drawn[i]).collect();
        let bytes = changed.iter().map(|&i| surfaces[i].bytes()).sum();
        if changed.is_empty() || !self.budget.spend(now, bytes) {
            return Ok(());
        }
        for i in changed {
            let (look, surface) = (&LOOKS[i], &surfaces[i]);
            debug_assert_eq!(look.role, Role::ALL[i]);
            let edges = format!("{}/edges", look.entity);
            if surface.is_empty() {
                stream.log(look.entity, &Clear::flat())?;
                stream.log(edges, &Clear::flat())?;
            } else {
                stream.log(look.entity, &surface.mesh(palette::glass(look.color, look.fill)))?;
                stream.log(edges, &surface.edges(palette::glass(look.color, look.edge), look.width))?;
            }
        }
        self.drawn = surfaces;
        Ok(())
    }

    fn markers(&self, stream: &RecordingStream, record: &TickRecord, scale: &ArrowScale) -> RecordingStreamResult<()> {
        let (hip, scp) = (record.hip.translation, record.proxy.translation);
        let force = record.out_wrench.force;
        let apart = hip.distance(scp) > 1e-7;
        // Labels stand aside on leaders, left and right of the force as the view first shows it, so that they hide neither
        // the points nor each other; both outside the obstacle, where no C-face hides the leaders.
        let out = force.try_normalize().or((scp - hip).try_normalize()).unwrap_or(DVec3::Z);
        let side = (self.eye - scp).cross(out).try_normalize().unwrap_or_else(|| out.any_orthonormal_vector());
        let hip_label = scp + (0.45 * out - side) * self.leader;
        let scp_label = scp + (0.45 * out + side) * self.leader;
        stream.log(HIP, &marker(hip, palette::HIP))?;
        stream.log(SCP, &marker(scp, palette::SCP))?;
        stream.log(TRAIL, &marker(scp, palette::SCP).with_radii([Radius::new_ui_points(1.5)]))?;
        let labels: &[(DVec3, &str, palette::Rgb)] = if apart {
            &[(hip_label, "HIP", palette::HIP), (scp_label, "SCP", palette::SCP)]
        } else {
            &[(scp_label, "x = HIP = SCP", palette::SCP)]
        };
        let anchors = Points3D::new(labels.iter().map(|l| l.0.as_vec3().to_array()))
            .with_labels(labels.iter().map(|l| l.1))
            .with_colors(labels.iter().map(|l| palette::ink(l.2)))
            .with_radii([Radius::new_ui_points(0.5)])
            .with_show_labels(true);
        stream.log(format!("{LEADERS}/labels"), &anchors)?;
        let mut lines = vec![([scp, scp_label], palette::SCP)];
        if apart {
            lines.push(([hip, hip_label], palette::HIP));
        }
        stream.log(LEADERS, &segments(&lines, 1.4))?;
        let projection = if apart { vec![([hip, scp], palette::HIP)] } else { Vec::new() };
        stream.log(PROJECTION, &segments(&projection, 2.0))?;
        stream.log(FORCE, &arrow(scp, force * scale.force, palette::FORCE))
    }
}

/// The C-faces of a pair, each with the place of its role among `LOOKS`.
fn obstacle(slice: &PairSlice) -> Obstacle<'_> {
    let surfaces = slice.roles.iter().map(|role| *role as usize);
    Obstacle { faces: slice.faces.iter().zip(surfaces).collect(), whole: slice.whole }
}

fn marker(at: DVec3, color: palette::Rgb) -> Points3D {
    Points3D::new([at.as_vec3().to_array()])
        .with_colors([palette::solid(color)])
        .with_radii([Radius::new_ui_points(5.5)])
}

/// Lines of `width` screen points.
fn segments(lines: &[([DVec3; 2], palette::Rgb)], width: f32) -> LineStrips3D {
    LineStrips3D::new(lines.iter().map(|(line, _)| line.map(|p| p.as_vec3().to_array())))
        .with_colors(lines.iter().map(|(_, color)| palette::solid(*color)))
        .with_radii([Radius::new_ui_points(width / 2.0)])
}
