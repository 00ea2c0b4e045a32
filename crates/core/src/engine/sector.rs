//! Partition of the mesh among workers: the ring into angular sectors, and where that pays the radius into bands.
//!
//! Sectors are dealt in turn to groups of workers, so that all have equal work although the pin covers a part of the ring
//! only; each worker of a group has one band of every sector of its group. Pin columns pass from group to group as the
//! disc turns. Between bands nothing passes, for no rule couples rows but through the sums; so bands are the better
//! partition as far as there are enough rows.

use std::ops::Range;

use crate::engine::execution::Decomposition;
use crate::engine::lanes::LANES;
use crate::engine::strips::strips;
use crate::model::mesh::Mesh;

/// Columns of work that a segment costs its group beside its own: each strip of it is begun and ended, what lies ahead of its boundary is
/// found and told, its first column handed on, and the one that enters taken over and read on its own. Between what was measured on the
/// paper's mesh with AVX-512 and with AVX2.
const SEGMENT_COST: usize = 25;

/// Partition of the mesh.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Partition {
    workers: usize,
    bands: usize,
    /// Strips of the mesh.
    strips: usize,
    rows: usize,
    disc_columns: usize,
    pin_columns: usize,
    /// First column of every sector, and the number of columns.
    starts: Vec<usize>,
}

/// Columns of the pin that lie over one sector.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Segment {
    /// Number of the sector.
    pub sector: usize,
    /// Columns of the pin.
    pub pin: Range<usize>,
    /// Column within the sector under the first of them.
    pub over: usize,
    /// True if the sector's column before that is at rest, so that the pass itself can read its pair of the next step.
    pub joined: bool,
}

/// A pair that no pass can read for the next step: of a pin column that the disc's turn carries over another sector, or
/// over a column that is passed over later.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Entering {
    /// Column of the pin.
    pub pin: usize,
    /// Sector in which the column is now.
    pub from: usize,
    /// Sector in which it will be.
    pub sector: usize,
    /// Column within that sector under it.
    pub over: usize,
}

impl Partition {
    /// The partition that keeps the most loaded worker's work least, on average over a revolution, among those of a
    /// kind.
    ///
    /// A sector has at least `shortest` columns, two of them or more; where the ring has too few for that, some workers get none.
    pub fn new(mesh: &Mesh, workers: usize, kind: Decomposition, shortest: usize) -> Self {
        let most_bands = strips(mesh.rows()).min(workers);
        let possible = |count: &usize| workers.is_multiple_of(*count);
        let candidates: Vec<usize> = match kind {
            Decomposition::Auto => (1..=most_bands).filter(possible).collect(),
            Decomposition::Sectors => vec![1],
            Decomposition::Bands => (1..=most_bands).rev().find(possible).into_iter().collect(),
        };
        let partitions = candidates.into_iter().flat_map(|bands| Self::of_bands(mesh, workers, bands, shortest));
        let best = partitions.map(|each| (each.cost(), each)).min_by(|a, b| a.0.total_cmp(&b.0));
        best.map_or_else(|| Self::of_sectors(mesh, workers, 1, 1), |(_, partition)| partition)
    }

    /// Partitions into so many bands and different numbers of sectors.
    fn of_bands(mesh: &Mesh, workers: usize, bands: usize, shortest: usize) -> Vec<Self> {
        let groups = workers / bands;
        if groups == 1 {
            return vec![Self::of_sectors(mesh, workers, bands, 1)];
        }
        let most_rounds = mesh.disc_columns() / (shortest * groups);
        if most_rounds == 0 {
            return vec![Self::of_sectors(mesh, workers, bands, (mesh.disc_columns() / shortest).max(1))];
        }
        let per_round = mesh.disc_columns().div_ceil(mesh.pin_columns());
        let rounds = 1..=most_rounds.min(4 * per_round);
        rounds.map(|rounds| Self::of_sectors(mesh, workers, bands, rounds * groups)).collect()
    }

    fn of_sectors(mesh: &Mesh, workers: usize, bands: usize, sectors: usize) -> Self {
        let columns = mesh.disc_columns();
        let starts = (0..=sectors).map(|sector| sector * columns / sectors).collect();
        let (strips, rows, pin_columns) = (strips(mesh.rows()), mesh.rows(), mesh.pin_columns());
        Self { workers, bands, strips, rows, disc_columns: columns, pin_columns, starts }
    }

    /// Work of the most loaded worker, in strips of columns.
    fn cost(&self) -> f64 {
        self.strips.div_ceil(self.bands) as f64 * self.mean_largest_work()
    }

    /// Describes in words which part of the mesh each worker has.
    pub fn told(&self) -> String {
        let part = |count: usize, name: &str| (count > 1).then(|| format!("{count} {name}"));
        let sectors = if self.groups() > 1 { part(self.sectors(), "sectors") } else { None };
        let parts: Vec<String> = [part(self.bands, "bands of rows"), sectors].into_iter().flatten().collect();
        if parts.is_empty() { "none".to_owned() } else { parts.join(" of ") }
    }

    /// Number of bands.
    pub fn bands(&self) -> usize {
        self.bands
    }

    /// Number of groups of workers that sectors are dealt to.
    pub fn groups(&self) -> usize {
        self.workers / self.bands
    }

    /// The group of a worker.
    pub fn group_of(&self, worker: usize) -> usize {
        worker / self.bands
    }

    /// The band of a worker.
    pub fn band_of(&self, worker: usize) -> usize {
        worker % self.bands
    }

    /// The strips of a band.
    pub fn strips_of(&self, band: usize) -> Range<usize> {
        band * self.strips / self.bands..(band + 1) * self.strips / self.bands
    }

    /// The rows of a band.
    pub fn rows_of(&self, band: usize) -> Range<usize> {
        let Range { start, end } = self.strips_of(band);
        start * LANES..(end * LANES).min(self.rows)
    }

    /// Number of sectors.
    pub fn sectors(&self) -> usize {
        self.starts.len() - 1
    }

    /// The group that a sector belongs to.
    pub fn group(&self, sector: usize) -> usize {
        sector % self.groups()
    }

    /// The worker that has a band of a sector.
    pub fn owner(&self, sector: usize, band: usize) -> usize {
        self.group(sector) * self.bands + band
    }

    /// The sector before another: the one that pin columns turn to.
    pub fn before(&self, sector: usize) -> usize {
        (sector + self.sectors() - 1) % self.sectors()
    }

    /// Kinds of messages that cross boundaries between workers, times these boundaries: of each band of a sector what lies ahead of its
    /// lower boundary, and the column that turns across it.
    pub fn messages(&self) -> usize {
        if self.groups() > 1 { 2 * self.sectors() * self.bands } else { 0 }
    }

    /// The columns of a sector.
    pub fn columns(&self, sector: usize) -> Range<usize> {
        self.starts[sector]..self.starts[sector + 1]
    }

    /// The sector of a column.
    pub fn sector_of(&self, column: usize) -> usize {
        self.starts.partition_point(|start| *start <= column) - 1
    }

    /// Mean over a revolution of the work of the most loaded group, in columns.
    fn mean_largest_work(&self) -> f64 {
        let sectors: Vec<usize> =
            (0..self.sectors()).flat_map(|sector| self.columns(sector).map(move |_| sector)).collect();
        let begins = |column: usize| column == self.starts[sectors[column]];
        let mut work = vec![0; self.groups()];
        self.segments(0).for_each(|segment| work[self.group(segment.sector)] += segment.pin.len() + SEGMENT_COST);
        let mut sum = 0;
        for column in 0..self.disc_columns {
            sum += work.iter().max().unwrap_or(&0);
            let (next, entering) = ((column + 1) % self.disc_columns, (column + self.pin_columns) % self.disc_columns);
            work[self.group(sectors[entering])] += 1 + if begins(entering) { SEGMENT_COST } else { 0 };
            work[self.group(sectors[column])] -= 1 + if begins(next) { SEGMENT_COST } else { 0 };
        }
        sum as f64 / self.disc_columns as f64
    }

    /// The segments of the pin over a disc turned so that pin column 0 lies over `first` (a disc column), in the order
    /// of the pin's columns.
    pub fn segments(&self, first: usize) -> impl Iterator<Item = Segment> + '_ {
        let (mut sector, mut column, mut pin) = (self.sector_of(first), first, 0);
        std::iter::from_fn(move || {
            if pin == self.pin_columns {
                return None;
            }
            let Range { start, end } = self.columns(sector);
            let columns = (end - column).min(self.pin_columns - pin);
            let joined = column > start && self.pin_columns < self.disc_columns;
            let segment = Segment { sector, pin: pin..pin + columns, over: column - start, joined };
            pin += columns;
            sector = (sector + 1) % self.sectors();
            column = self.starts[sector];
            Some(segment)
        })
    }

    /// Segments that belong to a group.
    pub fn segments_of(&self, group: usize, first: usize) -> impl Iterator<Item = Segment> + '_ {
        self.segments(first).filter(move |segment| self.group(segment.sector) == group)
    }

    /// Returns the pin columns that no pass can read for the next step: of each segment that is not joined, the first, which then lies
    /// over the disc column before.
    pub fn entering(&self, first: usize) -> impl Iterator<Item = Entering> + '_ {
        self.segments(first).filter(|segment| !segment.joined).map(|Segment { sector, pin, over, .. }| {
            if over > 0 {
                return Entering { pin: pin.start, from: sector, sector, over: over - 1 };
            }
            let before = self.before(sector);
            Entering { pin: pin.start, from: sector, sector: before, over: self.columns(before).len() - 1 }
        })
    }
}

#[cfg(test)]
#[path = "../../tests/unit/engine/sector.rs"]
mod tests;
