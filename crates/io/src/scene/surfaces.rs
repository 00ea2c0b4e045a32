//! From checked keys to the settings of the initial surfaces.

use std::path::PathBuf;

use plateau_core::surface::micrograph::{Micrograph, Threshold};
use plateau_core::surface::{FibreSynthesis, HeightSynthesis, Preparation, Texture};

use super::contents::{BaseSource, HeightSettings, HeightSource};
use super::error::Problem;
use super::interpret::Setting;
use super::schema::choices;
use super::settings::Settings;
use crate::surface::ReadOptions;

/// Heights of disc or pin, and how they are prepared.
pub(super) fn heights(settings: &Settings, body: &str) -> Result<HeightSettings, Problem> {
    let surface = |name: &str| format!("{body}.surface.{name}");
    let prepare = |name: &str| format!("{body}.prepare.{name}");
    let source = if let Some((path, dataset)) = file(settings, &format!("{body}.surface")) {
        HeightSource::File { path, options: read_options(settings, &surface, dataset)? }
    } else if settings.get(&surface("flat")).is_some() {
        HeightSource::Flat
    } else {
        HeightSource::Synthetic(synthesis(settings, &surface("synthetic"))?)
    };
    let preparation = Preparation {
        level: settings.choice(&prepare("level"), &choices::LEVEL)?,
        outliers: settings.optional_number(&prepare("outliers"))?,
        fill: settings.get(&prepare("fill")).map(|_| settings.choice(&prepare("fill"), &choices::FILL)).transpose()?,
        pixel: settings.optional_number(&prepare("pixel"))?,
        cutoff: settings.optional_number(&prepare("cutoff"))?,
        repeat: settings.bool(&prepare("repeat"))?,
        scale: settings.number(&prepare("scale"))?,
    };
    Ok(HeightSettings { source, mirror: settings.bool(&surface("mirror"))?, preparation })
}

/// The settings of synthetic heights in this inline table.
fn synthesis(settings: &Settings, table: &str) -> Result<HeightSynthesis, Problem> {
    let path = |name: &str| format!("{table}.{name}");
    let texture = match settings.optional_number(&path("correlation_length"))? {
        Some(along) => {
            let across = settings.optional_number(&path("correlation_length_across"))?;
            Texture::Correlation { along, across: across.unwrap_or(along) }
        }
        None => {
            let roll_off = settings.number(&path("roll_off"))?;
            let hurst = settings.optional_number(&path("hurst"))?.ok_or_else(|| {
                let message = "a power law needs its Hurst exponent too: give hurst, from 0 (rough) to 1 (smooth)";
                Problem::new(&settings.origin(&path("roll_off")), &path("roll_off"), message)
            })?;
            Texture::PowerLaw { hurst, roll_off, short_cutoff: settings.optional_number(&path("short_cutoff"))? }
        }
    };
    Ok(HeightSynthesis {
        seed: settings.integer(&path("seed"))?,
        rms_height: settings.number(&path("rms_height"))?,
        texture,
        skewness: settings.number(&path("skewness"))?,
        kurtosis: settings.number(&path("kurtosis"))?,
        patch: settings.optional_number(&path("patch"))?,
    })
}

/// The pin's fibre map.
pub(super) fn base(settings: &Settings) -> Result<BaseSource, Problem> {
    if let Some((path, dataset)) = file(settings, "pin.base") {
        return Ok(BaseSource::File { path, dataset });
    }
    if let Ok(path) = settings.text("pin.base.image") {
        return Ok(BaseSource::Image { path: path.into(), micrograph: micrograph(settings)? });
    }
    if settings.get("pin.base.uniform").is_some() {
        return Ok(BaseSource::Uniform(settings.choice("pin.base.uniform", &choices::UNIFORM)?));
    }
    let synthesis = FibreSynthesis {
        seed: settings.integer("pin.base.synthetic.seed")?,
        fibre_fraction: settings.number("pin.base.synthetic.fibre_fraction")?,
        fibre_length: settings.number("pin.base.synthetic.fibre_length")?,
        fibre_width: settings.number("pin.base.synthetic.fibre_width")?,
    };
    if synthesis.fibre_length < synthesis.fibre_width {
        let key = "pin.base.synthetic.fibre_length";
        let message = "a fibre is shorter than it is wide; expected fibre_length of at least fibre_width";
        return Err(Problem::new(&settings.origin(key), key, message));
    }
    Ok(BaseSource::Synthetic(synthesis))
}

/// What the scene says of a file of heights; `key` makes the path of a key from its name.
fn read_options(
    settings: &Settings,
    key: &impl Fn(&str) -> String,
    dataset: Option<String>,
) -> Result<ReadOptions, Problem> {
    let height_range = settings.optional_pair(&key("height_range"))?;
    if let Some([black, white]) = height_range
        && black == white
    {
        let message = "black and white have the same height, expected two that differ";
        return Err(Problem::new(&settings.origin(&key("height_range")), &key("height_range"), message));
    }
    Ok(ReadOptions {
        dataset,
        unit: settings.optional_number(&key("unit"))?,
        pitch: settings.optional_pair(&key("pitch"))?,
        height_range,
        decimal: settings.optional_choice(&key("decimal"), &choices::DECIMAL)?,
        skip: settings.get(&key("skip")).map(|_| settings.integer(&key("skip"))).transpose()?,
        profile_lay: settings.optional_choice(&key("profile_lay"), &choices::LAY)?,
    })
}

fn micrograph(settings: &Settings) -> Result<Micrograph, Problem> {
    let Some(pixel) = settings.optional_number("pin.base.pixel")? else {
        let message = "an image does not say how large it is: give pixel = \"10 um\", the distance of its pixels";
        return Err(Problem::new(&settings.origin("pin.base.image"), "pin.base.image", message));
    };
    Ok(Micrograph {
        pixel,
        quarters: settings.choice("pin.base.rotate", &choices::ROTATE)?,
        smooth: settings.optional_number("pin.base.smooth")?,
        threshold: match settings.get("pin.base.threshold") {
            Some(Setting::Number(level)) => Threshold::Level(*level),
            _ => Threshold::Otsu,
        },
        fibres: settings.choice("pin.base.fibres", &choices::FIBRES)?,
        despeckle: settings.optional_number("pin.base.despeckle")?,
    })
}

/// Input file and dataset of a source.
fn file(settings: &Settings, section: &str) -> Option<(PathBuf, Option<String>)> {
    let text = |name: &str| settings.text(&format!("{section}.{name}")).ok();
    Some((text("file")?.into(), text("dataset").map(str::to_owned)))
}
