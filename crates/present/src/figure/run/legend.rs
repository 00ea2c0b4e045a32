//! What lines and bands of runs are, in the legend above a figure: whose they are comes first, then how they were made of the samples. The
//! only run of a figure has its own colours there; what is said of several is said in words.

use super::Subject;
use super::spans::{OPACITY, Spans};
use crate::colour::paler;
use crate::figure::chart::Meaning;
use crate::figure::page::KeyStyle;
use crate::figure::stroke::Stroke;

/// How the lines of the only run that a figure shows are drawn; none where it shows several.
pub fn only_stroke(subjects: &[Subject], mut shown: impl Iterator<Item = usize>) -> Option<Stroke> {
    let first = shown.next()?;
    shown.all(|number| number == first).then(|| Stroke::of(first, subjects.len()))
}

/// What the lines of a figure mean: whose they are, then what those of one run are. The only run has its name in words where its lines have
/// meanings of their own.
pub fn with_names(subjects: &[Subject], shown: impl Fn(usize) -> bool, own: Vec<Meaning>) -> Vec<Meaning> {
    let shown: Vec<usize> = (0..subjects.len()).filter(|number| shown(*number)).collect();
    let name = |number: &usize| match &subjects[*number].label {
        label if shown.len() == 1 && !own.is_empty() => Meaning::in_words(label),
        label => Meaning::of_run(*number, label),
    };
    shown.iter().map(name).chain(own.iter().cloned()).collect()
}

/// What the lines of runs are for which the weighted means of the others are too long, given their names and times; none where there are no
/// such means, or all runs have them.
pub fn of_short_runs<'a>(
    spans: Spans,
    runs: impl Iterator<Item = (&'a str, &'a [f64])>,
    finest: &str,
) -> Option<Meaning> {
    if spans == Spans::FINEST {
        return None;
    }
    let short: Vec<&str> = runs.filter(|(_, times)| !spans.is_weighted(times)).map(|(name, _)| name).collect();
    let lines = if short.len() == 1 { "line" } else { "lines" };
    (!short.is_empty()).then(|| Meaning::in_words(&format!("{lines} of {}: {finest}", short.join(", "))))
}

/// What lines and bands are, where there are bands: in the colour of the only run, else in words, for there is no line of all runs.
pub fn meanings(has_bands: bool, only: Option<Stroke>, line: &str, band: &str) -> Vec<Meaning> {
    match only {
        _ if !has_bands => Vec::new(),
        Some(stroke) => {
            let colour = paler(stroke.colour, OPACITY);
            let area = Meaning { colour, style: KeyStyle::Area, text: band.to_owned() };
            vec![Meaning::of_line(stroke, line), area]
        }
        None => {
            [("lines", line), ("bands", band)].map(|(what, text)| Meaning::in_words(&format!("{what}: {text}"))).into()
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_legend_has_what_is_drawn() {
        let stroke = Stroke::of(0, 1);
        let [line, area] = &meanings(true, Some(stroke), "mean", "reach")[..] else { panic!("two meanings") };
        assert_eq!((line.colour, area.colour), (stroke.colour, paler(stroke.colour, OPACITY)));
        let words = meanings(true, None, "mean", "reach");
        assert!(words.iter().all(|meaning| meaning.style == KeyStyle::Words));
        assert_eq!(
            words.iter().map(|meaning| meaning.text.as_str()).collect::<Vec<_>>(),
            ["lines: mean", "bands: reach"]
        );
        assert!(meanings(false, None, "mean", "reach").is_empty());
    }

    #[test]
    fn runs_that_are_too_short_for_a_weighted_mean_are_named() {
        let times: Vec<f64> = (0..4000).map(f64::from).collect();
        let runs = || [("long", &times[..]), ("short", &times[..500]), ("other", &times[..100])].into_iter();
        let spans = Spans { most: 31, duration: 256.0 };
        let said = of_short_runs(spans, runs(), "mean of a revolution").unwrap();
        assert_eq!((said.text.as_str(), said.style), ("lines of short, other: mean of a revolution", KeyStyle::Words));
        let one = of_short_runs(spans, runs().take(2), "mean").unwrap();
        assert_eq!(one.text, "line of short: mean");
        assert!(of_short_runs(spans, runs().take(1), "mean").is_none());
        assert!(of_short_runs(Spans::FINEST, runs(), "mean").is_none());
    }
}
