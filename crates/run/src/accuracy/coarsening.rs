//! A scene's surfaces on a coarser mesh.

use std::f64::consts::TAU;

use plateau_core::model::mesh::{Mesh, MeshError};
use plateau_core::model::outline::{Outline, columns_of_disc};
use plateau_core::model::state::{Base, InitialSurfaces};

/// Fewest columns of the pin on a coarse mesh.
const FEWEST_COLUMNS: usize = 4;

/// How the cells of a coarse mesh are made of those of a fine one.
#[derive(Debug, Clone)]
pub struct Coarsening {
    /// The coarse mesh.
    pub mesh: Mesh,
    fine_rows: usize,
    rows: Overlap,
    disc_columns: Overlap,
    pin_columns: Overlap,
    /// Base of every coarse cell of the pin.
    base: Vec<Base>,
    /// Of the fine cells; none beyond the pin's outline.
    fine_base: Vec<Option<Base>>,
}

impl Coarsening {
    /// A mesh with about one cell where `fine` has `factor` by `factor`; none where that leaves too few cells.
    ///
    /// The pin has a whole number of columns, and so many are given to the ring that the pin stays as wide as it was, as
    /// nearly as whole numbers allow; its outline is the same circle, if it is one. Fibre and resin: see [`coarse_base`].
    ///
    /// # Errors
    /// [`MeshError`] when the coarse mesh is none.
    pub fn new(fine: &Mesh, fine_base: &[Base], factor: usize) -> Result<Option<Self>, MeshError> {
        let coarse = |count: usize, factor: f64| ((count as f64 / factor).round() as usize).max(1);
        let pin_columns = coarse(fine.pin_columns(), factor as f64);
        let rows = coarse(fine.rows(), factor as f64);
        if pin_columns < FEWEST_COLUMNS || (fine.rows() > 1 && rows < 2) {
            return Ok(None);
        }
        let wider = fine.pin_columns() as f64 / pin_columns as f64;
        let disc_columns = coarse(fine.disc_columns(), wider).max(pin_columns);
        let pin_columns = match fine.outline() {
            Outline::Rectangle => pin_columns,
            Outline::Disc { radius } => {
                let angle = TAU / disc_columns as f64;
                let columns = columns_of_disc(radius, fine.mean_radius(), angle).unwrap_or(pin_columns as f64);
                (columns as usize).min(disc_columns)
            }
        };
        let half = 0.5 * fine.rows() as f64 * fine.row_height();
        let radii = [fine.mean_radius() - half, fine.mean_radius() + half];
        let mesh = Mesh::new(rows, disc_columns, pin_columns, radii[0], radii[1])?.with_outline(fine.outline())?;
        let fine_base: Vec<Option<Base>> =
            fine_base.iter().enumerate().map(|(cell, base)| fine.is_present(cell).then_some(*base)).collect();
        let mut coarsening = Self {
            fine_rows: fine.rows(),
            rows: Overlap::of_rings(radii, fine.rows(), rows),
            disc_columns: Overlap::of_lengths(fine.disc_columns(), disc_columns),
            pin_columns: Overlap::of_lengths(fine.pin_columns(), pin_columns),
            base: Vec::new(),
            fine_base,
            mesh,
        };
        let part_of = |is_counted: fn(Option<Base>) -> bool| {
            let part = |cell: usize| f64::from(u8::from(is_counted(coarsening.fine_base[cell])));
            coarsening.integrals(&coarsening.pin_columns, part)
        };
        let fibre = part_of(|base| base == Some(Base::Primary));
        coarsening.base = coarse_base(&fibre, &part_of(|base| base.is_some()));
        Ok(Some(coarsening))
    }

    /// The surfaces on the coarse mesh.
    pub fn surfaces(&self, fine: &InitialSurfaces) -> InitialSurfaces {
        InitialSurfaces {
            disc_height: self.disc(&fine.disc_height),
            pin_height: self.pin(&fine.pin_height),
            pin_base: self.base.clone(),
        }
    }

    /// Heights of the disc: the mean of every coarse cell.
    pub fn disc(&self, heights: &[f64]) -> Vec<f64> {
        let sums = self.integrals(&self.disc_columns, |cell| heights[cell]);
        let whole = self.integrals(&self.disc_columns, |_| 1.0);
        sums.into_iter().zip(whole).map(|(sum, whole)| sum / whole).collect()
    }

    /// Heights of the pin: the mean over the part of a coarse cell that has the cell's base, for resin lies deeper than
    /// fibres, and a mean over both would be the height of neither. Cells that are beyond the outline of one of both pins do
    /// not count; one without any other has the mean height of its base.
    pub fn pin(&self, heights: &[f64]) -> Vec<f64> {
        let of = |base: Base| {
            let is_it = |cell: usize| self.fine_base[cell] == Some(base);
            let sums = self.integrals(&self.pin_columns, |cell| if is_it(cell) { heights[cell] } else { 0.0 });
            (sums, self.integrals(&self.pin_columns, |cell| f64::from(u8::from(is_it(cell)))))
        };
        let (fibre, resin) = (of(Base::Primary), of(Base::Resin));
        let height = |(cell, base): (usize, &Base)| {
            let (sums, parts) = if base.is_resin() { &resin } else { &fibre };
            match parts[cell] {
                part if part > 0.0 => sums[cell] / part,
                _ if fibre.1[cell] + resin.1[cell] > 0.0 => {
                    (fibre.0[cell] + resin.0[cell]) / (fibre.1[cell] + resin.1[cell])
                }
                _ if self.mesh.is_present(cell) => sums.iter().sum::<f64>() / parts.iter().sum::<f64>(),
                _ => 0.0,
            }
        };
        self.base.iter().enumerate().map(height).collect()
    }

    /// Σ value · measure over the fine cells in every coarse one, column by column.
    fn integrals(&self, columns: &Overlap, value: impl Fn(usize) -> f64) -> Vec<f64> {
        let mut integrals = Vec::with_capacity(self.mesh.rows() * self.mesh.disc_columns());
        let mut profile = vec![0.0; self.fine_rows];
        for column in columns.cells() {
            profile.fill(0.0);
            for (fine, share) in column {
                let first = fine * self.fine_rows;
                profile.iter_mut().enumerate().for_each(|(row, sum)| *sum += share * value(first + row));
            }
            let cells =
                self.rows.cells().map(|row| row.iter().map(|(fine, measure)| measure * profile[*fine]).sum::<f64>());
            integrals.extend(cells);
        }
        integrals
    }
}

/// Base of coarse cells from the area of fibre in each and its whole area: those with the largest part of fibre are fibre,
/// as many as keep the area of all fibres. By majority thin fibres would vanish.
fn coarse_base(fibre: &[f64], whole: &[f64]) -> Vec<Base> {
    const GOLDEN: f64 = 0.618_033_988_749_894_9;
    // Of cells with equal parts some are taken, spread evenly over the pin.
    let spread = |cell: usize| (cell as f64 * GOLDEN).fract();
    let mut cells: Vec<usize> = (0..fibre.len()).collect();
    let part = |cell: usize| if whole[cell] > 0.0 { fibre[cell] / whole[cell] } else { 0.0 };
    // Parts that differ by rounding only are equal.
    let rank = |cell: usize| ((1.0 - part(cell)) * 1e9).round() + spread(cell);
    cells.sort_by(|one, other| rank(*one).total_cmp(&rank(*other)));
    let mut left: f64 = fibre.iter().sum();
    let mut base = vec![Base::Resin; fibre.len()];
    for cell in cells.into_iter().filter(|cell| fibre[*cell] > 0.0) {
        if left < 0.5 * whole[cell] {
            break;
        }
        base[cell] = Base::Primary;
        left -= whole[cell];
    }
    base
}

/// For every coarse cell the fine cells that it overlaps, each with the measure of what they share.
#[derive(Debug, Clone, PartialEq)]
pub struct Overlap(Vec<Vec<(usize, f64)>>);

impl Overlap {
    /// Overlap of equal divisions of one interval; lengths count.
    pub fn of_lengths(fine: usize, coarse: usize) -> Self {
        Self::new(&division([0.0, 1.0], fine), &division([0.0, 1.0], coarse), |low, high| high - low)
    }

    /// Overlap of equal divisions of a range of radii; areas count, as between circles of these radii.
    pub fn of_rings(radii: [f64; 2], fine: usize, coarse: usize) -> Self {
        Self::new(&division(radii, fine), &division(radii, coarse), |low, high| 0.5 * (high - low) * (high + low))
    }

    fn new(fine: &[f64], coarse: &[f64], measure: impl Fn(f64, f64) -> f64) -> Self {
        let shared = |cell: &[f64]| {
            let first = fine.partition_point(|edge| *edge <= cell[0]).saturating_sub(1);
            let pieces = fine.windows(2).enumerate().skip(first).take_while(|(_, piece)| piece[0] < cell[1]);
            let shares = pieces.map(|(index, piece)| (index, piece[0].max(cell[0]), piece[1].min(cell[1])));
            shares.filter(|(_, low, high)| low < high).map(|(index, low, high)| (index, measure(low, high))).collect()
        };
        Self(coarse.windows(2).map(shared).collect())
    }

    /// The coarse cells, one after the other.
    pub fn cells(&self) -> impl Iterator<Item = &[(usize, f64)]> {
        self.0.iter().map(Vec::as_slice)
    }
}

/// Ends of the cells of an interval that is divided into equal ones.
fn division([begin, end]: [f64; 2], cells: usize) -> Vec<f64> {
    (0..=cells).map(|edge| begin + (end - begin) * (edge as f64 / cells as f64)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Six rows, 48 columns, 13 under the pin: neither is a multiple of the coarse mesh's.
    fn fine() -> (Mesh, InitialSurfaces) {
        let mesh = Mesh::new(6, 48, 13, 20e-3, 24e-3).unwrap();
        let height = |cell: usize| (cell * 7919 % 101) as f64 * 1e-8;
        // Every third column is fibre.
        let base = |cell: usize| if (cell / 6).is_multiple_of(3) { Base::Primary } else { Base::Resin };
        let surfaces = InitialSurfaces {
            disc_height: (0..6 * 48).map(height).collect(),
            pin_height: (0..6 * 13).map(|cell| if base(cell).is_resin() { 8e-6 } else { -1e-6 }).collect(),
            pin_base: (0..6 * 13).map(base).collect(),
        };
        (mesh, surfaces)
    }

    fn volume(mesh: &Mesh, heights: &[f64]) -> f64 {
        heights.chunks(mesh.rows()).flat_map(|column| column.iter().zip(mesh.area())).map(|(z, area)| z * area).sum()
    }

    #[test]
    fn the_mean_of_the_disc_is_kept() {
        let (mesh, surfaces) = fine();
        let coarsening = Coarsening::new(&mesh, &surfaces.pin_base, 2).unwrap().unwrap();
        let coarse = coarsening.surfaces(&surfaces);
        assert!(coarse.fits(&coarsening.mesh));
        let (before, after) = (volume(&mesh, &surfaces.disc_height), volume(&coarsening.mesh, &coarse.disc_height));
        assert!((after / before - 1.0).abs() < 1e-12, "{after} and {before}");
    }

    #[test]
    fn the_pin_stays_as_wide_as_whole_columns_allow() {
        let mesh = Mesh::new(80, 2764, 161, 20e-3, 24e-3).unwrap();
        let base = vec![Base::Primary; 80 * 161];
        for (factor, expected) in [(2, [40, 1391, 81]), (4, [20, 687, 40]), (8, [10, 343, 20])] {
            let coarse = Coarsening::new(&mesh, &base, factor).unwrap().unwrap().mesh;
            assert_eq!([coarse.rows(), coarse.disc_columns(), coarse.pin_columns()], expected);
            // By half a column of the ring at most: 161/2764 · 1/(2 · 343) of the ring.
            assert!((coarse.pin_area() / mesh.pin_area() - 1.0).abs() < 0.5 / 343.0);
        }
        assert!(Coarsening::new(&mesh, &base, 64).unwrap().is_none());
    }

    #[test]
    fn heights_of_fibres_and_resin_are_not_mixed_and_fibres_keep_their_area() {
        let (mesh, surfaces) = fine();
        let coarsening = Coarsening::new(&mesh, &surfaces.pin_base, 2).unwrap().unwrap();
        let coarse = coarsening.surfaces(&surfaces);
        for (height, base) in coarse.pin_height.iter().zip(&coarse.pin_base) {
            let expected = if base.is_resin() { 8e-6 } else { -1e-6 };
            assert!((height - expected).abs() < 1e-18, "{height} of {base:?}");
        }
        let fibre_area = |mesh: &Mesh, base: &[Base]| {
            volume(mesh, &base.iter().map(|base| f64::from(u8::from(!base.is_resin()))).collect::<Vec<_>>())
        };
        let (before, after) = (fibre_area(&mesh, &surfaces.pin_base), fibre_area(&coarsening.mesh, &coarse.pin_base));
        // Half a cell more or less; the coarse pin itself is a little wider or narrower.
        let wider = coarsening.mesh.pin_area() / mesh.pin_area();
        assert!((after - before * wider).abs() < 0.51 * coarsening.mesh.area()[2], "{after} and {before}");
    }

    #[test]
    fn a_round_pin_stays_round_and_keeps_its_heights() {
        let mesh = Mesh::new(60, 1400, 64, 20e-3, 24e-3).unwrap();
        let mesh = mesh.with_outline(Outline::Disc { radius: 2e-3 }).unwrap();
        // What is beyond the outline must not be seen.
        let of = |cell: usize, fibre: f64, resin: f64| match (mesh.is_present(cell), (cell / 60).is_multiple_of(3)) {
            (false, _) => f64::NAN,
            (_, true) => fibre,
            (_, false) => resin,
        };
        let heights: Vec<f64> = (0..mesh.pin_cells()).map(|cell| of(cell, -1e-6, 8e-6)).collect();
        let base: Vec<Base> = (0..mesh.pin_cells())
            .map(|cell| if of(cell, 1.0, 0.0) == 1.0 { Base::Primary } else { Base::Resin })
            .collect();
        for factor in [2, 4, 8] {
            let coarsening = Coarsening::new(&mesh, &base, factor).unwrap().unwrap();
            let coarse = &coarsening.mesh;
            assert_eq!(coarse.outline(), mesh.outline());
            // Either counts centres in the circle: each misses its area by a cell's half diagonal along the edge at most.
            let edge = TAU * 2e-3 * 0.5 * coarse.row_height().hypot(coarse.column_width());
            assert!((coarse.pin_area() - mesh.pin_area()).abs() < 2.0 * edge, "{factor}");
            let found = coarsening.pin(&heights);
            for (cell, base) in coarsening.base.iter().enumerate().filter(|(cell, _)| coarse.is_present(*cell)) {
                let expected = if base.is_resin() { 8e-6 } else { -1e-6 };
                assert!((found[cell] - expected).abs() < 1e-18 || factor > 2, "{factor}: {}", found[cell]);
                assert!((-1e-6 - 1e-18..=8e-6 + 1e-18).contains(&found[cell]), "{factor}: {}", found[cell]);
            }
        }
    }

    #[test]
    fn one_row_stays_one_row() {
        let mesh = Mesh::new(1, 64, 16, 20e-3, 24e-3).unwrap();
        let coarse = Coarsening::new(&mesh, &[Base::Resin; 16], 2).unwrap().unwrap();
        assert_eq!([coarse.mesh.rows(), coarse.mesh.disc_columns(), coarse.mesh.pin_columns()], [1, 32, 8]);
        assert_eq!(coarse.disc(&[2e-6; 64]), [2e-6; 32]);
    }

    #[test]
    fn cells_are_cut_where_they_must_be() {
        // Three cells of 1/3 in two of 1/2: the middle one is cut in halves of 1/6.
        let overlap = Overlap::of_lengths(3, 2);
        let cells: Vec<_> = overlap.cells().collect();
        for (cell, expected) in cells.iter().zip([[(0, 1.0 / 3.0), (1, 1.0 / 6.0)], [(1, 1.0 / 6.0), (2, 1.0 / 3.0)]]) {
            assert_eq!(cell.len(), 2);
            for ((index, share), (expected_index, expected)) in cell.iter().zip(expected) {
                assert!(*index == expected_index && (share - expected).abs() < 1e-15, "{cell:?}");
            }
        }
    }

    #[test]
    fn rings_count_by_their_areas() {
        // Between radii 1 and 3 in two rings: (2² − 1²)/2 and (3² − 2²)/2.
        let overlap = Overlap::of_rings([1.0, 3.0], 2, 1);
        assert_eq!(overlap.cells().next().unwrap(), [(0, 1.5), (1, 2.5)]);
    }
}
