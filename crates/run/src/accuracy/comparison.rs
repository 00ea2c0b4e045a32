//! What is kept of a run, and how far it is from the reference.

use plateau_core::model::mesh::Mesh;
use plateau_core::observe::Sample;

use super::coarsening::Coarsening;
use super::history::{History, Windows};

/// A run that came to its end.
#[derive(Debug, Clone, PartialEq)]
pub struct Outcome {
    /// Steps.
    pub steps: u64,
    /// Wall time of all steps, s: without making the surfaces, and without a run file. None where a run file does not tell.
    pub wall_time: Option<f64>,
    /// Its course, at the ends of the windows.
    pub history: History,
    /// Its end.
    pub end: End,
    /// Heights at the end, if they are known.
    pub heights: Heights,
}

/// Heights of disc and pin, m, column by column.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Heights {
    /// z_d.
    pub disc: Option<Vec<f64>>,
    /// z_p.
    pub pin: Option<Vec<f64>>,
}

/// Quantities at the end of a run; NaN where one is not known.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct End {
    /// Filled fraction.
    pub filled: f64,
    /// Worn volume of both bodies, m³.
    pub worn: f64,
    /// Debris that left the contact, m³.
    pub emitted: f64,
    /// Area fraction of the ring that is secondary plateau.
    pub disc_secondary: f64,
    /// Area fraction of the pin that is secondary plateau.
    pub pin_secondary: f64,
    /// Largest load residual of any step.
    pub load_residual: f64,
    /// Balance residual.
    pub balance_residual: f64,
}

impl End {
    /// Of the last sample of a run, the largest load residual of which was this.
    pub fn of(sample: &Sample, load_residual: f64) -> Self {
        Self {
            filled: sample.filled_fraction,
            worn: sample.worn_pin + sample.worn_resin + sample.worn_disc,
            emitted: sample.emitted,
            disc_secondary: sample.disc_secondary,
            pin_secondary: sample.pin_secondary,
            load_residual,
            balance_residual: sample.balance_residual,
        }
    }
}

/// How far a run is from the reference: differences are run − reference; NaN where one of them is not known.
#[derive(Debug, Clone, PartialEq)]
pub struct Comparison {
    /// Of the mean contact areas over the windows.
    pub contact_area: HistoryError,
    /// Of the filled fraction at the end.
    pub filled: f64,
    /// Largest of the filled fraction at the end of any window.
    pub filled_largest: f64,
    /// Of the worn volume, relative.
    pub worn: f64,
    /// Of the emitted volume, relative.
    pub emitted: f64,
    /// Of the disc's final heights, rms, m.
    pub disc_height: f64,
    /// Of the pin's final heights about their mean, rms, m.
    pub pin_height: f64,
    /// Of the contact ratio in the last window.
    pub contact_ratio: f64,
    /// Of the disc's coverage with secondary plateau at the end.
    pub disc_secondary: f64,
    /// Of the pin's.
    pub pin_secondary: f64,
}

impl Comparison {
    /// Compares a run on `mesh` with the reference. Where the run's mesh is coarser, the reference's heights are brought
    /// onto it as the initial ones were.
    pub fn of(
        run: &Outcome,
        reference: &Outcome,
        windows: &Windows,
        mesh: &Mesh,
        coarsening: Option<&Coarsening>,
    ) -> Self {
        let (history, expected) = (run.history.at(windows), reference.history.at(windows));
        let (areas, expected_areas) = (history.mean_areas(), expected.mean_areas());
        let last = |values: &[f64]| values.last().copied().unwrap_or(f64::NAN);
        let [disc_height, pin_height] = topography(&run.heights, &reference.heights, mesh, coarsening);
        let pin_area = coarsening.map_or(mesh, |coarsening| &coarsening.mesh).pin_area();
        Self {
            contact_area: HistoryError::of(&areas, &expected_areas),
            filled: run.end.filled - reference.end.filled,
            filled_largest: largest_difference(history.filled(), expected.filled()),
            worn: relative(run.end.worn, reference.end.worn),
            emitted: relative(run.end.emitted, reference.end.emitted),
            disc_height,
            pin_height,
            contact_ratio: last(&areas) / pin_area - last(&expected_areas) / mesh.pin_area(),
            disc_secondary: run.end.disc_secondary - reference.end.disc_secondary,
            pin_secondary: run.end.pin_secondary - reference.end.pin_secondary,
        }
    }
}

/// Difference relative to the reference; none where both are 0.
fn relative(value: f64, reference: f64) -> f64 {
    if value == reference { 0.0 } else { (value - reference) / reference }
}

fn topography(run: &Heights, reference: &Heights, mesh: &Mesh, coarsening: Option<&Coarsening>) -> [f64; 2] {
    let mesh = coarsening.map_or(mesh, |coarsening| &coarsening.mesh);
    let areas = mesh.area();
    let on_mesh = |heights: &Vec<f64>, coarse: fn(&Coarsening, &[f64]) -> Vec<f64>| match coarsening {
        Some(coarsening) => coarse(coarsening, heights),
        None => heights.clone(),
    };
    let disc = run.disc.as_ref().zip(reference.disc.as_ref());
    let pin = run.pin.as_ref().zip(reference.pin.as_ref());
    [
        disc.map_or(f64::NAN, |(run, expected)| rms_difference(run, &on_mesh(expected, Coarsening::disc), areas)),
        pin.map_or(f64::NAN, |(run, expected)| {
            let areas: Vec<f64> = mesh.pin_areas().collect();
            rms_difference_about_mean(run, &on_mesh(expected, Coarsening::pin), &areas)
        }),
    ]
}

/// Error of a history, relative to the reference.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct HistoryError {
    /// √(Σ (a − b)² / Σ b²) with b the reference.
    pub mean_square: f64,
    /// Largest |a − b| / |b| of any window.
    pub largest: f64,
}

impl HistoryError {
    /// Compares the means over the same windows; NaN where one of them is no number.
    pub fn of(values: &[f64], reference: &[f64]) -> Self {
        let pairs = || values.iter().zip(reference);
        let difference: f64 = pairs().map(|(a, b)| (a - b).powi(2)).sum();
        let size: f64 = reference.iter().map(|b| b.powi(2)).sum();
        Self { mean_square: (difference / size).sqrt(), largest: greatest(pairs().map(|(a, b)| ((a - b) / b).abs())) }
    }
}

/// Largest |a − b|.
fn largest_difference(values: &[f64], reference: &[f64]) -> f64 {
    greatest(values.iter().zip(reference).map(|(a, b)| (a - b).abs()))
}

/// The greatest of numbers that are not negative; NaN if one of them is no number.
fn greatest(numbers: impl Iterator<Item = f64>) -> f64 {
    numbers.fold(0.0, |most, number| if number.is_nan() || number > most { number } else { most })
}

/// Area-weighted rms of the difference of two fields, m; `areas` are those of the cells, or of the cells of a column. Cells
/// without area, as beyond the pin's outline, do not count.
fn rms_difference(heights: &[f64], reference: &[f64], areas: &[f64]) -> f64 {
    about(0.0, heights, reference, areas)
}

/// The same after the mean of the difference is taken out: how far the shapes are from each other.
fn rms_difference_about_mean(heights: &[f64], reference: &[f64], areas: &[f64]) -> f64 {
    let mean = weighted_mean(heights.iter().zip(reference).map(|(a, b)| a - b), areas);
    about(mean, heights, reference, areas)
}

fn about(level: f64, heights: &[f64], reference: &[f64], areas: &[f64]) -> f64 {
    weighted_mean(heights.iter().zip(reference).map(|(a, b)| (a - b - level).powi(2)), areas).sqrt()
}

fn weighted_mean(values: impl Iterator<Item = f64>, areas: &[f64]) -> f64 {
    let (sum, area) = values
        .zip(areas.iter().cycle())
        .filter(|(_, weight)| **weight > 0.0)
        .fold((0.0, 0.0), |(sum, area), (value, weight)| (sum + value * weight, area + weight));
    sum / area
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn errors_are_those_of_the_definition() {
        // By hand: √((0.3² + 0.4²)/(3² + 4²)) = 0.1; the larger of 0.3/3 and 0.4/4.
        let error = HistoryError::of(&[3.3, 3.6], &[3.0, 4.0]);
        assert!((error.mean_square - 0.1).abs() < 1e-15 && (error.largest - 0.1).abs() < 1e-15, "{error:?}");
        assert_eq!(HistoryError::of(&[3.0, 4.0], &[3.0, 4.0]), HistoryError { mean_square: 0.0, largest: 0.0 });
        assert_eq!(largest_difference(&[1.0, 0.5], &[0.75, 1.0]), 0.5);
    }

    #[test]
    fn what_is_no_number_is_no_small_error() {
        let error = HistoryError::of(&[f64::NAN, 4.0], &[3.0, 4.0]);
        assert!(error.mean_square.is_nan() && error.largest.is_nan());
    }

    #[test]
    fn cells_count_by_their_areas() {
        // Two columns of two rows with areas 1 and 3; differences 0, 2, 0, 2: mean square (3·4 + 3·4)/8 = 3, mean 1.5,
        // and about it 3 − 2.25 = 0.75.
        let (heights, reference, areas) = ([5.0, 9.0, 1.0, 4.0], [5.0, 7.0, 1.0, 2.0], [1.0, 3.0]);
        assert!((rms_difference(&heights, &reference, &areas) - 3_f64.sqrt()).abs() < 1e-15);
        assert!((rms_difference_about_mean(&heights, &reference, &areas) - 0.75_f64.sqrt()).abs() < 1e-15);
    }
}
