//! Plays a bag: what it holds, at its times.

use crate::parameters::{Declared, ParameterServer};
use crate::{Failure, Host, Inbox, Outcome, qos};
use bag::{BagMessage, BagReader, Messages, Topic};
use r2r::qos::ReliabilityPolicy;
use r2r::rosgraph_msgs::msg::Clock;
use r2r::std_srvs::srv::SetBool;
use r2r::{Node, ParameterValue as V, Publisher, PublisherUntyped, QosProfile, ServiceRequest};
use spatial::Stamp;
use std::path::Path;
use std::time::{Duration, Instant};

/// The player's parameters.
#[must_use]
pub fn declared() -> Vec<Declared> {
    vec![
        Declared::fixed("bag", V::String(String::new()), "the bag to play: a rosbag2 MCAP folder or file"),
        Declared::fixed("topics", V::StringArray(Vec::new()), "topics to play; empty: all"),
        Declared::fixed("rate", V::Double(1.0), "speed of play, 1 as recorded").within(0.01, 100.0).live(),
        Declared::fixed("loop", V::Bool(false), "whether to begin again at the end").live(),
        Declared::fixed("paused", V::Bool(false), "whether to stand still; also by ~/pause").live(),
        Declared::fixed("start", V::Double(0.0), "where to begin, or to go on when it is set while playing [s]")
            .within(0.0, 1e9)
            .live(),
        Declared::fixed("clock", V::Bool(false), "whether to publish /clock with the bag's time"),
        Declared::fixed(
            "wait_for_listeners",
            V::Double(1.0),
            "time given to listeners to find the topics before play [s]",
        )
        .within(0.0, 60.0),
    ]
}

/// A bag that plays.
pub struct Player<'h> {
    host: &'h mut Host,
    parameters: ParameterServer,
    pause: Inbox<ServiceRequest<SetBool::Service>>,
    paused: bool,
    clock: Option<Publisher<Clock>>,
    /// By the bag's numbering; none where the type is not known here or the topic is not wanted.
    topics: Vec<Option<Played>>,
    /// Where to go on, once `start` was set.
    seek: Option<f64>,
    played: u64,
}

struct Played {
    out: PublisherUntyped,
    latched: bool,
}

/// How a round ended.
enum End {
    Stopped,
    Finished,
    Seek(f64),
}

impl<'h> Player<'h> {
    /// Declares the parameters.
    ///
    /// # Errors
    /// A parameter is refused.
    pub fn start(host: &'h mut Host) -> Outcome<Self> {
        let parameters = ParameterServer::new(&mut host.node, declared())?;
        let pause =
            Inbox::new(host.node.create_service::<SetBool::Service>("~/pause", QosProfile::services_default())?);
        let clock = if parameters.switch("clock") {
            Some(host.node.create_publisher("/clock", QosProfile::sensor_data())?)
        } else {
            None
        };
        let paused = parameters.switch("paused");
        Ok(Self { host, pause, paused, clock, topics: Vec::new(), seek: None, played: 0, parameters })
    }

    /// Plays to the end, or until a signal.
    ///
    /// # Errors
    /// The bag cannot be read, or the middleware fails.
    pub fn run(mut self) -> Outcome<()> {
        let name = self.parameters.text("bag");
        if name.is_empty() {
            return Err(Failure::new("parameter `bag` is not set: name a bag to play, for example -p bag:=FOLDER"));
        }
        let reader = BagReader::open(Path::new(&name)).map_err(|e| Failure::new(e.to_string()))?;
        self.offer(reader.topics())?;
        let mut first = reader.messages();
        let Some(begin) = first.next().map(|m| m.stamp) else {
            return Err(Failure::new(format!("{name}: the bag holds no messages")));
        };
        drop(first);
        self.host.say_ready();
        self.wait(self.parameters.number("wait_for_listeners"))?;
        let mut offset = self.parameters.number("start");
        loop {
            match self.round(reader.messages(), begin, offset)? {
                End::Stopped => break,
                End::Seek(to) => offset = to,
                End::Finished if self.parameters.switch("loop") => offset = 0.0,
                End::Finished => break,
            }
        }
        // What was just published is still on its way.
        self.wait(0.2)?;
        self.host.say(&format!("played {} messages", self.played));
        Ok(())
    }

    fn offer(&mut self, topics: &[Topic]) -> Outcome<()> {
        let wanted = self.parameters.texts("topics");
        for topic in topics {
            let chosen = wanted.is_empty() || wanted.contains(&topic.name);
            let played = if chosen { self.offer_one(topic) } else { None };
            self.topics.push(played);
        }
        if self.topics.iter().all(Option::is_none) {
            return Err(Failure::new("nothing to play: none of the bag's topics is wanted and of a type known here"));
        }
        Ok(())
    }

    fn offer_one(&mut self, topic: &Topic) -> Option<Played> {
        let (profile, latched) = recorded_qos(&topic.qos);
        match publisher(&mut self.host.node, topic, profile) {
            Ok(out) => Some(Played { out, latched }),
            Err(e) => {
                self.host.warn(&format!("topic {} ({}) is not played: {e}", topic.name, topic.type_name));
                None
            }
        }
    }

    /// Plays from `offset` seconds behind `begin` on.
    fn round(&mut self, messages: Messages<'_>, begin: Stamp, offset: f64) -> Outcome<End> {
        let start = begin.0 + (offset * 1e9) as i64;
        let mut position = start as f64;
        let mut last = Instant::now();
        let mut clock_at = last;
        for message in messages {
            // What a late joiner is to have belongs before any place in the bag.
            if message.stamp.0 < start && !self.is_latched(&message) {
                continue;
            }
            while message.stamp.0 as f64 > position {
                let ahead = (message.stamp.0 as f64 - position) * 1e-9 / self.parameters.number("rate");
                self.turn(Duration::from_secs_f64(ahead.clamp(0.0, 0.005)))?;
                if let Some(to) = self.seek.take() {
                    return Ok(End::Seek(to));
                }
                if self.host.stopped() {
                    return Ok(End::Stopped);
                }
                let now = Instant::now();
                if !self.paused {
                    position += (now - last).as_secs_f64() * 1e9 * self.parameters.number("rate");
                }
                last = now;
                if now >= clock_at {
                    clock_at = now + Duration::from_millis(10);
                    self.say_clock(Stamp(position as i64))?;
                }
            }
            self.publish(&message)?;
        }
        Ok(End::Finished)
    }

    fn is_latched(&self, message: &BagMessage) -> bool {
        matches!(self.topics.get(message.topic), Some(Some(t)) if t.latched)
    }

    fn publish(&mut self, message: &BagMessage) -> Outcome<()> {
        if let Some(Some(topic)) = self.topics.get(message.topic) {
            topic.out.publish_raw(&message.data)?;
            self.played += 1;
        }
        Ok(())
    }

    fn say_clock(&self, at: Stamp) -> Outcome<()> {
        if let Some(clock) = &self.clock {
            clock.publish(&Clock { clock: crate::convert::time(at) })?;
        }
        Ok(())
    }

    fn wait(&mut self, seconds: f64) -> Outcome<()> {
        let end = Instant::now() + Duration::from_secs_f64(seconds);
        while Instant::now() < end && !self.host.stopped() {
            self.turn(Duration::from_millis(10))?;
        }
        Ok(())
    }

    fn turn(&mut self, timeout: Duration) -> Outcome<()> {
        self.host.spin_once(timeout);
        while let Some(request) = self.pause.take() {
            self.paused = request.message.data;
            let message = if self.paused { "paused" } else { "playing" };
            request.respond(SetBool::Response { success: true, message: message.into() })?;
        }
        let (paused, seek) = (&mut self.paused, &mut self.seek);
        self.parameters.serve(self.host.now(), &mut |new| {
            if let Some(V::Bool(p)) = new.get("paused") {
                *paused = *p;
            }
            if let Some(V::Double(s)) = new.get("start") {
                *seek = Some(*s);
            }
            Ok(())
        })
    }
}

fn publisher(node: &mut Node, topic: &Topic, profile: QosProfile) -> Result<PublisherUntyped, r2r::Error> {
    // The binding looks a type up by its parts and gives up the process on a name that is none.
    if topic.type_name.split('/').count() != 3 {
        return Err(r2r::Error::InvalidMessageType { msgtype: topic.type_name.clone() });
    }
    node.create_publisher_untyped(&topic.name, &topic.type_name, profile)
}

/// The profile that the topic was offered with, as far as a bag tells it, and whether it is kept for late joiners.
fn recorded_qos(text: &str) -> (QosProfile, bool) {
    // rosbag2 writes words; older bags write the middleware's numbers.
    let is = |key: &str, word: &str, number: &str| {
        text.lines().filter_map(|l| l.trim().trim_start_matches("- ").strip_prefix(key)).any(|v| {
            let v = v.trim_start_matches(':').trim();
            v == word || v == number
        })
    };
    let latched = is("durability", "transient_local", "1");
    let mut profile = if latched { qos::latched(1000) } else { QosProfile { depth: 1000, ..QosProfile::default() } };
    if is("reliability", "best_effort", "2") {
        profile.reliability = ReliabilityPolicy::BestEffort;
    }
    (profile, latched)
}

#[cfg(test)]
mod tests {
    use super::*;
    use r2r::qos::DurabilityPolicy;

    #[test]
    fn the_recorded_profile_is_offered_again() {
        let (p, latched) =
            recorded_qos("- history: keep_last\n  depth: 1\n  reliability: reliable\n  durability: transient_local\n");
        assert!(
            latched && p.durability == DurabilityPolicy::TransientLocal && p.reliability == ReliabilityPolicy::Reliable
        );
        let (p, latched) = recorded_qos("- history: 1\n  reliability: 2\n  durability: 2\n");
        assert!(!latched && p.reliability == ReliabilityPolicy::BestEffort);
        assert!(!recorded_qos("").1);
    }
}
