//! Samples and maps of a simulation (model section 5).

use crate::material::Status;
use crate::observe::{Map, MapValues, Sample, Snapshot};
use crate::simulation::Simulation;

impl Simulation {
    /// t, s.
    pub fn time(&self) -> f64 {
        self.parameters.time_at(self.step)
    }

    /// The reported quantities after the last step.
    pub fn sample(&mut self) -> Sample {
        let mesh = &self.parameters.mesh;
        self.filling.update(mesh, &self.disc, self.first_step + self.step);
        let contact_area = self.contact.area(mesh);
        let coverage = self.pin_coverage();
        let totals = self.debris.totals();
        Sample {
            step: self.step,
            time: self.time(),
            displacement: self.contact.displacement(),
            contact_area,
            contact_area_mean: self.history.revolution_mean(),
            contact_area_integral: self.history.integral(),
            sliding_distance: self.time() * self.parameters.angular_velocity * mesh.mean_radius(),
            contact_ratio: contact_area / mesh.pin_area(),
            mean_pressure: if contact_area > 0.0 { self.contact.load() / contact_area } else { 0.0 },
            max_pressure: self.contact.pressures(mesh).fold(0.0, f64::max),
            worn_pin: totals.worn_pin.value(),
            worn_resin: totals.worn_resin.value(),
            worn_disc: totals.worn_disc.value(),
            // Rounding may leave a trace of debt in an emptied pool; the balance residual takes it as it is.
            pool: self.debris.pool().max(0.0),
            emitted: totals.emitted.value(),
            deposited_pin: totals.deposited_pin.value(),
            deposited_disc: totals.deposited_disc.value(),
            returned: totals.returned.value(),
            pin_none: coverage[Status::None as usize],
            pin_primary: coverage[Status::Primary as usize],
            pin_secondary: coverage[Status::Secondary as usize],
            disc_secondary: self.filling.secondary_fraction(mesh),
            filled_fraction: self.filling.filled_fraction(),
            load_residual: self.contact.residual(),
            balance_residual: self.debris.balance_residual(),
        }
    }

    /// Area fraction of the pin by status.
    fn pin_coverage(&self) -> [f64; 3] {
        let mesh = &self.parameters.mesh;
        let mut coverage = [0.0; 3];
        for (status, area) in self.pin.statuses().zip(mesh.area().iter().cycle()) {
            coverage[status as usize] += area;
        }
        coverage.map(|area| area / mesh.pin_area())
    }

    /// The maps asked for, as they are now.
    pub fn snapshot(&self, maps: &[Map]) -> Snapshot {
        let values = |map| match map {
            Map::DiscHeight => MapValues::Float(self.disc.height.clone()),
            Map::DiscSubstrate => MapValues::Float(self.disc.substrate.clone()),
            Map::DiscStatus => MapValues::Status(self.disc.statuses().map(|status| status as u8).collect()),
            Map::PinHeight => MapValues::Float(self.pin.height.clone()),
            Map::PinSubstrate => MapValues::Float(self.pin.substrate.clone()),
            Map::PinStatus => MapValues::Status(self.pin.statuses().map(|status| status as u8).collect()),
            Map::Pressure => MapValues::Float(self.contact.pressures(&self.parameters.mesh).collect()),
        };
        Snapshot { time: self.time(), maps: maps.iter().map(|map| (*map, values(*map))).collect() }
    }
}
