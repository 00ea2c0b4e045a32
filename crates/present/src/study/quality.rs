//! How well a model fits.

use plateau_study::effects::Effects;

use plateau_io::number;

/// How well the model fits, in a line; `shown` makes a text of a value in the response's unit.
pub fn quality(effects: &Effects, shown: impl Fn(f64) -> String) -> String {
    let missing = if effects.missing > 0 { format!(", {} without a response", effects.missing) } else { String::new() };
    let mut parts = vec![
        format!("{}{missing}", number::count(effects.observations, "run")),
        format!("mean {}", shown(effects.mean)),
        format!("R² {:.4}", effects.r_squared),
    ];
    parts.extend(effects.predicted_r_squared.map(|share| format!("predicted R² {share:.4}")));
    parts.extend(
        effects
            .residual_standard_deviation
            .map(|deviation| format!("error {} (from {})", shown(deviation), effects.error)),
    );
    if effects.residual_standard_deviation.is_none() {
        parts.push(format!("error {}", effects.error));
    }
    parts.extend(effects.lenth.map(|lenth| {
        let [margin, simultaneous] = [lenth.margin, lenth.simultaneous_margin].map(&shown);
        format!("margin of error {margin}, simultaneous {simultaneous} (Lenth)")
    }));
    parts.join(", ")
}
