//! Pairs whose nearest plane is a seam: which felt plane counts for them, and where none is needed.

use super::{FREED, Scp, Touch, tie_of};
use crate::projection::Projection;
use crate::solid::{Covered, Pair, Placed, Sensed, Solids};
use cspace::{BasicContact, CFace};
use spatial::DVec3;

/// A felt plane that lies no more than this part of the depth behind its seam is taken without a look at others.
const CLOSE: f64 = 0.1;

/// A penetrating pair whose nearest plane is a seam, and its nearest felt plane once that has been looked for.
#[derive(Clone, Copy, Debug)]
pub(super) struct Unfelt {
    pair: Sensed,
    plane: Option<Option<CFace>>,
    /// The plane of some face proves it free where the others lead.
    parted: bool,
}

impl Unfelt {
    pub fn new(pair: &Sensed) -> Self {
        Self { pair: *pair, plane: None, parted: false }
    }

    /// Whether this felt plane lies so close behind the seam that it is a side of the solid there, and not a far one.
    fn is_close(&self, plane: &CFace) -> bool {
        self.pair.near.distance - plane.distance <= -CLOSE * self.pair.near.distance
    }

    /// The pair's nearest felt plane, which is looked for once.
    fn felt_plane(&mut self, solids: &Solids, placed: &Placed, hints: &mut [Option<BasicContact>]) -> Option<CFace> {
        let near = &self.pair.near;
        *self.plane.get_or_insert_with(|| {
            let pair = Pair::of(solids, &self.pair, placed);
            let hint = &mut hints[pair.part * solids.world.fixed.len() + pair.piece];
            pair.felt_plane(near, Covered::Felt, hint)
        })
    }
}

impl Scp {
    /// A pair whose nearest plane is a seam needs a felt plane of its own only where the others do not free it anyway: one
    /// plane with `f >= 0` at the SCP, felt or not, proves freedom. Those whose felt plane lies close behind the seam come first,
    /// then those where it lies least behind: the others may then be free rather than pushed out on a far side.
    /// But a way of more than `far` metres frees none whose felt plane lies close behind the seam.
    pub(super) fn add_unfelt(&mut self, solids: &Solids, placed: &Placed, far: f64) {
        loop {
            let Self { touches, unfelt, hints, projection, .. } = self;
            let shift = DVec3::from_array(projection.z);
            let freed = |c: &CFace| c.distance + c.normal_w.dot(shift) >= -FREED;
            let mut next = None;
            let mut least = f64::INFINITY;
            for (k, u) in unfelt.iter_mut().enumerate().filter(|(_, u)| !u.parted && !freed(&u.pair.near)) {
                if let Some(plane) = u.felt_plane(solids, placed, hints)
                    && u.pair.near.distance - plane.distance < least
                {
                    least = u.pair.near.distance - plane.distance;
                    next = Some((k, plane));
                    if u.is_close(&plane) {
                        break;
                    }
                }
            }
            let Some((k, plane)) = next else { break };
            let Sensed { part, piece, .. } = unfelt[k].pair;
            // An equal plane adds nothing to the force, but its contacts belong to the region.
            let again = !freed(&plane);
            // Near may be a joint that the way out runs along; then the plane of any face is proof as well, and so is one that holds
            // the SCP: it has what lies behind a rim behind it.
            let is_way_out = shift.length_squared() <= far * far || !unfelt[k].is_close(&plane);
            let there = placed.shifted(shift);
            let at_scp = Pair::new(solids, part, piece, &there);
            if again && is_way_out && is_parted(&at_scp, touches, projection) {
                unfelt[k].parted = true;
                continue;
            }
            unfelt.swap_remove(k);
            self.touch(solids, part, piece, plane);
            if again {
                self.projection.solve(&self.rows);
            }
        }
    }

    /// Adds the pairs that the others free, but that touch at the SCP all the same: their contacts belong to the region.
    pub(super) fn add_beside(&mut self, solids: &Solids, placed: &Placed) {
        let shift = DVec3::from_array(self.projection.z);
        for k in 0..self.unfelt.len() {
            let Sensed { part, piece, near } = self.unfelt[k].pair;
            let touches = |c: &CFace| (-FREED..=4.0 * tie_of(solids)).contains(&(c.distance + c.normal_w.dot(shift)));
            if touches(&near) {
                let plane = self.unfelt[k].felt_plane(solids, placed, &mut self.hints);
                if let Some(plane) = plane.filter(touches) {
                    self.touch(solids, part, piece, plane);
                }
            }
        }
    }

    /// Takes also the sides of the solid close behind seams that only the way out freed: where there is none they hold the part.
    pub(super) fn touch_unfelt(&mut self, solids: &Solids, placed: &Placed) {
        while let Some(mut u) = self.unfelt.pop() {
            let plane = u.felt_plane(solids, placed, &mut self.hints);
            if let Some(plane) = plane.filter(|p| u.is_close(p)) {
                self.touch(solids, u.pair.part, u.pair.piece, plane);
                self.nearest.extend(self.touches.last().copied());
            }
        }
    }
}

/// Whether the pair is proven free where the part is, by the plane of any face, or apart by one that holds the part there. What
/// only touches that one is a contact of the same wall.
pub(super) fn is_parted(pair: &Pair<'_>, touches: &[Touch], projection: &Projection<3>) -> bool {
    let mut holding = projection.active().map(|(i, _)| touches[i].plane.normal_w);
    let apart = 4.0 * tie_of(pair.solids);
    pair.a_face_parts(FREED) || holding.any(|n| pair.is_parted_along(n, -apart))
}
