//! A run held against the reference.

use plateau_core::mesh::Mesh;

use super::coarsening::Coarsening;
use super::history_error::{HistoryError, largest_difference};
use super::outcome::{Heights, Outcome};
use super::topography::{rms_difference, rms_difference_about_mean};
use super::windows::Windows;

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
    let areas = coarsening.map_or(mesh, |coarsening| &coarsening.mesh).area();
    let on_mesh = |heights: &Vec<f64>, coarse: fn(&Coarsening, &[f64]) -> Vec<f64>| match coarsening {
        Some(coarsening) => coarse(coarsening, heights),
        None => heights.clone(),
    };
    let disc = run.disc.as_ref().zip(reference.disc.as_ref());
    let pin = run.pin.as_ref().zip(reference.pin.as_ref());
    [
        disc.map_or(f64::NAN, |(run, expected)| rms_difference(run, &on_mesh(expected, Coarsening::disc), areas)),
        pin.map_or(f64::NAN, |(run, expected)| {
            rms_difference_about_mean(run, &on_mesh(expected, Coarsening::pin), areas)
        }),
    ]
}
