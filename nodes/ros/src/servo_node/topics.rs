use super::{Batcher, Due, Transforms};
use crate::convert::MarkerPainter;
use crate::{Outcome, Talker, qos};
use bag::msg;
use cspace::World;
use r2r::visualization_msgs::msg::MarkerArray;
use r2r::{Node, Publisher, QosProfile};
use servo::TickRecord;
use spatial::{Pose, Stamp, Wrench};

/// The frames' names: the world W and the manipulated part A.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Frames {
    /// W.
    pub world: String,
    /// A.
    pub part: String,
}

/// What the servo publishes of its ticks.
pub struct ServoTopics {
    frames: Frames,
    pose: Talker<msg::PoseStamped>,
    proxy_pose: Talker<msg::PoseStamped>,
    wrench: Talker<msg::WrenchStamped>,
    ticks: Talker<msg::TickBatch>,
    markers: Publisher<MarkerArray>,
    transforms: Option<Transforms>,
    painter: MarkerPainter,
    batcher: Batcher,
    poses_due: Due,
    markers_due: Due,
    standing_due: Due,
}

impl ServoTopics {
    /// Offers the topics; poses and wrenches go out `publish_rate` times a second, and transforms with them if
    /// `publish_tf` and this ROS has them.
    ///
    /// # Errors
    /// The middleware refuses a topic.
    pub fn new(
        node: &mut Node,
        frames: Frames,
        world: &World,
        publish_rate: f64,
        tick_rate: f64,
        publish_tf: bool,
    ) -> Outcome<Self> {
        let transforms = publish_tf.then(|| Transforms::offer(node, &frames.world, &frames.part)).flatten();
        Ok(Self {
            transforms,
            pose: Talker::new(node, "~/pose", qos::sensor())?,
            proxy_pose: Talker::new(node, "~/proxy_pose", qos::sensor())?,
            wrench: Talker::new(node, "~/wrench", qos::sensor())?,
            ticks: Talker::new(node, "~/ticks", qos::every_tick())?,
            markers: node.create_publisher("~/markers", QosProfile::default())?,
            painter: MarkerPainter::new(world, &frames.world),
            batcher: Batcher::new(&frames.world, &frames.part, (tick_rate / 100.0).ceil() as usize),
            poses_due: Due::every(1.0 / publish_rate),
            markers_due: Due::every(1.0 / 20.0),
            standing_due: Due::every(1.0),
            frames,
        })
    }

    /// Publishes what a tick gives rise to.
    ///
    /// # Errors
    /// The middleware refuses a message.
    pub fn tick(&mut self, tick: &TickRecord, lost: u64) -> Outcome<()> {
        let at = tick.input.stamp;
        if self.poses_due.at(at) {
            self.pose.say(&self.pose_message(at, &tick.hip))?;
            self.proxy_pose.say(&self.pose_message(at, &tick.proxy))?;
            self.wrench.say(&self.wrench_message(at, &tick.out_wrench))?;
            if let Some(transforms) = &self.transforms {
                transforms.tell(tick)?;
            }
        }
        if self.batcher.add(tick, lost) {
            self.flush()?;
        }
        if self.markers_due.at(at) && self.markers.get_inter_process_subscription_count().unwrap_or(0) > 0 {
            self.markers.publish(&self.painter.moving(tick))?;
            if self.standing_due.at(at) {
                self.markers.publish(&self.painter.standing(at))?;
            }
        }
        Ok(())
    }

    /// Sends the ticks that wait for company.
    ///
    /// # Errors
    /// The middleware refuses the message.
    pub fn flush(&mut self) -> Outcome<()> {
        if let Some(batch) = self.batcher.batch() {
            self.ticks.say(batch)?;
        }
        self.batcher.clear();
        Ok(())
    }

    /// The last word on the wrench topic: no force.
    ///
    /// # Errors
    /// The middleware refuses the message.
    pub fn say_no_force(&self, at: Stamp) -> Outcome<()> {
        self.wrench.say(&self.wrench_message(at, &Wrench::ZERO))
    }

    fn header(&self, at: Stamp) -> msg::Header {
        msg::Header { stamp: at.into(), frame_id: self.frames.world.clone() }
    }

    fn pose_message(&self, at: Stamp, pose: &Pose) -> msg::PoseStamped {
        msg::PoseStamped { header: self.header(at), pose: (*pose).into() }
    }

    fn wrench_message(&self, at: Stamp, wrench: &Wrench) -> msg::WrenchStamped {
        msg::WrenchStamped { header: self.header(at), wrench: (*wrench).into() }
    }
}
