//! What a simulation is like between two steps: samples, maps, surfaces, checkpoints.

use super::Simulation;
use crate::engine::checkpoint::Checkpoint;
use crate::engine::error::SimulationError;
use crate::model::state::{Disc, Pin};
use crate::observe::extra::Extra;
use crate::observe::{Map, MapValues, QUANTITIES, Sample, Snapshot};

impl Simulation {
    /// The reported quantities after the last step.
    ///
    /// # Errors
    /// [`SimulationError::Worker`] when a worker failed, [`SimulationError::NotWatched`] after [`Simulation::pass_to`],
    /// [`SimulationError::NotFinite`] when an amount is no number.
    pub fn sample(&mut self) -> Result<Sample, SimulationError> {
        let sample = self.workers.sample()?;
        // A ratio may have nothing to be a ratio of.
        let amounts = || QUANTITIES.iter().filter(|quantity| quantity.unit != "1");
        let name = |place| format!("the {}", amounts().nth(place).map_or("", |quantity| quantity.long_name));
        self.refuse_not_finite(amounts().map(|quantity| quantity.value(&sample)), name)?;
        Ok(sample)
    }

    /// The same with series on request. Each takes about as long as the maps that it is measured of.
    ///
    /// # Errors
    /// As [`Simulation::sample`].
    pub fn sample_with(&mut self, extras: &[&Extra]) -> Result<Sample, SimulationError> {
        let mut sample = self.sample()?;
        for extra in extras {
            let Some(request) = &extra.request else { continue };
            let fields: Vec<Vec<f64>> =
                self.snapshot(request.maps)?.maps.into_iter().map(|(_, values)| values.into_numbers()).collect();
            sample.add(extra.quantities, (request.measure)(&self.parameters, &fields));
        }
        Ok(sample)
    }

    /// The maps asked for, as they are now.
    ///
    /// # Errors
    /// [`SimulationError::Worker`] when a worker failed, [`SimulationError::NotWatched`] for pressures after
    /// [`Simulation::pass_to`], [`SimulationError::NotFinite`] when a value is no number.
    pub fn snapshot(&mut self, maps: &[Map]) -> Result<Snapshot, SimulationError> {
        let snapshot = self.workers.snapshot(maps)?;
        for (map, values) in &snapshot.maps {
            if let MapValues::Float(values) = values {
                let name = |place| format!("cell {place} of {}", map.name());
                self.refuse_not_finite(values.iter().copied(), name)?;
            }
        }
        Ok(snapshot)
    }

    /// The disc as it is now.
    ///
    /// # Errors
    /// [`SimulationError::Worker`] when a worker failed.
    pub fn disc(&mut self) -> Result<Disc, SimulationError> {
        let [height, substrate] = self.fields([Map::DiscHeight, Map::DiscSubstrate])?;
        Ok(Disc { height, substrate })
    }

    /// z_d of every disc cell as it is now, m, column by column.
    ///
    /// # Errors
    /// [`SimulationError::Worker`] when a worker failed.
    pub fn disc_height(&mut self) -> Result<Vec<f64>, SimulationError> {
        let [height] = self.fields([Map::DiscHeight])?;
        Ok(height)
    }

    /// The pin as it is now.
    ///
    /// # Errors
    /// [`SimulationError::Worker`] when a worker failed.
    pub fn pin(&mut self) -> Result<Pin, SimulationError> {
        let [height, substrate] = self.fields([Map::PinHeight, Map::PinSubstrate])?;
        Ok(Pin { height, substrate, base: self.pin_base.clone() })
    }

    fn fields<const COUNT: usize>(&mut self, maps: [Map; COUNT]) -> Result<[Vec<f64>; COUNT], SimulationError> {
        let mut fields = self.snapshot(&maps)?.maps.into_iter().map(|(_, values)| values.into_numbers());
        Ok(std::array::from_fn(|_| fields.next().unwrap_or_default()))
    }

    /// The complete state, to go on from later.
    ///
    /// # Errors
    /// [`SimulationError::Worker`] when a worker failed, [`SimulationError::NotFinite`] when a height is no number.
    pub fn checkpoint(&mut self) -> Result<Checkpoint, SimulationError> {
        let [disc_height, disc_substrate] = self.fields([Map::DiscHeight, Map::DiscSubstrate])?;
        let [pin_height, pin_substrate] = self.fields([Map::PinHeight, Map::PinSubstrate])?;
        let memory = self.workers.memory()?;
        let rows = self.parameters.mesh.rows();
        let fields = [
            ("height of the disc", &disc_height),
            ("substrate of the disc", &disc_substrate),
            ("height of the pin", &pin_height),
            ("substrate of the pin", &pin_substrate),
        ];
        for (name, values) in fields {
            let name = |cell| format!("the {name} at (column {}, row {})", cell / rows, cell % rows);
            self.refuse_not_finite(values.iter().copied(), name)?;
        }
        Ok(Checkpoint { disc_height, disc_substrate, pin_height, pin_substrate, memory })
    }

    /// Looks at all heights: one that is no number is followed by others, and shows in no series for a while.
    ///
    /// # Errors
    /// [`SimulationError::NotFinite`], and [`SimulationError::Worker`] when a worker failed.
    pub fn check_heights(&mut self) -> Result<(), SimulationError> {
        self.checkpoint().map(drop)
    }

    /// Refuses what is no number, which `name` names by its place.
    fn refuse_not_finite(
        &self,
        mut values: impl Iterator<Item = f64>,
        name: impl Fn(usize) -> String,
    ) -> Result<(), SimulationError> {
        let mut place = 0;
        let found = values.find(|value| {
            place += 1;
            !value.is_finite()
        });
        let error = |found| SimulationError::NotFinite { step: self.steps_done(), what: name(place - 1), found };
        found.map_or(Ok(()), |found| Err(error(found)))
    }
}
