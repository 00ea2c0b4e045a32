//! Where two simulations part that should agree to the last bit.

use std::fmt;

use plateau_core::model::accounts::AccountsReport;
use plateau_core::observe::{self, EXTRAS, Map, QUANTITIES, Sample, schedule};
use plateau_core::simulation::Simulation;

/// Steps between two comparisons; where one fails, the steps before it are taken once more, one by one.
const STEPS_BETWEEN: u64 = 100;

// A sample is its step, its time, the quantities, of which two are sums of others, and the extras: none of its numbers is left out of
// a comparison.
const _: () = assert!(
    size_of::<Sample>()
        == size_of::<f64>() * (QUANTITIES.len() - 2 + 2)
            + size_of::<AccountsReport>()
            + size_of::<Vec<(&'static str, f64)>>()
);

/// The first step after which two simulations differ, and in what.
#[derive(Debug, Clone, PartialEq)]
pub struct Divergence {
    /// Steps done.
    pub step: u64,
    /// Whether the steps before, taken once more and one by one, led to a difference again. Where they did not, timing
    /// decides over the results, and `step` is only where the difference was noticed.
    pub repeatable: bool,
    /// What differs.
    pub differences: Vec<Difference>,
}

/// One thing that differs.
#[derive(Debug, Clone, PartialEq)]
pub enum Difference {
    /// A number of the sample.
    Quantity {
        /// Its name.
        name: &'static str,
        /// What it is in the reference and in the other simulation.
        values: [f64; 2],
    },
    /// Cells of a map.
    Cells {
        /// The map's name.
        map: &'static str,
        /// How many cells differ, of how many.
        count: [usize; 2],
        /// Row and column of the first.
        first: (usize, usize),
        /// What it is there in the reference and in the other simulation.
        values: [f64; 2],
    },
    /// How the steps ended: the reference and the other simulation.
    End([String; 2]),
}

/// Takes so many steps of two simulations, which are given as the functions that make them, side by side, and compares all
/// numbers of their samples and all their maps every 100 steps, bit for bit.
///
/// # Panics
/// When either cannot be made, or a step fails.
pub fn first_divergence(
    steps: u64,
    reference: impl Fn() -> Simulation,
    other: impl Fn() -> Simulation,
) -> Option<Divergence> {
    let mut pair = [reference(), other()];
    let mut equal = 0;
    for step in (0..steps).step_by(STEPS_BETWEEN as usize).chain([steps]) {
        let differences = differences(&mut pair, step);
        if !differences.is_empty() {
            let again = search([reference(), other()], equal, step);
            return Some(again.unwrap_or(Divergence { step, repeatable: false, differences }));
        }
        equal = step;
    }
    None
}

/// The first difference from step `equal` to `different`, looked for step by step.
fn search(mut pair: [Simulation; 2], equal: u64, different: u64) -> Option<Divergence> {
    let mut steps = (equal..=different).map(|step| (step, differences(&mut pair, step)));
    let (step, differences) = steps.find(|(_, differences)| !differences.is_empty())?;
    Some(Divergence { step, repeatable: true, differences })
}

/// What differs between two simulations when so many steps are done.
pub fn differences(pair: &mut [Simulation; 2], step: u64) -> Vec<Difference> {
    let rows = pair[0].parameters().mesh.rows();
    match pair.each_mut().map(|simulation| Moment::reach(simulation, step)) {
        [Ok(reference), Ok(other)] => reference.differences(&other, rows),
        ends => {
            let [reference, other] = ends.map(|end| end.map_or_else(|error| error, |_| "no error".into()));
            if reference == other { Vec::new() } else { vec![Difference::End([reference, other])] }
        }
    }
}

/// All that a simulation tells at one moment.
struct Moment {
    quantities: Vec<(&'static str, f64)>,
    maps: Vec<(Map, Vec<f64>)>,
}

impl Moment {
    fn reach(simulation: &mut Simulation, step: u64) -> Result<Self, String> {
        let mut told = || {
            simulation.advance_to(step)?;
            let end = schedule::Moment { time: simulation.time(), ..schedule::Moment::default() };
            Ok((simulation.sample_at(&end, EXTRAS)?, simulation.snapshot(&Map::ALL)?))
        };
        let (sample, snapshot) =
            told().map_err(|error: plateau_core::simulation::SimulationError| error.to_string())?;
        let mut quantities = vec![("step", sample.step as f64), ("time", sample.time)];
        quantities.extend(observe::quantities(EXTRAS).map(|quantity| (quantity.name, quantity.value(&sample))));
        let maps = snapshot.maps.into_iter().map(|(map, values)| (map, values.into_numbers())).collect();
        Ok(Self { quantities, maps })
    }

    /// What differs, maps first: they name the cells.
    fn differences(&self, other: &Self, rows: usize) -> Vec<Difference> {
        let mut differences = Vec::new();
        for ((map, one_map), (_, other_map)) in self.maps.iter().zip(&other.maps) {
            let pairs = one_map.iter().zip(other_map).enumerate();
            let mut different = pairs.filter(|(_, (one, other))| one.to_bits() != other.to_bits());
            if let Some((cell, (one, other))) = different.next() {
                differences.push(Difference::Cells {
                    map: map.name(),
                    count: [1 + different.count(), one_map.len()],
                    first: (cell % rows, cell / rows),
                    values: [*one, *other],
                });
            }
        }
        let quantities = self.quantities.iter().zip(&other.quantities);
        let quantities = quantities.filter(|((_, one), (_, other))| one.to_bits() != other.to_bits());
        differences
            .extend(quantities.map(|((name, one), (_, other))| Difference::Quantity { name, values: [*one, *other] }));
        differences
    }
}

impl fmt::Display for Divergence {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { step, repeatable, differences } = self;
        if *repeatable {
            write!(f, "the first difference is after step {step}:")?;
        } else {
            write!(f, "a difference after step {step} that did not come again, so timing decides over the results:")?;
        }
        differences.iter().try_for_each(|difference| write!(f, "\n  {difference}"))
    }
}

impl fmt::Display for Difference {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Quantity { name, values } => write!(f, "{name} is {}", Instead(values)),
            Self::Cells { map, count: [count, of], first: (row, column), values } => {
                let values = Instead(values);
                write!(f, "{map} differs in {count} of {of} cells, first in row {row} of column {column}: {values}")
            }
            Self::End([reference, other]) => write!(f, "{other} instead of {reference}"),
        }
    }
}

/// What a number is instead of the reference's: shortest digits that tell it from any other, and its bits.
struct Instead<'a>(&'a [f64; 2]);

impl fmt::Display for Instead<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let [reference, other] = self.0;
        write!(f, "{other:e} ({:016x}) instead of {reference:e} ({:016x})", other.to_bits(), reference.to_bits())
    }
}
