//! Settings of the initial surfaces, made from checked keys.

use std::path::PathBuf;

use plateau_core::surface::micrograph::{Enlargement, Micrograph, Threshold};
use plateau_core::surface::{Crop, Extension, FibreSynthesis, HeightSynthesis, Preparation, Texture, Unroll};

use super::contents::{BaseSource, HeightSettings, HeightSource, ReadOptions};
use super::error::Problem;
use super::interpret::Setting;
use super::schema::choices;
use super::settings::Settings;

/// Heights of disc or pin, and how they are prepared.
pub(super) fn heights(settings: &Settings, body: &str) -> Result<HeightSettings, Problem> {
    let surface = |name: &str| format!("{body}.surface.{name}");
    let source = if let Some((path, dataset)) = file(settings, &format!("{body}.surface")) {
        HeightSource::File { path, options: read_options(settings, &surface, dataset)? }
    } else if settings.get(&surface("flat")).is_some() {
        HeightSource::Flat
    } else {
        HeightSource::Synthetic(synthesis(settings, &surface("synthetic"))?)
    };
    let preparation = preparation(settings, &format!("{body}.prepare"))?;
    Ok(HeightSettings { source, mirror: settings.bool(&surface("mirror"))?, preparation })
}

fn preparation(settings: &Settings, table: &str) -> Result<Preparation, Problem> {
    let key = |name: &str| format!("{table}.{name}");
    let number = |name: &str| settings.optional_number(&key(name));
    let range = |name: &str| range(settings, &key(name));
    let crop = Crop { along: range("crop.along")?, across: range("crop.across")? };
    let (centre, radii) = (settings.optional_pair(&key("unroll.centre"))?, range("unroll.radii")?);
    let (s_filter, l_filter) = (number("s_filter")?, number("l_filter")?);
    if let (Some(short), Some(long)) = (s_filter, l_filter)
        && short >= long
    {
        let message = "it is not shorter than l_filter; waves between the two are kept, expected a shorter one";
        return Err(settings.problem(&key("s_filter"), message));
    }
    Ok(Preparation {
        crop: Some(crop).filter(|crop| crop.along.is_some() || crop.across.is_some()),
        unroll: centre.map(|centre| Unroll { centre, radii }),
        rotate: number("rotate")?.unwrap_or(0.0),
        flip: settings.optional_choice(&key("flip"), &choices::FLIP)?,
        level: settings.choice(&key("level"), &choices::LEVEL)?,
        outlier_slope: number("outlier_slope")?,
        outliers: number("outliers")?,
        fill: settings.optional_choice(&key("fill"), &choices::FILL)?,
        pixel: number("pixel")?,
        s_filter,
        l_filter,
        cutoff: number("cutoff")?,
        repeat: repeats(settings, &key("repeat")),
        extend: extension(settings, &key)?.map(|seed| Extension::Statistics { seed }),
        scale: settings.number(&key("scale"))?,
    })
}

/// Two lengths that may be absent, of which the second is the larger one.
fn range(settings: &Settings, path: &str) -> Result<Option<[f64; 2]>, Problem> {
    let pair = settings.optional_pair(path)?;
    if pair.is_some_and(|[from, to]| from >= to) {
        let message = "the second length is not larger than the first, expected from where to where";
        return Err(settings.problem(path, message));
    }
    Ok(pair)
}

/// Tells whether what is smaller than the body is tiled; a scene that extends it has no such key.
fn repeats(settings: &Settings, key: &str) -> bool {
    settings.get(key).is_some_and(|repeat| *repeat == Setting::Bool(true))
}

/// Seed of what has the statistics of a patch or a picture that is smaller than the body, if that is asked for.
fn extension(settings: &Settings, key: &impl Fn(&str) -> String) -> Result<Option<u64>, Problem> {
    let extends = settings.optional_choice(&key("extend"), &choices::EXTEND)?;
    extends.map(|()| settings.integer(&key("extend_seed"))).transpose()
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
                settings.problem(&path("roll_off"), message)
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
        let message = "a fibre is shorter than it is wide; expected fibre_length of at least fibre_width";
        return Err(settings.problem("pin.base.synthetic.fibre_length", message));
    }
    Ok(BaseSource::Synthetic(synthesis))
}

/// Statements of the scene about a file of heights; `key` makes the path of a key from its name.
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
        return Err(settings.problem(&key("height_range"), message));
    }
    Ok(ReadOptions {
        dataset,
        at: settings.optional_number(&key("at"))?,
        unit: settings.optional_number(&key("unit"))?,
        pitch: settings.optional_pair(&key("pitch"))?,
        height_range,
        decimal: settings.optional_choice(&key("decimal"), &choices::DECIMAL)?,
        skip: settings.optional_integer(&key("skip"))?,
        profile_lay: settings.optional_choice(&key("profile_lay"), &choices::LAY)?,
    })
}

fn micrograph(settings: &Settings) -> Result<Micrograph, Problem> {
    let Some(pixel) = settings.optional_number("pin.base.pixel")? else {
        let message = "an image does not say how large it is: give pixel = \"10 um\", the distance of its pixels";
        return Err(settings.problem("pin.base.image", message));
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
        enlargement: match extension(settings, &|name| format!("pin.base.{name}"))? {
            Some(seed) => Some(Enlargement::Statistics { seed }),
            None => repeats(settings, "pin.base.repeat").then_some(Enlargement::Tiles),
        },
    })
}

fn file(settings: &Settings, section: &str) -> Option<(PathBuf, Option<String>)> {
    let text = |name: &str| settings.text(&format!("{section}.{name}")).ok();
    Some((text("file")?.into(), text("dataset").map(str::to_owned)))
}
