//! Cells of the runs: those of the scene, and, where the cell is a numerical setting, half and twice as long ones.

use plateau_core::model::mesh::Mesh;
use plateau_core::model::state::InitialSurfaces;

/// Length of cells along the sliding direction, against the scene's.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Cells {
    /// Half as long.
    Halved,
    /// The scene's.
    Own,
    /// Twice as long.
    Doubled,
}

impl Cells {
    /// Every so many columns of the halved cells there is one of these.
    fn stride(self) -> usize {
        match self {
            Self::Halved => 1,
            Self::Own => 2,
            Self::Doubled => 4,
        }
    }

    /// Columns of the disc and of the pin, from those of the scene's mesh; none where the disc's cannot be divided. A pin with an
    /// odd number of columns gets half a doubled cell more.
    pub fn columns(self, own: &Mesh) -> Option<[usize; 2]> {
        let [disc, pin] = [own.disc_columns(), own.pin_columns()].map(|columns| 2 * columns);
        (disc % self.stride() == 0).then_some([disc / self.stride(), pin.div_ceil(self.stride())])
    }

    /// Wall time of a run against that with the scene's cells: columns, and steps, are in inverse proportion to a cell's length.
    pub fn work(self) -> f64 {
        (2.0 / self.stride() as f64).powi(2)
    }

    /// Samples surfaces that were made on the mesh of halved cells: the same physical surfaces.
    #[must_use]
    pub fn sample(self, surfaces: &InitialSurfaces, rows: usize) -> InitialSurfaces {
        fn columns<T: Copy>(values: &[T], rows: usize, stride: usize) -> Vec<T> {
            values.chunks(rows).step_by(stride).flatten().copied().collect()
        }
        let stride = self.stride();
        InitialSurfaces {
            disc_height: columns(&surfaces.disc_height, rows, stride),
            pin_height: columns(&surfaces.pin_height, rows, stride),
            pin_base: columns(&surfaces.pin_base, rows, stride),
        }
    }
}

#[cfg(test)]
mod tests {
    use plateau_core::model::state::Base;

    use super::*;

    #[test]
    fn every_second_and_fourth_column_is_sampled() {
        let own = Mesh::new(2, 6, 3, 0.010, 0.011).unwrap();
        let columns = [Cells::Halved, Cells::Own, Cells::Doubled].map(|cells| cells.columns(&own));
        assert_eq!(columns, [Some([12, 6]), Some([6, 3]), Some([3, 2])]);
        assert_eq!(Cells::Doubled.columns(&Mesh::new(2, 7, 3, 0.010, 0.011).unwrap()), None);
        let numbers = |columns: usize| (0..2 * columns).map(|number| number as f64).collect();
        let finest =
            InitialSurfaces { disc_height: numbers(12), pin_height: numbers(6), pin_base: vec![Base::Primary; 12] };
        let doubled = Cells::Doubled.sample(&finest, 2);
        assert_eq!(doubled.disc_height, [0.0, 1.0, 8.0, 9.0, 16.0, 17.0]);
        assert_eq!((doubled.pin_height.as_slice(), doubled.pin_base.len()), ([0.0, 1.0, 8.0, 9.0].as_slice(), 4));
    }
}
