//! Roughness of disc and pin while they wear: height parameters of their cells (ISO 25178-2:2021, 4.2).

use super::extra::{Extra, Request};
use super::map::Map;
use super::quantity::Quantity;
use crate::model::mesh::Mesh;
use crate::surface::Body;

/// Roughness of both bodies with every sample, peaks positive on either: of the whole ring, since all of it passes under the pin,
/// and of the whole pin.
pub const EXTRA: Extra = Extra {
    name: "roughness",
    quantities: &[
        Quantity::extra("disc_sa", "m", "arithmetical mean height Sa of the disc"),
        Quantity::extra("disc_sq", "m", "root-mean-square height Sq of the disc"),
        Quantity::extra("disc_ssk", "1", "skewness Ssk of the disc heights"),
        Quantity::extra("disc_sku", "1", "kurtosis Sku of the disc heights"),
        Quantity::extra("pin_sa", "m", "arithmetical mean height Sa of the pin"),
        Quantity::extra("pin_sq", "m", "root-mean-square height Sq of the pin"),
        Quantity::extra("pin_ssk", "1", "skewness Ssk of the pin heights, peaks toward the disc"),
        Quantity::extra("pin_sku", "1", "kurtosis Sku of the pin heights"),
    ],
    request: Some(Request {
        what: "roughness",
        meaning: "whether Sa, Sq, Ssk and Sku of disc and pin are written with every sample",
        maps: &[Map::DiscHeight, Map::PinHeight],
        measure: |parameters, heights| {
            let of = |body: Body, heights| {
                let [sa, sq, ssk, sku] = height_parameters(&parameters.mesh, heights);
                [sa, sq, body.peak_sign() * ssk, sku]
            };
            [of(Body::Disc, &heights[0]), of(Body::Pin, &heights[1])].concat()
        },
    }),
    needs: "",
};

/// Sa, Sq, Ssk and Sku of heights of every cell of disc or pin, m, column by column, peaks positive: Sa = Σ A |z − z̄| / Σ A,
/// Sq = √(Σ A (z − z̄)² / Σ A), Ssk = Σ A (z − z̄)³ / Σ A / Sq³, Sku = Σ A (z − z̄)⁴ / Σ A / Sq⁴. Where all heights are equal the
/// last two are NaN.
///
/// A cell counts with its area, which differs from row to row, and heights are measured from the mean so weighted;
/// nothing else is taken out: that the track runs in as a groove is part of it. Cells beyond the pin's outline, whose height is
/// NaN, do not count. The sums are taken in the order of the mesh,
/// column by column: their bits do not depend on how a simulation is carried out.
fn height_parameters(mesh: &Mesh, heights: &[f64]) -> [f64; 4] {
    let columns = heights.len() / mesh.rows();
    let is_there = |height: &f64| !height.is_nan();
    let is_whole = mesh.is_rectangle() || heights.iter().all(is_there);
    let area = if is_whole { columns as f64 * mesh.column_area() } else { mesh.pin_area() };
    let mean_of = |terms: &dyn Fn(f64) -> [f64; 4]| {
        let mut sums = [0.0; 4];
        for column in heights.chunks_exact(mesh.rows()) {
            let mut own = [0.0; 4];
            for (height, area) in column.iter().zip(mesh.area()).filter(|(height, _)| is_there(height)) {
                own.iter_mut().zip(terms(*height)).for_each(|(sum, term)| *sum += area * term);
            }
            sums.iter_mut().zip(own).for_each(|(sum, own)| *sum += own);
        }
        sums.map(|sum| sum / area)
    };
    let [first, ..] = mean_of(&|height| [height, 0.0, 0.0, 0.0]);
    // What rounding left of the mean the first time; not added to it, which would round it again.
    let [rest, ..] = mean_of(&|height| [height - first, 0.0, 0.0, 0.0]);
    let [absolute, square, cube, fourth] = mean_of(&|height| {
        let z = (height - first) - rest;
        [z.abs(), z * z, z * z * z, z * z * z * z]
    });
    let root_mean_square_height = square.sqrt();
    let mut there = heights.iter().filter(|height| is_there(height));
    let flat = there.next().is_none_or(|first| there.all(|height| height == first));
    // What is no number though there are heights has become too large on the way.
    let relative = |moment: f64| match flat || square == 0.0 {
        true => f64::NAN,
        false if moment.is_nan() => f64::INFINITY,
        false => moment,
    };
    [
        absolute,
        root_mean_square_height,
        relative(cube / (square * root_mean_square_height)),
        relative(fourth / (square * square)),
    ]
}

/// √(Σ A (z − z̄_i)² / Σ A) of the disc's cells, m, heights being measured from the mean z̄_i of their own track (row).
pub(crate) fn root_mean_square_along_tracks(mesh: &Mesh, heights: &[f64]) -> f64 {
    let columns = heights.len() / mesh.rows();
    let sum_of_tracks = |add: &dyn Fn(usize, f64) -> f64| {
        let mut sums = vec![0.0; mesh.rows()];
        for column in heights.chunks_exact(mesh.rows()) {
            sums.iter_mut().zip(column).enumerate().for_each(|(row, (sum, height))| *sum += add(row, *height));
        }
        sums
    };
    let mean: Vec<f64> = sum_of_tracks(&|_, height| height).iter().map(|sum| sum / columns as f64).collect();
    let squares = sum_of_tracks(&|row, height| (height - mean[row]).powi(2));
    let weighted: f64 = squares.iter().zip(mesh.area()).map(|(square, area)| square * area).sum();
    (weighted / (columns as f64 * mesh.column_area())).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::outline::Outline;

    #[test]
    fn cells_count_with_their_areas() {
        // Two rows with areas as 3 : 5 (radii 1.5 and 2.5), heights 0 and 1: a Bernoulli distribution with p = 5/8, of
        // which mean absolute deviation 2pq, variance pq, skewness (q − p)/√(pq), kurtosis (1 − 3pq)/(pq).
        let mesh = Mesh::new(2, 6, 3, 1.0, 3.0).unwrap();
        let heights: Vec<f64> = (0..12).map(|cell| f64::from(cell % 2)).collect();
        let (p, q) = (0.625_f64, 0.375_f64);
        let expected = [2.0 * p * q, (p * q).sqrt(), (q - p) / (p * q).sqrt(), (1.0 - 3.0 * p * q) / (p * q)];
        for (found, expected) in height_parameters(&mesh, &heights).into_iter().zip(expected) {
            assert!((found / expected - 1.0).abs() < 1e-14, "{found}, {expected}");
        }
    }

    #[test]
    fn cells_beyond_the_outline_do_not_count() {
        // One row, so that all areas are equal, of which the middle two cells are there: heights 1 and 3.
        let mesh = Mesh::new(1, 1000, 4, 20.0, 20.2).unwrap();
        let mesh = mesh.with_outline(Outline::Disc { radius: 0.1 }).unwrap();
        let [sa, sq, ssk, sku] = height_parameters(&mesh, &[f64::NAN, 1.0, 3.0, f64::NAN]);
        assert_eq!(mesh.present_cells(), 2);
        assert!(
            [sa, sq, sku].iter().all(|one| (one - 1.0).abs() < 1e-12) && ssk.abs() < 1e-12,
            "{sa} {sq} {ssk} {sku}"
        );
        assert!(height_parameters(&mesh, &[f64::NAN, 2.0, 2.0, f64::NAN])[2].is_nan());
    }

    #[test]
    fn tracks_have_their_own_means() {
        // By hand: areas as 3 : 5; one track flat at 7, the other ± 2.
        let mesh = Mesh::new(2, 6, 3, 1.0, 3.0).unwrap();
        let heights: Vec<f64> = (0..6).flat_map(|column| [7.0, if column % 2 == 0 { 2.0 } else { -2.0 }]).collect();
        let expected = (5.0_f64 / 8.0 * 4.0).sqrt();
        assert!((root_mean_square_along_tracks(&mesh, &heights) / expected - 1.0).abs() < 1e-14);
    }

    #[test]
    fn a_large_offset_takes_no_digits_but_those_of_the_heights() {
        let mesh = Mesh::new(4, 10, 3, 1.0, 1.5).unwrap();
        let heights: Vec<f64> = (0..40).map(|cell| f64::from(cell * cell % 7)).collect();
        let shifted: Vec<f64> = heights.iter().map(|height| height + 1e6).collect();
        let ([_, near_sq, near_ssk, _], [_, far_sq, far_ssk, _]) =
            (height_parameters(&mesh, &heights), height_parameters(&mesh, &shifted));
        assert!((near_sq / far_sq - 1.0).abs() < 1e-14);
        assert!((near_ssk / far_ssk - 1.0).abs() < 1e-13);
    }

    #[test]
    fn a_flat_body_has_no_skewness() {
        let mesh = Mesh::new(3, 7, 3, 1.0, 1.5).unwrap();
        let [_, sq, ssk, sku] = height_parameters(&mesh, &[0.1; 21]);
        assert!(sq < 1e-16 && ssk.is_nan() && sku.is_nan());
    }
}
