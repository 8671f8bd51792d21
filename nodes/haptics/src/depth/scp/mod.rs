//! The surface contact point: the nearest touching configuration to the hand's at its orientation, one or more obstacles.

mod hold;
mod lasting;
mod refine;
mod unfelt;

use crate::projection::{Projection, Row};
use crate::region::{Gone, TIED, Way};
use crate::solid::{Covered, OnePlane, Pair, Placed, SAME, Sense, Sensed, Solids};
use cspace::{BasicContact, CFace};
use hold::Held;
use lasting::Lasting;
use spatial::{DVec3, Pose};
use unfelt::{Unfelt, is_parted};

/// Pairs this close to the hand may bound the SCP, metres.
pub(crate) const SCP_MARGIN: f64 = 5e-3;
/// A pair is free of the SCP when its plane is violated by no more than this, metres; and touches up to as much above it.
const FREED: f64 = 1e-9;
/// Another plane of a pair is taken where the square of the way to the SCP becomes less than this part of it.
const NEARER: f64 = 1.0 - 1e-6;
/// An SCP farther than this many depths from the hand is compared with what other starts lead to.
const FAR: f64 = 3.0;
/// Pairs this close to the SCP are looked at there, in sizes of the moving part.
const BESIDE: f64 = 6.0;

/// A pair whose plane counts: the felt one, and its contacts in the scratch list.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Touch {
    pub part: u32,
    pub piece: u32,
    /// Its `distance` is that of the hand.
    pub plane: CFace,
    pub first: usize,
    pub end: usize,
    /// From where to where those of its region follow that belong to other pairs.
    pub beside: [usize; 2],
    pub tie: f64,
    /// Its signed distance where its contacts are looked for, metres.
    pub left: f64,
    /// Contacts of this plane, and of those that are one with it, take place up to this gap, metres.
    pub level: f64,
    /// Share of the force that the plane carries: shift = sum push_i normal_i, metres.
    pub push: f64,
    /// It was found where the SCP is.
    pub found_there: bool,
    /// It is felt where the SCP is, and not where the hand is.
    pub felt_there: bool,
}

impl Touch {
    /// The plane where its contacts are looked for.
    pub fn plane_there(&self) -> CFace {
        CFace { distance: self.left, ..self.plane }
    }
}

/// Finds the SCP: corners by projection, `argmin |p - x0|^2` with p on the free side of one plane per pair.
///
/// Planes near the hand decide. Where obstacles crowd, these may ask too much (planes that meet far beyond their
/// faces) or too little; then each pair's plane is taken anew at the SCP itself until it touches and penetrates nothing.
/// One plane of a pair with `f >= 0` is enough for freedom, so each round admits the last one's SCP and comes nearer.
#[derive(Debug)]
pub(crate) struct Scp {
    pub touches: Vec<Touch>,
    best: Vec<Touch>,
    /// The planes nearest to the hand, if others were taken since.
    nearest: Vec<Touch>,
    rows: Vec<Row<3>>,
    unfelt: Vec<Unfelt>,
    projection: Projection<3>,
    shift: DVec3,
    /// For each pair the plane last felt where Near is a seam.
    hints: Vec<Option<BasicContact>>,
    /// For each pair what holds while the part goes on.
    lasting: Vec<Lasting>,
    pieces: usize,
    /// The tracker that looks around from the SCP.
    around: Sense,
    /// The last SCP.
    last: Option<DVec3>,
    held: Option<Held>,
    /// The way of the hand, and where it is.
    way: Way,
    gone: Gone,
    /// The way of the SCP.
    scp_way: Way,
    /// It is a compromise: the parts are wedged.
    wedged: bool,
    /// Which of the planes the last compromise violates.
    yielding: u64,
    /// Looks around left in this tick.
    looks: usize,
    /// Size of the largest part, metres.
    size: f64,
}

impl Scp {
    pub fn new(solids: &Solids) -> Self {
        let world = &solids.world;
        let pairs = world.moving.len() * world.fixed.len();
        let size = world.moving.iter().map(|p| p.size()).fold(0.0, f64::max);
        Self {
            touches: Vec::with_capacity(pairs),
            best: Vec::with_capacity(pairs),
            nearest: Vec::with_capacity(pairs),
            rows: Vec::with_capacity(pairs),
            unfelt: Vec::with_capacity(pairs),
            projection: Projection::new(),
            shift: DVec3::ZERO,
            hints: vec![None; pairs],
            lasting: vec![Lasting::NOTHING; pairs],
            pieces: world.fixed.len(),
            around: Sense::new(world.clone(), BESIDE * size),
            last: None,
            held: None,
            way: Way::new(solids.lever()),
            gone: Gone::NEVER,
            scp_way: Way::new(solids.lever()),
            wedged: false,
            yielding: 0,
            looks: 0,
            size,
        }
    }

    pub fn reset(&mut self) {
        self.last = None;
        self.held = None;
        self.wedged = false;
        self.yielding = 0;
        self.hints.fill(None);
        self.lasting.fill(Lasting::NOTHING);
        self.around.reset();
    }

    /// From the hand to the SCP, metres, axes of W.
    pub fn shift(&self) -> DVec3 {
        self.shift
    }

    /// The penetration of the hand's pose, metres, `>= 0`: the largest over the planes that count.
    pub fn depth(&mut self, solids: &Solids, pairs: &[Sensed], hip: &Pose, placed: &Placed) -> f64 {
        self.last = None;
        self.gone = self.way.go(hip.translation, hip.rotation);
        self.hold_depth(solids, pairs, hip, placed).unwrap_or_else(|| {
            let depth = self.project(solids, pairs, placed, true);
            self.begin_to_hold_depth(solids, pairs, hip, placed, depth);
            depth
        })
    }

    /// Finds the SCP and the planes that hold it, in `touches`; returns the depth as [`Scp::depth`] does.
    pub fn find(&mut self, solids: &Solids, pairs: &[Sensed], hip: &Pose, placed: &Placed) -> f64 {
        if self.held.is_none() && pairs.iter().all(|s| s.near.distance >= 0.0) {
            self.touches.clear();
            (self.last, self.wedged) = (None, false);
            return 0.0;
        }
        self.gone = self.way.go(hip.translation, hip.rotation);
        let depth = match self.hold(solids, pairs, hip, placed) {
            Some(depth) => depth,
            None => self.search(solids, pairs, hip, placed),
        };
        if depth <= 0.0 {
            self.last = None;
            self.wedged = false;
            return depth;
        }
        // What the others push free of is no contact at the SCP; planes equal to one that pushes are.
        let shift = self.shift;
        self.touches.retain(|t| t.plane.distance + t.plane.normal_w.dot(shift) <= 4.0 * t.tie);
        self.last = Some(hip.translation + self.shift);
        depth
    }

    /// A pair is free on the side of any of its planes: of each pair that holds the SCP among others takes the plane that lets
    /// the SCP come nearest to the hand. The nearest to the hand need not be: where the top of a wall carries together with
    /// others, its side holds nothing back. Where planes contradict each other, others may resolve it.
    fn choose(&mut self, solids: &Solids, placed: &Placed, depth: f64) {
        self.nearest.clear();
        if self.projection.active().count() < 2 && self.projection.contradictions == 0 {
            return;
        }
        for i in 0..self.touches.len() {
            let t = self.touches[i];
            let (rows, projection) = (&mut self.rows, &mut self.projection);
            let contradicted = projection.contradictions > 0;
            let z = DVec3::from_array(projection.z);
            let holds = projection.active().any(|(k, _)| k == i)
                || contradicted && t.plane.distance + t.plane.normal_w.dot(z) < -FREED;
            if !holds {
                continue;
            }
            let pair = Pair::new(solids, t.part, t.piece, placed);
            let rank = |p: &Projection<3>| (p.contradictions, p.way_squared());
            let (contradictions, way_squared) = rank(projection);
            let mut least = (contradictions, NEARER * way_squared);
            // The SCP is no nearer than any plane's foot.
            let reach = if contradicted { FAR * depth } else { least.1.sqrt() };
            let (mut best, mut tried) = (t.plane, false);
            pair.offer_planes_beside(&t.plane, -reach, SAME, |face| {
                if pair.is_felt(&face, Covered::Unfelt) {
                    tried = true;
                    rows[i] = row(&face);
                    projection.solve(rows);
                    if rank(projection) < least {
                        least = rank(projection);
                        best = face;
                    }
                }
            });
            if best != t.plane && self.nearest.is_empty() {
                self.nearest.extend_from_slice(&self.touches);
            }
            if tried {
                self.touches[i].plane = best;
                rows[i] = row(&best);
                projection.solve(rows);
            }
        }
    }

    /// From the planes near the hand to the SCP and the planes that hold it.
    fn search(&mut self, solids: &Solids, pairs: &[Sensed], hip: &Pose, placed: &Placed) -> f64 {
        let depth = self.project(solids, pairs, placed, false);
        if depth <= 0.0 {
            return depth;
        }
        self.choose(solids, placed, depth);
        self.take_projection();
        self.wedged = !self.is_plain(solids, hip, placed, depth) && !self.refine(solids, hip, depth);
        if self.wedged {
            let depth = self.depth_of_touches();
            self.hold_wedged(pairs, hip, depth);
            return depth;
        }
        // Either planes may lie deeper than the pairs do: a far one beside a seam, or one that frees a pair at the SCP.
        let depth = depth.min(self.depth_of_touches());
        self.begin_to_hold(solids, pairs, hip, placed, depth);
        depth
    }

    fn take_projection(&mut self) {
        self.shift = DVec3::from_array(self.projection.z);
        for t in &mut self.touches {
            t.push = 0.0;
        }
        for (i, m) in self.projection.active() {
            self.touches[i].push = m;
        }
    }

    /// Whether the SCP is known to touch and to be free without a look around: its planes' features face each other there, and
    /// all pairs that it could reach were among the constraints.
    fn is_plain(&mut self, solids: &Solids, hip: &Pose, placed: &Placed, depth: f64) -> bool {
        let way = self.shift.length();
        if self.projection.contradictions > 0 || way > SCP_MARGIN || way > 2.0 * depth {
            return false;
        }
        let mut active = self.touches.iter().filter(|t| t.push > 0.0);
        if let (Some(one), None) = (active.next(), active.next()) {
            // The foot on the nearest plane of a pair that is penetrated lies on its C-face.
            if self.nearest.is_empty() {
                return one.plane.distance < 0.0;
            }
        }
        self.takes_place(solids, hip, &placed.shifted(self.shift))
    }

    /// Whether the planes that push have contacts that take place at the SCP.
    fn takes_place(&mut self, solids: &Solids, hip: &Pose, scp: &Placed) -> bool {
        let Self { touches, lasting, pieces, scp_way, .. } = self;
        let known = (scp_way.go(scp.x, hip.rotation), scp_way.lever);
        let mut touches_there = |part: u32, piece: u32, contact: BasicContact, plane: &CFace| {
            let lasting = &mut lasting[part as usize * *pieces + piece as usize];
            lasting.faces(contact, FREED, known, || {
                (Pair::new(solids, part, piece, scp), CFace { contact, distance: 0.0, ..*plane })
            })
        };
        // Of the pieces that one wall is cut into, any may carry the force, and any other be touched.
        let same_wall = |t: &Touch, u: &Touch| OnePlane::EXACT.holds_for(&t.plane, &u.plane);
        touches.iter().filter(|t| t.push > 0.0).all(|t| {
            touches_there(t.part, t.piece, t.plane.contact, &t.plane)
                || touches.iter().any(|u| same_wall(t, u) && touches_there(u.part, u.piece, u.plane.contact, &u.plane))
                || solids
                    .flush_contacts(t.part, t.piece, t.plane.contact)
                    .any(|(part, piece, contact)| touches_there(part, piece, contact, &t.plane))
        })
    }

    /// Projection on the planes near the hand; returns the depth. Leaves planes in `touches` and, unless the depth alone is
    /// wanted, multipliers in `projection`.
    fn project(&mut self, solids: &Solids, pairs: &[Sensed], placed: &Placed, depth_alone: bool) -> f64 {
        self.touches.clear();
        self.rows.clear();
        let deepest = pairs.iter().map(|p| -p.near.distance).fold(0.0, f64::max);
        if deepest <= 0.0 {
            return 0.0;
        }
        self.unfelt.clear();
        for s in pairs {
            // Free pairs stay as constraints as far as the SCP may be pushed into them.
            if s.near.distance > 2.0 * deepest {
                continue;
            }
            if self.is_felt(solids, s, placed, Covered::Unfelt) {
                self.touch(solids, s.part, s.piece, s.near);
            } else if s.near.distance < 0.0 || !depth_alone {
                self.unfelt.push(Unfelt::new(s));
            }
        }
        if self.unfelt.is_empty() && depth_alone {
            return self.depth_of_touches();
        }
        self.projection.solve(&self.rows);
        self.add_unfelt(solids, placed, if depth_alone { FAR * deepest } else { f64::INFINITY });
        if !depth_alone {
            self.add_beside(solids, placed);
        }
        self.depth_of_touches()
    }

    /// Whether the pair's nearest plane is felt: see [`Pair::is_felt`].
    fn is_felt(&mut self, solids: &Solids, s: &Sensed, placed: &Placed, covered: Covered) -> bool {
        let known = (self.gone, self.way.lever);
        let lasting = &mut self.lasting[s.part as usize * self.pieces + s.piece as usize];
        lasting.is_felt(&s.near, covered, known, || Pair::of(solids, s, placed))
    }

    fn depth_of_touches(&self) -> f64 {
        self.touches.iter().map(|t| -t.plane.distance).fold(0.0, f64::max)
    }

    fn touch(&mut self, solids: &Solids, part: u32, piece: u32, plane: CFace) {
        self.touches.push(Touch {
            part,
            piece,
            plane,
            first: 0,
            end: 0,
            beside: [0; 2],
            tie: tie_of(solids),
            left: 0.0,
            level: 0.0,
            push: 0.0,
            found_there: false,
            felt_there: false,
        });
        self.rows.push(row(&plane));
    }
}

fn row(plane: &CFace) -> Row<3> {
    Row { normal: plane.normal_w.to_array(), offset: -plane.distance, equality: false }
}

/// Contacts of A that lie this close together take place together, metres: the same for all its parts, or one that is cut would
/// take on a contact in another tick than the whole.
fn tie_of(solids: &Solids) -> f64 {
    2.0 * solids.size * TIED
}
