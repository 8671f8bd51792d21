//! One place for every colour. Chosen after Okabe and Ito (2008), so that they stay apart for colour-blind readers,
//! and of middle brightness, so that areas and lines show on a light and on a dark ground; text is written in [`ink`].

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
/// The three axes of a vector's components.
pub(crate) const AXES: [Rgb; 3] = [[0xE0, 0x4A, 0x4A], [0x3C, 0xA9, 0x4C], [0x3D, 0x7C, 0xE8]];

/// Colours of the contact formations, in the order of `FormationKind`.
pub(crate) const FORMATIONS: [Rgb; 5] = [PLAIN, [0x4C, 0x9B, 0xD6], [0x0A, 0xA5, 0x78], NEAR, TOUCHING];

/// Opaque.
pub(crate) fn solid([r, g, b]: Rgb) -> Rgba32 {
    Rgba32::from_rgb(r, g, b)
}

/// To write in: the same hue, as bright as reads equally well on black and on white, the grounds of the viewer's themes.
pub(crate) fn ink(color: Rgb) -> Rgba32 {
    let linear = color.map(|c| (f64::from(c) / 255.0).powf(GAMMA));
    let scale = INK_LUMINANCE / luminance(linear);
    let [r, g, b] = linear.map(|c| ((c * scale).min(1.0).powf(1.0 / GAMMA) * 255.0).round() as u8);
    Rgba32::from_rgb(r, g, b)
}

/// Of a screen, nearly enough.
const GAMMA: f64 = 2.2;
/// Contrast is `(bright + 0.05) / (dark + 0.05)` (WCAG 2.1): here it is 4.6 to white as well as to black.
const INK_LUMINANCE: f64 = 0.179;

/// Brightness of a colour in linear light, 0 to 1.
fn luminance([r, g, b]: [f64; 3]) -> f64 {
    0.2126 * r + 0.7152 * g + 0.0722 * b
}

/// Translucent; `alpha` in `[0, 1]`.
pub(crate) fn glass([r, g, b]: Rgb, alpha: f32) -> Rgba32 {
    Rgba32::from_unmultiplied_rgba(r, g, b, (alpha * 255.0) as u8)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ink_reads_on_white_and_on_black() {
        let colors = [TOUCHING, NEAR, LOCAL, OTHER, HIP, SCP, FORCE, TORQUE, OBSTACLE, PLAIN];
        for color in colors.into_iter().chain(FORMATIONS) {
            let [r, g, b, _] = ink(color).to_array();
            let y = luminance([r, g, b].map(|c| (f64::from(c) / 255.0).powf(GAMMA)));
            let (on_white, on_black) = (1.05 / (y + 0.05), (y + 0.05) / 0.05);
            assert!(on_white > 4.4 && on_black > 4.4, "{color:?}: {on_white} on white, {on_black} on black");
        }
    }
}
