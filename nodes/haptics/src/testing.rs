//! Bodies for the unit tests, and for the tests of the laws.

use cspace::Polyhedron;
use spatial::DVec3;

/// A box between two corners, metres.
pub fn cuboid(low: DVec3, high: DVec3) -> Polyhedron {
    let v: Vec<DVec3> = (0..8)
        .map(|i| {
            DVec3::new(
                if i & 1 == 0 { low.x } else { high.x },
                if i & 2 == 0 { low.y } else { high.y },
                if i & 4 == 0 { low.z } else { high.z },
            )
        })
        .collect();
    let faces =
        [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]].map(|f| f.to_vec());
    Polyhedron::from_faces(&v, &faces).expect("a box is a polyhedron")
}
