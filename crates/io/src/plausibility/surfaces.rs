//! What a scene and its surfaces say together: what a cutoff cuts, and what the first step will meet.

use plateau_core::model::first_contact::FirstContact;
use plateau_core::surface::Length;

use super::words::number;
use super::{Finding, Rule, apply, softest_plateau, too_much_overlap, too_much_pressure};
use crate::scene::Warning;
use crate::scene::{HeightSettings, HeightSource, Scene};
use crate::surface::Loaded;

/// Fraction of the points that a cutoff takes off peaks alone: from here on it is in the valleys.
const HALF: f64 = 0.5;

/// What the rules look at.
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

/// What cannot be meant, now that the surfaces are known, of keys that `scene.warnings` does not name yet.
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
