use crate::atomic_file::AtomicFile;
use crate::bag_out::BagOut;
use crate::csv_io::read_text;
use crate::failure::Failure;
use crate::outputs::{spare, tell_apart};
use crate::replay_motion::Motion;
use crate::stdout::say;
use crate::step_time::StepTime;
use bag::first_difference;
use haptics::LawKind;
use scene::Scene;
use servo::{Config, Health, Tick, TickRecord};
use std::fmt::Write;
use std::path::{Path, PathBuf};

/// `replay`: render a motion in a scene.
///
/// Poses are the hand's poses of A in W: no clutch, no scaling.
#[derive(clap::Args)]
#[command(after_help = columns())]
#[command(group(clap::ArgGroup::new("motion").required(true).args(["poses", "bag"])))]
pub struct Args {
    /// The scene file; a bag of ticks brings its own.
    #[arg(long, required_unless_present = "bag")]
    pub scene: Option<PathBuf>,
    /// Poses of A in W, the hand's: CSV `t,x,y,z,qx,qy,qz,qw`.
    #[arg(long)]
    pub poses: Option<PathBuf>,
    /// A bag with ticks, which are rendered again bit for bit, or with poses.
    #[arg(long)]
    pub bag: Option<PathBuf>,
    /// The bag's topic of ticks or poses, if it holds several.
    #[arg(long, requires = "bag")]
    pub topic: Option<String>,
    /// CSV to write.
    #[arg(long)]
    pub out: PathBuf,
    /// The force law; otherwise that of the parameters or of the bag.
    #[arg(long, value_enum)]
    pub law: Option<Law>,
    /// Parameter file (as the servo node takes it); otherwise the defaults or those of the bag.
    #[arg(long)]
    pub params: Option<PathBuf>,
    /// Also write the ticks as a bag, into this new folder.
    #[arg(long)]
    pub bag_out: Option<PathBuf>,
    /// Also write a rerun recording.
    #[cfg(feature = "inspect")]
    #[arg(long)]
    pub rrd: Option<PathBuf>,
    /// Also print the time of a step.
    #[arg(long)]
    pub time: bool,
}

impl Args {
    #[cfg(feature = "inspect")]
    const fn rrd(&self) -> Option<&PathBuf> {
        self.rrd.as_ref()
    }

    #[cfg(not(feature = "inspect"))]
    const fn rrd(&self) -> Option<&PathBuf> {
        None
    }
}

/// `--law`.
#[derive(Clone, Copy, Debug, clap::ValueEnum)]
pub enum Law {
    /// The paper's equations (1) to (6) as written.
    Paper,
    /// Torque about the nearest point of the contact region.
    Pstar,
    /// Depth-weighted contact region.
    Blended,
    /// Six-dimensional proxy.
    Proxy,
}

impl Law {
    const fn kind(self) -> LawKind {
        match self {
            Self::Paper => LawKind::Paper,
            Self::Pstar => LawKind::Pstar,
            Self::Blended => LawKind::Blended,
            Self::Proxy => LawKind::Proxy,
        }
    }
}

/// What the output means, for people who ask for help.
fn columns() -> String {
    let bits: Vec<String> = Health::NAMES.iter().map(|(bit, name)| format!("{} {name}", bit.0)).collect();
    format!(
        "\
Columns of the output, one row a tick; wrenches act on the hand, in axes of W, torque about A's origin:
  t                    s
  depth                m, of the hand's pose in the obstacles, >= 0
  formation, contacts  free, vertex-face, edge-edge, edge-face or face-face, and the number of contact points
  scp_x, scp_y, scp_z  m, position of the surface contact pose (of the proxy) in W
  fx ... tz            N and N.m, the law's own wrench
  out_fx ... out_tz    N and N.m, what the device gets after ramp, damping, passivity control and limits
  health               0 is good, else the sum of: {}",
        bits.join(", ")
    )
}

const HEADER: &str = "t,depth,formation,contacts,scp_x,scp_y,scp_z,fx,fy,fz,tx,ty,tz,\
    out_fx,out_fy,out_fz,out_tx,out_ty,out_tz,health\n";

/// Runs `replay`.
pub fn run(args: &Args) -> Result<(), Failure> {
    let mut config = match &args.params {
        Some(path) => parse_config(&read_text(path)?, path)?,
        None => Config::default(),
    };
    if let Some(law) = args.law {
        config.gains.law = law.kind();
    }
    let mut motion = match (&args.poses, &args.bag) {
        (Some(csv), _) => Motion::from_csv(csv, &config)?,
        (None, Some(dir)) => Motion::from_bag(dir, args.topic.as_deref(), &config)?,
        // The argument group asks for one of them.
        (None, None) => return Err(Failure::plain("neither --poses nor --bag")),
    };
    if let (Some(c), None, Some(dir)) = (&motion.configuration, &args.params, &args.bag) {
        config = parse_config(&c.yaml, dir)?;
    }
    if let Some(law) = args.law {
        config.gains.law = law.kind();
        motion.inputs.iter_mut().for_each(|i| i.gains.law = law.kind());
    }
    let scene = load_scene(args, &motion)?;
    let records = render(args, &scene, &config, &motion)?;
    motion.notes.iter().try_for_each(|note| say(note))?;
    compare(&motion.recorded, &records)?;
    if args.time {
        let time = StepTime::measure_from(|| Tick::new(&scene, &config), &motion.inputs, Tick::step);
        say(&time.to_string())?;
    }
    Ok(())
}

fn parse_config(yaml: &str, file: &Path) -> Result<Config, Failure> {
    Config::from_yaml(yaml).map_err(|e| Failure::file(file, e))
}

fn load_scene(args: &Args, motion: &Motion) -> Result<Scene, Failure> {
    if let Some(path) = &args.scene {
        return Scene::load(path).map_err(Failure::plain);
    }
    let dir = args.bag.as_deref().unwrap_or(Path::new(""));
    motion.own_scene(dir)?.ok_or_else(|| Failure::file(dir, "the bag holds no scene: name one with --scene"))
}

/// Renders all ticks and writes what was asked for; CSV and bag appear last, when all the rest went well.
fn render(args: &Args, scene: &Scene, config: &Config, motion: &Motion) -> Result<Vec<TickRecord>, Failure> {
    let files = if args.scene.is_some() { scene.bundle.paths() } else { Vec::new() };
    let named = [&args.poses, &args.params, &args.bag].into_iter().flatten();
    let inputs: Vec<&Path> = named.chain(&files).map(PathBuf::as_path).collect();
    let outs: Vec<&Path> =
        [Some(&args.out), args.bag_out.as_ref(), args.rrd()].into_iter().flatten().map(PathBuf::as_path).collect();
    tell_apart(&outs)?;
    outs.iter().try_for_each(|out| spare(out, &inputs))?;
    let mut out = AtomicFile::create(&args.out, &inputs)?;
    out.write(HEADER)?;
    let mut tick = Tick::new(scene, config);
    let mut row = String::with_capacity(512);
    let mut records = Vec::with_capacity(motion.inputs.len());
    for (input, t) in motion.inputs.iter().zip(&motion.times) {
        let record = tick.step(input);
        row.clear();
        format_row(&mut row, *t, &record);
        out.write(&row)?;
        records.push(record);
    }
    let bag = args.bag_out.as_ref().map(|dir| BagOut::write(dir, scene, config, &records)).transpose()?;
    #[cfg(feature = "inspect")]
    if let Some(rrd) = args.rrd() {
        crate::rrd::fill(rrd, &inputs, |sink| crate::rrd::record(sink, scene, &records))?.finish()?;
    }
    out.finish()?;
    bag.map_or(Ok(()), BagOut::finish)?;
    Ok(records)
}

fn format_row(row: &mut String, t: f64, record: &TickRecord) {
    let (p, law, out) = (record.proxy.translation, &record.law_wrench, &record.out_wrench);
    // `{:?}` of an f64 is the shortest text that reads back to the same number. Writing to a String cannot fail.
    let contacts = record.formation.points().len();
    let _ = write!(row, "{t:?},{:?},{},{contacts}", record.depth, record.formation.kind.name());
    for v in [p, law.force, law.torque, out.force, out.torque] {
        let _ = write!(row, ",{:?},{:?},{:?}", v.x, v.y, v.z);
    }
    let _ = writeln!(row, ",{}", record.health.0);
}

/// Says how the ticks differ from the recorded ones.
fn compare(recorded: &[TickRecord], rendered: &[TickRecord]) -> Result<(), Failure> {
    if recorded.is_empty() {
        return Ok(());
    }
    let (mut differing, mut other_formation, mut first) = (0usize, 0usize, None);
    let (mut force, mut torque, mut depth) = (0.0f64, 0.0f64, 0.0f64);
    for (old, new) in recorded.iter().zip(rendered) {
        // The input is the recorded one, but for the law where another was asked for: that is no difference in itself.
        let Some(field) = first_difference(old, &TickRecord { input: old.input, ..*new }) else { continue };
        differing += 1;
        other_formation += usize::from(old.formation.kind != new.formation.kind);
        first.get_or_insert((old.input.sequence, field));
        force = force.max((old.out_wrench.force - new.out_wrench.force).length());
        torque = torque.max((old.out_wrench.torque - new.out_wrench.torque).length());
        depth = depth.max((old.depth - new.depth).abs());
    }
    let n = recorded.len();
    match first {
        None => say(&format!("{n} ticks, all identical to the recorded ones")),
        Some((first, field)) => say(&format!(
            "{n} ticks, {differing} differ from the recorded ones, first at tick {first} in {field}; \
             at most {force:.3e} N, {torque:.3e} N.m, depth {depth:.3e} m; another formation in {other_formation} ticks"
        )),
    }
}
