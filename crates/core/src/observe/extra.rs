//! Series that not every run has: their type, their table, and the functions that measure them.

use crate::model::brake::Brake;
use crate::model::mesh::Mesh;
use crate::model::parameters::Parameters;
use crate::observe::map::Map;
use crate::observe::sample::{QUANTITIES, Quantity, Sample};
use crate::surface::Body;

/// A series that not every run has.
#[derive(Debug, Clone, Copy)]
pub struct Extra {
    /// Name; of one on request that of its switch, `output.NAME` in a scene.
    pub name: &'static str,
    /// Quantities that are written with every sample.
    pub quantities: &'static [Quantity],
    /// Request by a switch, with its measurement; none where a run has it for another reason.
    pub request: Option<Request>,
    /// Needs of the series in a scene, in words, besides a switch; empty where it has none.
    pub needs: &'static str,
}

/// A series on request.
#[derive(Debug, Clone, Copy)]
pub struct Request {
    /// Name in words, as in "roughness with every sample".
    pub what: &'static str,
    /// Meaning of its switch.
    pub meaning: &'static str,
    /// Fields that it is measured of; gathering them is its cost.
    pub maps: &'static [Map],
    /// Measures it of these fields, column by column: one value for each quantity.
    pub measure: fn(&Parameters, &[Vec<f64>]) -> Vec<f64>,
}

impl Extra {
    /// Adds the values of its quantities to a sample.
    pub fn record(&self, sample: &mut Sample, values: impl IntoIterator<Item = f64>) {
        sample.extras.extend(self.quantities.iter().map(|quantity| quantity.name).zip(values));
    }
}

impl PartialEq for Extra {
    fn eq(&self, other: &Self) -> bool {
        self.name == other.name
    }
}

/// The table of series that not every run has, in the order of a run file. Scenes (`output.NAME`), run files, exports,
/// figures and documents follow from its entries.
pub const EXTRAS: &[&Extra] = &[
    &ROUGHNESS,
    &PRESSURE_SPREAD,
    &CONTACT_TEMPERATURE,
    &ACCELERATION,
    &CYCLE,
    &ROAD,
    &FRICTION,
    &HEAT,
    &EMISSION,
    &PADS,
    &PADS_ON_ROAD,
    &BRAKE_TORQUE,
    &BRAKE_EMISSION,
    &EMISSION_ON_ROAD,
];

/// Quantities, a row each: name, unit and meaning; behind `part.field =>` where it is one of the accounts, which a run without that part has not.
macro_rules! quantities {
    ($($($part:ident . $field:ident =>)? $name:literal, $unit:literal, $long_name:literal;)*) => {
        &[$(quantities!(@ $($part . $field)?; $name, $unit, $long_name)),*]
    };
    (@; $name:literal, $unit:literal, $long_name:literal) => { Quantity::extra($name, $unit, $long_name) };
    (@ $part:ident . $field:ident; $name:literal, $unit:literal, $long_name:literal) => {
        Quantity::of($name, $unit, $long_name, |sample| sample.accounts.$part.map(|part| part.$field))
    };
}

/// The acceleration at the end of a step, in a run that chooses it.
pub const ACCELERATION: Extra = Extra {
    name: "acceleration",
    quantities: quantities! {
        "time_acceleration", "1", "revolutions that one simulated revolution stands for";
        "acceleration_error", "1", "estimate of the relative error of the contact area that the time acceleration causes";
    },
    request: None,
    needs: "a time acceleration that the run chooses, numerics.time_acceleration = { tolerance = 0.01, max = 1000 }",
};

/// Load, speed and the time in contact; [`Cycle::operation_at`](crate::model::cycle::Cycle::operation_at) and
/// [`Cycle::contact_time_until`](crate::model::cycle::Cycle::contact_time_until) give their values.
pub const CYCLE: Extra = Extra {
    name: "cycle",
    quantities: quantities! {
        "normal_force", "N", "normal force on the simulated pin in the step, mean over its angle";
        "rotational_speed", "rad s-1", "rotational speed of the disc at the end of the step";
        "contact_time", "s", "time since the first step in which the pin was not lifted";
    },
    request: None,
    needs: "a cycle, table [operation.cycle]",
};

/// Distance that the vehicle has travelled, m, where its speed is given.
pub const ROAD: Extra = Extra {
    name: "road",
    quantities: quantities! {
        "road_distance", "m", "distance that the vehicle has travelled";
    },
    request: None,
    needs: "a cycle with the speed on the road, column road_speed",
};

/// The series on request: those whose switch, by its name, is on.
pub fn requested<E>(is_on: impl Fn(&str) -> Result<bool, E>) -> Result<Vec<&'static Extra>, E> {
    let mut extras = Vec::new();
    for extra in EXTRAS.iter().copied().filter(|extra| extra.request.is_some()) {
        if is_on(extra.name)? {
            extras.push(extra);
        }
    }
    Ok(extras)
}

/// The series of a run file but the time, with these besides those of every run.
pub fn quantities(extras: &[&Extra]) -> impl Iterator<Item = &'static Quantity> {
    QUANTITIES.iter().chain(extras.iter().flat_map(|extra| extra.quantities))
}

/// Roughness of both bodies while they wear (ISO 25178-2:2021, 4.2), with every sample, peaks positive on either: of the whole ring,
/// since all of it passes under the pin, and of the whole pin.
pub const ROUGHNESS: Extra = Extra {
    name: "roughness",
    quantities: quantities! {
        "disc_sa", "m", "arithmetical mean height Sa of the disc";
        "disc_sq", "m", "root-mean-square height Sq of the disc";
        "disc_ssk", "1", "skewness Ssk of the disc heights";
        "disc_sku", "1", "kurtosis Sku of the disc heights";
        "pin_sa", "m", "arithmetical mean height Sa of the pin";
        "pin_sq", "m", "root-mean-square height Sq of the pin";
        "pin_ssk", "1", "skewness Ssk of the pin heights, peaks toward the disc";
        "pin_sku", "1", "kurtosis Sku of the pin heights";
    },
    request: Some(Request {
        what: "roughness",
        meaning: "whether Sa, Sq, Ssk and Sku of disc and pin are written with every sample",
        maps: &[Map::DiscHeight, Map::PinHeight],
        measure: |parameters, heights| {
            let of = |body: Body, heights| {
                let [sa, sq, ssk, sku] = height_parameters(&parameters.mesh, heights);
                [sa, sq, body.peak_sign() * ssk, sku]
            };
            [of(Body::Disc, &heights[0]), of(Body::Pin, &heights[1])].concat()
        },
    }),
    needs: "",
};

/// Sa, Sq, Ssk and Sku of heights of every cell of disc or pin, m, column by column, peaks positive: Sa = Σ A |z − z̄| / Σ A,
/// Sq = √(Σ A (z − z̄)² / Σ A), Ssk = Σ A (z − z̄)³ / Σ A / Sq³, Sku = Σ A (z − z̄)⁴ / Σ A / Sq⁴. Where all heights are equal the
/// last two are NaN.
///
/// A cell counts with its area, which differs from row to row, and heights are measured from the mean so weighted;
/// nothing else is taken out: that the track runs in as a groove is part of it. Cells beyond the pin's outline, whose height is
/// NaN, do not count. The sums are taken in the order of the mesh,
/// column by column: their bits do not depend on how a simulation is carried out.
fn height_parameters(mesh: &Mesh, heights: &[f64]) -> [f64; 4] {
    let columns = heights.len() / mesh.rows();
    let is_there = |height: &f64| !height.is_nan();
    let is_whole = mesh.is_rectangle() || heights.iter().all(is_there);
    let area = if is_whole { columns as f64 * mesh.column_area() } else { mesh.pin_area() };
    let mean_of = |terms: &dyn Fn(f64) -> [f64; 4]| {
        let mut sums = [0.0; 4];
        for column in heights.chunks_exact(mesh.rows()) {
            let mut own = [0.0; 4];
            for (height, area) in column.iter().zip(mesh.area()).filter(|(height, _)| is_there(height)) {
                own.iter_mut().zip(terms(*height)).for_each(|(sum, term)| *sum += area * term);
            }
            sums.iter_mut().zip(own).for_each(|(sum, own)| *sum += own);
        }
        sums.map(|sum| sum / area)
    };
    let [first, ..] = mean_of(&|height| [height, 0.0, 0.0, 0.0]);
    // What rounding left of the mean the first time; not added to it, which would round it again.
    let [rest, ..] = mean_of(&|height| [height - first, 0.0, 0.0, 0.0]);
    let [absolute, square, cube, fourth] = mean_of(&|height| {
        let z = (height - first) - rest;
        [z.abs(), z * z, z * z * z, z * z * z * z]
    });
    let root_mean_square_height = square.sqrt();
    let mut there = heights.iter().filter(|height| is_there(height));
    let flat = there.next().is_none_or(|first| there.all(|height| height == first));
    // What is no number though there are heights has become too large on the way.
    let relative = |moment: f64| match flat || square == 0.0 {
        true => f64::NAN,
        false if moment.is_nan() => f64::INFINITY,
        false => moment,
    };
    [
        absolute,
        root_mean_square_height,
        relative(cube / (square * root_mean_square_height)),
        relative(fourth / (square * square)),
    ]
}

/// √(Σ A (z − z̄_i)² / Σ A) of the disc's cells, m, heights being measured from the mean z̄_i of their own track (row).
pub(crate) fn root_mean_square_along_tracks(mesh: &Mesh, heights: &[f64]) -> f64 {
    let columns = heights.len() / mesh.rows();
    let sum_of_tracks = |add: &dyn Fn(usize, f64) -> f64| {
        let mut sums = vec![0.0; mesh.rows()];
        for column in heights.chunks_exact(mesh.rows()) {
            sums.iter_mut().zip(column).enumerate().for_each(|(row, (sum, height))| *sum += add(row, *height));
        }
        sums
    };
    let mean: Vec<f64> = sum_of_tracks(&|_, height| height).iter().map(|sum| sum / columns as f64).collect();
    let squares = sum_of_tracks(&|row, height| (height - mean[row]).powi(2));
    let weighted: f64 = squares.iter().zip(mesh.area()).map(|(square, area)| square * area).sum();
    (weighted / (columns as f64 * mesh.column_area())).sqrt()
}

/// The spread of the pressures with every sample.
pub const PRESSURE_SPREAD: Extra = Extra {
    name: "pressure_spread",
    quantities: quantities! {
        "pressure_variation", "1", "coefficient of variation of the pressure over the cells in contact";
        "pressure_gini", "1", "Gini coefficient of the pressure over the cells in contact";
    },
    request: Some(Request {
        what: "spread of the pressure",
        meaning: "whether the coefficient of variation and the Gini coefficient of the pressure are written with every sample",
        maps: &[Map::Pressure],
        measure: |parameters, pressures| spread(&parameters.mesh, &pressures[0]).to_vec(),
    }),
    needs: "",
};

/// Coefficient of variation and Gini coefficient of the pressures (Pa) of the cells in contact, each counted with its area; of no
/// cell NaN. A cell that is not in contact has the pressure 0.
///
/// The first is the standard deviation over the mean, 0 where all pressures are equal. The second is the mean difference of the
/// pressures of two pieces of the contact area over twice the mean pressure: 0 where all are equal, nearly 1 where a small
/// part carries nearly all.
fn spread(mesh: &Mesh, pressures: &[f64]) -> [f64; 2] {
    let cells = pressures.iter().zip(mesh.area().iter().cycle());
    let mut touching: Vec<(f64, f64)> =
        cells.filter(|(pressure, _)| **pressure > 0.0).map(|(pressure, area)| (*pressure, *area)).collect();
    touching.sort_by(|one, other| one.0.total_cmp(&other.0));
    let sum = |term: &dyn Fn(f64) -> f64| touching.iter().map(|(pressure, area)| term(*pressure) * area).sum::<f64>();
    let (area, force) = (sum(&|_| 1.0), sum(&|pressure| pressure));
    let mean = force / area;
    let variance = sum(&|pressure| (pressure - mean) * (pressure - mean)) / area;
    // The area below the Lorenz curve: force of all that is pressed less, against area.
    let (mut carried, mut below) = (0.0, 0.0);
    for (pressure, cell) in &touching {
        let own = pressure * cell;
        below += (carried + 0.5 * own) * cell;
        carried += own;
    }
    [variance.sqrt() / mean, 1.0 - 2.0 * below / (area * force)]
}

/// Coefficient and work of friction, with `[friction]`.
pub const FRICTION: Extra = Extra {
    name: "friction",
    quantities: quantities! {
        friction.coefficient => "friction_coefficient", "1", "coefficient of friction";
        friction.coefficient_mean => "friction_coefficient_mean", "1",
            "coefficient of friction, mean over the last simulated revolution, weighted by load";
        friction.work => "friction_work", "J", "work of friction of the simulated pin";
    },
    request: None,
    needs: "a law of friction, table [friction]",
};

/// Temperatures and balance of heat, with `[thermal]`.
pub const HEAT: Extra = Extra {
    name: "heat",
    quantities: quantities! {
        heat.contact => "contact_temperature", "K", "temperature of the contact";
        heat.disc => "disc_temperature", "K", "mean temperature of the disc";
        heat.pin => "pin_temperature", "K", "mean temperature of the pin";
        heat.lost => "heat_lost", "J", "heat lost to the air and the holder of the simulated pin";
        heat.residual => "heat_residual", "1", "relative residual of the energy balance";
    },
    request: None,
    needs: "heat, table [thermal]",
};

/// Airborne emission of the simulated pin, with `[emission]`.
pub const EMISSION: Extra = Extra {
    name: "emission",
    quantities: quantities! {
        emission.mass => "emitted_mass", "kg", "mass of the debris that left the contact of the simulated pin";
        emission.pm10 => "pm10_mass", "kg", "mass of it that is airborne as PM10, of the simulated pin";
        emission.pm25 => "pm25_mass", "kg", "mass of it that is airborne as PM2.5, of the simulated pin";
        emission.number => "particle_number", "1", "number of airborne particles of the simulated pin";
    },
    request: None,
    needs: "airborne emission, table [emission]",
};

/// Wear of the pads, with `[brake]`.
pub const PADS: Extra = Extra {
    name: "pads",
    quantities: quantities! {
        "pad_wear", "m", "thickness that the pads have lost, mean over their area";
    },
    request: None,
    needs: "a brake, table [brake]",
};

/// Braking torque, with `[brake]` and `[friction]`.
pub const BRAKE_TORQUE: Extra = Extra {
    name: "brake_torque",
    quantities: quantities! {
        "brake_torque", "N m", "braking torque of the whole brake";
    },
    request: None,
    needs: "a brake and a law of friction, tables [brake] and [friction]",
};

/// Airborne emission of the whole brake, with `[brake]` and `[emission]`.
pub const BRAKE_EMISSION: Extra = Extra {
    name: "brake_emission",
    quantities: quantities! {
        "brake_emitted_mass", "kg", "mass of the debris that left the whole brake: what pads and disc have lost";
        "brake_pm10_mass", "kg", "mass of it that is airborne as PM10, of the whole brake";
        "brake_pm25_mass", "kg", "mass of it that is airborne as PM2.5, of the whole brake";
        "brake_particle_number", "1", "number of airborne particles of the whole brake";
    },
    request: None,
    needs: "a brake and airborne emission, tables [brake] and [emission]",
};

/// Wear of the pads over the distance of the vehicle, with `[brake]` and the speed on the road.
pub const PADS_ON_ROAD: Extra = Extra {
    name: "pads_on_road",
    quantities: quantities! {
        "pad_wear_per_distance", "1", "thickness that the pads have lost over the distance of the vehicle";
        "pad_life", "m", "distance of the vehicle after which the pads are worn down at that rate";
    },
    request: None,
    needs: "a brake and a cycle with the speed on the road, table [brake] and column road_speed",
};

/// Emission of the brake over the distance of the vehicle, with `[brake]`, `[emission]` and the speed on the road.
pub const EMISSION_ON_ROAD: Extra = Extra {
    name: "emission_on_road",
    quantities: quantities! {
        "brake_emitted_per_distance", "kg m-1", "mass that the whole brake lost over the distance of the vehicle";
        "brake_pm10_per_distance", "kg m-1", "PM10 of the whole brake over the distance of the vehicle";
        "brake_pm25_per_distance", "kg m-1", "PM2.5 of the whole brake over the distance of the vehicle";
        "brake_particles_per_distance", "m-1", "particles of the whole brake over the distance of the vehicle";
    },
    request: None,
    needs: "a brake, airborne emission and a cycle with the speed on the road, tables [brake] and [emission] and column road_speed",
};

/// The series of a brake.
pub const OF_BRAKES: &[&Extra] = &[&PADS, &PADS_ON_ROAD, &BRAKE_TORQUE, &BRAKE_EMISSION, &EMISSION_ON_ROAD];

/// Adds the values of the series of a brake to a sample of the pin of a mesh, which is pressed with a force (N) at a rotational speed (rad/s),
/// and whose vehicle has come a distance (m). What the scene does not have is NaN, as is the torque that holds a disc at rest.
pub fn record_brake(brake: &Brake, mesh: &Mesh, [force, speed]: [f64; 2], distance: f64, sample: &mut Sample) {
    let pad_wear = sample.lost_pin() / mesh.pin_area();
    let per_distance = |total: f64| total / distance;
    PADS.record(sample, [pad_wear]);
    PADS_ON_ROAD.record(sample, [per_distance(pad_wear), brake.pad_thickness / per_distance(pad_wear)]);
    if let Some(friction) = sample.accounts.friction {
        let friction_force = match (force, speed) {
            // Where nothing presses, there is no coefficient.
            (0.0, _) => 0.0,
            (_, 0.0) => f64::NAN,
            _ => friction.coefficient * force,
        };
        BRAKE_TORQUE.record(sample, [brake.torque(friction_force, mesh)]);
    }
    if let Some(emission) = sample.accounts.emission {
        let of_brake =
            [emission.mass, emission.pm10, emission.pm25, emission.number].map(|of_pin| of_pin / brake.share(mesh));
        BRAKE_EMISSION.record(sample, of_brake);
        EMISSION_ON_ROAD.record(sample, of_brake.map(per_distance));
    }
}

/// Mean and largest contact temperature, K, over its map, which is written, too.
pub const CONTACT_TEMPERATURE: Extra = Extra {
    name: "contact_temperature",
    quantities: quantities! {
        "contact_temperature_heated", "K", "temperature of the cells in contact, mean over their area, pressures frozen during the pass";
        "contact_temperature_max", "K", "largest temperature of any pin cell, pressures frozen during the pass";
    },
    request: Some(Request {
        what: "contact temperatures and their map",
        meaning: "whether the temperature of every cell of the contact is reckoned with every sample, and written with the maps; needs [thermal]",
        maps: &[Map::Pressure, Map::Temperature],
        measure: heated_and_largest,
    }),
    needs: "heat, table [thermal]",
};

/// Mean over the area of the cells in contact, and the largest of all, K; no number where nothing touches.
fn heated_and_largest(parameters: &Parameters, fields: &[Vec<f64>]) -> Vec<f64> {
    let [pressure, temperature] = fields else { return vec![f64::NAN; 2] };
    let cells = pressure.iter().zip(temperature).zip(parameters.mesh.area().iter().cycle());
    let (mut heat, mut area_in_contact) = (0.0, 0.0);
    for ((_, temperature), area) in cells.filter(|((pressure, _), _)| **pressure > 0.0) {
        heat += temperature * area;
        area_in_contact += area;
    }
    let largest = temperature.iter().copied().fold(f64::NAN, f64::max);
    vec![heat / area_in_contact, largest]
}
