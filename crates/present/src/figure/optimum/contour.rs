//! The mean desirability over two factors, with the others at the optimum.

use plateau_study::design::Setting;
use plateau_study::optimum::{Kept, Limit};

use super::Shown;
use crate::figure::axes::Axis;
use crate::figure::canvas::TEXT;
use crate::figure::effects::axes;
use crate::figure::effects::factor_map::FactorMap;
use crate::figure::font::shortened;
use crate::figure::format::Figure;
use crate::study::goals::limit_sides;

/// Longest name of a limit, pixels.
const LABEL: f64 = 420.0;

/// The figure; none where the desirability is the same all over.
pub fn figure(shown: &Shown<'_>, factors: [usize; 2]) -> Option<Figure> {
    let axes = axes(shown.analysis);
    let surrogates = shown.surrogates();
    let value = |coded: [f64; 2]| {
        let changed = [0, 1].map(|at| (factors[at], Setting::Coded(coded[at])));
        shown.desirability(&surrogates, &shown.with(&changed)).filter(|desirability| *desirability > 0.0)
    };
    let map = FactorMap::new(shown.analysis, factors, factors.map(|factor| &axes[factor]), value);
    if !map.varies() {
        return None;
    }
    let border = |limit: &Limit| {
        let margin = |coded: [f64; 2]| {
            let changed = [0, 1].map(|at| (factors[at], Setting::Coded(coded[at])));
            shown.margin(&surrogates, limit, &shown.with(&changed))
        };
        let response = &shown.analysis.responses[limit.response];
        let text = shortened(&format!("{} {}", response.name, limit_sides(response, limit)), TEXT, LABEL);
        FactorMap::new(shown.analysis, factors, factors.map(|factor| &axes[factor]), margin).lines_at(0.0, &text)
    };
    let borders: Vec<_> = shown.limits.iter().flat_map(border).collect();
    let best = factors.map(|factor| match shown.best[factor] {
        Setting::Coded(coded) => Some(coded),
        level @ Setting::Level(_) => axes[factor].factor.factor.coded(level),
    });
    let mark = if let [Some(x), Some(y)] = best { Some(([x, y], "optimum".to_owned())) } else { None };
    let others = (0..axes.len()).filter(|factor| !factors.contains(factor));
    let others: Vec<String> = others
        .map(|factor| format!("{} = {}", axes[factor].plain_name(), axes[factor].name(shown.best[factor])))
        .collect();
    let (held, note) = if others.is_empty() {
        (String::new(), String::new())
    } else {
        let plain = others.iter().map(|other| other.replacen(" = ", " ", 1)).collect::<Vec<_>>().join(", ");
        (format!(" The others are at the optimum: {}.", others.join(", ")), format!("held at the optimum: {plain}"))
    };
    let runs = map.runs(shown.analysis, &shown.best.iter().copied().map(Some).collect::<Vec<_>>());
    let scale = |range, length| Axis::linear(range, shortened("desirability", TEXT, length));
    let kept = match shown.limits.first().map(|limit| limit.kept) {
        Some(Kept::Means) => "limits are kept by the interval of means",
        Some(Kept::Runs) => "limits are kept by the interval of runs",
        Some(Kept::Value) | None => "",
    };
    let page = map.page(scale, "desirability 0", &borders, &runs, mark, &[note, runs.note(), kept.to_owned()]);
    Some(Figure {
        name: "contour".to_owned(),
        title: "Desirability over two factors".to_owned(),
        caption: format!(
            "How much all goals are met over two factors, as far as there are runs, with lines of equal desirability; grey where \
             it is 0: a limit is missed, or a goal altogether. Dashed lines: limits.{held}"
        ),
        page,
    })
}
