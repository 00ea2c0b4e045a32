//! What a finished run tells its user.

use plateau_core::observe::window_mean::WindowMean;
use plateau_present::acceleration::acceleration;
use plateau_present::running_in::{in_contact, running_in, running_in_time};
use plateau_run::RunSummary;

use crate::failure::Failure;
use crate::number;
use crate::table::{list, table};

/// One JSON document.
///
/// # Errors
/// When it cannot be written down.
pub fn json(summary: &RunSummary) -> Result<String, Failure> {
    serde_json::to_string_pretty(summary).map(|text| text + "\n").map_err(Failure::run)
}

/// A table for people.
pub fn text(summary: &RunSummary) -> String {
    // Adding 0 makes a negative zero a plain one.
    let percent = |fraction: f64| format!("{:.2} %", (1e4 * fraction).round() / 1e2 + 0.0);
    let square_millimetres = |area: f64| format!("{:.4} mm²", area * 1e6);
    let cubic_millimetres = |volume: f64| format!("{} mm³", number::short(volume * 1e9));
    let megapascal = |pressure: f64| format!("{:.3} MPa", pressure * 1e-6);
    let of_last_step = format!(
        "last step {}, {} of the pin",
        square_millimetres(summary.contact_area),
        percent(summary.contact_ratio)
    );
    let contact_area = match &summary.contact_area_last_tenth {
        Some(window) => format!("{}; {of_last_step}", contact_area(window)),
        None => of_last_step,
    };
    let steps = if summary.steps == 1 { "step" } else { "steps" };
    let mut rows = vec![
        ("simulated time", format!("{} s in {} {steps}", number::short(summary.time), number::grouped(summary.steps))),
        (
            "wall time",
            format!(
                "{} ({} steps/s)",
                number::duration(summary.wall_time),
                number::grouped(summary.steps_per_second as u64)
            ),
        ),
        ("waited for the run file", number::duration(summary.writer_wait)),
        ("contact area", contact_area),
    ];
    rows.extend(summary.time_acceleration.as_ref().map(|chosen| ("time acceleration", acceleration(chosen))));
    let (drift, time) = &summary.running_in;
    rows.extend([("running in", running_in(drift)), ("running-in time", running_in_time(time))]);
    rows.extend([
        (
            "contact pressure",
            format!(
                "last step: mean {}, largest {}",
                megapascal(summary.mean_pressure),
                megapascal(summary.max_pressure)
            ),
        ),
        ("disc filled", percent(summary.filled_fraction)),
        (
            "secondary plateaus",
            format!("{} of the disc, {} of the pin", percent(summary.disc_secondary), percent(summary.pin_secondary)),
        ),
        (
            "worn volume",
            format!(
                "{} of the simulated pin and the disc, of which emitted {}",
                cubic_millimetres(summary.worn),
                cubic_millimetres(summary.emitted)
            ),
        ),
    ]);
    rows.push((
        "worn off the pin",
        format!(
            "{} of the whole simulated pin, {} of it off plateaus",
            cubic_millimetres(summary.worn_whole_pin),
            cubic_millimetres(summary.worn_pin)
        ),
    ));
    if let Some(rate) = summary.specific_wear_rate_whole_pin {
        // Build-up on the pin is weighed with it.
        let lost = cubic_millimetres(summary.lost_pin);
        rows.push((
            "lost by the pin",
            format!("{lost} as a balance shows it, specific wear rate of the whole pin {rate:.3e} 1/Pa"),
        ));
    }
    rows.extend(parts(summary));
    rows.push((
        "residuals",
        format!(
            "load {:.1e} at most, debris balance {:.1e}{}",
            summary.load_residual,
            summary.balance_residual,
            summary.parts.heat_residual.map_or(String::new(), |residual| format!(", heat {residual:.1e}"))
        ),
    ));
    if let Some(bytes) = summary.peak_memory {
        rows.push(("peak memory", number::bytes(bytes)));
    }
    rows.push(("run file", format!("{} ({})", summary.file.display(), number::bytes(summary.file_size))));
    format!("{}\n{}", table(&summary.title, &rows), list("Surfaces", &summary.surfaces))
}

/// Rows of the parts of the model that the scene asks for.
fn parts(summary: &RunSummary) -> Vec<(&'static str, String)> {
    let (parts, mut rows) = (&summary.parts, Vec::new());
    if let (Some(coefficient), Some(work)) = (parts.friction_coefficient_mean, parts.friction_work) {
        let over = "mean of the last simulated revolution";
        rows.push((
            "friction",
            format!("coefficient {coefficient:.3} ({over}), work {} J of the simulated pin", number::short(work)),
        ));
    }
    if let (Some(contact), Some(disc), Some(pin)) =
        (parts.contact_temperature, parts.disc_temperature, parts.pin_temperature)
    {
        let celsius = |kelvin: f64| format!("{:.1} °C", kelvin - 273.15);
        let contact = if contact.is_nan() { "lifted".to_owned() } else { celsius(contact) };
        rows.push(("temperature", format!("contact {contact}, disc {}, pin {}", celsius(disc), celsius(pin))));
    }
    if let (Some(pm10), Some(pm25), Some(number)) = (parts.pm10_mass, parts.pm25_mass, parts.particle_number) {
        let microgram = |mass: f64| format!("{} µg", number::short(mass * 1e9));
        let particles = number::short(number);
        let airborne = format!(
            "PM10 {}, PM2.5 {}, {particles} particles of the simulated pin, {} mm²",
            microgram(pm10),
            microgram(pm25),
            number::rounded(summary.pin_area * 1e6, 3)
        );
        rows.push(("airborne", airborne));
    }
    rows
}

/// A mean contact area with its standard error, and over what it is taken.
fn contact_area(window: &WindowMean) -> String {
    let mean = number::with_error(window.mean * 1e6, window.standard_error.map(|error| error * 1e6));
    let width = number::rounded(window.to - window.from, 4);
    let over = match window.revolutions {
        Some(revolutions) if !window.is_long() => {
            format!("mean of all {width} s, only {} simulated revolutions", number::rounded(revolutions, 2))
        }
        _ => format!("mean of the last {width} s"),
    };
    let contact = in_contact(window);
    let error = if window.standard_error.is_some() { ", ± standard error" } else { ", too few samples for an error" };
    format!("{mean} mm² ({over}{contact}{error})")
}
