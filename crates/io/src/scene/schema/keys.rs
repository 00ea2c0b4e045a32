//! Table of all keys: name, kind, default, meaning and role of each, in the order of docs/scenes.md.
//!
//! Keys of the mesh, of the parts that a table switches on (friction, heat, emission), of heights and of their preparation are added by
//! functions of their own.

use plateau_core::observe::EXTRAS;

use super::choices::{self, words};
use super::key::{Choose, Key, Kind, Need, Range, Role};
use crate::units::Dimension::{
    self, Angle, Area, Cooling, CoolingPerSpeed, Density, Force, Length, NumberPerMass, Pressure, RotationalSpeed,
    SpecificHeat, SpecificWearRate, Speed, Temperature, ThermalConductivity, Time, Torque,
};
use Kind::{Bool, Choice, CountOr, InputFile, Integer, LengthUnit, Maps, Number, NumberOr, Rows, Text, Times, True};
use Need::{Computed, Default, OfWay, OneOf, Optional, Required, RequiredUnless, SameAs};

/// Collects keys; `section` is the table to which the next ones belong, `role` what they change.
struct Table {
    keys: Vec<Key>,
    section: &'static str,
    role: Role,
}

/// Adds keys to a table, a row each: name, kind, need, meaning, and the role where that is not the table's.
macro_rules! keys {
    ($table:expr; $($name:expr, $kind:expr, $need:expr, $meaning:expr $(, $role:expr)?;)*) => {
        $($table.keys.push(Key {
            section: $table.section,
            name: $name,
            kind: $kind,
            need: $need,
            meaning: $meaning,
            role: keys!(@role $table $(, $role)?),
        });)*
    };
    (@role $table:expr, $role:expr) => { $role };
    (@role $table:expr) => { $table.role };
}

/// The words of a choice, as the kind of its key.
macro_rules! choice {
    ($choices:ident) => {
        Choice(&const { words(&choices::$choices) })
    };
}

/// A quantity that the resolved scene has in this unit.
const fn quantity(dimension: Dimension, unit: &'static str, range: Range) -> Kind {
    Kind::Quantity { dimension, unit, range }
}

const fn positive(dimension: Dimension, unit: &'static str) -> Kind {
    quantity(dimension, unit, Range::POSITIVE)
}

const fn not_negative(dimension: Dimension, unit: &'static str) -> Kind {
    quantity(dimension, unit, Range::NOT_NEGATIVE)
}

/// Full path of the key of m: a number, or a table with how the run chooses it.
pub(crate) const ACCELERATION: &str = "numerics.time_acceleration";
/// Name of the key of a braking torque, in the table of the operation and as a column of a cycle.
pub(crate) const BRAKING_TORQUE: &str = "braking_torque";
/// Full path of the table of the cycle.
pub(crate) const CYCLE: &str = "operation.cycle";

/// Keys that name the columns of a cycle in a file with headers of its own.
pub(crate) const CYCLE_COLUMNS: &[&str] = &[
    "cycle.columns.time",
    "cycle.columns.normal_force",
    "cycle.columns.nominal_pressure",
    "cycle.columns.braking_torque",
    "cycle.columns.brake_torque",
    "cycle.columns.brake_pressure",
    "cycle.columns.rotational_speed",
    "cycle.columns.sliding_speed",
    "cycle.columns.road_speed",
];

/// Debris goes into the gap behind the cell that wears, and there is no pool.
pub(super) const DEBRIS_IS_LOCAL: Choose = Choose { key: "plateaus.debris", value: "local" };
pub(super) const PIN_IS_ROUND: Choose = Choose { key: "mesh.shape", value: "disc" };
/// A pin that covers all its rows and columns.
pub(super) const PIN_IS_A_RECTANGLE: Choose = Choose { key: "mesh.shape", value: "rectangle" };

const POISSON_RATIO: Range = Range::new(-1.0, false, 0.5, true);
const ABOVE_0_TO_1: Range = Range::new(0.0, false, 1.0, true);
const BETWEEN_0_AND_1: Range = Range::new(0.0, false, 1.0, false);
const ABOVE_1: Range = Range::new(1.0, false, f64::INFINITY, false);
const AT_LEAST_1: Range = Range::new(1.0, true, f64::INFINITY, false);

/// Every key, in the order of docs/scenes.md.
pub(super) fn all() -> Vec<Key> {
    let mut table = Table { keys: Vec::new(), section: "", role: Role::Nothing };
    keys! { table;
        "version", Integer(1), Required, "version of the scene format: 1";
        "title", Text, Computed("the scene file's name"), "title of the run";
        "extends", Text, Optional, "scene that this one takes as its base, relative to this file";
    }

    table.role = Role::Physics;
    table.mesh();

    table.section = "operation";
    keys! { table;
        "normal_force", positive(Force, "N"), OneOf, "force that presses the pin on the disc";
        BRAKING_TORQUE, positive(Torque, "N m"), OneOf, "torque of friction on the pin, for which it is pressed as hard as it takes";
        "rotational_speed", positive(RotationalSpeed, "rpm"), OneOf, "rotational speed of the disc";
        "sliding_speed", positive(Speed, "m/s"), OneOf, "sliding speed at the mean radius";
        "duration", positive(Time, "s"), OneOf, "physical time to simulate", Role::Length;
        "steps", Integer(1), OneOf, "steps to simulate, each by one column of cells", Role::Length;
        "cycle.file", InputFile, OneOf,
            "load and speed over time: .csv whose header has units, such as time [s], normal_force [N], rotational_speed [rpm]";
    }
    for name in CYCLE_COLUMNS {
        keys! { table; name, Text, Optional, "its header in the file"; }
    }
    keys! { table;
        "cycle.points", Rows, OneOf, "the same in the scene: rows of time, load and speed";
        "cycle.interpolation", choice!(INTERPOLATION), Default("\"linear\""),
            "what is between two rows: straight lines, or the values of the first";
        "cycle.repeat", Integer(1), Default("1"), "how many times the rows are played";
        "cycle.force_scale", Number(Range::POSITIVE), Default("1"), "factor of every load of the cycle";
        "cycle.speed_scale", Number(Range::POSITIVE), Default("1"), "factor of every speed of the cycle";
    }

    table.section = "contact";
    keys! { table;
        "foundation_height", positive(Length, "um"), Required, "height h of the elastic foundation, which is E*/h stiff per area";
        "load_tolerance", Number(BETWEEN_0_AND_1), Default("1e-9"), "accepted |sum k A u - F| / F", Role::Nothing;
    }

    table.material("materials.disc_primary", None);
    table.material("materials.disc_secondary", Some("materials.disc_primary"));
    table.material("materials.pin_primary", None);
    table.wear_by_counterface();
    table.material("materials.pin_secondary", Some("materials.pin_primary"));
    table.wear_by_counterface();
    keys! { table;
        "strength", positive(Pressure, "Pa"), Optional, "pressure above which build-up on resin breaks away";
    }
    table.section = "materials.pin_resin";
    table.elasticity(Required);
    keys! { table;
        "wear_height", not_negative(Length, "um"), Required, "height that resin loses in a step in which it touches";
    }

    table.section = "plateaus";
    keys! { table;
        "debris", choice!(DEBRIS), Computed("`\"contact\"`"),
            "where wear debris goes: into the gap behind the cell that wears, into a pool, or into one for each row of cells";
        "debris_pool", choice!(DEBRIS_POOL), Optional, "the former name of `debris`, for the two pools";
        "captured_fraction", Number(Range::FRACTION), RequiredUnless(DEBRIS_IS_LOCAL, "1"),
            "fraction of the wear debris that may stay in the contact; the rest leaves";
        "captured_resin_fraction", Number(Range::FRACTION), Optional, "the same of what wears off resin, where that is another";
        "pad_share", Number(Range::FRACTION), Default("0.5"), "pin's share of a deposit on both surfaces, with a pool";
        "transport_length", positive(Length, "um"), Optional,
            "how far local debris is gathered and spread, so that results do not depend on the cell; without it one cell";
        "formation", Bool, Default("true"), "whether plateaus form at all";
        "destruction", Bool, Default("true"), "whether unsupported plateaus of the pin break up, with a pool";
    }

    table.brake();
    table.friction();
    table.thermal();
    table.emission();

    table.section = "disc.surface";
    table.heights();
    table.section = "disc.prepare";
    table.preparation();

    table.section = "pin.base";
    keys! { table;
        "synthetic.seed", Integer(0), Default("0"), "seed of the random fibres";
        "synthetic.fibre_fraction", Number(Range::FRACTION), Required, "area fraction that is fibre";
        "synthetic.fibre_length", positive(Length, "um"), Required, "length of a fibre from end to end";
        "synthetic.fibre_width", positive(Length, "um"), Required, "width of a fibre";
        "image", InputFile, OneOf, "micrograph of the pin: PNG, TIFF, JPEG";
        "pixel", positive(Length, "um"), Optional, "distance of the image's pixels; required beside it";
        "rotate", choice!(ROTATE), Computed("`\"0 deg\"`"), "how far the image is turned, counterclockwise";
        "smooth", not_negative(Length, "um"), Optional, "standard deviation of a Gaussian over the image";
        "threshold", NumberOr(Range::FRACTION, "otsu"), Computed("`\"otsu\"`"),
            "grey level, black 0 to white 1, that parts fibre and resin";
        "fibres", choice!(FIBRES), Computed("`\"bright\"`"), "which side of the threshold is fibre";
        "despeckle", not_negative(Area, "um^2"), Optional, "area below which specks of fibre, then holes in it, are removed";
        "repeat", Bool, Computed("`false`"), "whether the image is tiled over the pin, mirrored from tile to tile";
        "extend", choice!(EXTEND), Optional, "random fibres with fraction and correlation of the image in place of the image itself";
        "extend_seed", Integer(0), Computed("`0`"), "seed of the random fibres of `extend`";
        "file", InputFile, OneOf, "HDF5 file with the fibre map";
        "dataset", Text, Optional, "dataset in the file: integers, 0 none, 1 primary, shape (pin_columns, rows)";
        "uniform", choice!(UNIFORM), OneOf, "all cells alike: fibre or resin";
        "mirror", Bool, Default("false"), "whether the map is a view of the pin's face, to be mirrored";
    }

    table.section = "pin.surface";
    table.heights();
    keys! { table;
        "resin_recess", quantity(Length, "um", Range::ANY), Default("\"0 um\""), "added to the height of cells without fibre";
    }
    table.section = "pin.prepare";
    table.preparation();

    table.role = Role::Numerics;
    table.section = "numerics";
    keys! { table;
        "time_acceleration", Number(AT_LEAST_1), Default("1"), "revolutions that one simulated revolution stands for";
        "time_acceleration.tolerance", Number(BETWEEN_0_AND_1), Required,
            "relative error of the contact area, as estimated, that the acceleration may cause";
        "time_acceleration.max", Number(AT_LEAST_1), Required, "largest acceleration that the run chooses";
        "integrator", choice!(INTEGRATOR), Default("\"explicit\""),
            "how much a step wears; exponential is stable for any step, docs/model.md";
        "workers", CountOr("auto"), Default("1"), "threads that share the ring", Role::Nothing;
        "decomposition", choice!(DECOMPOSITION), Optional,
            "what each of several workers has: angular sectors, bands of rows, or whichever is faster", Role::Nothing;
    }

    table.role = Role::Series;
    table.section = "output";
    keys! { table;
        "file", Text, Computed("the scene file's name with .h5"), "run file, relative to the working directory", Role::Nothing;
        "sample_every", positive(Time, "s"), OneOf, "physical time between samples";
        "sample_every_steps", Integer(1), Computed("one revolution, unless sample_every is given"), "steps between samples";
        "maps_at", Times, Default("[]"), "physical times of maps; the last state is always written", Role::MapTimes;
        "maps", Maps, Computed("all seven"), "maps that are written", Role::Maps;
    }
    for extra in EXTRAS {
        if let Some(request) = &extra.request {
            keys! { table; extra.name, Bool, Default("false"), request.meaning; }
        }
    }
    keys! { table;
        "checkpoint_every", positive(Time, "s"), Default("\"60 s\""),
            "wall time between two checkpoints, from which a run that was stopped or killed goes on", Role::Nothing;
    }
    table.keys
}

impl Table {
    fn elasticity(&mut self, need: Need) {
        keys! { self;
            "youngs_modulus", positive(Pressure, "Pa"), need, "Young's modulus";
            "poisson_ratio", Number(POISSON_RATIO), need, "Poisson's ratio";
        }
    }

    fn material(&mut self, section: &'static str, like: Option<&'static str>) {
        self.section = section;
        let need = like.map_or(Required, SameAs);
        self.elasticity(need);
        keys! { self;
            "specific_wear_rate", not_negative(SpecificWearRate, "1/Pa"), need, "worn volume per force and sliding distance";
        }
    }

    fn wear_by_counterface(&mut self) {
        keys! { self;
            "wear_rate_against_secondary", not_negative(SpecificWearRate, "1/Pa"), Optional,
                "the same on build-up of the disc, where that is another";
        }
    }

    fn mesh(&mut self) {
        self.section = "mesh";
        let millimetres = positive(Length, "mm");
        let needed = OfWay(None);
        keys! { self;
            "inner_radius", millimetres, needed, "inner radius of the ring";
            "outer_radius", millimetres, needed, "outer radius of the ring";
            "rows", Integer(1), needed, "cells along the radius";
            "disc_columns", Integer(1), needed, "cells around the ring";
            "pin_columns", Integer(1), needed, "cells that the pin covers along the ring, at most disc_columns";
            "pin_diameter", millimetres, Optional,
                "diameter of a round pin in the middle of these rows and columns; required there with shape = \"disc\"";
            "pin_width", millimetres, needed, "width of the pin along the radius; of a round pin its diameter";
            "pin_length", millimetres, OfWay(Some(PIN_IS_ROUND)), "length of the pin along sliding, at the mean radius";
            "cell_size", positive(Length, "um"), needed, "about how large a cell is, in both directions";
            "mean_radius", millimetres, needed, "radius of the middle of the track";
            "shape", choice!(SHAPE), Computed("`\"rectangle\"`"), "outline of the pin seen from above";
        }
    }

    fn brake(&mut self) {
        self.section = "brake";
        let millimetres = positive(Length, "mm");
        let area = positive(Area, "cm^2");
        keys! { self;
            "pad_area", area, Required, "area of friction material of one pad";
            "pads", Integer(1), Default("2"), "pads of the brake";
            "pad_thickness", millimetres, Required, "thickness of the friction material that may wear";
            "effective_radius", millimetres, Required, "radius at which the friction force of the pads acts";
            "wheel_radius", millimetres, Required, "rolling radius of the wheel";
            "piston_area", area, Optional, "area of the pistons that press one pad; for a column brake_pressure";
            "efficiency", Number(ABOVE_0_TO_1), Default("1"), "part of the force of the pistons that presses the pad";
        }
    }

    fn friction(&mut self) {
        self.section = "friction";
        let coefficient = Number(Range::NOT_NEGATIVE);
        let strength = not_negative(Pressure, "MPa");
        let (of_pressure, of_area) =
            ("shear stress per pressure: the coefficient at high pressure", "shear stress without pressure");
        let same = Computed("as above");
        keys! { self;
            "pressure_coefficient", coefficient, Default("0"), of_pressure;
            "shear_strength", strength, Default("\"0 MPa\""), of_area;
            "maximum", Number(Range::POSITIVE), Optional, "the largest coefficient of friction";
            "secondary.pressure_coefficient", coefficient, same, of_pressure;
            "secondary.shear_strength", strength, same, of_area;
            "resin.pressure_coefficient", coefficient, same, of_pressure;
            "resin.shear_strength", strength, same, of_area;
        }
    }

    /// λ, ρ and c, under these names.
    fn substance(&mut self, [conductivity, density, specific_heat]: [&'static str; 3]) {
        keys! { self;
            conductivity, positive(ThermalConductivity, "W/(m K)"), Required, "thermal conductivity";
            density, positive(Density, "kg/m^3"), Required, "density";
            specific_heat, positive(SpecificHeat, "J/(kg K)"), Required, "specific heat";
        }
    }

    fn thermal(&mut self) {
        self.section = "thermal";
        keys! { self;
            "ambient", positive(Temperature, "degC"), Required, "temperature of the air, and of all at the start";
            "wear_rate_factor", Kind::Factor, Optional,
                "factor of the wear rates of the pin's plateaus over the temperature of the contact";
            "friction_factor", Kind::Factor, Optional, "factor of the coefficient of friction over the temperature of the contact";
        }

        let area = positive(Area, "cm^2");
        let cooling = not_negative(Cooling, "W/K");
        let substance = ["conductivity", "density", "specific_heat"];
        self.section = "thermal.disc";
        self.substance(substance);
        keys! { self;
            "area", area, Required, "area of the disc that takes heat and is cooled";
            "thickness", positive(Length, "mm"), Required, "thickness of the disc";
            "cooling", cooling, Default("\"0 W/K\""), "heat lost to the air per temperature above the ambient";
            "cooling_per_speed", not_negative(CoolingPerSpeed, "J/(K rad)"), Default("\"0 J/(K rad)\""),
                "the same per rotational speed, added to it";
            "coating.thickness", not_negative(Length, "um"), Required, "thickness of the coating";
        }
        self.substance(["coating.conductivity", "coating.density", "coating.specific_heat"]);

        self.section = "thermal.pin";
        self.substance(substance);
        keys! { self;
            "area", area, Required, "cross-section of the pin";
            "length", positive(Length, "mm"), Required, "length of the pin up to its holder";
            "cooling", cooling, Default("\"0 W/K\""), "heat lost to the holder per temperature above the ambient";
        }
    }

    fn emission(&mut self) {
        self.section = "emission";
        let fraction = Number(Range::FRACTION);
        let density = positive(Density, "kg/m^3");
        keys! { self;
            "pm10_fraction", fraction, Default("0"), "fraction of the emitted mass that is airborne as PM10";
            "pm25_fraction", fraction, Default("0"), "fraction of the emitted mass that is airborne as PM2.5";
            "number_per_mass", not_negative(NumberPerMass, "1/kg"), Default("\"0 1/kg\""), "particles per mass of PM10";
            "pin_density", density, Required, "density of what wears off the pin";
            "disc_density", density, Required, "density of what wears off the disc";
            "number_factor", Kind::Factor, Optional,
                "factor of the number of particles over the temperature of the contact; needs [thermal]";
        }
    }

    /// Sources of the heights of a body: a file, random numbers or nothing.
    fn heights(&mut self) {
        let pair = |single, range| Kind::Lengths { single, unit: "um", range };
        let micrometres = positive(Length, "um");
        keys! { self;
            "file", InputFile, OneOf, "measured heights: .sdf .h5 .nc .txt .xyz .csv .npy .npz .png .tif";
            "dataset", Text, Optional,
                "dataset in an HDF5 file, array in an .npz: metres, shape (columns, rows); number of a table in a text";
            "at", not_negative(Time, "s"), Optional, "time of the map of a run file that is taken; without it the last one is";
            "unit", LengthUnit, Optional, "what the number 1 stands for, for text, .npy and decimal images";
            "pitch", pair(true, Range::POSITIVE), Optional,
                "distance of points, or those along x and y, for files that do not state it";
            "height_range", pair(false, Range::ANY), Optional, "heights of black and white, for images";
            "decimal", choice!(DECIMAL), Optional, "decimal mark of a text file, where its content does not tell it";
            "skip", Integer(0), Optional, "lines of a text file before the table that are not read";
            "profile_lay", choice!(LAY), Optional,
                "the file is a profile: whether its surface has grooves along or across sliding, or no direction";
            "synthetic.seed", Integer(0), Default("0"), "seed of the random heights";
            "synthetic.rms_height", not_negative(Length, "um"), Required, "realised rms height";
            "synthetic.correlation_length", micrometres, OneOf, "length l of the autocorrelation exp(-(r/l)^2)";
            "synthetic.correlation_length_across", micrometres, Optional, "another length l across the sliding direction: a lay";
            "synthetic.roll_off", micrometres, OneOf, "wavelength from which down the spectrum falls as a power law";
            "synthetic.hurst", Number(Range::FRACTION), Optional,
                "Hurst exponent of the power law, 0 rough to 1 smooth; required beside roll_off";
            "synthetic.short_cutoff", micrometres, Optional, "wavelength at which the power law ends";
            "synthetic.patch", positive(Length, "mm"), Optional, "length after which the heights repeat";
            "synthetic.skewness", Number(Range::ANY), Default("0"), "skewness of the heights";
            "synthetic.kurtosis", Number(ABOVE_1), Default("3"), "kurtosis of the heights, 3 for normal ones";
            "flat", True, OneOf, "all heights zero";
            "mirror", Bool, Default("false"), "whether the heights are a view of the face, to be mirrored";
        }
    }

    /// Preparation of the heights before the first step.
    fn preparation(&mut self) {
        let pair = |range| Kind::Lengths { single: false, unit: "mm", range };
        let nesting_index = positive(Length, "um");
        keys! { self;
            "crop.along", pair(Range::NOT_NEGATIVE), Optional,
                "part that is kept along the sliding direction: from, to, from the first corner";
            "crop.across", pair(Range::NOT_NEGATIVE), Optional, "part that is kept across the sliding direction: from, to, outward";
            "unroll.centre", pair(Range::ANY), Required,
                "centre of the ring of which the patch is a sector, along and across from the first corner";
            "unroll.radii", pair(Range::NOT_NEGATIVE), Optional,
                "inner and outer radius that are kept; without them the largest rectangle that was measured";
            "rotate", quantity(Angle, "deg", Range::ANY), Optional,
                "how far the heights are turned, counterclockwise; interpolated between quarters of a turn";
            "flip", choice!(FLIP), Optional, "reverses the heights along or across the sliding direction";
            "level", choice!(LEVEL), Default("\"none\""), "form that is taken out: none, the mean, the plane, second order";
            "outlier_slope", Number(Range::POSITIVE), Optional, "slope beyond which points of spikes and pits are taken out";
            "outliers", Number(Range::POSITIVE), Optional, "robust standard deviations from the median beyond which points are taken out";
            "fill", choice!(FILL), Optional, "what missing points and outliers get; without it they are an error";
            "pixel", positive(Length, "um"), Optional, "pixel pitch in place of the file's own";
            "s_filter", nesting_index, Optional, "nesting index of a Gaussian filter that takes out shorter waves";
            "l_filter", nesting_index, Optional, "nesting index of a Gaussian filter that takes out longer waves";
            "cutoff", not_negative(Length, "um"), Optional, "height above the mean at which peaks are cut";
            "repeat", Bool, Computed("`false`"), "whether the patch is tiled over the ring or pin, mirrored from tile to tile";
            "extend", choice!(EXTEND), Optional, "random heights with the statistics of the patch in place of the patch itself";
            "extend_seed", Integer(0), Computed("`0`"), "seed of the random heights of `extend`";
            "scale", Number(Range::ANY), Default("1"), "factor of the heights";
        }
    }
}
