//! Every case.

use plateau_core::model::parameters::{DebrisRule, Integrator, Parameters};
use plateau_core::model::state::Base;

use super::case::{Case, Expected, paper, with_stiffness_number};
use super::surfaces::{all as of_base, rough, scaled, with_disc_cell};
use crate::scenes::flat;

/// Every case; that of most steps takes `most_steps`.
pub fn all(most_steps: u64) -> Vec<Case> {
    let physics = [stiffness(), contrast(), loads(), contacts(), heights(), meshes(), bodies(), times()].concat();
    [with_both_rules(physics), captured(), pad_shares(), durations(most_steps)].concat()
}

/// Each case with one debris pool, and again with local debris.
fn with_both_rules(cases: Vec<Case>) -> Vec<Case> {
    cases.into_iter().flat_map(|case| [case.clone(), case.with_local_debris()]).collect()
}

/// The mesh that most cases have.
fn usual() -> Parameters {
    paper(12, 96, 17)
}

/// Stiffness numbers from where nothing wears to where everything does, with both integrators.
fn stiffness() -> Vec<Case> {
    let mut cases = Vec::new();
    for (name, integrator) in [("explicit", Integrator::Explicit), ("exponential", Integrator::Exponential)] {
        for number in [1e-8, 1e-4, 0.5, 1.0, 2.0, 10.0, 1e4] {
            let parameters = with_stiffness_number(usual(), number, integrator);
            let surfaces = rough(&parameters.mesh);
            let overshoots = integrator == Integrator::Explicit && number > 1.0;
            let expected = if overshoots { Expected::Overshoot } else { Expected::Sound };
            cases.push(Case::new(format!("Π = {number:e}, {name}"), parameters, surfaces).expecting(expected));
        }
    }
    cases
}

/// Fibre stiffer than resin by up to twelve orders of magnitude.
fn contrast() -> Vec<Case> {
    let case = |contrast: f64| {
        let mut parameters = usual();
        parameters.materials.pin_resin.youngs_modulus = parameters.materials.pin_primary.youngs_modulus / contrast;
        let surfaces = rough(&parameters.mesh);
        Case::new(format!("fibre stiffer than resin by {contrast:e}"), parameters, surfaces)
    };
    [1.0, 1e6, 1e12].map(case).to_vec()
}

fn loads() -> Vec<Case> {
    let case = |normal_force: f64| {
        let parameters = Parameters { normal_force, integrator: Integrator::Exponential, ..usual() };
        let surfaces = rough(&parameters.mesh);
        Case::new(format!("load of {normal_force:e} N"), parameters, surfaces)
    };
    let mut cases = [1e-9, 1e-3, 1e3, 1e9].map(case).to_vec();
    // The overlap that carries so little is less than the last bit of a height.
    cases.push(case(1e-30).expecting(Expected::Refused));
    cases
}

/// How many cells touch, and how alike they are.
fn contacts() -> Vec<Case> {
    let parameters = usual();
    let mesh = parameters.mesh.clone();
    let rough = || of_base(rough(&mesh), Base::Primary);
    let mut steps = rough();
    steps.disc_height.iter_mut().for_each(|height| *height = (*height * 1e6).round() * 1e-6);
    steps.pin_height.fill(0.0);
    let light = Parameters { normal_force: 1e-3, ..parameters.clone() };
    let heavy = Parameters { normal_force: 1e4 * parameters.normal_force, ..parameters.clone() };
    let flat = flat(&mesh, Base::Primary);
    vec![
        Case::new("one cell touches", light, with_disc_cell(flat.clone(), 1e-3)),
        Case::new("every cell touches", Parameters { integrator: Integrator::Exponential, ..heavy }, rough()),
        Case::new("seven heights, thousands of ties", parameters.clone(), steps),
        Case::new("perfectly flat", parameters, flat),
    ]
}

fn heights() -> Vec<Case> {
    let parameters = Parameters { integrator: Integrator::Exponential, ..usual() };
    let rough = rough(&parameters.mesh);
    let case = |name: &str, surfaces| Case::new(name, parameters.clone(), surfaces);
    let mut offset = rough.clone();
    offset.disc_height.iter_mut().for_each(|height| *height += 1.0);
    vec![
        case("heights of 1 m", scaled(rough.clone(), 1e6)),
        case("heights of 1e-15 m", scaled(rough.clone(), 1e-10)),
        case("subnormal heights", scaled(rough.clone(), 1e-305)),
        case("a disc 1 m above its reference", offset),
        case("a spike of 1 cm", with_disc_cell(rough.clone(), 1e-2)),
        case("a hole of 1 cm", with_disc_cell(rough.clone(), -1e-2)),
        case("heights of 1e200 m", scaled(rough, 1e206)).expecting(Expected::Refused),
    ]
}

fn meshes() -> Vec<Case> {
    let case = |name: &str, rows, disc_columns, pin_columns| {
        let parameters = paper(rows, disc_columns, pin_columns);
        let surfaces = of_base(rough(&parameters.mesh), Base::Primary);
        Case::new(name, parameters, surfaces)
    };
    vec![
        case("one row", 1, 96, 17),
        case("one column under the pin", 12, 96, 1),
        case("one cell under the pin", 1, 2, 1),
        case("a pin as wide as the ring", 12, 40, 40),
        case("prime sizes", 13, 97, 19),
    ]
}

/// What the pin is made of, and how fast it wears.
fn bodies() -> Vec<Case> {
    let parameters = usual();
    let rough = rough(&parameters.mesh);
    let case = |name: &str, change: &dyn Fn(&mut Parameters), base: Option<Base>| {
        let mut parameters = parameters.clone();
        change(&mut parameters);
        let surfaces = base.map_or_else(|| rough.clone(), |base| of_base(rough.clone(), base));
        Case::new(name, parameters, surfaces)
    };
    let wear = |parameters: &mut Parameters, rate: f64| {
        parameters.materials.pin_primary.specific_wear_rate = rate;
        parameters.materials.pin_secondary.specific_wear_rate = rate;
    };
    vec![
        case("resin only", &|_| {}, Some(Base::Resin)),
        case("fibres only", &|_| {}, Some(Base::Primary)),
        case("no wear", &|parameters| wear(parameters, 0.0), Some(Base::Primary)),
        case("a revolution takes the pin's roughness off", &|parameters| wear(parameters, 1e-11), None),
        case("resin without stiffness", &|parameters| parameters.materials.pin_resin.youngs_modulus = 1e-300, None),
        case(
            "resin only, without stiffness",
            &|parameters| parameters.materials.pin_resin.youngs_modulus = 1e-300,
            Some(Base::Resin),
        )
        .expecting(Expected::Refused),
    ]
}

/// The usual case with a change.
fn changed(name: &str, change: impl FnOnce(&mut Parameters)) -> Case {
    let mut parameters = usual();
    change(&mut parameters);
    let surfaces = rough(&parameters.mesh);
    Case::new(name, parameters, surfaces)
}

/// Steps that take very long, and steps that stand for very many.
fn times() -> Vec<Case> {
    vec![
        changed("a speed of 1e-12 rad/s", |parameters| parameters.angular_velocity = 1e-12),
        changed("a time acceleration of 1e6", |parameters| {
            parameters.time_acceleration = 1e6;
            parameters.integrator = Integrator::Exponential;
        }),
    ]
}

/// Nothing and all that wears stays in the contact; all of it with local debris is the usual case.
fn captured() -> Vec<Case> {
    let mut cases: Vec<Case> = Vec::new();
    for pool in [DebrisRule::Contact, DebrisRule::Track] {
        for fraction in [0.0, 1.0] {
            let name = format!("captured fraction {fraction}, pool of the {}", format!("{pool:?}").to_lowercase());
            cases.push(changed(&name, |parameters| {
                parameters.plateaus.captured_fraction = fraction;
                parameters.plateaus.debris = pool;
            }));
        }
    }
    let mut local = changed("captured fraction 0", |_| {}).with_local_debris();
    local.parameters.plateaus.captured_fraction = 0.0;
    cases.push(local);
    cases
}

/// All of a deposit out of the pool goes to the disc, or to the pin where it can; local debris has no such share.
fn pad_shares() -> Vec<Case> {
    let case = |share| {
        changed(&format!("pad share {share}"), |parameters: &mut Parameters| parameters.plateaus.pad_share = share)
    };
    [0.0, 1.0].map(case).to_vec()
}

/// Very many steps of two flat bodies, of which the closed form is known. With local debris a tenth of them: a step takes
/// longer, and does the same, for all cells touch and nothing finds room.
fn durations(most_steps: u64) -> Vec<Case> {
    let case = |steps: u64| {
        let mut parameters = paper(1, 3, 2);
        parameters.plateaus.captured_fraction = 0.0;
        let surfaces = flat(&parameters.mesh, Base::Primary);
        let name = format!("{} million steps", steps as f64 / 1e6);
        Case::new(name, parameters, surfaces).of_steps(steps).expecting(Expected::Recession)
    };
    vec![case(most_steps), case(most_steps / 10).with_local_debris()]
}
