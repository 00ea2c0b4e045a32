//! What a simulation is like between two steps: samples, maps, surfaces, checkpoints.

use super::checkpoint::{Checkpoint, LastContact};
use super::{LastMoment, Simulation};
use crate::model::accounts::{AccountsReport, Resting};
use crate::model::cycle::Kind;
use crate::model::error::SimulationError;
use crate::model::heat::account::HeatModel;
use crate::model::heat::map;
use crate::model::history::Course;
use crate::model::memory::Heights;
use crate::model::state::{Disc, Pin};
use crate::observe::extra::Extra;
use crate::observe::schedule::Moment;
use crate::observe::{ABSENT, Map, MapValues, QUANTITIES, Quantity, Sample, Snapshot, dissipation, quantities};

impl Simulation {
    /// The reported quantities after the last step.
    ///
    /// # Errors
    /// [`SimulationError::Worker`] when a worker failed, [`SimulationError::NotWatched`] after [`Simulation::pass_to`],
    /// [`SimulationError::NotFinite`] when an amount is no number.
    pub fn sample(&mut self) -> Result<Sample, SimulationError> {
        if let Some(contact) = self.last_contact() {
            return Ok(contact.sample.clone());
        }
        let sample = self.workers.sample()?;
        // A ratio may have nothing to be a ratio of.
        let amounts = || QUANTITIES.iter().filter(|quantity| quantity.unit != "1");
        let name = |place| format!("the {}", amounts().nth(place).map_or("", |quantity| quantity.long_name));
        self.refuse_not_finite(amounts().map(|quantity| quantity.value(&sample)), name)?;
        let AccountsReport { friction, heat, emission } = sample.accounts;
        let parts = [
            ("the work of friction", friction.map(|friction| friction.work)),
            ("the heat lost", heat.map(|heat| heat.lost)),
            ("the temperature of the disc", heat.map(|heat| heat.disc)),
            ("the number of airborne particles", emission.map(|emission| emission.number)),
        ];
        for (name, value) in parts {
            self.refuse_not_finite(value.into_iter(), |_| name.to_owned())?;
        }
        Ok(sample)
    }

    /// Keeps what the last step showed, which in a pause is reported again and again, and also by who goes on from a checkpoint
    /// of the pause.
    ///
    /// # Errors
    /// As [`Simulation::sample`].
    pub fn keep_contact(&mut self) -> Result<(), SimulationError> {
        if self.last_contact().is_none() {
            let [pressure] = self.fields([Map::Pressure])?;
            self.contact = Some(LastContact { sample: self.sample()?, pressure });
        }
        Ok(())
    }

    /// What is kept, if it is of the last step.
    fn last_contact(&self) -> Option<&LastContact> {
        self.contact.as_ref().filter(|contact| contact.sample.step == self.steps_done())
    }

    /// The same at a moment that the last step belongs to, with series on request. Each of those takes about as long as the
    /// maps that it is measured of.
    ///
    /// In a pause (model 9) without load nothing touches and there is no displacement; a pin that stands touches as in the
    /// step.
    ///
    /// # Errors
    /// As [`Simulation::sample`], of all quantities.
    pub fn sample_at(&mut self, moment: &Moment, extras: &[&Extra]) -> Result<Sample, SimulationError> {
        let mut sample = self.sample()?;
        if let (Some(cycle), Some(pause)) = (self.parameters.cycle.clone(), moment.pause) {
            let loaded = cycle.loaded_until(moment.time) - cycle.loaded_until(sample.time);
            sample.contact_area_integral += sample.contact_area * loaded;
            sample.sliding_distance = cycle.angle_at(moment.time) * self.parameters.mesh.mean_radius();
            sample.time = moment.time;
            sample.accounts = self.accounts_at(moment)?;
            if pause == Kind::Lifted {
                (sample.displacement, sample.contact_area, sample.contact_ratio) = (f64::NAN, 0.0, 0.0);
                (sample.mean_pressure, sample.max_pressure) = (0.0, 0.0);
            }
        }
        for extra in extras {
            let Some(request) = &extra.request else { continue };
            let maps = self.snapshot_at(moment, request.maps)?.maps;
            let fields: Vec<Vec<f64>> = maps.into_iter().map(|(_, values)| values.into_numbers()).collect();
            extra.record(&mut sample, (request.measure)(&self.parameters, &fields));
        }
        self.refuse_overflow(&sample, extras)?;
        Ok(sample)
    }

    /// Refuses a sample in which something is infinite, or an amount is no number that the model always has. A ratio may have
    /// nothing to be a ratio of; where nothing touches there is no displacement, no temperature of the contact.
    fn refuse_overflow(&self, sample: &Sample, extras: &[&Extra]) -> Result<(), SimulationError> {
        let of_accounts = [&dissipation::FRICTION, &dissipation::HEAT, &dissipation::EMISSION];
        let quantities = quantities(extras).chain(of_accounts.into_iter().flat_map(|extra| extra.quantities));
        let wrong = |quantity: &&Quantity| {
            let value = quantity.value(sample);
            let is_amount = ["m", "kg"].contains(&quantity.unit) || quantity.name == "particle_number";
            value.is_infinite()
                || (value.is_nan() && is_amount && quantity.name != "displacement" && quantity.is_of(sample))
        };
        let error = |quantity: &Quantity| SimulationError::NotFinite {
            step: self.steps_done(),
            what: format!("the {}", quantity.long_name),
            found: quantity.value(sample),
        };
        quantities.into_iter().find(wrong).map_or(Ok(()), |quantity| Err(error(quantity)))
    }

    /// Friction, heat and emission at a moment that the last step belongs to; none of them where the scene asks for none.
    ///
    /// # Errors
    /// [`SimulationError::Worker`] when a worker failed.
    pub fn accounts_at(&mut self, moment: &Moment) -> Result<AccountsReport, SimulationError> {
        let parameters = &self.parameters;
        if parameters.friction.is_none() && parameters.emission.is_none() {
            return Ok(AccountsReport::default());
        }
        let of = (self.steps_done(), moment.step, moment.pause.is_some());
        let accounts = match self.resting.take() {
            Some(resting) if resting.of == of && resting.until <= moment.time => Some(resting.accounts),
            _ => {
                let after = |accounts| Resting::new(accounts, moment.step, parameters.step_angle(), moment.pause);
                self.workers.accounts(parameters)?.map(after)
            }
        };
        let Some(mut accounts) = accounts else { return Ok(AccountsReport::default()) };
        let report = accounts.report(moment.time, moment.pause);
        self.resting = Some(LastMoment { of, until: moment.time, accounts });
        Ok(report)
    }

    /// The maps asked for, as they are now. Cells beyond the pin's outline are NaN, and have the status [`ABSENT`].
    ///
    /// # Errors
    /// [`SimulationError::Worker`] when a worker failed, [`SimulationError::NotWatched`] for pressures after
    /// [`Simulation::pass_to`], [`SimulationError::NotFinite`] when a value is no number.
    pub fn snapshot(&mut self, maps: &[Map]) -> Result<Snapshot, SimulationError> {
        let Course { steps, time, .. } = self.course();
        self.snapshot_at(&Moment { step: steps, time, ..Moment::default() }, maps)
    }

    /// The same at a moment that the last step belongs to: in a pause without load all pressures are 0.
    ///
    /// # Errors
    /// As [`Simulation::snapshot`].
    pub fn snapshot_at(&mut self, moment: &Moment, maps: &[Map]) -> Result<Snapshot, SimulationError> {
        let mut values = Vec::with_capacity(maps.len());
        for map in maps {
            let found = match map {
                Map::Pressure => MapValues::Float(self.pressures_at(moment)?),
                Map::Temperature => MapValues::Float(self.temperatures_at(moment)?),
                map => self.field(*map)?,
            };
            values.push((*map, self.outlined(*map, found)));
        }
        Ok(Snapshot { time: moment.time, maps: values })
    }

    /// A map in which the cells beyond the pin's outline are told from the others.
    fn outlined(&self, map: Map, mut values: MapValues) -> MapValues {
        if !map.on_disc() {
            for cell in self.parameters.mesh.absent_cells() {
                match &mut values {
                    MapValues::Float(values) => values[cell] = f64::NAN,
                    MapValues::Status(statuses) => statuses[cell] = ABSENT,
                }
            }
        }
        values
    }

    /// p of every pin cell at a moment, Pa; 0 beyond the pin's outline.
    fn pressures_at(&mut self, moment: &Moment) -> Result<Vec<f64>, SimulationError> {
        if moment.pause == Some(Kind::Lifted) {
            return Ok(vec![0.0; self.parameters.mesh.pin_cells()]);
        }
        match self.last_contact() {
            Some(contact) => Ok(contact.pressure.clone()),
            None => Ok(self.field(Map::Pressure)?.into_numbers()),
        }
    }

    /// T of every pin cell at a moment, K; no numbers where the pin is lifted, or no heat is reckoned.
    fn temperatures_at(&mut self, moment: &Moment) -> Result<Vec<f64>, SimulationError> {
        let pressure = self.pressures_at(moment)?;
        let AccountsReport { friction, heat, .. } = self.accounts_at(moment)?;
        let (Some(model), Some(friction), Some(heat)) = (HeatModel::of(&self.parameters), friction, heat) else {
            return Ok(vec![f64::NAN; pressure.len()]);
        };
        let speed = self.parameters.mean_speed_of(moment.step);
        let moves = moment.pause.is_none() && moment.step > 0;
        let flux =
            if moves { heat.share * friction.coefficient * speed * self.parameters.mesh.mean_radius() } else { 0.0 };
        Ok(map::temperatures(model.passing(), &self.parameters.mesh, &pressure, flux, heat.face, speed))
    }

    /// One map that the workers have; 0 beyond the pin's outline.
    fn field(&mut self, map: Map) -> Result<MapValues, SimulationError> {
        let found = self.workers.snapshot(&[map])?.maps.into_iter().next();
        let mut values = found.map_or(MapValues::Float(Vec::new()), |(_, values)| values);
        if !map.on_disc() {
            // What the workers keep there is their own affair.
            for cell in self.parameters.mesh.absent_cells() {
                match &mut values {
                    MapValues::Float(values) => values[cell] = 0.0,
                    MapValues::Status(statuses) => statuses[cell] = 0,
                }
            }
        }
        if let MapValues::Float(values) = &values {
            let name = |place| format!("cell {place} of {}", map.name());
            self.refuse_not_finite(values.iter().copied(), name)?;
        }
        Ok(values)
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

    /// The pin as it is now; heights beyond its outline are 0.
    ///
    /// # Errors
    /// [`SimulationError::Worker`] when a worker failed.
    pub fn pin(&mut self) -> Result<Pin, SimulationError> {
        let [height, substrate] = self.fields([Map::PinHeight, Map::PinSubstrate])?;
        Ok(Pin { height, substrate, base: self.pin_base.clone() })
    }

    fn fields<const COUNT: usize>(&mut self, maps: [Map; COUNT]) -> Result<[Vec<f64>; COUNT], SimulationError> {
        let mut fields = [const { Vec::new() }; COUNT];
        for (field, map) in fields.iter_mut().zip(maps) {
            *field = self.field(map)?.into_numbers();
        }
        Ok(fields)
    }

    /// The complete state, to go on from later.
    ///
    /// # Errors
    /// [`SimulationError::Worker`] when a worker failed, [`SimulationError::NotFinite`] when a height is no number.
    pub fn checkpoint(&mut self) -> Result<Checkpoint, SimulationError> {
        let [disc_height, disc_substrate] = self.fields([Map::DiscHeight, Map::DiscSubstrate])?;
        let [pin_height, pin_substrate] = self.fields([Map::PinHeight, Map::PinSubstrate])?;
        let (memory, engine) = self.workers.memory()?;
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
        let contact = self.last_contact().cloned();
        let heights = Heights { disc_height, disc_substrate, pin_height, pin_substrate };
        Ok(Checkpoint { heights, contact, memory, engine })
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
