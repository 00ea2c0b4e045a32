//! Load balance of a step: the displacement that carries the load (model 4.1).

use super::Worker;
use crate::engine::coefficients::StatusPair;
use crate::engine::contact::{Carried, Verdict};
use crate::engine::exact::{ExactSum, Quantum, Unit, of_words, words};
use crate::engine::kernel::{Bracket, NearPair, Span, gaps_below};
use crate::engine::lanes::LANES;
use crate::engine::sector::Segment;
use crate::engine::strips::OUT_OF_REACH;
use crate::model::error::{ContactError, SimulationError};
use crate::model::state::pin_status;

/// Largest number of readings of one step; Newton's method needs few, this bound only keeps rounding from going round in circles.
const MOST_READINGS: u32 = 200;
/// Share of the load that the rounding of overlaps may hide; where it may hide more, the balance is refined.
const LEAST_DOUBT: f64 = 1e-10;
/// Largest number of refinements of one step: Newton's method from so near needs one or two.
const MOST_REFINEMENTS: u32 = 8;
/// Factor by which a quantum must be finer for another reading.
const FINER: f64 = 16.0;
/// Bits of the load below which what cells carry is cut off where it is added up.
const LOAD_BITS: i32 = 64;

impl Worker {
    /// Finds the displacement that carries the load: nearly always the last pass has read all that this needs. Returns a
    /// bound of the overlaps at it, m.
    pub(super) fn balance(&mut self) -> Result<f64, SimulationError> {
        let (step, normal_force) = (self.course.steps + 1, self.operation.load);
        let mut bracket = match self.bracket {
            Some(bracket) => bracket,
            None => self.read_around_first_contact()?,
        };
        for _ in 0..MOST_READINGS {
            let columns = self.parameters.mesh.pin_columns();
            let largest = self.reading.largest_overlap(&bracket);
            if !bracket.quantum.holds(largest, columns) {
                bracket = Bracket::new(bracket.low, bracket.width, Quantum::of_sum(largest, columns));
                self.read_columns(&bracket)?;
                continue;
            }
            let verdict =
                self.contact.balance(&self.weights, &self.sums, &mut self.reading.near, &bracket, normal_force);
            match verdict.map_err(|source| SimulationError::Contact { step, source })? {
                Verdict::Solved => {
                    let displacement = self.contact.displacement();
                    // What the last place of the displacement carries is hidden whatever the sums say.
                    let hidden = self.contact.slope() * displacement.abs() * f64::EPSILON;
                    if self.contact.doubt() > hidden.max(LEAST_DOUBT * normal_force) {
                        let rounding = bracket.quantum.value();
                        let finest = Quantum::of_sum(largest.max(displacement - bracket.low), columns);
                        let finer = Bracket::new(displacement - rounding, 2.0 * rounding, finest);
                        if finer.quantum.value() < rounding / FINER {
                            bracket = finer;
                            self.read_columns(&bracket)?;
                            continue;
                        }
                        self.refine(&bracket)?;
                    }
                    self.bracket = Some(bracket);
                    self.note_near_touches();
                    if largest > 0.0 {
                        self.overlap_quantum = Quantum::of_sum(largest, columns);
                    }
                    self.course.largest_load_residual = self.course.largest_load_residual.max(self.contact.residual());
                    let above = self.contact.displacement() - bracket.low;
                    return Ok(largest.max(0.0) + above + bracket.quantum.value());
                }
                Verdict::Between(low, high) => {
                    bracket = Bracket::new(low, high - low, self.overlap_quantum);
                    self.read_columns(&bracket)?;
                }
                Verdict::Apart => bracket = self.read_around_first_contact()?,
            }
        }
        let source = ContactError::NotCarried { displacement: bracket.low, normal_force };
        Err(SimulationError::Contact { step, source })
    }

    /// Finds the displacement once more, from what every pair carries at it: where build-up is far softer than fibre, no
    /// quantum that holds the overlaps of the one is fine enough for those of the other.
    fn refine(&mut self, bracket: &Bracket) -> Result<(), SimulationError> {
        let (normal_force, unit) = (self.operation.load, self.load_unit());
        let mut best: Option<Carried> = None;
        let mut displacement = self.contact.displacement();
        for _ in 0..MOST_REFINEMENTS {
            let mut own = Vec::with_capacity(2 * StatusPair::COUNT);
            self.carried(displacement).into_iter().for_each(|load| own.extend(words(load.integer())));
            let mut loads = [ExactSum::default(); StatusPair::COUNT];
            self.communicator.all_gather(&own, &mut |_, words| {
                let mut words = words.iter().copied();
                loads.iter_mut().for_each(|load| load.add(ExactSum::of_integer(of_words(&mut words))));
            })?;
            let loads = loads.map(|load| unit.value(load));
            let missing = normal_force - loads.iter().sum::<f64>();
            let residual = (missing / normal_force).abs();
            let is_better = residual < best.map_or(f64::INFINITY, |best| best.residual);
            if !is_better {
                break;
            }
            best = Some(Carried { displacement, loads, residual });
            displacement += missing / self.contact.slope();
        }
        if let Some(carried) = best {
            let Self { contact, weights, sums, reading, .. } = self;
            contact.refine(weights, sums, &mut reading.near, bracket, &carried);
        }
        Ok(())
    }

    /// Load Σ k A (δ − g)₊ of the own pairs at a displacement, by pair.
    fn carried(&self, displacement: f64) -> [ExactSum; StatusPair::COUNT] {
        let unit = self.load_unit();
        let mut loads = [ExactSum::default(); StatusPair::COUNT];
        self.for_each_pair_below(displacement, |row, _, gap, pair| {
            loads[pair].add(unit.exact(self.coefficients.stiffness[pair][row] * (displacement - gap)));
        });
        loads
    }

    /// Unit of the loads of cells where they are added up, N.
    fn load_unit(&self) -> Unit {
        Unit::new(libm::ilogb(self.operation.load).saturating_sub(LOAD_BITS), 0.0)
    }

    /// Residual |Σ k A u − F_N| / F_N of the last step, 1, by what all of its cells carried.
    pub(super) fn load_residual(&self, carried: ExactSum) -> f64 {
        (self.load_unit().value(carried) / self.operation.load - 1.0).abs()
    }

    /// Reads the pairs at the displacement at which the first cell would carry the load alone: it is never below the
    /// solution.
    fn read_around_first_contact(&mut self) -> Result<Bracket, SimulationError> {
        let normal_force = self.operation.load;
        let mut least = f64::INFINITY;
        self.for_each_pair_below(OUT_OF_REACH, |row, _, gap, pair| {
            least = least.min(gap + normal_force / self.coefficients.stiffness[pair][row]);
        });
        let own = least.to_bits();
        self.communicator.all_gather(&[own], &mut |_, words| least = least.min(f64::from_bits(words[0])))?;
        let bracket = Bracket::new(least, 0.0, self.overlap_quantum);
        self.read_columns(&bracket)?;
        Ok(bracket)
    }

    /// Reads all own pairs of the coming step against a bracket, and gathers what the others read.
    pub(super) fn read_columns(&mut self, bracket: &Bracket) -> Result<(), SimulationError> {
        self.course.extra_readings += 1;
        self.reading.clear();
        for Segment { sector, pin, over, .. } in self.partition.segments(self.first()) {
            let Some(sector) = &self.sectors[sector] else { continue };
            let span = Span { first: pin.start, over, columns: pin.len() };
            (self.read)(self.instructions, &mut self.pin, sector, span, bracket, &mut self.reading);
        }
        self.gather_reading(bracket)
    }

    /// Notes which of the pairs that the bracket did not decide touch at the displacement.
    fn note_near_touches(&mut self) {
        let displacement = self.contact.displacement();
        for near in self.reading.near.iter().take_while(|near| near.gap < displacement) {
            let row = near.row as usize;
            if self.rows.contains(&row) {
                // In columns of other workers it means nothing: they are read anew when they come here.
                self.pin.note_touch(row - self.rows.start, near.column as usize);
            }
        }
    }

    /// Calls `each` with row, pin column, gap (m) and pair of statuses of every own cell under the pin whose gap is less than a
    /// displacement.
    fn for_each_pair_below(&self, displacement: f64, mut each: impl FnMut(usize, usize, f64, usize)) {
        let mut below = vec![0; self.parameters.mesh.pin_columns()];
        for Segment { sector, pin, over, .. } in self.partition.segments(self.first()) {
            let Some(sector) = &self.sectors[sector] else { continue };
            let below = &mut below[..pin.len()];
            for strip in 0..self.pin.height.strips() {
                let pin_heights = &self.pin.height.strip(strip)[pin.clone()];
                let disc_heights = &sector.height.strip(strip)[over..][..pin.len()];
                gaps_below(self.instructions, pin_heights, disc_heights, displacement, below);
                for (offset, rows) in below.iter_mut().enumerate() {
                    let column = pin.start + offset;
                    while *rows != 0 {
                        let lane = rows.trailing_zeros() as usize;
                        *rows &= *rows - 1;
                        let row = strip * LANES + lane;
                        let [z_p, z_d] = [&pin_heights[offset], &disc_heights[offset]].map(|chunk| chunk.0[lane]);
                        let b_p = self.pin.substrate().chunk(strip, column).0[lane];
                        let b_d = sector.substrate().chunk(strip, over + offset).0[lane];
                        let status = pin_status(z_p, b_p, self.pin.is_resin(row, column));
                        each(self.rows.start + row, column, z_p - z_d, StatusPair::new(status, z_d > b_d).index());
                    }
                }
            }
        }
    }

    /// Keeps the own pairs that touch, of which pressures follow.
    pub(super) fn record_touching(&mut self) {
        let mut touching = std::mem::take(&mut self.touching);
        touching.clear();
        self.for_each_pair_below(self.contact.displacement(), |row, column, gap, pair| {
            touching.push(NearPair { gap, row: row as u32, column: column as u32, pair: pair as u8 });
        });
        (self.touching, self.is_watched) = (touching, true);
    }

    /// Returns the load Σ k A u of the own pairs that touched in the last step, if it was watched, and p = k u (Pa) of every pin cell,
    /// column by column, 0 where no own pair touched.
    pub(super) fn pressures(&self) -> (ExactSum, Vec<f64>) {
        let (mesh, unit) = (&self.parameters.mesh, self.load_unit());
        let (mut load, mut pressure) = (ExactSum::default(), vec![0.0; mesh.pin_cells()]);
        for NearPair { gap, row, column, pair } in &self.touching {
            let (row, overlap) = (*row as usize, self.contact.displacement() - gap);
            let stiffness = self.coefficients.stiffness[usize::from(*pair)][row];
            pressure[mesh.column(*column as usize).start + row] = stiffness / mesh.area()[row] * overlap;
            load.add(unit.exact(stiffness * overlap));
        }
        (load, pressure)
    }
}
