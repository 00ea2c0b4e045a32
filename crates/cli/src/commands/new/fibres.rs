//! The pin's fibres from a micrograph, for a scene to begin with.

use std::path::Path;

use plateau_core::surface::micrograph::{FibreMap, MicrographError};
use plateau_core::surface::{Length, fibre_fraction};
use plateau_io::scene::Scene;
use plateau_io::surface::{self, FileError, SurfaceError};
use plateau_io::units::{self, Dimension};

use super::keys::{line, path_from};
use crate::arguments::NewArguments;
use crate::failure::Failure;

/// The fibres of who has no micrograph.
const SYNTHETIC: &str =
    "synthetic = { seed = 2, fibre_fraction = 0.3, fibre_length = \"400 um\", fibre_width = \"100 um\" }";

/// Distances of pixels, m, that a file may state and be believed: of more, 1000 to the inch, a program states how large it prints.
const BELIEVED: std::ops::Range<f64> = 1e-9..25.4e-6;
/// Distances that differ by less than this part are the same.
const SAME: f64 = 0.01;

/// The keys of the pin's base, and what should be known of them.
pub(super) fn lines(arguments: &NewArguments) -> Result<(String, Vec<String>), Failure> {
    let NewArguments { scene, micrograph, pixel, .. } = arguments;
    let Some(path) = micrograph else {
        let remark = "# <- or --micrograph: image = \"pin.jpg\" with its pixel";
        return Ok((format!("{SYNTHETIC} {remark}"), Vec::new()));
    };
    let stated = surface::stated_pixel(path).map_err(|reason| Failure::of_file(path, reason))?;
    let believed = stated.filter(|stated| BELIEVED.contains(stated)).map(Length);
    let mut notes = Vec::new();
    let pixel = match (pixel, believed) {
        (Some(given), None) => given.clone(),
        (Some(given), Some(stated)) => {
            let differs = |given: f64| (given / stated.0 - 1.0).abs() > SAME;
            if units::parse(given, Dimension::Length).is_ok_and(differs) {
                notes.push(format!("{}: it states pixels of {stated}, --pixel {given}, which holds", path.display()));
            }
            given.clone()
        }
        (None, Some(stated)) => {
            notes.push(format!(
                "{}: pixels of {stated} are what it states: compare the size with the scale bar, --pixel gives another",
                path.display()
            ));
            stated.to_string()
        }
        (None, None) => {
            let states = stated.map_or("it does not say how large its pixels are".to_owned(), |stated| {
                format!("it states pixels of {}, at which a program would print it", Length(stated))
            });
            let advice = "give --pixel, such as --pixel \"2 um\", the length of the scale bar over its pixels";
            return Err(Failure::of_file(path, format_args!("{states}: {advice}")));
        }
    };
    let lines = [
        line("image", path_from(scene, path).map_err(|reason| Failure::of_file(path, reason))?, "<-"),
        line("pixel", pixel, "<- distance of its pixels"),
        line("threshold", "otsu", "parts fibre and resin; or a grey level from 0 (black) to 1 (white)"),
        line("fibres", "bright", "or dark"),
    ];
    Ok((lines.join("\n"), notes))
}

/// The line for a picture that is smaller than the pin.
pub(super) fn beyond() -> String {
    line("repeat", true, "smaller than the pin: mirrored tiles; or extend = \"statistics\", random fibres like these")
}

/// Tells whether the picture of a scene is smaller than its pin, which is refused.
pub(super) fn is_too_small(found: &Result<Option<(FibreMap, f64)>, SurfaceError>) -> bool {
    let small = |reason: &FileError| matches!(reason, FileError::Micrograph(MicrographError::Small { .. }));
    matches!(found, Err(SurfaceError::File { reason, .. }) if small(reason))
}

/// Notes the size of a picture, and the fraction of fibre in it and on the pin.
pub(super) fn told(path: &Path, map: &FibreMap, pixel: f64, scene: &Scene, is_small: bool) -> Vec<String> {
    let [width, height] = map.fibre.size(pixel).map(Length);
    let picture = 100.0 * map.fibre.fraction();
    let pin = 100.0 * fibre_fraction(&map.base, &scene.parameters.mesh);
    let mut notes = vec![format!(
        "{}: {width} by {height}; fibre is {picture:.1} % of the picture by Otsu's grey level and {pin:.1} % of the pin: compare it with the pin's \
         formulation",
        path.display()
    )];
    if is_small {
        notes.push(format!(
            "{}: it is smaller than the pin: repeat = true tiles it, mirrored at the seams; extend = \"statistics\" makes random \
             fibres with its fraction and correlation",
            path.display()
        ));
    }
    notes
}
