//! A picture in the plane of the pin, and the pin's cells in it.

use super::{MicrographError, Picture};
use crate::model::mesh::Mesh;

/// Points of a cell along either direction: at least this many, and at least [`PER_PIXEL`] for every pixel, up to
/// [`MOST_POINTS`].
const FEWEST_POINTS: usize = 8;
const PER_PIXEL: f64 = 2.0;
const MOST_POINTS: usize = 64;

/// Lengths that differ by less than this are the same length.
const SAME_LENGTH: f64 = 1e-9;

/// Where the picture lies: its middle on the pin's middle (mean radius, middle of the columns), its lines along the
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

    /// The same of so many columns between two radii, m.
    fn half_extent_of(&self, inner: f64, outer: f64, columns: usize) -> (f64, f64) {
        let mesh = self.mesh;
        let angle = 0.5 * columns as f64 * mesh.column_angle();
        let quarter = std::f64::consts::FRAC_PI_2;
        let across = if angle < quarter { outer * libm::sin(angle) } else { outer };
        // The lowest point is a corner of the innermost row, or of the outermost where the pin spans half the ring.
        let lowest = (inner * libm::cos(angle)).min(outer * libm::cos(angle));
        (across, (outer - mesh.mean_radius()).max(mesh.mean_radius() - lowest))
    }

    fn inner_radius(&self) -> f64 {
        self.mesh.mean_radius() - 0.5 * self.mesh.rows() as f64 * self.mesh.row_height()
    }
}

/// Fraction of every pin cell that is set, column by column: the mean over points that stand for equal shares of angle
/// and radius, weighted by the radius.
pub(super) fn fractions(picture: &Picture<bool>, pixel: f64, mesh: &Mesh) -> Result<Vec<f64>, MicrographError> {
    let plane = PinPlane::new(mesh);
    let (across, up) = plane.half_extent();
    let (width, height) = (picture.width as f64 * pixel, picture.height as f64 * pixel);
    if 0.5 * width < across * (1.0 - SAME_LENGTH) || 0.5 * height < up * (1.0 - SAME_LENGTH) {
        let needed = (2.0 * across / picture.width as f64).max(2.0 * up / picture.height as f64);
        return Err(MicrographError::Small { width, height, pin: (2.0 * across, 2.0 * up), pixel: needed });
    }
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
                    // Casts saturate, so what rounding puts outside belongs to the outermost pixels.
                    let x = ((x + 0.5 * width) / pixel) as usize;
                    let y = ((0.5 * height - y) / pixel) as usize;
                    picture.pixels[y.min(picture.height - 1) * picture.width + x.min(picture.width - 1)]
                });
                set += radius * hits.count() as f64;
                all += radius * per_column as f64;
            }
            fractions.push(set / all);
        }
    }
    Ok(fractions)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Cells of 50 µm, a pin of 4 mm by 8 mm at 22 mm: the paper's.
    fn mesh() -> Mesh {
        Mesh::new(80, 2764, 161, 20e-3, 24e-3).unwrap()
    }

    fn picture(width: usize, height: usize, pixel: f64, set: impl Fn(f64, f64) -> bool) -> Picture<bool> {
        let place = |at: usize, count: usize| (at as f64 + 0.5 - 0.5 * count as f64) * pixel;
        let pixels = (0..height)
            .flat_map(|y| (0..width).map(move |x| (x, y)))
            .map(|(x, y)| set(place(x, width), -place(y, height)))
            .collect();
        Picture { width, height, pixels }
    }

    /// Area-weighted fraction of the pin.
    fn fraction(cells: &[f64], mesh: &Mesh) -> f64 {
        cells.iter().zip(mesh.area().iter().cycle()).map(|(f, a)| f * a).sum::<f64>() / mesh.pin_area()
    }

    #[test]
    fn a_cell_is_found_where_its_centre_lies() {
        let mesh = mesh();
        let plane = PinPlane::new(&mesh);
        for column in [0, 1, 80, 159, 160] {
            for row in [0, 1, 40, 79] {
                let angle = (column as f64 + 0.5 - 80.5) * mesh.column_angle();
                let radius = mesh.radius()[row];
                let found = plane.cell(radius * angle.sin(), radius * angle.cos() - mesh.mean_radius());
                assert_eq!(found, Some(column * 80 + row));
            }
        }
        for (x, y) in [(0.0, 2.001e-3), (0.0, -2.001e-3), (4.1e-3, 0.0), (-4.1e-3, 0.0)] {
            assert_eq!(plane.cell(x, y), None);
        }
    }

    #[test]
    fn a_disc_in_the_picture_keeps_its_area_and_place() {
        // Area π R². Pixels of 10 µm misplace the edge by at most half a diagonal over the circumference, with random
        // sign, so that far less than one in a hundred of that band remains; one in fifty is asked for.
        let mesh = mesh();
        let (centre, radius) = ((1.5e-3, -0.6e-3), 0.8e-3);
        let inside = |x: f64, y: f64| (x - centre.0).hypot(y - centre.1) < radius;
        let cells = fractions(&picture(1000, 600, 10e-6, inside), 10e-6, &mesh).unwrap();
        let area = fraction(&cells, &mesh) * mesh.pin_area();
        let expected = std::f64::consts::PI * radius * radius;
        let band = std::f64::consts::TAU * radius * 7.1e-6;
        assert!((area - expected).abs() < 0.02 * band, "{area} {expected}");
        // Its centre of area, from the cells, by the mapping in the other direction.
        let mut moment = (0.0, 0.0);
        for (cell, fraction) in cells.iter().enumerate() {
            let angle = ((cell / 80) as f64 + 0.5 - 80.5) * mesh.column_angle();
            let (r, share) = (mesh.radius()[cell % 80], fraction * mesh.area()[cell % 80] / area);
            moment.0 += share * r * angle.sin();
            moment.1 += share * (r * angle.cos() - mesh.mean_radius());
        }
        assert!((moment.0 - centre.0).hypot(moment.1 - centre.1) < 1e-6, "{moment:?}");
    }

    #[test]
    fn cells_take_the_mean_of_their_area() {
        // Lines of 8 pixels on, 8 off along x: cells at the middle, where x is the arc, are 5 pixels wide.
        let mesh = mesh();
        let stripes = |x: f64, _: f64| (x / 80e-6).rem_euclid(2.0) < 1.0;
        let cells = fractions(&picture(1000, 600, 10e-6, stripes), 10e-6, &mesh).unwrap();
        assert!((fraction(&cells, &mesh) - 0.5).abs() < 0.005);
        assert!(cells.contains(&0.0) && cells.contains(&1.0));
        assert!(cells.iter().any(|f| *f > 0.3 && *f < 0.7));
    }

    #[test]
    fn a_round_pin_needs_a_picture_of_its_own_size() {
        // Arcs about the axis are not straight, so that the circle is a little bent: by R²/(2 r̄) = 91 µm of 2 mm at most.
        let mesh = mesh().with_outline(crate::model::outline::Outline::Disc { radius: 2e-3 }).unwrap();
        let (across, up) = PinPlane::new(&mesh).half_extent();
        assert!((across - 2e-3).abs() < 91e-6 + 50e-6 && (up - 2e-3).abs() < 91e-6 + 50e-6, "{across} {up}");
    }

    #[test]
    fn a_picture_that_does_not_cover_the_pin_is_refused() {
        let mesh = mesh();
        let (across, up) = PinPlane::new(&mesh).half_extent();
        // The outer corners lie at 24 mm · sin(80.5 · 2π/2764), the lowest points at 20 mm · cos.
        let angle = 80.5 * std::f64::consts::TAU / 2764.0;
        assert!((across - 24e-3 * angle.sin()).abs() < 1e-15 && (up - (22e-3 - 20e-3 * angle.cos())).abs() < 1e-15);
        let all = picture(1000, 400, 10e-6, |_, _| true);
        let Err(MicrographError::Small { pixel, .. }) = fractions(&all, 10e-6, &mesh) else { panic!() };
        assert!(fractions(&all, pixel * 0.999, &mesh).is_err());
        assert!(fractions(&all, pixel * 1.001, &mesh).unwrap().iter().all(|fraction| *fraction == 1.0));
    }
}
