//! The contact model and the description of surfaces agree: the load balance of a flat punch on a measured surface gives
//! its Abbott-Firestone curve.
//!
//! A flat pin at the height c above a surface touches where z > c, with the overlap z − c, wherever the heights come from:
//! contact ratio = Smr(c), and nominal pressure F_N/ΣA = k ⟨(z − c)₊⟩ = k Vm(c) (model 4.1; ISO 25178-2, 4.5).

use std::path::{Path, PathBuf};

use plateau_core::model::mesh::Mesh;
use plateau_core::model::parameters::Parameters;
use plateau_core::surface::{Level, level};
use plateau_io::surface::{ReadOptions, read};
use plateau_tests::program::repository;
use plateau_tests::scenes::{all_primary, primary_stiffness, wear_only};

/// Material ratios at which the punch is held.
const RATIOS: [f64; 6] = [1e-3, 0.01, 0.1, 0.3, 0.6, 0.9];

/// Rows of the mesh.
const ROWS: usize = 256;

/// Heights of the measured points, the least-squares plane taken out, about their mean, m; as many as fill all rows.
fn levelled(path: &Path) -> Vec<f64> {
    let measured = read(path, &ReadOptions::default()).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
    let (rows, mut heights) = (measured.rows, measured.heights);
    level(&mut heights, rows, Level::Plane, false);
    heights.retain(|height| !height.is_nan());
    heights.truncate(heights.len() / ROWS * ROWS);
    heights
}

/// A wide ring, whose cells have nearly the same area, under a pin that covers it.
fn wide_ring(columns: usize) -> Parameters {
    let parameters = wear_only(ROWS, columns, columns);
    let inner = 1e4;
    let mesh = Mesh::new(ROWS, columns, columns, inner, inner + ROWS as f64 * 50e-6).expect("a valid mesh");
    Parameters { mesh, ..parameters }
}

/// By how much areas of cells of the wide ring differ.
const AREA_SPREAD: f64 = ROWS as f64 * 50e-6 / 1e4;

/// The Abbott-Firestone curve by its definition: heights, m, the highest first.
struct MaterialCurve(Vec<f64>);

impl MaterialCurve {
    /// Smr(c): fraction of the points that reach the height `c` or stand above it.
    fn ratio(&self, c: f64) -> f64 {
        self.0.iter().filter(|height| **height >= c).count() as f64 / self.0.len() as f64
    }

    /// Vm(c): volume of material above the height `c` per area, m.
    fn volume(&self, c: f64) -> f64 {
        self.0.iter().map(|height| (height - c).max(0.0)).sum::<f64>() / self.0.len() as f64
    }

    /// A height between two neighbouring heights, near the material ratio `ratio`: no point lies on it.
    fn height_between_points(&self, ratio: f64) -> f64 {
        let upper = self.0[(ratio * self.0.len() as f64) as usize];
        0.5 * (upper + self.0[self.0.partition_point(|height| *height >= upper)])
    }
}

fn assert_agrees(path: &Path) {
    let heights = levelled(path);
    let points = heights.len();
    let mut descending = heights.clone();
    descending.sort_unstable_by(|one, other| other.total_cmp(one));
    let curve = MaterialCurve(descending);
    for ratio in RATIOS {
        let c = curve.height_between_points(ratio);
        let volume = curve.volume(c);
        let mut parameters = wide_ring(points / ROWS);
        let stiffness = primary_stiffness(&parameters);
        parameters.normal_force = stiffness * volume * parameters.mesh.pin_area();
        let mut simulation = all_primary(parameters, heights.clone(), vec![0.0; points]);
        simulation.advance().expect("a step");
        let sample = simulation.sample().expect("a sample");
        let what = format!("{} at {ratio}", path.display());
        // The spread of the areas shifts the mean overlap, and with it the height of the punch.
        let shift = AREA_SPREAD * volume / curve.ratio(c);
        let height = -sample.displacement;
        assert!((height - c).abs() <= shift, "{what}: the punch is at {height} m, not {c} m");
        // Within that shift, points that touch or not; besides them the areas differ.
        let between = curve.ratio(c - shift) - curve.ratio(c + shift) + AREA_SPREAD;
        let found = sample.contact_ratio - curve.ratio(c);
        assert!(found.abs() <= between, "{what}: the contact ratio is off by {found:e}, at most {between:e}");
        let pressure = sample.mean_pressure * sample.contact_ratio / (stiffness * volume) - 1.0;
        assert!(pressure.abs() < 1e-12, "{what}: the nominal pressure is off by {pressure:e}");
    }
}

#[test]
fn a_flat_punch_meets_the_material_ratio_of_a_measured_surface() {
    assert_agrees(&repository().join("data/surfaces/afm_256x256.sdf"));
}

#[test]
fn a_flat_punch_meets_the_material_ratio_of_every_shared_surface() {
    let folder: PathBuf = repository().join("../shared/surfaces");
    if !folder.is_dir() {
        println!("skipped: {} is not there", folder.display());
        return;
    }
    let files = std::fs::read_dir(&folder).expect("a folder").map(|entry| entry.expect("an entry").path());
    let readable = |path: &PathBuf| path.extension().is_some_and(|ending| ending == "sdf");
    let files: Vec<PathBuf> = files.filter(readable).collect();
    assert!(files.len() >= 6, "{files:?}");
    files.iter().for_each(|path| assert_agrees(path));
}
