//! Random fibres with the area fraction and the two-point correlation of a picture.
//!
//! Fibre is where a Gaussian field of unit variance is above a level t, at which it is so often as the picture shows fibre,
//! p = P(x > t) (Quiblier 1984, doi:10.1016/0021-9797(84)90481-8). Where the field has the autocorrelation r, fibre has the
//! covariance
//!
//! ```text
//! C(r) = P(x > t, y > t) − p² = 1/2π ∫ exp(−t²/(1 + sin θ)) dθ    from θ = 0 to arcsin r
//! ```
//!
//! because the probability changes with r as the bivariate normal density at (t, t) (Plackett 1954, doi:10.1093/biomet/41.3-4.351);
//! for p = ½ that is arcsin(r)/2π. The field is given the autocorrelation at which C(r)/C(1) is that of the picture, or the nearest
//! that a field has: the correlation of thin straight fibres falls faster from one cell to the next than that of any field.
//!
//! The autocorrelation of n points scatters at every lag with the standard error √(Σ ρ²/n) (Bartlett 1946). It is taken as far as it
//! is told from none: to the first distance at which its root mean square over all directions is below two of them.

use std::f64::consts::{FRAC_1_SQRT_2, FRAC_PI_2, PI, TAU};

use super::super::extend::{crossing, few_lengths, gaussian_power};
use super::super::fft::Complex;
use super::super::random::{Random, Stream};
use super::super::synthesis::planar::{self, Grid, Plane};
use super::super::{Body, Extension, Length};
use super::picture::{MicrographError, Picture};
use crate::model::mesh::Mesh;
use crate::model::state::Base;

/// Part of the picture's shorter side up to which its correlation is taken as it is found, at most; beyond, it falls to none over as
/// much again, by a cosine.
const KEPT: f64 = 0.25;
/// Standard errors below which a correlation is none.
const TOLD: f64 = 2.0;
/// Points in a cell along either direction; of finer pixels every n-th is taken.
const POINTS: f64 = 8.0;

/// Base of every pin cell, by a picture whose pixels are this far apart, m. What is done, and what the picture cannot tell, goes
/// into the report.
pub(super) fn base(
    picture: &Picture<bool>,
    pixel: f64,
    seed: u64,
    mesh: &Mesh,
    report: &mut Vec<String>,
) -> Result<Vec<Base>, MicrographError> {
    let fraction = picture.fraction();
    if fraction == 0.0 || fraction == 1.0 {
        report.push("extend: the picture is one of fibre or of resin alone, and so is the pin".to_owned());
        return Ok(vec![if fraction == 0.0 { Base::Resin } else { Base::Primary }; mesh.pin_cells()]);
    }
    let (size, cell) = (picture.size(pixel), [mesh.column_width(), mesh.row_height()]);
    let cells = [0, 1].map(|axis| (size[axis] / cell[axis] * (1.0 + 1e-9)) as usize);
    if cells.iter().any(|count| *count < Extension::FEWEST_CELLS) {
        return Err(MicrographError::FewCells { picture: size, cells });
    }
    let found = Autocorrelation::of(picture, pixel, cell)?;
    let grid = Grid::new(Body::Pin, mesh, [2.0 * found.reach; 2], 1);
    if grid.is_too_large() {
        return Err(MicrographError::LargeField { picture: size, field: [grid.padded_columns, grid.padded_rows] });
    }
    report.push(format!(
        "extend: random fibres with the fraction and the correlation of the picture of {} by {}, seed {seed}; fibre is related over \
         {}, shapes are not kept",
        Length(size[0]),
        Length(size[1]),
        Length(found.reach)
    ));
    report.extend(found.warnings(size));
    let correlation = found.on(&grid);
    let cut = Cut::of(fraction);
    let power = nearest(gaussian_power(correlation, |value| cut.inverse(value), &Plane::of(&grid)));
    let field = planar::field(&grid, power, None, &mut Random::new(seed, Stream::PinBaseExtension));
    let base = highest(&field, fraction, mesh);
    let of_picture = [found.at(cell[0], 0.0), found.at(0.0, cell[1])];
    let of_pin = [neighbours(&base, mesh, mesh.rows()), neighbours(&base, mesh, 1)];
    report.push(format!(
        "extend: cells side by side are correlated by {:.3} along and {:.3} across sliding, by {:.3} and {:.3} in the picture",
        of_pin[0], of_pin[1], of_picture[0], of_picture[1]
    ));
    Ok(base)
}

/// Correlation of cells of the pin with those that stand this many places behind them in their order.
fn neighbours(base: &[Base], mesh: &Mesh, step: usize) -> f64 {
    let rows = mesh.rows();
    let is_pair = |cell: &usize| {
        let other = cell + step;
        let in_line = step == rows || cell % rows + 1 < rows;
        other < base.len() && in_line && mesh.is_present(*cell) && mesh.is_present(other)
    };
    let value = |cell: usize| f64::from(u8::from(base[cell] == Base::Primary));
    let (mut count, mut set, mut both) = (0.0, 0.0, 0.0);
    for cell in (0..base.len()).filter(is_pair) {
        count += 1.0;
        set += 0.5 * (value(cell) + value(cell + step));
        both += value(cell) * value(cell + step);
    }
    let fraction = set / count;
    (both / count - fraction * fraction) / (fraction * (1.0 - fraction))
}

/// The power without negative values that has the same sum and is nearest, by the squares of the differences: all less by so much that
/// what is left above zero has the sum. Only cut off at zero, it would have more, and all correlations were less by that.
fn nearest(mut power: Vec<f64>) -> Vec<f64> {
    let sum: f64 = power.iter().sum();
    let (mut low, mut high) = (0.0, power.iter().copied().fold(0.0, f64::max));
    for _ in 0..60 {
        let less = 0.5 * (low + high);
        let left: f64 = power.iter().map(|power| (power - less).max(0.0)).sum();
        if left > sum { low = less } else { high = less }
    }
    power.iter_mut().for_each(|power| *power = (*power - high).max(0.0));
    power
}

/// Fibre where the field is highest, on so many cells that they have this fraction of the pin's area as nearly as they can.
fn highest(field: &[f64], fraction: f64, mesh: &Mesh) -> Vec<Base> {
    let areas: Vec<f64> = mesh.pin_areas().collect();
    let mut order: Vec<usize> = (0..field.len()).filter(|cell| mesh.is_present(*cell)).collect();
    order.sort_unstable_by(|one, other| field[*other].total_cmp(&field[*one]).then(one.cmp(other)));
    let wanted = fraction * mesh.pin_area();
    let mut base = vec![Base::Resin; field.len()];
    let mut covered = 0.0;
    for cell in order {
        if covered + 0.5 * areas[cell] > wanted {
            break;
        }
        covered += areas[cell];
        base[cell] = Base::Primary;
    }
    base
}

/// The autocorrelation of a picture: the mean over all pairs of points at a distance, 1 at none.
struct Autocorrelation {
    /// Points along x and y.
    points: [usize; 2],
    /// Distance of the points, m.
    pitch: [f64; 2],
    /// Lags of the transform along x and y, of which the second half are negative.
    lags: [usize; 2],
    /// Values column by column, with y downward as in the picture.
    values: Vec<f64>,
    /// Distance up to which values are told from none, m.
    reach: f64,
}

impl Autocorrelation {
    /// Autocorrelation of a picture whose pixels are this far apart, m, as finely as these cells, m, need it.
    fn of(picture: &Picture<bool>, pixel: f64, cell: [f64; 2]) -> Result<Self, MicrographError> {
        let every = cell.map(|cell| ((cell / (POINTS * pixel)) as usize).max(1));
        let points = [picture.width.div_ceil(every[0]), picture.height.div_ceil(every[1])];
        // Some lags more than are used, for the interpolation.
        let reach = points.map(|count| (2.0 * KEPT * count as f64) as usize + 3);
        let lags = [0, 1].map(|axis| (points[axis] + reach[axis]).next_power_of_two());
        if lags[0].checked_mul(lags[1]).is_none_or(|count| count > Grid::MOST_CELLS) {
            return Err(MicrographError::LargeField { picture: picture.size(pixel), field: lags });
        }
        let is_fibre = |x: usize, y: usize| picture.pixels[y * every[1] * picture.width + x * every[0]];
        let places = || (0..points[0]).flat_map(|x| (0..points[1]).map(move |y| (x, y)));
        let mean = places().filter(|(x, y)| is_fibre(*x, *y)).count() as f64 / (points[0] * points[1]) as f64;
        let mut values = vec![Complex::default(); lags[0] * lags[1]];
        for (x, y) in places() {
            values[x * lags[1] + y].re = f64::from(u8::from(is_fibre(x, y))) - mean;
        }
        let plane = Plane::new(lags[0], lags[1]);
        plane.forward(&mut values);
        values.iter_mut().for_each(|value| *value = Complex { re: value.norm_sqr(), im: 0.0 });
        // The transform of what is symmetric is that back.
        plane.forward(&mut values);
        let pairs = |lag: usize, axis: usize| points[axis].saturating_sub(lag.min(lags[axis] - lag)).max(1) as f64;
        let at = |index: usize| values[index].re / (pairs(index / lags[1], 0) * pairs(index % lags[1], 1));
        let variance = at(0);
        let values = (0..values.len()).map(|index| at(index) / variance).collect();
        let mut found = Self { points, pitch: every.map(|every| every as f64 * pixel), lags, values, reach: 0.0 };
        found.reach = found.told(cell[0].max(cell[1]));
        Ok(found)
    }

    /// The distance up to which values are told from none, in steps of this length, m.
    fn told(&self, step: f64) -> f64 {
        let sides = [0, 1].map(|axis| self.points[axis] as f64 * self.pitch[axis]);
        let farthest = KEPT * sides[0].min(sides[1]);
        let most = self.pitch.map(|pitch| (farthest / pitch) as isize);
        let mut shells = vec![(0.0, 0.0); (farthest / step) as usize + 1];
        for x in -most[0]..=most[0] {
            for y in -most[1]..=most[1] {
                let distance = libm::hypot(x as f64 * self.pitch[0], y as f64 * self.pitch[1]);
                let Some((squares, count)) = shells.get_mut((distance / step).round() as usize) else { continue };
                let [column, row] = [x.rem_euclid(self.lags[0] as isize), y.rem_euclid(self.lags[1] as isize)];
                let value = self.values[column as usize * self.lags[1] + row as usize];
                *squares += value * value;
                *count += 1.0;
            }
        }
        let points = (self.points[0] * self.points[1]) as f64;
        let mut sum = 0.0;
        let last = shells.iter().position(|(squares, count)| {
            sum += squares;
            squares / count <= TOLD * TOLD * sum / points
        });
        last.map_or(farthest, |shell| shell as f64 * step).min(farthest).max(step)
    }

    /// The value at a distance along x and y, y outward, m: linear between the lags; 0 beyond the reach.
    fn at(&self, x: f64, y: f64) -> f64 {
        let place = [x / self.pitch[0], -y / self.pitch[1]];
        let window = match libm::hypot(x, y) / self.reach {
            ..=1.0 => 1.0,
            beyond @ ..2.0 => 0.5 * (1.0 + libm::cos(PI * (beyond - 1.0))),
            _ => return 0.0,
        };
        let below = place.map(libm::floor);
        let [u, v] = [0, 1].map(|axis| place[axis] - below[axis]);
        let lag = |axis: usize, more: f64| (below[axis] + more).rem_euclid(self.lags[axis] as f64) as usize;
        let value = |more: [f64; 2]| self.values[lag(0, more[0]) * self.lags[1] + lag(1, more[1])];
        let along = |more: f64| (1.0 - u) * value([0.0, more]) + u * value([1.0, more]);
        window * ((1.0 - v) * along(0.0) + v * along(1.0))
    }

    /// The values at every lag of a periodic grid, column by column.
    fn on(&self, grid: &Grid) -> Vec<f64> {
        let [columns, rows] = [grid.padded_columns, grid.padded_rows];
        let nearest = |lag: usize, count: usize| if 2 * lag > count { lag as f64 - count as f64 } else { lag as f64 };
        let place = |index: usize| {
            let (column, row) = (nearest(index / rows, columns), nearest(index % rows, rows));
            (column * grid.column_width, row * grid.row_height)
        };
        (0..columns * rows).map(place).map(|(x, y)| self.at(x, y)).collect()
    }

    /// Warnings of what the picture is too small to tell.
    fn warnings(&self, size: [f64; 2]) -> Vec<String> {
        let kept = [0, 1].map(|axis| (KEPT * self.points[axis] as f64) as usize + 1);
        let lengths = [
            crossing((0..kept[0]).map(|lag| self.values[lag * self.lags[1]])).map(|lag| lag * self.pitch[0]),
            crossing((0..kept[1]).map(|lag| self.values[lag])).map(|lag| lag * self.pitch[1]),
        ];
        few_lengths(lengths, size, ["fibre is", "a quarter", "picture"])
            .map(|few| format!("{few}: its fraction and correlation are those of few fibres"))
            .collect()
    }
}

/// Panels of the quadrature over θ from −π/2 to π/2.
const PANELS: usize = 256;
/// Nodes and weights of Gauss and Legendre with five points between −1 and 1.
const NODES: [(f64, f64); 5] = [
    (0.0, 0.568_888_888_888_888_9),
    (-0.538_469_310_105_683_1, 0.478_628_670_499_366_5),
    (0.538_469_310_105_683_1, 0.478_628_670_499_366_5),
    (-0.906_179_845_938_664, 0.236_926_885_056_189_1),
    (0.906_179_845_938_664, 0.236_926_885_056_189_1),
];

/// Change of the autocorrelation of a Gaussian field when it is cut at a level.
struct Cut {
    /// t².
    square: f64,
    /// C at the ends of the panels, from r = −1 to 1.
    covariances: Vec<f64>,
}

impl Cut {
    /// Cut at the level above which the field is with this probability, between 0 and 1.
    fn of(fraction: f64) -> Self {
        let (mut low, mut high) = (-40.0, 40.0);
        for _ in 0..100 {
            let level = 0.5 * (low + high);
            if 0.5 * libm::erfc(level * FRAC_1_SQRT_2) > fraction { low = level } else { high = level }
        }
        let mut cut = Self { square: low * low, covariances: vec![0.0] };
        for panel in 0..PANELS {
            let sum = cut.covariances[panel] + cut.integral(angle(panel), angle(panel + 1));
            cut.covariances.push(sum);
        }
        let none = cut.covariances[PANELS / 2];
        cut.covariances.iter_mut().for_each(|value| *value -= none);
        cut
    }

    /// The covariance of the cut field per angle θ.
    fn density(&self, angle: f64) -> f64 {
        libm::exp(-self.square / (1.0 + libm::sin(angle))) / TAU
    }

    fn integral(&self, from: f64, to: f64) -> f64 {
        let (centre, half) = (0.5 * (from + to), 0.5 * (to - from));
        NODES.iter().map(|(node, weight)| weight * half * self.density(centre + half * node)).sum()
    }

    /// The autocorrelation of the Gaussian field at which the cut one has this autocorrelation, −1 where none has.
    fn inverse(&self, autocorrelation: f64) -> f64 {
        let wanted = autocorrelation * self.covariances[PANELS];
        let panel = self.covariances.partition_point(|value| *value <= wanted).clamp(1, PANELS) - 1;
        let [begin, end] = [angle(panel), angle(panel + 1)];
        let (mut low, mut high) = (begin, end);
        let mut at = 0.5 * (low + high);
        // Newton's method, kept between bounds that close in.
        for _ in 0..60 {
            let off = self.covariances[panel] + self.integral(begin, at) - wanted;
            if off < 0.0 {
                low = at
            } else {
                high = at
            }
            let newton = at - off / self.density(at);
            let next = if newton >= low && newton <= high { newton } else { 0.5 * (low + high) };
            if (next - at).abs() <= f64::EPSILON {
                break;
            }
            at = next;
        }
        libm::sin(at)
    }
}

/// Angle θ at which a panel begins, rad.
fn angle(panel: usize) -> f64 {
    FRAC_PI_2 * (2.0 * panel as f64 / PANELS as f64 - 1.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// P(x > t, y > t) for standard normal x and y of correlation r, by the mean of P(y > t | x) over x > t: Simpson's rule.
    fn joint(level: f64, r: f64) -> f64 {
        let tail = |t: f64| 0.5 * libm::erfc(t * FRAC_1_SQRT_2);
        let given = |x: f64| (-0.5 * x * x).exp() / TAU.sqrt() * tail((level - r * x) / (1.0 - r * r).sqrt());
        let (count, step) = (20_000, 12.0 / 20_000.0);
        let weight = |at: usize| if at == 0 || at == count { 1.0 } else { 2.0 + 2.0 * (at % 2) as f64 };
        (0..=count).map(|at| weight(at) * given(level + step * at as f64)).sum::<f64>() * step / 3.0
    }

    #[test]
    fn the_field_has_the_autocorrelation_that_the_cut_turns_into_that_of_the_picture() {
        for level in [-1.3, 0.0, 0.4, 1.0, 2.5] {
            let fraction = 0.5 * libm::erfc(level * FRAC_1_SQRT_2);
            let cut = Cut::of(fraction);
            for r in [-0.6, -0.2, 0.1, 0.5, 0.9, 0.99] {
                let of_fibre = (joint(level, r) - fraction * fraction) / (fraction * (1.0 - fraction));
                let found = cut.inverse(of_fibre);
                // Of negative correlations at high levels little is left: the integral has some fourteen digits.
                let slope = cut.density(libm::asin(r)) / (fraction * (1.0 - fraction));
                assert!((found - r).abs() < 1e-11 / slope.min(1.0), "{level}, {r}: {found}");
            }
            assert!((cut.covariances[PANELS] - fraction * (1.0 - fraction)).abs() < 1e-14);
            assert_eq!(cut.inverse(1.0), 1.0);
            assert!(cut.inverse(-1.0) < -0.99, "no field has it");
        }
    }

    #[test]
    fn the_nearest_power_has_the_same_sum() {
        // 5 − 2, 4 − 2 and nothing of the others: 3 + 2 = 5 + 4 + 1 − 2 − 3.
        let found = nearest(vec![5.0, -2.0, 1.0, 4.0, -3.0]);
        for (found, expected) in found.iter().zip([3.0, 0.0, 0.0, 2.0, 0.0]) {
            assert!((found - expected).abs() < 1e-12, "{found}, expected {expected}");
        }
        assert!(
            nearest(vec![1.0, 0.0, 2.0]).iter().zip([1.0, 0.0, 2.0]).all(|(one, other)| (one - other).abs() < 1e-12)
        );
    }

    #[test]
    fn half_of_a_field_has_the_law_of_the_arcsine() {
        let cut = Cut::of(0.5);
        for r in [-0.99f64, -0.5, 0.0, 0.3, 0.8, 1.0 - 1e-9] {
            let found = cut.inverse(2.0 / PI * r.asin());
            assert!((found - r).abs() < 1e-14, "{r}: {found}");
        }
    }
}
