//! Hears a servo and draws it: to a file, a viewer, or both.

use crate::convert::scene_from;
use crate::parameters::{Declared, ParameterServer};
use crate::recorder::absolute_name;
use crate::{Failure, Host, Listener, Outcome, qos};
use bag::msg::{SceneDescription, TickBatch};
use bag::tick_from_msg;
use inspect::{Feed, Options, Sink, Subject};
use r2r::ParameterValue as V;
use scene::Scene;
use servo::TickRecord;
use std::path::{Path, PathBuf};
use std::time::Duration;

/// What a file may take to swallow the rest.
const FILE_FLUSH: Duration = Duration::from_secs(10);
/// And a viewer, which may not be there at all: launchers kill what has not ended five seconds after their signal.
const VIEWER_FLUSH: Duration = Duration::from_secs(2);

/// Where the pictures come from and go to.
#[derive(Clone, Debug)]
pub struct PictureOptions {
    sinks: Vec<Sink>,
    servo: String,
    scene: Option<PathBuf>,
}

impl PictureOptions {
    /// The node's parameters.
    #[must_use]
    pub fn declared() -> Vec<Declared> {
        let text = |s: &str| V::String(s.to_owned());
        vec![
            Declared::fixed("output", text(""), "the .rrd file to write; empty: none"),
            Declared::fixed("viewer", V::Bool(false), "whether to draw in a running viewer, see `address`"),
            Declared::fixed("address", text("127.0.0.1:9876"), "the viewer's HOST:PORT"),
            Declared::fixed("servo", text("haptic_servo"), "the servo node to draw"),
            Declared::fixed("scene", text(""), "scene file; empty: the one that the servo tells"),
        ]
    }

    /// The options as the parameters have them; relative names are taken in `namespace`.
    ///
    /// # Errors
    /// If there is neither a file nor a viewer.
    pub fn from_parameters(parameters: &ParameterServer, namespace: &str) -> Outcome<Self> {
        let (output, scene) = (parameters.text("output"), parameters.text("scene"));
        let mut sinks = Vec::new();
        if !output.is_empty() {
            sinks.push(Sink::File(output.into()));
        }
        if parameters.switch("viewer") {
            sinks.push(Sink::Viewer(parameters.text("address")));
        }
        if sinks.is_empty() {
            return Err(Failure::new("nowhere to draw: set -p output:=FILE.rrd or -p viewer:=true"));
        }
        sinks.iter().try_for_each(Sink::check).map_err(|e| Failure::new(e.to_string()))?;
        Ok(Self {
            sinks,
            servo: absolute_name(namespace, &parameters.text("servo")),
            scene: (!scene.is_empty()).then(|| scene.into()),
        })
    }
}

/// The drawing in progress.
pub struct Pictures {
    options: PictureOptions,
    ticks: Listener<TickBatch>,
    scenes: Listener<SceneDescription>,
    feeds: Vec<Feed>,
    waiting: Vec<TickRecord>,
    hash: String,
    drawn: u64,
}

impl Pictures {
    /// Ticks that are kept while the scene is not known yet: ten seconds at 1 kHz.
    const WAITING: usize = 10_000;

    /// Subscribes, and opens the sinks at once if the scene is given by a file.
    ///
    /// # Errors
    /// An unreadable scene, a file that cannot be written.
    pub fn new(host: &mut Host, options: PictureOptions) -> Outcome<Self> {
        // A file that cannot be written is an error before any work is done.
        for sink in &options.sinks {
            if let Sink::File(path) = sink {
                std::fs::File::create(path).map_err(|e| Failure::new(format!("{}: {e}", path.display())))?;
            }
        }
        let servo = &options.servo;
        let mut pictures = Self {
            ticks: Listener::new(&mut host.node, &format!("{servo}/ticks"), qos::every_tick())?,
            scenes: Listener::new(&mut host.node, &format!("{servo}/scene"), qos::latched(1))?,
            feeds: Vec::new(),
            waiting: Vec::new(),
            hash: String::new(),
            drawn: 0,
            options,
        };
        if let Some(path) = pictures.options.scene.clone() {
            let scene = Scene::load(&path).map_err(|e| Failure::new(e.to_string()))?;
            pictures.open(&scene)?;
        }
        Ok(pictures)
    }

    /// One turn: waits up to `timeout` for ticks and hands them on. True if any came.
    ///
    /// # Errors
    /// An unreadable scene or sink, ticks of another version.
    pub fn turn(&mut self, host: &mut Host, timeout: Duration) -> Outcome<bool> {
        host.spin_once(timeout);
        if let Some(description) = self.scenes.take_newest() {
            self.hear_scene(host, &description)?;
        }
        let mut came = false;
        while let Some(batch) = self.ticks.take() {
            came = true;
            if batch.version != TickRecord::VERSION {
                return Err(Failure::new(format!(
                    "{}/ticks: layout version {}, this program knows {}; use programs of the same version",
                    self.options.servo,
                    batch.version,
                    TickRecord::VERSION
                )));
            }
            for tick in &batch.ticks {
                let tick = tick_from_msg(tick).map_err(|e| Failure::new(e.to_string()))?;
                self.draw(tick);
            }
        }
        Ok(came)
    }

    /// Ends the pictures; each sink has its time to take what is left. Says what was drawn.
    ///
    /// # Errors
    /// If no scene ever came, or a sink did not take everything.
    pub fn finish(self) -> Outcome<String> {
        if self.feeds.is_empty() {
            return Err(Failure::new(format!(
                "nothing was drawn: no scene came from {}; is it running, and on this ROS domain?",
                self.options.servo
            )));
        }
        let dropped: u64 = self.feeds.iter().map(Feed::dropped).sum();
        for (feed, sink) in self.feeds.into_iter().zip(&self.options.sinks) {
            let timeout = if matches!(sink, Sink::File(_)) { FILE_FLUSH } else { VIEWER_FLUSH };
            feed.finish(timeout).map_err(|e| Failure::new(e.to_string()))?;
        }
        Ok(format!("drawn: ticks={} dropped={dropped}", self.drawn))
    }

    fn hear_scene(&mut self, host: &Host, description: &SceneDescription) -> Outcome<()> {
        if self.feeds.is_empty() {
            let scene = scene_from(description)?;
            self.open(&scene)?;
        } else if !self.hash.is_empty() && self.hash != description.sha256 {
            host.warn(&format!(
                "{} now has scene {}; start this node anew to draw it",
                self.options.servo, description.name
            ));
        }
        self.hash.clone_from(&description.sha256);
        Ok(())
    }

    fn open(&mut self, scene: &Scene) -> Outcome<()> {
        let stem =
            |mesh: &str| Path::new(mesh).file_stem().map_or_else(String::new, |s| s.to_string_lossy().into_owned());
        let subject = Subject {
            name: scene.name.clone(),
            world: scene.world.clone(),
            moving_names: scene.moving.iter().flat_map(|b| b.parts.clone().map(|_| stem(&b.mesh))).collect(),
            fixed_names: scene.fixed.iter().map(|b| stem(&b.mesh)).collect(),
        };
        for sink in &self.options.sinks {
            let feed =
                Feed::start(subject.clone(), sink, &Options::default()).map_err(|e| Failure::new(e.to_string()))?;
            self.feeds.push(feed);
        }
        for tick in std::mem::take(&mut self.waiting) {
            self.draw(tick);
        }
        Ok(())
    }

    fn draw(&mut self, tick: TickRecord) {
        if self.feeds.is_empty() {
            if self.waiting.len() < Self::WAITING {
                self.waiting.push(tick);
            }
            return;
        }
        self.drawn += 1;
        for feed in &mut self.feeds {
            feed.tick(&tick);
        }
    }
}
