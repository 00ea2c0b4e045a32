//! `plateau check`: what a scene resolves to, what it needs and what it will cost, without running it.

use std::time::{Duration, Instant};

use plateau_core::acceleration::scout::Idle;
use plateau_core::acceleration::smoothness::Smoothness;
use plateau_core::engine::parts::parts;
use plateau_core::simulation::Simulation;
use plateau_io::plausibility;
use plateau_io::surface::{self, Loaded};
use plateau_run::execution::{decide, time_per_step};
use plateau_run::{idle_warning, stiffness_warning};

use super::check_parts::PulseReport;
use super::check_report::{CheckReport, files};
use crate::arguments::CheckArguments;
use crate::failure::Failure;
use crate::scene::load_scene;
use crate::table::{print, print_json};
use crate::terminal::Messages;
use crate::{invocation, message};

/// Time that the trial on which the estimated time rests may take.
const TRIAL: Duration = Duration::from_millis(300);

/// Checks a scene.
pub fn check(arguments: &CheckArguments) -> Result<(), Failure> {
    let mut scene = load_scene(&arguments.scene)?;
    let start = Instant::now();
    let loaded = surface::load(&scene).map_err(Failure::input)?;
    let preparing = start.elapsed().as_secs_f64();
    loaded.warnings().for_each(message::warning);
    let implausible = plausibility::of_surfaces(&scene, &loaded);
    implausible.iter().for_each(message::warning);
    scene.warnings.extend(implausible);
    let parts = parts(&scene.parameters, &loaded.surfaces.pin_base);
    let Loaded { surfaces, inputs, report, .. } = loaded;
    let pulse = PulseReport::of(&scene.parameters, &surfaces.pin_base, scene.steps);
    let files = files(&scene, &inputs);
    if scene.adaptive.is_some() && Smoothness::forbids_from_the_start(&scene.parameters, &surfaces) {
        message::warning(idle_warning(Idle::Smooth(0.0)));
        scene.adaptive = None;
    }
    let options = arguments.execution.options();
    let decided = decide(&scene, 1, &options, &surfaces, &mut Messages).map_err(Failure::run)?;
    let mut simulation =
        Simulation::with_execution(scene.parameters.clone(), surfaces, decided).map_err(Failure::input)?;
    let seconds_per_step = time_per_step(&mut simulation, scene.steps, TRIAL).map_err(Failure::run)?;
    // A ring of few columns has no work for many workers: what there are, the simulation knows.
    let check =
        CheckReport::new(&scene, files, report, &parts, pulse, simulation.execution(), [preparing, seconds_per_step]);
    stiffness_warning(&scene.parameters).iter().for_each(message::warning);
    if scene.output.file.exists() {
        message::warning(format_args!(
            "{} exists; `{} run` needs --force to replace it, or -o FILE",
            scene.output.file.display(),
            invocation::program()
        ));
    }
    if arguments.scene.json { print_json(&check) } else { print(&check.to_text(arguments.all, message::warnings())) }
}
