//! Partition of the ring into angular sectors, dealt in turn to the workers.

use std::ops::Range;

use crate::mesh::Mesh;

/// Columns of work that a boundary under the pin costs a worker: its first column is handed on, and the one that enters
/// is read on its own. Measured on the paper's mesh.
const BOUNDARY_COST: f64 = 0.7;

/// Sectors of the ring; sector s belongs to worker s mod workers.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Partition {
    workers: usize,
    disc_columns: usize,
    pin_columns: usize,
    /// First column of every sector, and the number of columns.
    starts: Vec<usize>,
}

/// Columns of the pin that lie over one sector.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Segment {
    /// Which sector.
    pub sector: usize,
    /// Columns of the pin.
    pub pin: Range<usize>,
    /// Column within the sector under the first of them.
    pub over: usize,
}

/// A pair that no sweep can read for the next step: a pin column that the disc's turn carries over another sector, or
/// over a column that no pin column lies over yet.
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
    /// The partition that keeps the most loaded worker's work least, on average over a revolution.
    ///
    /// A sector has at least two columns; where the ring has too few for that, some workers get none.
    pub fn new(mesh: &Mesh, workers: usize) -> Self {
        let most_rounds = (mesh.disc_columns() / (2 * workers)).max(1);
        if workers == 1 {
            return Self::of_sectors(mesh, 1, 1);
        }
        if mesh.disc_columns() < 2 * workers {
            return Self::of_sectors(mesh, workers, (mesh.disc_columns() / 2).max(1));
        }
        let per_round = mesh.disc_columns().div_ceil(mesh.pin_columns());
        let candidates =
            (1..=most_rounds.min(4 * per_round)).map(|rounds| Self::of_sectors(mesh, workers, rounds * workers));
        let cost = |partition: &Self| {
            let boundaries = (partition.sectors() * mesh.pin_columns()) as f64 / mesh.disc_columns() as f64;
            partition.mean_largest_load() + BOUNDARY_COST * boundaries / workers as f64
        };
        let best = candidates.map(|partition| (cost(&partition), partition)).min_by(|a, b| a.0.total_cmp(&b.0));
        best.map_or_else(|| Self::of_sectors(mesh, workers, workers), |(_, partition)| partition)
    }

    fn of_sectors(mesh: &Mesh, workers: usize, sectors: usize) -> Self {
        let columns = mesh.disc_columns();
        let starts = (0..=sectors).map(|sector| sector * columns / sectors).collect();
        Self { workers, disc_columns: columns, pin_columns: mesh.pin_columns(), starts }
    }

    /// Number of sectors.
    pub fn sectors(&self) -> usize {
        self.starts.len() - 1
    }

    /// The worker that a sector belongs to.
    pub fn owner(&self, sector: usize) -> usize {
        sector % self.workers
    }

    /// The sector before another: the one that pin columns turn to.
    pub fn before(&self, sector: usize) -> usize {
        (sector + self.sectors() - 1) % self.sectors()
    }

    /// The columns of a sector.
    pub fn columns(&self, sector: usize) -> Range<usize> {
        self.starts[sector]..self.starts[sector + 1]
    }

    /// The sector of a column.
    pub fn sector_of(&self, column: usize) -> usize {
        self.starts.partition_point(|start| *start <= column) - 1
    }

    /// Mean over a revolution of the columns under the pin that the most loaded worker has.
    pub fn mean_largest_load(&self) -> f64 {
        let owners: Vec<usize> = (0..self.sectors())
            .flat_map(|sector| self.columns(sector).map(move |_| sector))
            .map(|s| self.owner(s))
            .collect();
        let mut loads = vec![0_usize; self.workers];
        owners[..self.pin_columns].iter().for_each(|owner| loads[*owner] += 1);
        let mut sum = 0;
        for column in 0..self.disc_columns {
            sum += loads.iter().max().unwrap_or(&0);
            loads[owners[column]] -= 1;
            loads[owners[(column + self.pin_columns) % self.disc_columns]] += 1;
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
            let segment = Segment { sector, pin: pin..pin + columns, over: column - start };
            pin += columns;
            sector = (sector + 1) % self.sectors();
            column = self.starts[sector];
            Some(segment)
        })
    }

    /// Those of the segments that belong to a worker.
    pub fn segments_of(&self, worker: usize, first: usize) -> impl Iterator<Item = Segment> + '_ {
        self.segments(first).filter(move |segment| self.owner(segment.sector) == worker)
    }

    /// What enters where: of each segment the first pin column, which in the next step lies over the disc column before.
    pub fn entering(&self, first: usize) -> impl Iterator<Item = Entering> + '_ {
        self.segments(first).map(|Segment { sector, pin, over }| {
            if over > 0 {
                return Entering { pin: pin.start, from: sector, sector, over: over - 1 };
            }
            let before = self.before(sector);
            Entering { pin: pin.start, from: sector, sector: before, over: self.columns(before).len() - 1 }
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn mesh(disc_columns: usize, pin_columns: usize) -> Mesh {
        Mesh::new(3, disc_columns, pin_columns, 1.0, 2.0).unwrap()
    }

    #[test]
    fn segments_cover_the_pin_and_lie_over_the_right_columns() {
        for (disc_columns, pin_columns, workers) in
            [(2764, 161, 2), (40, 40, 3), (17, 5, 8), (9, 9, 1), (30, 1, 5), (7, 4, 5)]
        {
            let mesh = mesh(disc_columns, pin_columns);
            let partition = Partition::new(&mesh, workers);
            for step in 0..2 * disc_columns as u64 {
                let mut next = 0;
                for segment in partition.segments(mesh.disc_column(0, step)) {
                    assert_eq!(segment.pin.start, next);
                    for (offset, pin) in segment.pin.clone().enumerate() {
                        let column = partition.columns(segment.sector).start + segment.over + offset;
                        assert_eq!(column, mesh.disc_column(pin, step));
                        assert_eq!(partition.sector_of(column), segment.sector);
                    }
                    next = segment.pin.end;
                }
                assert_eq!(next, pin_columns);
                for entering in partition.entering(mesh.disc_column(0, step)) {
                    let column = partition.columns(entering.sector).start + entering.over;
                    assert_eq!(column, mesh.disc_column(entering.pin, step + 1));
                }
            }
        }
    }

    #[test]
    fn work_is_shared_evenly() {
        for workers in [2, 3, 4, 8] {
            let partition = Partition::new(&mesh(2764, 161), workers);
            let even = 161.0 / workers as f64;
            let largest = partition.mean_largest_load();
            assert!(largest < even + 2.0, "{workers} workers: {largest} columns instead of {even}");
        }
    }
}
