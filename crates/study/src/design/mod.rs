//! Designs: at which settings of the factors a study makes its runs.
//!
//! [`design`] makes them all. Two-level designs are in standard order: the first factor changes fastest.

mod aliases;
mod box_behnken;
mod central_composite;
mod definition;
mod direction_numbers;
mod fractional_factorial;
mod full_factorial;
mod generators;
mod latin_hypercube;
mod minimum_aberration;
mod morris;
mod plackett_burman;
mod sobol;

use definition::{only_ends, room};

pub use definition::{Aliases, Alpha, Design, DesignError, Factor, Fraction, Kind, Setting};

/// The design of this kind for these factors.
///
/// # Errors
///
/// There is no such design: no factors, factors of fewer than two levels, or for designs of coded settings of more than
/// two; more factors than the kind has designs for; wrong generators; no points, or more than ten million.
pub fn design(kind: &Kind, factors: &[Factor]) -> Result<Design, DesignError> {
    design_with_centre(kind, 0, factors)
}

/// The same, with so many more points at the centre of all ranges, which show whether the response is curved.
///
/// # Errors
///
/// As [`design`], and a factor of more than two levels, which has no centre.
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
        Kind::FullFactorial => full_factorial::full_factorial(factors),
        Kind::FractionalFactorial(fraction) => fractional_factorial::fractional_factorial(fraction, factors),
        Kind::PlackettBurman => plackett_burman::plackett_burman(factors),
        Kind::CentralComposite { alpha, centre } => central_composite::central_composite(*alpha, *centre, factors),
        Kind::BoxBehnken { centre } => box_behnken::box_behnken(*centre, factors),
        Kind::LatinHypercube { points, seed } => latin_hypercube::latin_hypercube(*points, *seed, factors),
        Kind::Sobol { points } => sobol::sobol(*points, factors),
        Kind::Morris { trajectories, levels, seed } => morris::morris(*trajectories, *levels, *seed, factors),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_has_no_design_is_refused() {
        let message = |factors: &[Factor]| design(&Kind::FullFactorial, factors).unwrap_err().0;
        assert_eq!(message(&[]), "a design needs at least one factor");
        assert_eq!(message(&[Factor::Range, Factor::Levels(1)]), "factor 2 needs at least two levels, not 1");
        assert_eq!(
            message(&[Factor::Levels(usize::MAX); 2]),
            "a design of 2 factors has at most 10000000 points, not far more"
        );
        assert_eq!(
            message(&[Factor::Levels(2); 24]),
            "a design of 24 factors has at most 4166666 points, not 16777216"
        );
        let three = design(&Kind::BoxBehnken { centre: 1 }, &[Factor::Range, Factor::Levels(3), Factor::Range]);
        assert_eq!(three.unwrap_err().0, "a Box-Behnken design needs ranges or two levels, but factor 2 has 3 levels");
    }

    #[test]
    fn settings_are_whole_points() {
        assert!(Design::from_settings(2, vec![Setting::Level(0); 3], None).is_err());
        assert!(Design::from_settings(0, Vec::new(), None).is_err());
        assert_eq!(Design::from_settings(2, vec![Setting::Level(0); 6], None).unwrap().points(), 3);
    }
}
