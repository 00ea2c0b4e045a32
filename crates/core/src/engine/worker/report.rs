//! Samples and maps of what all workers have (model section 5).

use std::ops::Range;

use super::Worker;
use crate::engine::exact::{self, ExactSum};
use crate::engine::filling::RingSums;
use crate::engine::lanes::LANES;
use crate::engine::strips::DiscSector;
use crate::model::accounts::AccountsReport;
use crate::model::error::SimulationError;
use crate::model::material::Status;
use crate::model::state::{reported_disc_status, reported_pin_status};
use crate::observe::{Map, MapValues, Sample, Snapshot};

impl Worker {
    /// The reported quantities after the last step.
    pub fn sample(&mut self) -> Result<Sample, SimulationError> {
        self.check_watched()?;
        let parameters = self.parameters.clone();
        let mesh = &parameters.mesh;
        self.filling.update(mesh, &self.rows, self.sectors.iter().flatten(), self.last_first(), self.course.steps);
        let own = self.own_part();
        let mut rest = OwnPart { largest_pressure: 0.0, pin: vec![0; own.pin.len()], ..OwnPart::default() };
        self.communicator.all_gather(&own.words(), &mut |_, words| rest.add(words))?;
        let OwnPart { largest_pressure, load, ring, pin } = rest;
        let area_of =
            |counts: &[u64]| -> f64 { counts.iter().zip(mesh.area()).map(|(count, area)| *count as f64 * area).sum() };
        let coverage: Vec<f64> =
            pin.chunks_exact(mesh.rows()).map(|counts| area_of(counts) / mesh.pin_area()).collect();
        let contact_area = self.contact.area();
        let account = self.debris.account();
        let totals = &account.totals;
        Ok(Sample {
            step: self.course.steps,
            time: self.course.time,
            displacement: self.contact.displacement(),
            contact_area,
            contact_area_mean: self.history.revolution_mean(),
            contact_area_integral: self.history.integral(),
            sliding_distance: parameters.angle_turned(self.course.steps, self.course.time) * mesh.mean_radius(),
            contact_ratio: contact_area / mesh.pin_area(),
            mean_pressure: if contact_area > 0.0 { self.contact.load() / contact_area } else { 0.0 },
            max_pressure: largest_pressure,
            worn_pin: totals.worn_pin.value(),
            worn_resin: totals.worn_resin.value(),
            worn_disc: totals.worn_disc.value(),
            pool: account.pool(),
            emitted: totals.emitted.amount(),
            deposited_pin: totals.deposited_pin.value(),
            deposited_disc: totals.deposited_disc.value(),
            returned: totals.returned.value(),
            pin_none: coverage[Status::Resin as usize],
            pin_primary: coverage[Status::Primary as usize],
            pin_secondary: coverage[Status::Secondary as usize],
            // Rounding may leave all of the disc a trace above 1.
            disc_secondary: (self.filling.secondary_area(&ring) / mesh.disc_area()).min(1.0),
            filled_fraction: self.filling.filled_fraction(&ring),
            load_residual: if self.course.steps > 0 { self.load_residual(load) } else { 0.0 },
            balance_residual: account.balance_residual(self.filling.lost(&ring)),
            accounts: self.accounts.as_ref().map_or(AccountsReport::default(), |accounts| {
                accounts.report(self.course.steps, parameters.step_angle(), self.course.time, None)
            }),
            extras: Vec::new(),
        })
    }

    /// Returns the part of a sample that the worker's own cells give.
    fn own_part(&self) -> OwnPart {
        let rows = self.parameters.mesh.rows();
        let (load, pressure) = self.pressures();
        let largest_pressure = pressure.into_iter().fold(0.0, f64::max);
        let mut part = OwnPart { largest_pressure, load, ring: self.filling.own(), pin: vec![0; 3 * rows] };
        for column in self.own_pin_columns() {
            for (own, status) in self.pin_statuses(column).enumerate() {
                let is_there = self.pin.is_present(own, column);
                part.pin[status as usize * rows + self.rows.start + own] += u64::from(is_there);
            }
            for (strip, area) in self.parameters.mesh.area()[self.rows.clone()].chunks(LANES).enumerate() {
                let is_there = |row: usize| self.pin.is_present(LANES * strip + row, column);
                let heights = &self.pin.height.chunk(strip, column).0;
                part.ring.pin_volume.add(self.filling.pin_volume(heights, area, is_there));
            }
        }
        part
    }

    /// The pin columns that this worker passed over in the last step; before the first step those that it will.
    fn own_pin_columns(&self) -> impl Iterator<Item = usize> + '_ {
        self.partition.segments_of(self.group, self.last_first()).flat_map(|segment| segment.pin)
    }

    /// The own cells of a pin column.
    fn own_cells(&self, column: usize) -> Range<usize> {
        let start = self.parameters.mesh.column(column).start;
        start + self.rows.start..start + self.rows.end
    }

    fn pin_statuses(&self, column: usize) -> impl Iterator<Item = Status> + '_ {
        let cells = self.pin.height.column(column).zip(self.pin.substrate().column(column)).enumerate();
        cells.map(move |(row, (height, substrate))| {
            reported_pin_status(height, substrate, self.pin.is_resin(row, column))
        })
    }

    /// The maps asked for, as they are now.
    pub fn snapshot(&mut self, maps: &[Map]) -> Result<Snapshot, SimulationError> {
        let mut values = Vec::with_capacity(maps.len());
        if maps.contains(&Map::Pressure) {
            self.check_watched()?;
        }
        for map in maps {
            let field = if map.on_disc() { self.gather_disc(*map)? } else { self.gather_pin(*map)? };
            let field = match map.is_status() {
                true => MapValues::Status(field.into_iter().map(|status| status as u8).collect()),
                false => MapValues::Float(field.into_iter().map(f64::from_bits).collect()),
            };
            values.push((*map, field));
        }
        Ok(Snapshot { time: self.course.time, maps: values })
    }

    /// The values of a map of the disc, as words, column by column.
    fn gather_disc(&mut self, map: Map) -> Result<Vec<u64>, SimulationError> {
        let mut own = Vec::new();
        for sector in self.sectors.iter().flatten() {
            (0..sector.columns).for_each(|column| own.extend(disc_words(sector, column, map)));
        }
        let (partition, rows) = (self.partition.clone(), self.parameters.mesh.rows());
        let mut field = vec![0; self.parameters.mesh.disc_cells()];
        self.communicator.all_gather(&own, &mut |from, words| {
            let (group, band) = (partition.group_of(from), partition.rows_of(partition.band_of(from)));
            let sectors = (0..partition.sectors()).filter(|sector| partition.group(*sector) == group);
            let columns = sectors.flat_map(|sector| partition.columns(sector));
            for (column, words) in columns.zip(words.chunks_exact(band.len())) {
                field[rows * column + band.start..rows * column + band.end].copy_from_slice(words);
            }
        })?;
        Ok(field)
    }

    /// The values of a map of the pin, as words, column by column.
    fn gather_pin(&mut self, map: Map) -> Result<Vec<u64>, SimulationError> {
        let mesh = &self.parameters.mesh;
        let mut own = Vec::new();
        let pressure = match map {
            Map::PinHeight | Map::PinSubstrate | Map::PinStatus => Vec::new(),
            _ => self.pressures().1,
        };
        for column in self.own_pin_columns() {
            match map {
                Map::PinHeight => own.extend(self.pin.height.column(column).map(f64::to_bits)),
                Map::PinSubstrate => own.extend(self.pin.substrate_column(column).map(f64::to_bits)),
                Map::PinStatus => own.extend(self.pin_statuses(column).map(|status| status as u64)),
                _ => own.extend(pressure[self.own_cells(column)].iter().map(|pressure| pressure.to_bits())),
            }
        }
        let (partition, first, rows) = (self.partition.clone(), self.last_first(), mesh.rows());
        let mut field = vec![0; mesh.pin_cells()];
        self.communicator.all_gather(&own, &mut |from, words| {
            let band = partition.rows_of(partition.band_of(from));
            let columns = partition.segments_of(partition.group_of(from), first).flat_map(|segment| segment.pin);
            for (column, words) in columns.zip(words.chunks_exact(band.len())) {
                field[rows * column + band.start..rows * column + band.end].copy_from_slice(words);
            }
        })?;
        Ok(field)
    }
}

/// The values of a map in one column of a sector, as words.
fn disc_words(sector: &DiscSector, column: usize, map: Map) -> Vec<u64> {
    let (height, substrate) = (sector.height.column(column), sector.substrate().column(column));
    match map {
        Map::DiscHeight => height.map(f64::to_bits).collect(),
        Map::DiscSubstrate => substrate.map(f64::to_bits).collect(),
        _ => height.zip(substrate).map(|(height, substrate)| reported_disc_status(height, substrate) as u64).collect(),
    }
}

/// Part of a sample that the cells of one worker, or of all, give.
#[derive(Debug, Clone, Default)]
struct OwnPart {
    /// Largest pressure, Pa.
    largest_pressure: f64,
    /// Load Σ k A u of the last step.
    load: ExactSum,
    /// Volumes and areas of disc and pin.
    ring: RingSums,
    /// Cells of the pin by status and row.
    pin: Vec<u64>,
}

impl OwnPart {
    fn words(&self) -> Vec<u64> {
        let mut words = vec![self.largest_pressure.to_bits()];
        let mut ring = self.ring;
        for sum in std::iter::once(&mut self.load.clone()).chain(ring.each()) {
            words.extend(exact::words(sum.integer()));
        }
        words.extend(&self.pin);
        words
    }

    fn add(&mut self, words: &[u64]) {
        self.largest_pressure = self.largest_pressure.max(f64::from_bits(words[0]));
        let (sums, pin) = words[1..].split_at(10);
        let mut sums = sums.iter().copied();
        for sum in std::iter::once(&mut self.load).chain(self.ring.each()) {
            sum.add(ExactSum::of_integer(exact::of_words(&mut sums)));
        }
        self.pin.iter_mut().zip(pin).for_each(|(sum, count)| *sum += count);
    }
}
