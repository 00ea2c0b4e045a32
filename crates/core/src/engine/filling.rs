//! Filling of the lowlands of the disc, coverage of the disc, and the volume that both surfaces have lost by their heights
//! (model section 5).

use std::ops::Range;

use crate::engine::exact::{ExactSum, Unit};
use crate::engine::lanes::LANES;
use crate::engine::strips::DiscSector;
use crate::model::material::Status;
use crate::model::mesh::Mesh;
use crate::model::state::{InitialSurfaces, reported_disc_status};

/// Exponent of the unit of areas and volumes of the whole ring, where that of a scene need not be larger.
const FINEST: i32 = -110;

/// Exact sums over cells of the ring and of the pin, in whole units of volume and area.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct RingSums {
    /// Volume Σ A (z_ref − z_d)₊ that is open below z_ref.
    pub open_volume: ExactSum,
    /// Volume Σ A (z_d − z_ref)₊ above z_ref.
    pub volume_above: ExactSum,
    /// Area Σ A over secondary cells of the disc.
    pub secondary_area: ExactSum,
    /// Volume Σ A (z_p − the pin's highest initial height).
    pub pin_volume: ExactSum,
}

impl RingSums {
    /// Returns each of the sums, for a message or a sum.
    pub fn each(&mut self) -> [&mut ExactSum; 4] {
        let Self { open_volume, volume_above, secondary_area, pin_volume } = self;
        [open_volume, volume_above, secondary_area, pin_volume]
    }

    /// Changes each with that of others.
    pub fn combine(&mut self, mut other: Self, operation: fn(&mut ExactSum, ExactSum)) {
        self.each().into_iter().zip(other.each()).for_each(|(own, other)| operation(own, *other));
    }
}

/// Filling and coverage of a worker's disc columns, kept up to date for the columns that passed under the pin.
#[derive(Debug, Clone, PartialEq)]
pub struct Filling {
    /// Level z_ref, m: highest initial height of the whole disc.
    reference: f64,
    /// Highest initial height of the pin, m.
    pin_reference: f64,
    volume_unit: Unit,
    area_unit: Unit,
    /// Sums of the whole disc and the whole pin at the start.
    initial: RingSums,
    /// Sums of every own column of the disc.
    columns: Vec<RingSums>,
    /// Sums of all own columns of the disc.
    own: RingSums,
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
        let pin = || (0..mesh.pin_cells()).filter(|cell| mesh.is_present(*cell)).map(|cell| surfaces.pin_height[cell]);
        let ring_area = mesh.disc_area() + mesh.pin_area();
        let mut filling = Self {
            reference: surfaces.reference_height(),
            pin_reference: pin().fold(f64::NEG_INFINITY, f64::max),
            volume_unit: Unit::new(FINEST, ring_area * relief(mesh, surfaces)),
            area_unit: Unit::new(FINEST, ring_area),
            initial: RingSums::default(),
            columns: vec![RingSums::default(); mesh.disc_columns()],
            own: RingSums::default(),
            up_to: 0,
        };
        let mut initial = RingSums::default();
        for heights in surfaces.disc_height.chunks_exact(mesh.rows()) {
            for (heights, area) in heights.chunks(LANES).zip(mesh.area().chunks(LANES)) {
                filling.add_disc(&mut initial, heights, heights, area);
            }
        }
        for column in 0..mesh.pin_columns() {
            let start = mesh.column(column).start;
            let strips = surfaces.pin_height[mesh.column(column)].chunks(LANES).zip(mesh.area().chunks(LANES));
            for (strip, (heights, area)) in strips.enumerate() {
                let there = |row: usize| mesh.is_present(start + LANES * strip + row);
                initial.pin_volume.add(filling.pin_volume(heights, area, there));
            }
        }
        filling.initial = initial;
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
        let mut measured = RingSums::default();
        let substrate = sector.substrate();
        // Strip by strip: a sum over all rows would be rounded otherwise where they are shared among workers.
        for (strip, area) in area.chunks(LANES).enumerate() {
            let (heights, substrates) = (&sector.height.chunk(strip, column).0, &substrate.chunk(strip, column).0);
            self.add_disc(&mut measured, heights, substrates, area);
        }
        let before = std::mem::replace(&mut self.columns[sector.first + column], measured);
        self.own.combine(measured, ExactSum::add);
        self.own.combine(before, ExactSum::subtract);
    }

    /// Adds a strip of a column of the disc to sums.
    fn add_disc(&self, sums: &mut RingSums, heights: &[f64], substrates: &[f64], area: &[f64]) {
        let (mut open, mut above, mut secondary) = (0.0, 0.0, 0.0);
        for ((height, substrate), area) in heights.iter().zip(substrates).zip(area) {
            let below = self.reference - height;
            open += below.max(0.0) * area;
            above += (-below).max(0.0) * area;
            secondary += if reported_disc_status(*height, *substrate) == Status::Secondary { *area } else { 0.0 };
        }
        sums.open_volume.add(self.volume_unit.exact(open));
        // Mostly 0.
        if above > 0.0 {
            sums.volume_above.add(self.volume_unit.exact(above));
        }
        if secondary > 0.0 {
            sums.secondary_area.add(self.area_unit.exact(secondary));
        }
    }

    /// Volume Σ A (z_p − the pin's highest initial height) over a strip of a column of the pin, of the rows that are there.
    pub fn pin_volume(&self, heights: &[f64], area: &[f64], is_there: impl Fn(usize) -> bool) -> ExactSum {
        let cells = heights.iter().zip(area).enumerate().filter(|(row, _)| is_there(*row));
        self.volume_unit.exact(cells.map(|(_, (height, area))| (height - self.pin_reference) * area).sum())
    }

    /// Level z_ref, m: highest initial height of the whole disc.
    pub fn reference_height(&self) -> f64 {
        self.reference
    }

    /// The sums over the own columns of the disc.
    pub fn own(&self) -> RingSums {
        self.own
    }

    /// Area Σ A over secondary cells of the disc, m².
    pub fn secondary_area(&self, whole: &RingSums) -> f64 {
        self.area_unit.value(whole.secondary_area)
    }

    /// Filled fraction 1 − V(t)/V(0), 1, with V(t) the open volume of the whole disc; 0 when nothing was open at the start.
    pub fn filled_fraction(&self, whole: &RingSums) -> f64 {
        let initial = self.volume_unit.value(self.initial.open_volume);
        if initial == 0.0 { 0.0 } else { 1.0 - self.volume_unit.value(whole.open_volume) / initial }
    }

    /// Volume that pin and disc have lost since the start, by their heights, m³.
    pub fn lost(&self, whole: &RingSums) -> f64 {
        let mut lost = whole.open_volume;
        lost.subtract(self.initial.open_volume);
        lost.subtract(whole.volume_above);
        lost.add(whole.pin_volume);
        lost.subtract(self.initial.pin_volume);
        self.volume_unit.value(lost)
    }
}

/// Relief of the initial surfaces, m: from the lowest to the highest height of the disc, plus the same of the pin.
pub fn relief(mesh: &Mesh, surfaces: &InitialSurfaces) -> f64 {
    let mut pin = (0..mesh.pin_cells()).filter(|cell| mesh.is_present(*cell)).map(|cell| surfaces.pin_height[cell]);
    let range = |heights: &mut dyn Iterator<Item = f64>| {
        let (low, high) =
            heights.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), each| (low.min(each), high.max(each)));
        high - low
    };
    range(&mut surfaces.disc_height.iter().copied()) + range(&mut pin)
}
