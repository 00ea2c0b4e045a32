//! Designs: at which settings of the factors a study makes its runs.

use thiserror::Error;

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
    /// −1 is the lower end of the range (the first of two levels), 1 its upper end (the second).
    Coded(f64),
}

/// Which design.
#[derive(Debug, Clone, PartialEq)]
pub enum Kind {
    /// Every combination of the levels.
    FullFactorial,
    /// 2^(k − p) of the combinations of two levels.
    FractionalFactorial(Fraction),
    /// Main effects of two levels in a multiple of four points.
    PlackettBurman,
    /// Two-level points, axial points and centre points, for quadratic response surfaces.
    CentralComposite {
        /// How far out the axial points lie.
        alpha: Alpha,
        /// Centre points, with the two-level and with the axial points.
        centre: [usize; 2],
    },
    /// Midpoints of edges and centre points, for quadratic response surfaces.
    BoxBehnken {
        /// Centre points.
        centre: usize,
    },
    /// As many strata of every range as there are points, each with one point.
    LatinHypercube {
        /// How many.
        points: usize,
        /// Seed of the random numbers.
        seed: u64,
    },
    /// A sequence that fills the ranges evenly.
    Sobol {
        /// How many, from the beginning of the sequence.
        points: usize,
    },
}

/// How a fraction is chosen.
#[derive(Debug, Clone, PartialEq)]
pub enum Fraction {
    /// The smallest of at least this resolution.
    Resolution(u32),
    /// Given by the generators of the added factors, such as `E = ABCD` or `-ABCD`.
    Generators(Vec<String>),
}

/// Distance of axial points from the centre.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Alpha {
    /// Equal variance of prediction at equal distance from the centre.
    Rotatable,
    /// Uncorrelated quadratic effects.
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

/// What a fraction of the two-level combinations cannot tell.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Aliases {
    /// Words of the defining relation, such as `ABCE` or `-ABD`; I equals each of them.
    pub defining_words: Vec<String>,
    /// Length of the shortest word.
    pub resolution: u32,
    /// Sets of effects up to two-factor interactions that cannot be told from each other, such as `AB = CE`.
    pub chains: Vec<Vec<String>>,
}

/// Why there is no such design.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[error("{0}")]
pub struct DesignError(pub String);

impl Design {
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
