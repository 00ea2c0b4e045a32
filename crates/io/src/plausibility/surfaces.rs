//! Rules of the initial surfaces, and of the samples that a run recorded.

use plateau_core::model::first_contact::FirstContact;
use plateau_core::model::material::Status;
use plateau_core::model::parameters::Parameters;
use plateau_core::observe::Sample;
use plateau_core::surface::Length;

use super::rule::{Finding, Rule, apply, number, softest_plateau, too_much_overlap, too_much_pressure};
use crate::scene::{HeightSettings, HeightSource, Scene, Warning};
use crate::surface::Loaded;

/// Fraction of the points that a cutoff takes off peaks alone: from here on it is in the valleys.
const HALF: f64 = 0.5;

/// Subject of the rules.
struct Beginning {
    disc_cutoff: Option<Cutoff>,
    pin_cutoff: Option<Cutoff>,
    contact: Option<FirstContact>,
    foundation_height: f64,
    softest_plateau: f64,
}

/// A cutoff and what it did.
struct Cutoff {
    /// Height above the mean, m.
    height: f64,
    /// Fraction of the points that stood higher.
    cut: f64,
}

const RULES: &[Rule<Beginning>] = &[
    Rule { key: "disc.prepare.cutoff", look: |beginning| useless(beginning.disc_cutoff.as_ref()) },
    Rule { key: "pin.prepare.cutoff", look: |beginning| useless(beginning.pin_cutoff.as_ref()) },
    Rule { key: "operation.normal_force", look: pressure_of_the_first_step },
    Rule { key: "contact.foundation_height", look: overlap_of_the_first_step },
];

/// Values that cannot be meant, now that the surfaces are known, of keys that `scene.warnings` does not name yet.
pub fn of_surfaces(scene: &Scene, loaded: &Loaded) -> Vec<Warning> {
    let parameters = &scene.parameters;
    // Where heights are flat nothing can be cut, and whoever tries a flat disc in a scene need not take its cutoff away.
    let cutoff = |heights: &HeightSettings, cut: Option<f64>| match heights.source {
        HeightSource::Flat => None,
        HeightSource::File { .. } | HeightSource::Synthetic(_) => {
            Some(Cutoff { height: heights.preparation.cutoff?, cut: cut? })
        }
    };
    let beginning = Beginning {
        disc_cutoff: cutoff(&scene.disc_surface, loaded.disc_cut),
        pin_cutoff: cutoff(&scene.pin_surface, loaded.pin_cut),
        contact: FirstContact::of(parameters, &loaded.surfaces),
        foundation_height: parameters.foundation_height,
        softest_plateau: softest_plateau(&parameters.materials),
    };
    apply(RULES, &beginning, scene)
}

fn useless(cutoff: Option<&Cutoff>) -> Option<Finding> {
    let Cutoff { height, cut } = *cutoff?;
    let (bound, advice) = if cut == 0.0 {
        ("no point at all", "no peak is so high: check its unit, or say cutoff = \"none\"")
    } else if cut >= HALF {
        (
            "half of them or more",
            "it is meant for the peaks: check its unit, and what prepare.level takes out before it",
        )
    } else {
        return None;
    };
    Some(Finding {
        found: format!("at {} above the mean it cuts {} % of the points", Length(height), number(100.0 * cut)),
        bound: bound.to_owned(),
        advice,
    })
}

fn pressure_of_the_first_step(beginning: &Beginning) -> Option<Finding> {
    let pressure = beginning.contact?.mean_pressure;
    too_much_pressure(pressure, beginning.softest_plateau, "in the first step a mean contact pressure of")
}

fn overlap_of_the_first_step(beginning: &Beginning) -> Option<Finding> {
    let overlap = beginning.contact?.largest_overlap;
    too_much_overlap(overlap, beginning.foundation_height, "in the first step an overlap of")
}

/// Extent to which a filled fraction may leave 0 to 1: a disc that wears opens a little before the first debris fills it.
const SLACK: f64 = 1e-3;

/// A number and when it was reached, s.
#[derive(Debug, Clone, Copy)]
struct Reached {
    value: f64,
    time: f64,
}

/// The extremes of what a run recorded.
#[derive(Debug)]
pub struct Recorded {
    parameters: Parameters,
    mean_pressure: Reached,
    /// m: what the largest pressure takes in the stiffest pair that there is. A softer pair overlaps more.
    overlap: Reached,
    /// The one furthest outside of 0 to 1, if any is outside by more than [`SLACK`].
    filled_fraction: Option<Reached>,
}

const RECORDED_RULES: &[Rule<Recorded>] = &[
    Rule { key: "operation.normal_force", look: pressure },
    Rule { key: "contact.foundation_height", look: overlap },
    Rule { key: "materials.disc_primary.specific_wear_rate", look: filled_fraction },
];

impl Recorded {
    /// Nothing recorded yet of a run with these parameters.
    pub fn new(parameters: &Parameters) -> Self {
        let none = Reached { value: 0.0, time: 0.0 };
        Self { parameters: parameters.clone(), mean_pressure: none, overlap: none, filled_fraction: None }
    }

    /// Takes note of a sample.
    pub fn add(&mut self, sample: &Sample) {
        let reached = |value| Reached { value, time: sample.time };
        if sample.mean_pressure > self.mean_pressure.value {
            self.mean_pressure = reached(sample.mean_pressure);
        }
        let overlap = sample.max_pressure / largest_stiffness(&self.parameters, sample);
        if overlap > self.overlap.value {
            self.overlap = reached(overlap);
        }
        let beyond = |fraction: f64| (-fraction).max(fraction - 1.0);
        let so_far = self.filled_fraction.map_or(SLACK, |filled| beyond(filled.value));
        if beyond(sample.filled_fraction) > so_far {
            self.filled_fraction = Some(reached(sample.filled_fraction));
        }
    }

    /// Values that cannot be meant, of keys that `scene.warnings` does not name yet.
    pub fn warnings(&self, scene: &Scene) -> Vec<Warning> {
        apply(RECORDED_RULES, self, scene)
    }
}

/// k of the stiffest pair whose statuses a sample has, Pa/m.
fn largest_stiffness(parameters: &Parameters, sample: &Sample) -> f64 {
    let pin = [
        (Status::Resin, sample.pin_none),
        (Status::Primary, sample.pin_primary),
        (Status::Secondary, sample.pin_secondary),
    ];
    let disc = [(false, 1.0 - sample.disc_secondary), (true, sample.disc_secondary)];
    let mut largest = 0.0_f64;
    for (pin, _) in pin.into_iter().filter(|(_, area)| *area > 0.0) {
        for (disc_secondary, _) in disc.into_iter().filter(|(_, area)| *area > 0.0) {
            largest = largest.max(parameters.materials.combined_modulus(pin, disc_secondary));
        }
    }
    largest / parameters.foundation_height
}

fn pressure(recorded: &Recorded) -> Option<Finding> {
    let Reached { value, time } = recorded.mean_pressure;
    let what = format!("at {} s a mean contact pressure of", number(time));
    too_much_pressure(value, softest_plateau(&recorded.parameters.materials), &what)
}

fn overlap(recorded: &Recorded) -> Option<Finding> {
    let Reached { value, time } = recorded.overlap;
    let what = format!("at {} s an overlap of at least", number(time));
    too_much_overlap(value, recorded.parameters.foundation_height, &what)
}

fn filled_fraction(recorded: &Recorded) -> Option<Finding> {
    let Reached { value, time } = recorded.filled_fraction?;
    Some(Finding {
        found: format!("at {} s a filled fraction of {}", number(time), number(value)),
        bound: format!("outside of 0 to 1 by more than {SLACK}"),
        advice: "the disc wears deeper than its lowlands were: check the wear rate, or do not use the filled fraction",
    })
}
