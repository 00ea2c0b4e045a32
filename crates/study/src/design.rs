//! Designs: at which settings of the factors a study makes its runs.
//!
//! [`design`] makes them all. Two-level designs are in standard order: the first factor changes fastest.

mod definition;
mod direction_numbers;
mod factorial;
mod response_surface;
mod sampled;

use definition::{only_ends, room};

pub use definition::{Aliases, Alpha, Design, DesignError, Factor, Fraction, Kind, Setting};

/// The design of this kind for these factors.
pub fn design(kind: &Kind, factors: &[Factor]) -> Result<Design, DesignError> {
    design_with_centre(kind, 0, factors)
}

/// The same, with so many more points at the centre of all ranges, which show whether the response is curved.
pub fn design_with_centre(kind: &Kind, centre: usize, factors: &[Factor]) -> Result<Design, DesignError> {
    let design = of_kind(kind, factors)?;
    if centre == 0 {
        return Ok(design);
    }
    only_ends(factors, "a design with centre points")?;
    room(design.points().checked_add(centre), factors.len())?;
    let settings = (0..design.points()).flat_map(|point| design.point(point).to_vec());
    let centre = std::iter::repeat_n(Setting::Coded(0.0), centre * factors.len());
    Design::from_settings(factors.len(), settings.chain(centre).collect(), design.aliases().cloned())
}

fn of_kind(kind: &Kind, factors: &[Factor]) -> Result<Design, DesignError> {
    if factors.is_empty() {
        return Err(DesignError("a design needs at least one factor".into()));
    }
    if let Some(index) = factors.iter().position(|factor| factor.levels() < 2) {
        let (factor, levels) = (index + 1, factors[index].levels());
        return Err(DesignError(format!("factor {factor} needs at least two levels, not {levels}")));
    }
    match kind {
        Kind::FullFactorial => factorial::full_factorial(factors),
        Kind::FractionalFactorial(fraction) => factorial::fractional_factorial(fraction, factors),
        Kind::PlackettBurman => factorial::plackett_burman(factors),
        Kind::CentralComposite { alpha, centre } => response_surface::central_composite(*alpha, *centre, factors),
        Kind::BoxBehnken { centre } => response_surface::box_behnken(*centre, factors),
        Kind::LatinHypercube { points, seed } => sampled::latin_hypercube(*points, *seed, factors),
        Kind::Sobol { points } => sampled::sobol(*points, factors),
        Kind::Morris { trajectories, levels, seed } => sampled::morris(*trajectories, *levels, *seed, factors),
    }
}

#[cfg(test)]
#[path = "../tests/unit/design.rs"]
mod tests;
