//! Colours.

use plotters::style::RGBColor;

/// Text and axes.
pub const INK: RGBColor = RGBColor(0x22, 0x22, 0x22);
/// Lines that help the eye.
pub const FAINT: RGBColor = RGBColor(0x9a, 0x9a, 0x9a);
/// What was not measured: in no colour of the map.
pub const MISSING: RGBColor = RGBColor(0xbd, 0xbd, 0xbd);
/// The data.
pub const DATA: RGBColor = RGBColor(0x31, 0x68, 0x8e);
/// Areas of the data.
pub const DATA_AREA: RGBColor = RGBColor(0x9d, 0xbf, 0xd6);
/// What is made out of the data.
pub const DERIVED: RGBColor = RGBColor(0xc4, 0x4e, 0x1c);
/// Areas of it.
pub const DERIVED_AREA: RGBColor = RGBColor(0xf4, 0xcd, 0xb6);

/// Colour of a value from 0 to 1; what is beyond takes the colour of the end.
pub fn viridis(value: f64) -> RGBColor {
    let colour = colorous::VIRIDIS.eval_continuous(value.clamp(0.0, 1.0));
    RGBColor(colour.r, colour.g, colour.b)
}
