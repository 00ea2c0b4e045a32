//! Designs: at which settings of the factors a study makes its runs.
//!
//! [`design`] makes them all. Two-level designs are in standard order: the first factor changes fastest.

mod aliases;
mod box_behnken;
mod central_composite;
mod direction_numbers;
mod fractional_factorial;
mod full_factorial;
mod generators;
mod latin_hypercube;
mod minimum_aberration;
mod morris;
mod plackett_burman;
mod sobol;

use thiserror::Error;

/// Most points of a design.
const MOST_POINTS: usize = 10_000_000;
/// Most settings of a design, points times factors: 1.6 GB.
const MOST_SETTINGS: usize = 100_000_000;

/// What is known of a factor before a design sets it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Factor {
    /// So many levels, at least two.
    Levels(usize),
    /// A range between two values.
    Range,
}

/// Where a point of a design lies along a factor.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Setting {
    /// The level of this index.
    Level(usize),
    /// −1 is the lower end of the range (the first of two levels), 1 its upper end (the second). Axial points may lie
    /// beyond them.
    Coded(f64),
}

/// Which design.
#[derive(Debug, Clone, PartialEq)]
pub enum Kind {
    /// Every combination of the levels; a range has its ends for levels.
    FullFactorial,
    /// 2^(k − p) of the combinations of two levels.
    FractionalFactorial(Fraction),
    /// Main effects of two levels in a multiple of four points, for up to 23 factors. Interactions of two factors
    /// spread over the main effects of others.
    PlackettBurman,
    /// Two-level points (from five factors on a fraction of resolution V), axial points and centre points, for
    /// quadratic response surfaces.
    CentralComposite {
        /// How far out the axial points lie.
        alpha: Alpha,
        /// Centre points, with the two-level and with the axial points.
        centre: [usize; 2],
    },
    /// Midpoints of edges (from six factors on of faces) and centre points, for quadratic response surfaces of 3 to
    /// 7 factors. No point is at a corner.
    BoxBehnken {
        /// Centre points.
        centre: usize,
    },
    /// As many strata of every range as there are points, each with one point, at random within; the points are kept
    /// apart. Levels get equal shares of the strata.
    LatinHypercube {
        /// How many.
        points: usize,
        /// Seed of the random numbers.
        seed: u64,
    },
    /// A sequence that fills the ranges of up to 101 factors evenly, best with a power of two of points. The first
    /// point is at all lower ends. Levels get equal shares of the sequence.
    Sobol {
        /// How many, from the beginning of the sequence.
        points: usize,
    },
    /// Trajectories of points of which each differs from the one before in one factor, for elementary effects of many
    /// factors; by lot.
    Morris {
        /// How many trajectories, each of one point more than there are factors.
        trajectories: usize,
        /// Levels of each range, an even number.
        levels: usize,
        /// Seed of the random numbers.
        seed: u64,
    },
}

/// How a fraction is chosen.
#[derive(Debug, Clone, PartialEq)]
pub enum Fraction {
    /// The smallest of at least this resolution, with as few short words as possible; all combinations where no
    /// fraction has it. From 16 factors on there is none of more than 4096 points.
    Resolution(u32),
    /// Given by the generators of the added factors, such as `E = ABCD` or `-ABCD`. Factors are named by the letters A
    /// to Z without I, the first ones being the base factors.
    Generators(Vec<String>),
}

/// Distance of axial points from the centre.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Alpha {
    /// Equal variance of prediction at equal distance from the centre: the fourth root of the number of two-level
    /// points.
    Rotatable,
    /// Two-level points and axial points, each with their centre points, are orthogonal blocks: a shift between them
    /// changes no effect.
    Orthogonal,
    /// On the faces: no value outside the range.
    Face,
}

/// A design.
#[derive(Debug, Clone, PartialEq)]
pub struct Design {
    factors: usize,
    /// One setting for each point and factor, point by point.
    settings: Vec<Setting>,
    /// Which effects a fraction cannot tell from each other.
    aliases: Option<Aliases>,
}

/// What a fraction of the two-level combinations cannot tell. Factors are named by the letters A to Z without I.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Aliases {
    /// Words of the defining relation, such as `ABCE` or `-ABD`, the shortest first; I equals each of them. Of more
    /// than 4095 only those of the least lengths.
    pub defining_words: Vec<String>,
    /// How many words there are of each length, from 0 to the number of factors.
    pub word_lengths: Vec<usize>,
    /// Length of the shortest word.
    pub resolution: u32,
    /// Sets of effects up to two-factor interactions that cannot be told from each other, such as `AB = CE`.
    pub chains: Vec<Vec<String>>,
}

/// Why there is no such design.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[error("{0}")]
pub struct DesignError(pub String);

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

/// The number of points, if that many settings have room; `None` is a number that overflowed.
fn room(points: Option<usize>, factors: usize) -> Result<usize, DesignError> {
    match points {
        Some(points) if points <= MOST_POINTS && points <= MOST_SETTINGS / factors => Ok(points),
        _ => {
            let found = points.map_or_else(|| "far more".into(), |points| points.to_string());
            let most = MOST_POINTS.min(MOST_SETTINGS / factors);
            let factors = counted(factors);
            Err(DesignError(format!("a design of {factors} has at most {most} points, not {found}")))
        }
    }
}

/// So many factors, in words.
fn counted(factors: usize) -> String {
    format!("{factors} factor{}", if factors == 1 { "" } else { "s" })
}

/// Whether all factors are ranges or have two levels, as this design needs.
fn only_ends(factors: &[Factor], design: &str) -> Result<(), DesignError> {
    match factors.iter().position(|factor| factor.levels() != 2) {
        None => Ok(()),
        Some(index) => {
            let (factor, levels) = (index + 1, factors[index].levels());
            Err(DesignError(format!("{design} needs ranges or two levels, but factor {factor} has {levels} levels")))
        }
    }
}

/// The setting at this part of a range, from 0 to below 1; levels have equal parts.
fn spread(factor: &Factor, unit: f64) -> Setting {
    match factor {
        Factor::Range => Setting::Coded(2.0 * unit - 1.0),
        Factor::Levels(levels) => Setting::Level(((unit * *levels as f64) as usize).min(levels - 1)),
    }
}

impl Factor {
    /// How many levels; a range has two, its ends.
    fn levels(&self) -> usize {
        match self {
            Self::Levels(levels) => *levels,
            Self::Range => 2,
        }
    }
}

impl Design {
    /// A design of these settings, point by point and factor by factor.
    ///
    /// # Errors
    ///
    /// The settings are not a whole number of points.
    pub fn from_settings(
        factors: usize,
        settings: Vec<Setting>,
        aliases: Option<Aliases>,
    ) -> Result<Self, DesignError> {
        if factors == 0 || !settings.len().is_multiple_of(factors) {
            let found = settings.len();
            return Err(DesignError(format!("{found} settings are not a whole number of points of {factors} factors")));
        }
        Ok(Self { factors, settings, aliases })
    }

    /// Number of factors.
    pub fn factors(&self) -> usize {
        self.factors
    }

    /// Number of points.
    pub fn points(&self) -> usize {
        self.settings.len() / self.factors.max(1)
    }

    /// The settings of a point, factor by factor.
    pub fn point(&self, point: usize) -> &[Setting] {
        &self.settings[point * self.factors..][..self.factors]
    }

    /// What a fraction cannot tell; none for designs that are no fraction.
    pub fn aliases(&self) -> Option<&Aliases> {
        self.aliases.as_ref()
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
