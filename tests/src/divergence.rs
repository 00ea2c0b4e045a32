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

#[cfg(test)]
mod tests {
    use std::cell::Cell;

    use plateau_core::model::parameters::Parameters;
    use plateau_core::model::state::{Base, InitialSurfaces};

    use super::*;
    use crate::scenes::{random_surfaces, wear_only};

    const STEPS: u64 = 350;

    /// A small scene with plateaus.
    fn scene() -> (Parameters, InitialSurfaces) {
        let mut parameters = wear_only(11, 40, 9);
        parameters.plateaus.formation = true;
        parameters.plateaus.captured_fraction = 0.5;
        let surfaces = random_surfaces(&parameters.mesh, 1);
        (parameters, surfaces)
    }

    fn start((parameters, surfaces): (Parameters, InitialSurfaces)) -> Simulation {
        Simulation::new(parameters, surfaces).expect("a scene")
    }

    fn names(divergence: &Divergence) -> Vec<&str> {
        let name = |difference: &Difference| match difference {
            Difference::Quantity { name, .. } => *name,
            Difference::Cells { map, .. } => *map,
            Difference::End(_) => "end",
        };
        divergence.differences.iter().map(name).collect()
    }

    #[test]
    fn equal_simulations_do_not_part() {
        assert_eq!(first_divergence(STEPS, || start(scene()), || start(scene())), None);
    }

    #[test]
    fn one_bit_of_one_height_is_found() {
        let other = || {
            let (parameters, mut surfaces) = scene();
            let height = &mut surfaces.disc_height[11 * 23 + 4];
            *height = f64::from_bits(height.to_bits() + 1);
            start((parameters, surfaces))
        };
        let mut divergence = first_divergence(STEPS, || start(scene()), other).expect("a difference");
        let height = scene().1.disc_height[11 * 23 + 4];
        let values = [height, f64::from_bits(height.to_bits() + 1)];
        let cells = |map| Difference::Cells { map, count: [1, 440], first: (4, 23), values };
        let expected =
            Divergence { step: 0, repeatable: true, differences: vec![cells("disc_height"), cells("disc_substrate")] };
        // After the maps there may be the roughness of that disc, as far as its last bits tell.
        let is_roughness = |difference: &Difference| match difference {
            Difference::Quantity { name, .. } => name.starts_with("disc_s"),
            _ => false,
        };
        assert!(divergence.differences.iter().skip(2).all(is_roughness), "{divergence}");
        divergence.differences.truncate(2);
        assert_eq!(divergence, expected);
        let text = divergence.to_string();
        assert!(
            text.contains("after step 0:\n  disc_height differs in 1 of 440 cells, first in row 4 of column 23: "),
            "{text}"
        );
    }

    #[test]
    fn the_first_step_is_found_between_two_comparisons() {
        // A column of fibre and one of resin, 3 µm behind it, over a flat disc: the fibre's overlap is p/k = 0.9 µm, and
        // it wears 3 nm a step. Only a peak of 5 µm in disc column 7 reaches the resin, which loses its wear height then.
        // Step n faces disc column 1 − (n − 1) mod 40 there: n = 35.
        let make = |wear_height: f64| {
            move || {
                let mut parameters = wear_only(3, 40, 2);
                parameters.materials.wear_height = wear_height;
                let mut disc_height = vec![0.0; parameters.mesh.disc_cells()];
                disc_height[3 * 7 + 2] = 5e-6;
                let pin_height = [[0.0; 3], [3e-6; 3]].concat();
                let pin_base = [[Base::Primary; 3], [Base::Resin; 3]].concat();
                start((parameters, InitialSurfaces { disc_height, pin_height, pin_base }))
            }
        };
        let divergence = first_divergence(STEPS, make(5e-6), make(6e-6)).expect("a difference");
        assert_eq!((divergence.step, divergence.repeatable), (35, true));
        assert!(divergence.differences.contains(&Difference::Cells {
            map: "pin_height",
            count: [1, 6],
            first: (2, 1),
            values: [3e-6 + 5e-6, 3e-6 + 6e-6],
        }));
    }

    #[test]
    fn another_captured_fraction_shows_when_something_was_worn() {
        let other = || {
            let (mut parameters, surfaces) = scene();
            parameters.plateaus.captured_fraction = 0.25;
            start((parameters, surfaces))
        };
        let divergence = first_divergence(STEPS, || start(scene()), other).expect("a difference");
        // What is worn in step 1 is shared out in step 2 (model 4P).
        assert_eq!((divergence.step, &names(&divergence)[..2]), (1, &["pool", "emitted"][..]));
        assert!(!divergence.to_string().contains("height"), "{divergence}");
    }

    #[test]
    fn a_difference_that_does_not_come_again_is_told_as_such() {
        let made = Cell::new(0);
        let other = || {
            let (mut parameters, surfaces) = scene();
            parameters.plateaus.captured_fraction = if made.replace(made.get() + 1) == 0 { 0.25 } else { 0.5 };
            start((parameters, surfaces))
        };
        let divergence = first_divergence(STEPS, || start(scene()), other).expect("a difference");
        assert_eq!((divergence.step, divergence.repeatable), (STEPS_BETWEEN, false));
        assert!(divergence.to_string().contains("timing decides"), "{divergence}");
    }

    #[test]
    fn an_end_that_the_reference_does_not_have_is_told() {
        let other = || {
            let (mut parameters, surfaces) = scene();
            parameters.normal_force = f64::INFINITY;
            start((parameters, surfaces))
        };
        let divergence = first_divergence(STEPS, || start(scene()), other).expect("a difference");
        assert_eq!((divergence.step, names(&divergence)), (1, vec!["end"]));
        assert!(divergence.to_string().ends_with(" instead of no error"), "{divergence}");
    }
}
