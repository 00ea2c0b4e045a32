//! How far the lowlands of the disc are filled, and how much of it is covered (model section 5).

use std::ops::Range;

use crate::engine::exact::RingSum;
use crate::engine::lanes::LANES;
use crate::engine::strips::DiscSector;
use crate::model::material::Status;
use crate::model::mesh::Mesh;
use crate::model::state::{InitialSurfaces, reported_disc_status};

/// Filling and coverage of a worker's disc columns, kept up to date for the columns that passed under the pin.
#[derive(Debug, Clone, PartialEq)]
pub struct Filling {
    /// z_ref, m: highest initial height of the whole disc.
    reference: f64,
    /// V(0) of the whole disc, m³.
    initial_volume: f64,
    /// Open volume and secondary area of every own column.
    columns: Vec<(RingSum, RingSum)>,
    /// Σ A (z_ref − z_d)₊ over the own columns, m³.
    open_volume: RingSum,
    /// Σ A over the own secondary cells, m².
    secondary_area: RingSum,
    /// Steps up to which the columns are up to date.
    up_to: u64,
}

impl Filling {
    /// Measures the initial disc, and the own rows of the own sectors of it.
    pub fn new<'a>(
        mesh: &Mesh,
        rows: Range<usize>,
        surfaces: &InitialSurfaces,
        sectors: impl Iterator<Item = &'a DiscSector>,
    ) -> Self {
        let reference = surfaces.disc_height.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        let mut initial_volume = RingSum::default();
        for heights in surfaces.disc_height.chunks_exact(mesh.rows()) {
            for (heights, area) in heights.chunks(LANES).zip(mesh.area().chunks(LANES)) {
                initial_volume.add(open_volume(reference, heights, area));
            }
        }
        let mut filling = Self {
            reference,
            initial_volume: initial_volume.value(),
            columns: vec![(RingSum::default(), RingSum::default()); mesh.disc_columns()],
            open_volume: RingSum::default(),
            secondary_area: RingSum::default(),
            up_to: 0,
        };
        filling.measure_all(mesh, &rows, sectors, 0);
        filling
    }

    /// Measures the own columns that the pin touched since the last call, after `steps` steps; in the last of them pin
    /// column 0 lay over the disc column `first`.
    pub fn update<'a>(
        &mut self,
        mesh: &Mesh,
        rows: &Range<usize>,
        sectors: impl Iterator<Item = &'a DiscSector>,
        first: usize,
        steps: u64,
    ) {
        let new = steps - self.up_to;
        if new == 0 {
            return;
        }
        self.up_to = steps;
        // In step n the pin lies over columns −n .. pin_columns − n, so over `new` steps a span that much longer.
        let span = (mesh.pin_columns() as u64 - 1).saturating_add(new).min(mesh.disc_columns() as u64) as usize;
        for sector in sectors {
            for column in 0..sector.columns {
                let behind = (sector.first + column + mesh.disc_columns() - first) % mesh.disc_columns();
                if behind < span {
                    self.measure(&mesh.area()[rows.clone()], sector, column);
                }
            }
        }
    }

    /// Measures every column anew, as they are after so many steps.
    pub fn measure_all<'a>(
        &mut self,
        mesh: &Mesh,
        rows: &Range<usize>,
        sectors: impl Iterator<Item = &'a DiscSector>,
        steps: u64,
    ) {
        self.up_to = steps;
        for sector in sectors {
            (0..sector.columns).for_each(|column| self.measure(&mesh.area()[rows.clone()], sector, column));
        }
    }

    fn measure(&mut self, area: &[f64], sector: &DiscSector, column: usize) {
        let mut measured = (RingSum::default(), RingSum::default());
        let substrate = sector.substrate();
        // Strip by strip: a sum over all rows would be rounded otherwise where they are shared among workers.
        for (strip, area) in area.chunks(LANES).enumerate() {
            let (heights, substrates) = (&sector.height.chunk(strip, column).0, &substrate.chunk(strip, column).0);
            measured.0.add(open_volume(self.reference, heights, area));
            let cells = heights.iter().zip(substrates).zip(area);
            let is_secondary =
                |height: &f64, substrate: &f64| reported_disc_status(*height, *substrate) == Status::Secondary;
            let secondary =
                cells.filter(|((height, substrate), _)| is_secondary(height, substrate)).map(|(_, area)| area).sum();
            measured.1.add(RingSum::of(secondary));
        }
        let before = std::mem::replace(&mut self.columns[sector.first + column], measured);
        self.open_volume.add(measured.0);
        self.open_volume.subtract(before.0);
        self.secondary_area.add(measured.1);
        self.secondary_area.subtract(before.1);
    }

    /// z_ref, m: highest initial height of the whole disc.
    pub fn reference_height(&self) -> f64 {
        self.reference
    }

    /// Σ A (z_ref − z_d)₊ over the own columns, m³.
    pub fn open_volume(&self) -> RingSum {
        self.open_volume
    }

    /// Σ A over the own secondary cells, m².
    pub fn secondary_area(&self) -> RingSum {
        self.secondary_area
    }

    /// 1 − V(t)/V(0) with V(t) the open volume of the whole disc; 0 when nothing was open at the start.
    pub fn filled_fraction(&self, open_volume: RingSum) -> f64 {
        if self.initial_volume == 0.0 {
            return 0.0;
        }
        1.0 - open_volume.value() / self.initial_volume
    }
}

/// Σ A (z_ref − z_d)₊ of a strip of a column, m³.
fn open_volume(reference: f64, heights: &[f64], area: &[f64]) -> RingSum {
    RingSum::of(heights.iter().zip(area).map(|(height, area)| (reference - height).max(0.0) * area).sum())
}
