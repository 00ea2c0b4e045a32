//! The parameters as one list: what they are called, what they measure and where a [`Description`] keeps them; and how far they may be
//! off because a surface is only a part of a larger one.

use super::{Description, Grid, ProfileParameters};

/// One parameter.
#[derive(Debug, Clone, Copy)]
pub struct Parameter {
    /// Symbol of the standard; that of a profile parameter ends in the direction of the profiles.
    pub symbol: &'static str,
    /// What it is, in words.
    pub name: &'static str,
    /// What it measures.
    pub unit: Unit,
    /// Which parameters it belongs to.
    pub group: Group,
    /// The value, in SI units; none without a pitch, NaN where the heights do not determine it.
    pub value: fn(&Description) -> Option<f64>,
}

/// What a parameter measures.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Unit {
    /// Heights, and volumes per area, m.
    Height,
    /// Lengths along the surface, m.
    Length,
    /// A number.
    Number,
    /// A fraction that is given in percent.
    Percent,
    /// An angle, rad.
    Angle,
}

/// Parameters that belong together.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Group {
    /// Height parameters.
    Height,
    /// Core, peaks and dales of the Abbott-Firestone curve.
    Core,
    /// Volumes.
    Volume,
    /// Slopes and developed area.
    Hybrid,
    /// Autocorrelation.
    Spatial,
    /// Profiles along and across the sliding direction.
    Profile,
}

impl Group {
    /// Its name.
    pub fn name(self) -> &'static str {
        match self {
            Self::Height => "height",
            Self::Core => "Abbott-Firestone curve",
            Self::Volume => "volume",
            Self::Hybrid => "slope",
            Self::Spatial => "autocorrelation",
            Self::Profile => "profiles",
        }
    }
}

macro_rules! parameters {
    ($($symbol:literal, $group:ident, $unit:ident, $name:literal, $value:expr;)*) => {
        &[$(Parameter {
            symbol: $symbol,
            name: $name,
            unit: Unit::$unit,
            group: Group::$group,
            value: $value,
        }),*]
    };
}

/// Every parameter, in the order in which they are reported.
pub const PARAMETERS: &[Parameter] = parameters! {
    "Sa", Height, Height, "arithmetical mean height", |d| Some(d.heights.arithmetical_mean_height);
    "Sq", Height, Height, "root-mean-square height", |d| Some(d.heights.root_mean_square_height);
    "Ssk", Height, Number, "skewness", |d| Some(d.heights.skewness);
    "Sku", Height, Number, "kurtosis", |d| Some(d.heights.kurtosis);
    "Sp", Height, Height, "maximum peak height", |d| Some(d.heights.maximum_peak_height);
    "Sv", Height, Height, "maximum pit depth", |d| Some(d.heights.maximum_pit_depth);
    "Sz", Height, Height, "maximum height", |d| Some(d.heights.maximum_height());
    "Sk", Core, Height, "core height", |d| Some(d.core.core_height);
    "Spk", Core, Height, "reduced peak height", |d| Some(d.core.reduced_peak_height);
    "Svk", Core, Height, "reduced dale depth", |d| Some(d.core.reduced_dale_depth);
    "Smr1", Core, Percent, "material ratio of the peaks", |d| Some(d.core.peak_ratio);
    "Smr2", Core, Percent, "material ratio of peaks and core", |d| Some(d.core.dale_ratio);
    "Sxp", Core, Height, "extreme peak height, from 2.5 % to 50 %", |d| Some(d.extreme_peak_height);
    "Vmp", Volume, Height, "peak material volume per area, to 10 %", |d| Some(d.volumes.peak_material);
    "Vmc", Volume, Height, "core material volume per area, 10 to 80 %", |d| Some(d.volumes.core_material);
    "Vvc", Volume, Height, "core void volume per area, 10 to 80 %", |d| Some(d.volumes.core_void);
    "Vvv", Volume, Height, "dale void volume per area, from 80 %", |d| Some(d.volumes.dale_void);
    "Vm", Volume, Height, "material volume per area, to 80 %", |d| Some(d.volumes.material());
    "Vv", Volume, Height, "void volume per area, from 10 %", |d| Some(d.volumes.void());
    "Sdq", Hybrid, Number, "root-mean-square slope", |d| d.gradient.map(|gradient| gradient.root_mean_square_slope);
    "Sdr", Hybrid, Percent, "developed area over that of the grid, less 1",
        |d| d.gradient.map(|gradient| gradient.developed_area_ratio);
    "Sal", Spatial, Length, "autocorrelation length", |d| d.autocorrelation.map(|spatial| spatial.length);
    "Str", Spatial, Number, "texture aspect ratio", |d| d.autocorrelation.map(|spatial| spatial.aspect_ratio);
    "Std", Spatial, Angle, "texture direction: lay from x towards y", |d| d.autocorrelation.map(|spatial| spatial.direction);
    "Ra_x", Profile, Height, "arithmetical mean height, along", |d| along(d, |p| p.arithmetical_mean_height);
    "Rq_x", Profile, Height, "root-mean-square height, along", |d| along(d, |p| p.root_mean_square_height);
    "Rsk_x", Profile, Number, "skewness, along", |d| along(d, |p| p.skewness);
    "Rku_x", Profile, Number, "kurtosis, along", |d| along(d, |p| p.kurtosis);
    "Ra_y", Profile, Height, "arithmetical mean height, across", |d| across(d, |p| p.arithmetical_mean_height);
    "Rq_y", Profile, Height, "root-mean-square height, across", |d| across(d, |p| p.root_mean_square_height);
    "Rsk_y", Profile, Number, "skewness, across", |d| across(d, |p| p.skewness);
    "Rku_y", Profile, Number, "kurtosis, across", |d| across(d, |p| p.kurtosis);
};

fn along(description: &Description, value: fn(&ProfileParameters) -> f64) -> Option<f64> {
    Some(value(&description.along))
}

fn across(description: &Description, value: fn(&ProfileParameters) -> f64) -> Option<f64> {
    Some(value(&description.across))
}

/// Blocks into which a surface is divided, about.
const BLOCKS: f64 = 25.0;
/// Parameters of which blocks tell nothing: those that are set by single points (Miller 1974, doi:10.1093/biomet/61.1.1), and a
/// direction, which has no mean.
const WITHOUT: [&str; 4] = ["Sp", "Sv", "Sz", "Std"];

/// The standard error of every parameter of [`PARAMETERS`], SI units: what it varies by from one part of this size of a
/// larger surface to another. NaN where it is not determined, for extremes and the direction, and with less than four blocks.
///
/// The surface is divided into some 25 blocks, as square as may be. Of the parameters without one block each, θ_i of B, the
/// variance is (B − 1)/B Σ (θ_i − θ̄)²: the jackknife over blocks (Künsch 1989, doi:10.1214/aos/1176347265). Blocks have to be
/// larger than the distance over which heights are related; of a surface with few such lengths the error is larger than told.
pub fn sampling_errors(grid: &Grid) -> Vec<f64> {
    let blocks = blocks(grid);
    let [along, across] = blocks;
    let count = along * across;
    if count < 4 {
        return vec![f64::NAN; PARAMETERS.len()];
    }
    let mut heights = grid.heights.to_vec();
    let mut parameters = vec![Vec::with_capacity(count); PARAMETERS.len()];
    for block in 0..count {
        let [columns, rows] = [(block / across, along, grid.columns), (block % across, across, grid.rows)]
            .map(|(part, parts, points)| part * points / parts..(part + 1) * points / parts);
        let places = || columns.clone().flat_map(|column| rows.clone().map(move |row| column * grid.rows + row));
        places().for_each(|place| heights[place] = f64::NAN);
        let description = Description::of(&Grid { heights: &heights, ..*grid });
        places().for_each(|place| heights[place] = grid.heights[place]);
        for (values, parameter) in parameters.iter_mut().zip(PARAMETERS) {
            values.push(description.as_ref().and_then(parameter.value).unwrap_or(f64::NAN));
        }
    }
    let error = |values: &Vec<f64>| {
        let count = values.len() as f64;
        let mean = values.iter().sum::<f64>() / count;
        let squares: f64 = values.iter().map(|value| (value - mean) * (value - mean)).sum();
        (squares * (count - 1.0) / count).sqrt()
    };
    let has_none = |index: usize| WITHOUT.contains(&PARAMETERS[index].symbol);
    parameters.iter().enumerate().map(|(n, values)| if has_none(n) { f64::NAN } else { error(values) }).collect()
}

/// Blocks along x and y.
fn blocks(grid: &Grid) -> [usize; 2] {
    let [x, y] = grid.pitch.unwrap_or([1.0; 2]);
    let proportion = (grid.columns as f64 * x) / (grid.rows as f64 * y);
    let along = (BLOCKS * proportion).sqrt().round().clamp(1.0, BLOCKS).min(grid.columns as f64);
    let across = (BLOCKS / along).round().clamp(1.0, grid.rows as f64);
    [along as usize, across as usize]
}
