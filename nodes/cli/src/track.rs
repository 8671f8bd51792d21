use crate::atomic_file::AtomicFile;
use crate::csv_io::{StampedPose, read_poses, read_text};
use crate::failure::Failure;
use crate::step_time::StepTime;
use cspace::{Polyhedron, PrincipalContact, Tracked, Tracker, principal_contact};
use haptics::FormationKind;
use std::fmt::Write;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// `track`: the nearest C-face of two convex parts along a motion.
#[derive(clap::Args)]
#[command(after_help = COLUMNS)]
pub struct Args {
    /// Mesh of the moving part A (OBJ, convex), in its own frame, metres.
    #[arg(long)]
    pub moving: PathBuf,
    /// Mesh of the obstacle B (OBJ, convex), in W, metres.
    #[arg(long)]
    pub fixed: PathBuf,
    /// Poses of A in W: CSV `t,x,y,z,qx,qy,qz,qw`.
    #[arg(long)]
    pub poses: PathBuf,
    /// CSV to write.
    #[arg(long)]
    pub out: PathBuf,
    /// Also print the time of a step.
    #[arg(long)]
    pub time: bool,
}

/// What the output means, for people who ask for help.
const COLUMNS: &str = "\
Columns of the output, one row a pose:
  t                     s, as in the poses
  distance              m, A's origin to the plane of the nearest C-face (Near): > 0 free, <= 0 contact
  type                  A: face of A, vertex of B; B: vertex of A, face of B; C: edges
  feature_a, feature_b  the two, counted from 0: vertices as in the OBJ file; faces after coplanar ones were merged,
                        in the order of their first face in the file; edges in the order in which those faces, each
                        from its lowest-numbered vertex on, first run along them
  nx, ny, nz            the plane's normal, unit, in W, towards freedom
  formation, contacts   free, vertex-face, edge-edge, edge-face or face-face, and of how many basic contacts
  reseeded              1 where Near was not reached continuously, as in the first row
  divergent             1 where the depth is not the least one, or this was not proven";

const HEADER: &str = "t,distance,type,feature_a,feature_b,nx,ny,nz,formation,contacts,reseeded,divergent\n";

/// Runs `track`.
pub fn run(args: &Args) -> Result<(), Failure> {
    let (a, b) = (read_polyhedron(&args.moving)?, read_polyhedron(&args.fixed)?);
    let poses = read_poses(&args.poses)?;
    let mut out = AtomicFile::create(&args.out, &[&args.moving, &args.fixed, &args.poses])?;
    out.write(HEADER)?;
    let fresh = Tracker::new(a.clone(), b.clone());
    let mut tracker = fresh.clone();
    let mut row = String::with_capacity(256);
    for sample in &poses {
        let tracked = tracker.step(&sample.pose);
        row.clear();
        format_row(&mut row, sample, &tracked, &a, &b);
        out.write(&row)?;
    }
    let time = args.time.then(|| StepTime::measure(&fresh, &poses, |tracker, s| tracker.step(&s.pose)));
    out.finish()?;
    time.map_or(Ok(()), |t| crate::stdout::say(&t.to_string()))
}

/// A convex polyhedron from an OBJ file; every error names the line of the vertex or face at fault.
fn read_polyhedron(path: &Path) -> Result<Arc<Polyhedron>, Failure> {
    let kind = path.extension().and_then(|e| e.to_str()).unwrap_or_default();
    if ["stl", "urdf"].iter().any(|other| kind.eq_ignore_ascii_case(other)) {
        return Err(Failure::file(path, format!("track reads OBJ meshes, this is .{kind}: convert it, or use replay")));
    }
    let text = read_text(path)?;
    let (mesh, lines) =
        scene::parse_obj_with_lines(&text).map_err(|e| Failure::line(path, e.line.unwrap_or(1), e.reason))?;
    scene::polyhedron(&mesh).map(Arc::new).map_err(|e| {
        let face = e.face().and_then(|f| lines.faces.get(f));
        let line = face.or_else(|| e.vertex().and_then(|v| lines.vertices.get(v)));
        Failure::line(path, line.copied().unwrap_or(1), format!("{e} (faces and vertices counted from 0)"))
    })
}

fn format_row(row: &mut String, sample: &StampedPose, tracked: &Tracked, a: &Polyhedron, b: &Polyhedron) {
    let near = &tracked.near;
    let (kind, contacts) = if tracked.is_free() {
        (FormationKind::Free, 0)
    } else {
        let (principal, contacts) = principal_contact(near, a, b, &sample.pose);
        (formation_kind(principal), contacts)
    };
    let (feature_a, feature_b) = near.contact.features();
    let n = near.normal_w;
    // `{:?}` of an f64 is the shortest text that reads back to the same number. Writing to a String cannot fail.
    let _ = writeln!(
        row,
        "{:?},{:?},{},{feature_a},{feature_b},{:?},{:?},{:?},{},{contacts},{},{}",
        sample.t,
        tracked.distance,
        near.contact.type_letter(),
        n.x,
        n.y,
        n.z,
        kind.name(),
        u8::from(tracked.reseeded),
        u8::from(tracked.divergent),
    );
}

fn formation_kind(p: PrincipalContact) -> FormationKind {
    match p {
        PrincipalContact::VertexFace => FormationKind::VertexFace,
        PrincipalContact::EdgeEdge => FormationKind::EdgeEdge,
        PrincipalContact::EdgeFace => FormationKind::EdgeFace,
        PrincipalContact::FaceFace => FormationKind::FaceFace,
    }
}
