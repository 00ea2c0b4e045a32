//! Examples of values, for documentation and editors.

use super::key::{Key, Kind};

/// Lengths and times of the paper's baseline or of its kind, by the last name of the key.
const USUAL: &[(&str, &str)] = &[
    ("inner_radius", "20 mm"),
    ("outer_radius", "24 mm"),
    ("pin_diameter", "3 mm"),
    ("pin_width", "4 mm"),
    ("pin_length", "8 mm"),
    ("cell_size", "50 um"),
    ("mean_radius", "22 mm"),
    ("wear_height", "5 um"),
    ("pitch", "0.5 um"),
    ("height_range", "12 um"),
    ("rms_height", "3 um"),
    ("correlation_length", "120 um"),
    ("correlation_length_across", "40 um"),
    ("roll_off", "200 um"),
    ("short_cutoff", "20 um"),
    ("patch", "8 mm"),
    ("pixel", "10 um"),
    ("s_filter", "25 um"),
    ("l_filter", "2 mm"),
    ("cutoff", "3 um"),
    ("fibre_length", "400 um"),
    ("fibre_width", "100 um"),
    ("smooth", "25 um"),
    ("resin_recess", "8 um"),
    ("sample_every", "1 s"),
    ("checkpoint_every", "60 s"),
    ("shear_strength", "0.75 MPa"),
    ("thickness", "6 mm"),
    ("coating.thickness", "60 um"),
    ("length", "12 mm"),
    ("area", "31 cm^2"),
];

/// Pairs of lengths, by the last name of the key.
const PAIRS: &[(&str, &str)] = &[
    ("along", "[\"1 mm\", \"9 mm\"]"),
    ("across", "[\"0.5 mm\", \"5 mm\"]"),
    ("centre", "[\"4 mm\", \"-20 mm\"]"),
    ("radii", "[\"20 mm\", \"24 mm\"]"),
];

impl Key {
    /// A value as a scene may give it, in TOML, where a value's form has to be seen.
    pub fn example(&self) -> Option<String> {
        of(self)
    }
}

/// A value that the key may have, in TOML; `None` where its form is plain.
fn of(key: &Key) -> Option<String> {
    let name = key.name.rsplit('.').next().unwrap_or(key.name);
    let usual = USUAL.iter().find(|(known, _)| *known == name).map(|(_, example)| *example);
    if let Some((_, pair)) = PAIRS.iter().find(|(known, _)| *known == name) {
        return Some((*pair).to_owned());
    }
    match key.kind {
        Kind::Quantity { dimension, .. } => Some(format!("\"{}\"", usual.unwrap_or(dimension.example()))),
        Kind::Lengths { single: true, .. } => usual.map(|length| format!("\"{length}\"")),
        Kind::Lengths { .. } => usual.map(|length| format!("[\"0 um\", \"{length}\"]")),
        Kind::LengthUnit => Some("\"um\"".to_owned()),
        Kind::Times => Some("[\"0 s\", \"500 s\"]".to_owned()),
        Kind::Rows => Some("[[\"0 s\", \"47 N\", \"850 rpm\"], [\"3 s\", \"47 N\", \"0 rpm\"]]".to_owned()),
        Kind::Factor => Some("[[\"230 degC\", 1.0], [\"400 degC\", 4.0]]".to_owned()),
        Kind::Maps => Some("[\"disc_height\", \"pressure\"]".to_owned()),
        _ => None,
    }
}
