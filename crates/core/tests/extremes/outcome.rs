//! What came of a case.

use plateau_core::model::material::Status;
use plateau_core::model::parameters::Parameters;
use plateau_core::observe::{Map, QUANTITIES, Sample};
use plateau_core::simulation::{Simulation, SimulationError};

use super::case::{Case, Expected};
use super::local::LocalLaws;
use crate::scenes::balance_rounding;

/// Steps of a case that are watched one by one; the others are taken in one go.
const WATCHED: u64 = 600;
/// Largest load residual, where rounding of the heights allows it.
const LOAD: f64 = 1e-9;
/// Largest share of the worn volume that may be unaccounted for.
const BALANCE: f64 = 1e-12;
/// Largest distance that a cell may be worn past its contact by rounding, by the largest overlap of the step.
const ROUNDING: f64 = 1e-9;

/// Whether a case keeps its bounds.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Verdict {
    Pass,
    /// As expected, with the message.
    Refused(String),
    Fail(String),
}

impl Verdict {
    pub fn is_pass(&self) -> bool {
        !matches!(self, Self::Fail(_))
    }
}

/// What came of a case.
#[derive(Debug, Clone)]
pub struct Outcome {
    case: Case,
    measured: Measured,
    pub verdict: Verdict,
}

/// The figures of a case.
#[derive(Debug, Clone, Copy, Default)]
struct Measured {
    load_residual: f64,
    balance_residual: f64,
    /// Whether each was within the bound, or what rounding of the heights explains.
    is_balanced: bool,
    /// Largest distance by which a plateau in contact was worn past the other surface, by the largest overlap of its step.
    overshoot: f64,
    extra_readings: u64,
    is_finite: bool,
    /// Law of local debris that a step broke.
    broken_law: Option<&'static str>,
    /// Relative error of the recession of two flat bodies.
    recession_error: f64,
}

impl Outcome {
    /// Runs a case.
    pub fn of(case: Case) -> Self {
        let mut measured = Measured { is_finite: true, is_balanced: true, ..Measured::default() };
        let verdict = match run(&case, &mut measured) {
            Ok(()) if case.expected == Expected::Refused => Verdict::Fail("not refused".into()),
            Ok(()) => match defect(&case, &measured) {
                Some(defect) => Verdict::Fail(defect),
                None => Verdict::Pass,
            },
            Err(error) if case.expected == Expected::Refused => Verdict::Refused(error.to_string()),
            Err(error) => Verdict::Fail(error.to_string()),
        };
        Self { case, measured, verdict }
    }

    /// Its line of the table.
    pub fn row(&self) -> Vec<String> {
        let Self { case, measured, verdict } = self;
        let has_result = !matches!(verdict, Verdict::Refused(_));
        let figure = |text: String| if has_result { text } else { "–".into() };
        let (expected, verdict) = (
            match case.expected {
                Expected::Sound => "sound".into(),
                Expected::Overshoot => "sound but for overshoot, warned".into(),
                Expected::Recession => format!("recession off by {:.1e}", measured.recession_error),
                Expected::Refused => "refused".into(),
            },
            match verdict {
                Verdict::Pass | Verdict::Refused(_) => "pass".into(),
                Verdict::Fail(reason) => format!("FAIL: {reason}"),
            },
        );
        vec![
            case.name.clone(),
            format!("{:.1e}", case.parameters.stiffness_number()),
            case.steps.to_string(),
            figure(format!("{:.1e}", measured.load_residual)),
            figure(format!("{:.1e}", measured.balance_residual)),
            figure(format!("{:.1e}", measured.overshoot)),
            figure(measured.extra_readings.to_string()),
            expected,
            verdict,
        ]
    }
}

/// Which bound is not kept, if one is not.
fn defect(case: &Case, measured: &Measured) -> Option<String> {
    if !measured.is_finite {
        return Some("a number is not finite".into());
    }
    if measured.load_residual > LOAD.max(load_rounding(case)) {
        return Some("load residual".into());
    }
    if !measured.is_balanced {
        return Some("balance residual".into());
    }
    if let Some(law) = measured.broken_law {
        return Some(law.into());
    }
    if case.expected != Expected::Overshoot && measured.overshoot > ROUNDING {
        return Some("overshoot".into());
    }
    if case.expected == Expected::Recession && measured.recession_error > recession_rounding(case) {
        return Some(format!("recession off by {:e}", measured.recession_error));
    }
    None
}

/// Load residual that rounding explains: an overlap is known to half a unit in the last place of the heights, and every
/// cell of the pin may touch. Where this is above the tolerance, the program warns.
fn load_rounding(case: &Case) -> f64 {
    let Parameters { mesh, materials, foundation_height, normal_force, .. } = &case.parameters;
    let stiffness = materials.combined_modulus(Status::Primary, false) / foundation_height;
    // Over very many steps the pin goes far from where it was.
    let recession =
        if case.expected == Expected::Recession { recession_per_step(case) * case.steps as f64 } else { 0.0 };
    let highest = highest(case).max(recession);
    stiffness * mesh.pin_area() * highest * 0.5 * f64::EPSILON / normal_force
}

/// The largest initial height of either surface, m.
pub fn highest(case: &Case) -> f64 {
    let heights = case.surfaces.disc_height.iter().chain(&case.surfaces.pin_height);
    heights.fold(0.0, |highest, height| highest.max(height.abs()))
}

fn run(case: &Case, measured: &mut Measured) -> Result<(), SimulationError> {
    let mut simulation = Simulation::new(case.parameters.clone(), case.surfaces.clone())?;
    let laws = LocalLaws::of(&case.parameters, &case.surfaces);
    let mut before = State::of(&mut simulation)?;
    for _ in 0..case.steps.min(WATCHED) {
        let step = simulation.steps_done();
        simulation.advance()?;
        let sample = simulation.sample()?;
        measured.take(case, &sample);
        let after = State::of(&mut simulation)?;
        measured.is_finite &= after.is_finite();
        measured.broken_law = measured.broken_law.or_else(|| laws.broken(&sample, &after.disc));
        measured.overshoot = measured.overshoot.max(before.overshoot(&after, case, step, sample.displacement));
        before = after;
    }
    let first = simulation.sample()?;
    simulation.advance_to(case.steps)?;
    let last = simulation.sample()?;
    measured.take(case, &last);
    let end = State::of(&mut simulation)?;
    measured.is_finite &= end.is_finite();
    measured.broken_law = measured.broken_law.or_else(|| laws.broken(&last, &end.disc));
    let course = simulation.course();
    (measured.load_residual, measured.extra_readings) = (course.largest_load_residual, course.extra_readings);
    if case.expected == Expected::Recession && last.step > first.step {
        let expected = recession_per_step(case) * (last.step - first.step) as f64;
        measured.recession_error = ((last.displacement - first.displacement) / expected - 1.0).abs();
    }
    Ok(())
}

/// κ p r Δθ of a flat pin of one row, m (model section 8).
fn recession_per_step(case: &Case) -> f64 {
    let mesh = &case.parameters.mesh;
    let pressure = case.parameters.normal_force / mesh.pin_area();
    let wear_rate = case.parameters.materials.pin_primary.specific_wear_rate;
    wear_rate * pressure * mesh.mean_radius() * mesh.column_angle() * case.parameters.time_acceleration
}

/// Relative error of the recession that rounding explains: each step rounds a height to half a unit in its last place.
fn recession_rounding(case: &Case) -> f64 {
    let step = recession_per_step(case);
    0.5 * f64::EPSILON * (step * case.steps as f64) / step
}

impl Measured {
    fn take(&mut self, case: &Case, sample: &Sample) {
        self.balance_residual = self.balance_residual.max(sample.balance_residual.abs());
        let highest = highest(case).max(sample.displacement.abs());
        let rounding = balance_rounding(&case.parameters, highest, sample);
        self.is_balanced &= sample.balance_residual.abs() <= BALANCE.max(rounding);
        self.is_finite &= QUANTITIES.iter().map(|quantity| quantity.value(sample)).all(f64::is_finite);
    }
}

/// Heights and statuses at one moment.
struct State {
    disc: Vec<f64>,
    pin: Vec<f64>,
    pin_status: Vec<f64>,
}

impl State {
    fn of(simulation: &mut Simulation) -> Result<Self, SimulationError> {
        let maps = simulation.snapshot(&[Map::DiscHeight, Map::PinHeight, Map::PinStatus])?.maps;
        let mut fields = maps.into_iter().map(|(_, values)| values.into_numbers());
        let mut next = || fields.next().unwrap_or_default();
        Ok(Self { disc: next(), pin: next(), pin_status: next() })
    }

    fn is_finite(&self) -> bool {
        self.disc.iter().chain(&self.pin).all(|height| height.is_finite())
    }

    /// How far the worst plateau in contact was worn past the other surface in the step from here to `after`, by the
    /// largest overlap. Plateaus whose status changes are left out: what they lose is not all wear.
    fn overshoot(&self, after: &Self, case: &Case, step: u64, displacement: f64) -> f64 {
        let mesh = &case.parameters.mesh;
        let (mut worst, mut largest) = (0.0_f64, 0.0_f64);
        for column in 0..mesh.pin_columns() {
            let over = mesh.column(mesh.disc_column(column, step));
            for (pin, disc) in mesh.column(column).zip(over) {
                let overlap = displacement + self.disc[disc] - self.pin[pin];
                largest = largest.max(overlap);
                let is_plateau = self.pin_status[pin] != f64::from(Status::Resin as u8);
                if overlap > 0.0 && is_plateau && self.pin_status[pin] == after.pin_status[pin] {
                    worst = worst.max(after.pin[pin] - after.disc[disc] - displacement);
                }
            }
        }
        if largest > 0.0 { worst / largest } else { 0.0 }
    }
}
