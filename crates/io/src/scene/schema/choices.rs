//! The words of choices, and what each stands for.

use plateau_core::model::cycle::Interpolation;
use plateau_core::model::parameters::{DebrisRule, Integrator};
use plateau_core::model::state::Base;
use plateau_core::simulation::Decomposition;
use plateau_core::surface::micrograph::Fibres;
use plateau_core::surface::{Fill, Flip, Level};

use crate::delimited::Decimal;
use crate::scene::contents::Lay;

/// Words, each with its meaning.
pub type Choices<T, const COUNT: usize> = [(&'static str, T); COUNT];

/// `plateaus.debris`.
pub(crate) const DEBRIS: Choices<DebrisRule, 3> =
    [("local", DebrisRule::Local), ("contact", DebrisRule::Contact), ("track", DebrisRule::Track)];
/// `plateaus.debris_pool`, as `plateaus.debris` was called when there were only these.
pub(crate) const DEBRIS_POOL: Choices<DebrisRule, 2> = [DEBRIS[1], DEBRIS[2]];
/// `numerics.integrator`.
pub const INTEGRATOR: Choices<Integrator, 2> =
    [("explicit", Integrator::Explicit), ("exponential", Integrator::Exponential)];
/// `numerics.decomposition`.
pub const DECOMPOSITION: Choices<Decomposition, 3> =
    [("auto", Decomposition::Auto), ("sectors", Decomposition::Sectors), ("bands", Decomposition::Bands)];
/// `operation.cycle.interpolation`.
pub(crate) const INTERPOLATION: Choices<Interpolation, 2> =
    [("linear", Interpolation::Linear), ("hold", Interpolation::Hold)];
/// `flip` of a preparation.
pub(crate) const FLIP: Choices<Flip, 3> = [("along", Flip::Along), ("across", Flip::Across), ("both", Flip::Both)];
/// `level` of a preparation.
pub const LEVEL: Choices<Level, 4> =
    [("quadratic", Level::Quadratic), ("plane", Level::Plane), ("mean", Level::Mean), ("none", Level::None)];
/// `fill` of a preparation.
pub(crate) const FILL: Choices<Fill, 2> = [("level", Fill::Level), ("interpolate", Fill::Interpolate)];
/// `decimal` of a text file.
pub const DECIMAL: Choices<Decimal, 2> = [(".", Decimal::Point), (",", Decimal::Comma)];
/// `profile_lay` of a file.
pub const LAY: Choices<Lay, 3> = [("along", Lay::Along), ("across", Lay::Across), ("isotropic", Lay::Isotropic)];
/// `extend` of a preparation; its seed is a key of its own.
pub(crate) const EXTEND: Choices<(), 1> = [("statistics", ())];
/// `pin.base.rotate`: quarters of a turn.
pub(crate) const ROTATE: Choices<u8, 4> = [("0 deg", 0), ("90 deg", 1), ("180 deg", 2), ("270 deg", 3)];
/// `pin.base.fibres`.
pub(crate) const FIBRES: Choices<Fibres, 2> = [("bright", Fibres::Bright), ("dark", Fibres::Dark)];
/// `pin.base.uniform`.
pub(crate) const UNIFORM: Choices<Base, 2> = [("primary", Base::Primary), ("none", Base::Resin)];

/// `mesh.shape`.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Shape {
    /// All cells of the pin's rows and columns.
    Rectangle,
    /// Those within a circle.
    Disc,
}

/// `mesh.shape`.
pub(crate) const SHAPE: Choices<Shape, 2> = [("rectangle", Shape::Rectangle), ("disc", Shape::Disc)];

/// The words alone.
pub(super) const fn words<T, const COUNT: usize>(choices: &Choices<T, COUNT>) -> [&'static str; COUNT] {
    let mut words = [""; COUNT];
    let mut place = 0;
    while place < COUNT {
        words[place] = choices[place].0;
        place += 1;
    }
    words
}

/// The word that stands for a value of a choice.
pub fn word<T: PartialEq, const COUNT: usize>(choices: &Choices<T, COUNT>, value: &T) -> &'static str {
    choices.iter().find(|(_, other)| other == value).map_or("", |(word, _)| word)
}
