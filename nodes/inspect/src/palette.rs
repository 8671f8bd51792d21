//! One place for every colour. Chosen after Okabe and Ito (2008), so that they stay apart for colour-blind readers,
//! and of middle brightness, so that they read on a light and on a dark ground.

use rerun::Rgba32;

/// A colour as `[r, g, b]`.
pub(crate) type Rgb = [u8; 3];

/// C-faces on which a contact takes place.
pub(crate) const TOUCHING: Rgb = [0xD5, 0x3E, 0x0F];
/// Near of each pair.
pub(crate) const NEAR: Rgb = [0xF0, 0x8C, 0x00];
/// The local subgraph's C-faces besides Near.
pub(crate) const LOCAL: Rgb = [0xE0, 0xC0, 0x30];
/// The other applicable C-faces.
pub(crate) const OTHER: Rgb = [0x4C, 0x9B, 0xD6];
/// The hand: haptic interface point and ghost.
pub(crate) const HIP: Rgb = [0xC8, 0x5C, 0xC8];
/// The surface contact point and the part that touches.
pub(crate) const SCP: Rgb = [0x0A, 0xA5, 0x78];
/// Force on the hand.
pub(crate) const FORCE: Rgb = [0x2B, 0x6F, 0xE0];
/// Torque on the hand.
pub(crate) const TORQUE: Rgb = [0x8A, 0x5A, 0xD8];
/// Obstacles.
pub(crate) const OBSTACLE: Rgb = [0x8C, 0x96, 0xA4];
/// Text and lines that carry no meaning of their own.
pub(crate) const PLAIN: Rgb = [0x80, 0x88, 0x92];
/// The ground of the 3D views, dark in both themes of the viewer.
pub(crate) const GROUND: Rgb = [0x17, 0x1B, 0x22];
/// The three axes of a vector's components.
pub(crate) const AXES: [Rgb; 3] = [[0xE0, 0x4A, 0x4A], [0x3C, 0xA9, 0x4C], [0x3D, 0x7C, 0xE8]];

/// Colours of the contact formations, in the order of `FormationKind`.
pub(crate) const FORMATIONS: [Rgb; 5] = [PLAIN, [0x4C, 0x9B, 0xD6], [0x0A, 0xA5, 0x78], NEAR, TOUCHING];

/// Opaque.
pub(crate) fn solid([r, g, b]: Rgb) -> Rgba32 {
    Rgba32::from_rgb(r, g, b)
}

/// Translucent; `alpha` in `[0, 1]`.
pub(crate) fn glass([r, g, b]: Rgb, alpha: f32) -> Rgba32 {
    Rgba32::from_unmultiplied_rgba(r, g, b, (alpha * 255.0) as u8)
}
