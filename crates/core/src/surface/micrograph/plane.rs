//! Place of a picture on the pin, and how much of every cell it shows as fibre.

use super::picture::{MicrographError, Picture};
use crate::model::mesh::Mesh;

/// Points of a cell along either direction: at least this many, and at least [`PER_PIXEL`] for every pixel, up to
/// [`MOST_POINTS`].
const FEWEST_POINTS: usize = 8;
const PER_PIXEL: f64 = 2.0;
const MOST_POINTS: usize = 64;

/// Lengths that differ by less than this are the same length.
const SAME_LENGTH: f64 = 1e-9;

/// Plane of the picture: its middle on the pin's middle (mean radius, middle of the columns), its lines along the
/// sliding direction there, its top outward. The point at the radius r and the angle φ from the middle column has
/// x = r sin φ and y = r cos φ − mean radius.
#[derive(Debug, Clone, Copy)]
pub struct PinPlane<'a> {
    mesh: &'a Mesh,
}

impl<'a> PinPlane<'a> {
    /// The plane of this mesh's pin.
    pub fn new(mesh: &'a Mesh) -> Self {
        Self { mesh }
    }

    /// The pin cell at a point of the plane, m, if there is one.
    pub fn cell(&self, x: f64, y: f64) -> Option<usize> {
        let (mesh, y) = (self.mesh, y + self.mesh.mean_radius());
        let row = (libm::hypot(x, y) - self.inner_radius()) / mesh.row_height();
        let column = libm::atan2(x, y) / mesh.column_angle() + 0.5 * mesh.pin_columns() as f64;
        let inside = (0.0..mesh.rows() as f64).contains(&row) && (0.0..mesh.pin_columns() as f64).contains(&column);
        inside.then(|| column as usize * mesh.rows() + row as usize)
    }

    /// Half the extent of the smallest picture that covers the pin, m.
    pub fn half_extent(&self) -> (f64, f64) {
        let (mesh, inner) = (self.mesh, self.inner_radius());
        if mesh.is_rectangle() {
            return self.half_extent_of(inner, inner + mesh.rows() as f64 * mesh.row_height(), mesh.pin_columns());
        }
        let of_row = |row: usize| {
            let inner = inner + row as f64 * mesh.row_height();
            self.half_extent_of(inner, inner + mesh.row_height(), mesh.chord(row).len())
        };
        let rows = (0..mesh.rows()).filter(|row| !mesh.chord(*row).is_empty()).map(of_row);
        rows.fold((0.0, 0.0), |(across, up): (f64, f64), (own_across, own_up)| (across.max(own_across), up.max(own_up)))
    }

    /// Half the extent of so many columns between two radii, m.
    fn half_extent_of(&self, inner: f64, outer: f64, columns: usize) -> (f64, f64) {
        let mesh = self.mesh;
        let angle = 0.5 * columns as f64 * mesh.column_angle();
        let quarter = std::f64::consts::FRAC_PI_2;
        let across = if angle < quarter { outer * libm::sin(angle) } else { outer };
        // The lowest point is a corner of the innermost row, or of the outermost where the pin spans half the ring.
        let lowest = (inner * libm::cos(angle)).min(outer * libm::cos(angle));
        (across, (outer - mesh.mean_radius()).max(mesh.mean_radius() - lowest))
    }

    /// Tells whether a picture of this width and height, m, covers the pin.
    pub fn is_covered_by(&self, [width, height]: [f64; 2]) -> bool {
        let (across, up) = self.half_extent();
        0.5 * width >= across * (1.0 - SAME_LENGTH) && 0.5 * height >= up * (1.0 - SAME_LENGTH)
    }

    fn inner_radius(&self) -> f64 {
        self.mesh.mean_radius() - 0.5 * self.mesh.rows() as f64 * self.mesh.row_height()
    }
}

/// Fraction of every pin cell that is set, column by column: the mean over points that stand for equal shares of angle
/// and radius, weighted by the radius. Where a repeated picture ends, its mirror image begins.
pub(super) fn fractions(
    picture: &Picture<bool>,
    pixel: f64,
    repeats: bool,
    mesh: &Mesh,
) -> Result<Vec<f64>, MicrographError> {
    let plane = PinPlane::new(mesh);
    let [width, height] = picture.size(pixel);
    if !repeats && !plane.is_covered_by([width, height]) {
        let (across, up) = plane.half_extent();
        return Err(MicrographError::Small { width, height, pin: (2.0 * across, 2.0 * up) });
    }
    let place = |at: f64, count: usize| {
        // Casts saturate, so what rounding puts outside belongs to the outermost pixels.
        if repeats { mirrored(at, count) } else { (at as usize).min(count - 1) }
    };
    let points = |cell: f64| ((libm::ceil(PER_PIXEL * cell / pixel)) as usize).clamp(FEWEST_POINTS, MOST_POINTS);
    let per_column = points(mesh.column_width());
    let per_row = points(mesh.row_height());
    let radii: Vec<f64> = (0..mesh.rows() * per_row)
        .map(|point| plane.inner_radius() + (point as f64 + 0.5) / per_row as f64 * mesh.row_height())
        .collect();
    let directions: Vec<(f64, f64)> = (0..mesh.pin_columns() * per_column)
        .map(|point| {
            let column = (point as f64 + 0.5) / per_column as f64 - 0.5 * mesh.pin_columns() as f64;
            let angle = column * mesh.column_angle();
            (libm::sin(angle), libm::cos(angle))
        })
        .collect();
    let mut fractions = Vec::with_capacity(mesh.pin_cells());
    for column in directions.chunks_exact(per_column) {
        for row in radii.chunks_exact(per_row) {
            let (mut set, mut all) = (0.0, 0.0);
            for radius in row {
                let hits = column.iter().filter(|(sin, cos)| {
                    let (x, y) = (radius * sin, radius * cos - mesh.mean_radius());
                    let x = place((x + 0.5 * width) / pixel, picture.width);
                    let y = place((0.5 * height - y) / pixel, picture.height);
                    picture.pixels[y * picture.width + x]
                });
                set += radius * hits.count() as f64;
                all += radius * per_column as f64;
            }
            fractions.push(set / all);
        }
    }
    Ok(fractions)
}

/// The pixel at a place on a line of `count` pixels and its mirror images, in pixels from its beginning.
fn mirrored(at: f64, count: usize) -> usize {
    let period = 2.0 * count as f64;
    let place = libm::floor(at - period * libm::floor(at / period)) as usize;
    if place < count { place } else { (2 * count - 1).saturating_sub(place) }
}

#[cfg(test)]
mod tests {
    use super::mirrored;

    #[test]
    fn a_line_goes_on_as_its_mirror_image() {
        let places: Vec<usize> = (-7..10).map(|place| mirrored(f64::from(place) + 0.5, 3)).collect();
        assert_eq!(places, [0, 0, 1, 2, 2, 1, 0, 0, 1, 2, 2, 1, 0, 0, 1, 2, 2]);
        // What rounding makes of the end of a period.
        assert!(mirrored(6.0 - 1e-15, 3) == 0 && mirrored(-1e-300, 3) == 0);
    }
}
