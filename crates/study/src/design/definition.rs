//! Factors, settings and points of a design, and its limits.

use thiserror::Error;

/// Most points of a design.
const MOST_POINTS: usize = 10_000_000;
/// Most settings of a design, points times factors: 1.6 GB.
const MOST_SETTINGS: usize = 100_000_000;

/// Factor before a design sets it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Factor {
    /// Number of levels, at least two.
    Levels(usize),
    /// A range between two values.
    Range,
}

/// Setting of a factor at a point of a design.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Setting {
    /// The level of this index.
    Level(usize),
    /// −1 is the lower end of the range (the first of two levels), 1 its upper end (the second). Axial points may lie
    /// beyond them.
    Coded(f64),
}

/// Kind of a design.
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
        /// Distance of the axial points.
        alpha: Alpha,
        /// Numbers of centre points, with the two-level and with the axial points.
        centre: [usize; 2],
    },
    /// Midpoints of edges (from six factors on of faces) and centre points, for quadratic response surfaces of 3 to
    /// 7 factors. No point is at a corner.
    BoxBehnken {
        /// Number of centre points.
        centre: usize,
    },
    /// Strata of every range, as many as there are points, each with one point, at random within; the points are kept
    /// apart. Levels get equal shares of the strata.
    LatinHypercube {
        /// Number of points.
        points: usize,
        /// Seed of the random numbers.
        seed: u64,
    },
    /// A sequence that fills the ranges of up to 101 factors evenly, best with a power of two of points. The first
    /// point is at all lower ends. Levels get equal shares of the sequence.
    Sobol {
        /// Number of points, from the beginning of the sequence.
        points: usize,
    },
    /// Trajectories of points of which each differs from the one before in one factor, for elementary effects of many
    /// factors; by lot.
    Morris {
        /// Number of trajectories, each of one point more than factors.
        trajectories: usize,
        /// Levels of each range, an even number.
        levels: usize,
        /// Seed of the random numbers.
        seed: u64,
    },
}

/// Choice of a fraction.
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
    /// Axial points on the faces: no value outside the range.
    Face,
}

/// A design.
#[derive(Debug, Clone, PartialEq)]
pub struct Design {
    factors: usize,
    /// One setting for each point and factor, point by point.
    settings: Vec<Setting>,
    /// Effects that a fraction cannot tell from each other.
    aliases: Option<Aliases>,
}

/// Aliases: what a fraction of the two-level combinations cannot tell. Factors are named by the letters A to Z without I.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Aliases {
    /// Words of the defining relation, such as `ABCE` or `-ABD`, the shortest first; I equals each of them. Of more
    /// than 4095 only those of the least lengths.
    pub defining_words: Vec<String>,
    /// Number of words of each length, from 0 to the number of factors.
    pub word_lengths: Vec<usize>,
    /// Length of the shortest word.
    pub resolution: u32,
    /// Sets of effects up to two-factor interactions that cannot be told from each other, such as `AB = CE`.
    pub chains: Vec<Vec<String>>,
}

/// Reason why there is no such design.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[error("{0}")]
pub struct DesignError(pub String);

/// The number of points, if that many settings have room; `None` is a number that overflowed.
pub(super) fn room(points: Option<usize>, factors: usize) -> Result<usize, DesignError> {
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

/// Counts factors in words.
pub(super) fn counted(factors: usize) -> String {
    format!("{factors} factor{}", if factors == 1 { "" } else { "s" })
}

/// Refuses factors that are neither ranges nor of two levels, as this design needs them.
pub(super) fn only_ends(factors: &[Factor], design: &str) -> Result<(), DesignError> {
    match factors.iter().position(|factor| factor.levels() != 2) {
        None => Ok(()),
        Some(index) => {
            let (factor, levels) = (index + 1, factors[index].levels());
            Err(DesignError(format!("{design} needs ranges or two levels, but factor {factor} has {levels} levels")))
        }
    }
}

/// The setting at this part of a range, from 0 to below 1; levels have equal parts.
pub(super) fn spread(factor: &Factor, unit: f64) -> Setting {
    match factor {
        Factor::Range => Setting::Coded(2.0 * unit - 1.0),
        Factor::Levels(levels) => Setting::Level(((unit * *levels as f64) as usize).min(levels - 1)),
    }
}

impl Factor {
    /// Number of levels; a range has two, its ends.
    pub(super) fn levels(&self) -> usize {
        match self {
            Self::Levels(levels) => *levels,
            Self::Range => 2,
        }
    }
}

impl Design {
    /// A design of these settings, point by point and factor by factor.
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

    /// Aliases of a fraction; none for designs that are no fraction.
    pub fn aliases(&self) -> Option<&Aliases> {
        self.aliases.as_ref()
    }
}
