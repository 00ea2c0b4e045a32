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
