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
pub(super) struct Table {
    pub(super) keys: Vec<Key>,
    pub(super) section: &'static str,
    pub(super) role: Role,
}

impl Table {
    /// No keys; the first ones belong to the top of a scene.
    pub(super) fn new(role: Role) -> Self {
        Self { keys: Vec::new(), section: "", role }
    }

    /// Adds a key.
    pub(super) fn key(&mut self, name: &'static str, kind: Kind, need: Need, meaning: &'static str) -> &mut Key {
        let place = self.keys.len();
        self.keys.push(Key { section: self.section, name, kind, need, meaning, role: self.role });
        &mut self.keys[place]
    }
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
/// Name of the key of a wear rate on build-up of the disc.
const AGAINST_SECONDARY: &str = "wear_rate_against_secondary";
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
    let mut table = Table::new(Role::Nothing);
    table.key("version", Integer(1), Required, "version of the scene format: 1");
    table.key("title", Text, Computed("the scene file's name"), "title of the run");
    table.key("extends", Text, Optional, "scene that this one takes as its base, relative to this file");

    table.role = Role::Physics;
    table.mesh();

    table.section = "operation";
    table.key("normal_force", positive(Force, "N"), OneOf, "force that presses the pin on the disc");
    table.key(
        BRAKING_TORQUE,
        positive(Torque, "N m"),
        OneOf,
        "torque of friction on the pin, for which it is pressed as hard as it takes",
    );
    table.key("rotational_speed", positive(RotationalSpeed, "rpm"), OneOf, "rotational speed of the disc");
    table.key("sliding_speed", positive(Speed, "m/s"), OneOf, "sliding speed at the mean radius");
    table.key("duration", positive(Time, "s"), OneOf, "physical time to simulate").role = Role::Length;
    table.key("steps", Integer(1), OneOf, "steps to simulate, each by one column of cells").role = Role::Length;
    table.key(
        "cycle.file",
        InputFile,
        OneOf,
        "load and speed over time: .csv whose header has units, such as time [s], normal_force [N], rotational_speed [rpm]",
    );
    for name in CYCLE_COLUMNS {
        table.key(name, Text, Optional, "its header in the file");
    }
    table.key("cycle.points", Rows, OneOf, "the same in the scene: rows of time, load and speed");
    table.key(
        "cycle.interpolation",
        Choice(&const { words(&choices::INTERPOLATION) }),
        Default("\"linear\""),
        "what is between two rows: straight lines, or the values of the first",
    );
    table.key("cycle.repeat", Integer(1), Default("1"), "how many times the rows are played");
    table.key("cycle.force_scale", Number(Range::POSITIVE), Default("1"), "factor of every load of the cycle");
    table.key("cycle.speed_scale", Number(Range::POSITIVE), Default("1"), "factor of every speed of the cycle");

    table.section = "contact";
    table.key(
        "foundation_height",
        positive(Length, "um"),
        Required,
        "height h of the elastic foundation, which is E*/h stiff per area",
    );
    let tolerance = Number(BETWEEN_0_AND_1);
    table.key("load_tolerance", tolerance, Default("1e-9"), "accepted |sum k A u - F| / F").role = Role::Nothing;

    table.material("materials.disc_primary", None);
    table.material("materials.disc_secondary", Some("materials.disc_primary"));
    table.material("materials.pin_primary", None);
    table.wear_by_counterface();
    table.material("materials.pin_secondary", Some("materials.pin_primary"));
    table.wear_by_counterface();
    table.key("strength", positive(Pressure, "Pa"), Optional, "pressure above which build-up on resin breaks away");
    table.section = "materials.pin_resin";
    table.elasticity(Required);
    let wear_height = not_negative(Length, "um");
    table.key("wear_height", wear_height, Required, "height that resin loses in a step in which it touches");

    table.section = "plateaus";
    table.key(
        "debris",
        Choice(&const { words(&choices::DEBRIS) }),
        Computed("`\"contact\"`"),
        "where wear debris goes: into the gap behind the cell that wears, into a pool, or into one for each row of cells",
    );
    let former = Choice(&const { words(&choices::DEBRIS_POOL) });
    table.key("debris_pool", former, Optional, "the former name of `debris`, for the two pools");
    table.key(
        "captured_fraction",
        Number(Range::FRACTION),
        RequiredUnless(DEBRIS_IS_LOCAL, "1"),
        "fraction of the wear debris that may stay in the contact; the rest leaves",
    );
    table.key(
        "captured_resin_fraction",
        Number(Range::FRACTION),
        Optional,
        "the same of what wears off resin, where that is another",
    );
    let pad_share = "pin's share of a deposit on both surfaces, with a pool";
    table.key("pad_share", Number(Range::FRACTION), Default("0.5"), pad_share);
    table.key(
        "transport_length",
        positive(Length, "um"),
        Optional,
        "how far local debris is gathered and spread, so that results do not depend on the cell; without it one cell",
    );
    table.key("formation", Bool, Default("true"), "whether plateaus form at all");
    table.key("destruction", Bool, Default("true"), "whether unsupported plateaus of the pin break up, with a pool");

    table.brake();
    table.friction();
    table.thermal();
    table.emission();

    table.section = "disc.surface";
    table.heights();
    table.section = "disc.prepare";
    table.preparation();

    table.section = "pin.base";
    table.key("synthetic.seed", Integer(0), Default("0"), "seed of the random fibres");
    table.key("synthetic.fibre_fraction", Number(Range::FRACTION), Required, "area fraction that is fibre");
    table.key("synthetic.fibre_length", positive(Length, "um"), Required, "length of a fibre from end to end");
    table.key("synthetic.fibre_width", positive(Length, "um"), Required, "width of a fibre");
    table.key("image", InputFile, OneOf, "micrograph of the pin: PNG, TIFF, JPEG");
    table.key("pixel", positive(Length, "um"), Optional, "distance of the image's pixels; required beside it");
    let rotations = Choice(&const { words(&choices::ROTATE) });
    table.key("rotate", rotations, Computed("`\"0 deg\"`"), "how far the image is turned, counterclockwise");
    table.key("smooth", not_negative(Length, "um"), Optional, "standard deviation of a Gaussian over the image");
    table.key(
        "threshold",
        NumberOr(Range::FRACTION, "otsu"),
        Computed("`\"otsu\"`"),
        "grey level, black 0 to white 1, that parts fibre and resin",
    );
    let fibres = Choice(&const { words(&choices::FIBRES) });
    table.key("fibres", fibres, Computed("`\"bright\"`"), "which side of the threshold is fibre");
    let area = not_negative(Area, "um^2");
    table.key("despeckle", area, Optional, "area below which specks of fibre, then holes in it, are removed");
    table.key(
        "repeat",
        Bool,
        Computed("`false`"),
        "whether the image is tiled over the pin, mirrored from tile to tile",
    );
    let extend = "random fibres with fraction and correlation of the image in place of the image itself";
    table.key("extend", Choice(&const { words(&choices::EXTEND) }), Optional, extend);
    table.key("extend_seed", Integer(0), Computed("`0`"), "seed of the random fibres of `extend`");
    table.key("file", InputFile, OneOf, "HDF5 file with the fibre map");
    table.key("dataset", Text, Optional, "dataset in the file: integers, 0 none, 1 primary, shape (pin_columns, rows)");
    table.key("uniform", Choice(&const { words(&choices::UNIFORM) }), OneOf, "all cells alike: fibre or resin");
    table.key("mirror", Bool, Default("false"), "whether the map is a view of the pin's face, to be mirrored");

    table.section = "pin.surface";
    table.heights();
    table.key(
        "resin_recess",
        quantity(Length, "um", Range::ANY),
        Default("\"0 um\""),
        "added to the height of cells without fibre",
    );
    table.section = "pin.prepare";
    table.preparation();

    table.role = Role::Numerics;
    table.section = "numerics";
    table.key(
        "time_acceleration",
        Number(AT_LEAST_1),
        Default("1"),
        "revolutions that one simulated revolution stands for",
    );
    table.key(
        "time_acceleration.tolerance",
        Number(BETWEEN_0_AND_1),
        Required,
        "relative error of the contact area, as estimated, that the acceleration may cause",
    );
    table.key("time_acceleration.max", Number(AT_LEAST_1), Required, "largest acceleration that the run chooses");
    table.key(
        "integrator",
        Choice(&const { words(&choices::INTEGRATOR) }),
        Default("\"explicit\""),
        "how much a step wears; exponential is stable for any step, docs/model.md",
    );
    table.key("workers", CountOr("auto"), Default("1"), "threads that share the ring").role = Role::Nothing;
    let kinds = Choice(&const { words(&choices::DECOMPOSITION) });
    let decomposition = "what each of several workers has: angular sectors, bands of rows, or whichever is faster";
    table.key("decomposition", kinds, Optional, decomposition).role = Role::Nothing;

    table.role = Role::Series;
    table.section = "output";
    let file = "run file, relative to the working directory";
    table.key("file", Text, Computed("the scene file's name with .h5"), file).role = Role::Nothing;
    table.key("sample_every", positive(Time, "s"), OneOf, "physical time between samples");
    table.key(
        "sample_every_steps",
        Integer(1),
        Computed("one revolution, unless sample_every is given"),
        "steps between samples",
    );
    let maps_at = "physical times of maps; the last state is always written";
    table.key("maps_at", Times, Default("[]"), maps_at).role = Role::MapTimes;
    table.key("maps", Maps, Computed("all seven"), "maps that are written").role = Role::Maps;
    for extra in EXTRAS {
        if let Some(request) = &extra.request {
            table.key(extra.name, Bool, Default("false"), request.meaning);
        }
    }
    let checkpoint_every = "wall time between two checkpoints, from which a run that was stopped or killed goes on";
    let usual = Default("\"60 s\"");
    table.key("checkpoint_every", positive(Time, "s"), usual, checkpoint_every).role = Role::Nothing;
    table.keys
}

impl Table {
    fn elasticity(&mut self, need: Need) {
        self.key("youngs_modulus", positive(Pressure, "Pa"), need, "Young's modulus");
        self.key("poisson_ratio", Number(POISSON_RATIO), need, "Poisson's ratio");
    }

    fn material(&mut self, section: &'static str, like: Option<&'static str>) {
        self.section = section;
        let need = like.map_or(Required, SameAs);
        self.elasticity(need);
        let rate = not_negative(SpecificWearRate, "1/Pa");
        self.key("specific_wear_rate", rate, need, "worn volume per force and sliding distance");
    }

    fn wear_by_counterface(&mut self) {
        let rate = not_negative(SpecificWearRate, "1/Pa");
        self.key(AGAINST_SECONDARY, rate, Optional, "the same on build-up of the disc, where that is another");
    }

    fn mesh(&mut self) {
        self.section = "mesh";
        let millimetres = positive(Length, "mm");
        let needed = OfWay(None);
        self.key("inner_radius", millimetres, needed, "inner radius of the ring");
        self.key("outer_radius", millimetres, needed, "outer radius of the ring");
        self.key("rows", Integer(1), needed, "cells along the radius");
        self.key("disc_columns", Integer(1), needed, "cells around the ring");
        self.key("pin_columns", Integer(1), needed, "cells that the pin covers along the ring, at most disc_columns");
        let diameter =
            "diameter of a round pin in the middle of these rows and columns; required there with shape = \"disc\"";
        self.key("pin_diameter", millimetres, Optional, diameter);
        self.key("pin_width", millimetres, needed, "width of the pin along the radius; of a round pin its diameter");
        let of_rectangle = OfWay(Some(PIN_IS_ROUND));
        self.key("pin_length", millimetres, of_rectangle, "length of the pin along sliding, at the mean radius");
        self.key("cell_size", positive(Length, "um"), needed, "about how large a cell is, in both directions");
        self.key("mean_radius", millimetres, needed, "radius of the middle of the track");
        let shapes = Choice(&const { words(&choices::SHAPE) });
        self.key("shape", shapes, Computed("`\"rectangle\"`"), "outline of the pin seen from above");
    }

    fn brake(&mut self) {
        self.section = "brake";
        let millimetres = positive(Length, "mm");
        let area = positive(Area, "cm^2");
        self.key("pad_area", area, Required, "area of friction material of one pad");
        self.key("pads", Integer(1), Default("2"), "pads of the brake");
        self.key("pad_thickness", millimetres, Required, "thickness of the friction material that may wear");
        self.key("effective_radius", millimetres, Required, "radius at which the friction force of the pads acts");
        self.key("wheel_radius", millimetres, Required, "rolling radius of the wheel");
        self.key("piston_area", area, Optional, "area of the pistons that press one pad; for a column brake_pressure");
        self.key(
            "efficiency",
            Number(ABOVE_0_TO_1),
            Default("1"),
            "part of the force of the pistons that presses the pad",
        );
    }

    fn friction(&mut self) {
        self.section = "friction";
        let coefficient = Number(Range::NOT_NEGATIVE);
        let strength = not_negative(Pressure, "MPa");
        let (of_pressure, of_area) =
            ("shear stress per pressure: the coefficient at high pressure", "shear stress without pressure");
        self.key("pressure_coefficient", coefficient, Default("0"), of_pressure);
        self.key("shear_strength", strength, Default("\"0 MPa\""), of_area);
        self.key("maximum", Number(Range::POSITIVE), Optional, "the largest coefficient of friction");
        let same = "as above";
        self.key("secondary.pressure_coefficient", coefficient, Computed(same), of_pressure);
        self.key("secondary.shear_strength", strength, Computed(same), of_area);
        self.key("resin.pressure_coefficient", coefficient, Computed(same), of_pressure);
        self.key("resin.shear_strength", strength, Computed(same), of_area);
    }

    /// λ, ρ and c, under these names.
    fn substance(&mut self, names: [&'static str; 3]) {
        self.key(names[0], positive(ThermalConductivity, "W/(m K)"), Required, "thermal conductivity");
        self.key(names[1], positive(Density, "kg/m^3"), Required, "density");
        self.key(names[2], positive(SpecificHeat, "J/(kg K)"), Required, "specific heat");
    }

    fn thermal(&mut self) {
        self.section = "thermal";
        self.key("ambient", positive(Temperature, "degC"), Required, "temperature of the air, and of all at the start");
        let wear = "factor of the wear rates of the pin's plateaus over the temperature of the contact";
        self.key("wear_rate_factor", Kind::Factor, Optional, wear);
        let friction = "factor of the coefficient of friction over the temperature of the contact";
        self.key("friction_factor", Kind::Factor, Optional, friction);

        let area = positive(Area, "cm^2");
        let cooling = not_negative(Cooling, "W/K");
        let substance = ["conductivity", "density", "specific_heat"];
        self.section = "thermal.disc";
        self.substance(substance);
        self.key("area", area, Required, "area of the disc that takes heat and is cooled");
        self.key("thickness", positive(Length, "mm"), Required, "thickness of the disc");
        self.key("cooling", cooling, Default("\"0 W/K\""), "heat lost to the air per temperature above the ambient");
        self.key(
            "cooling_per_speed",
            not_negative(CoolingPerSpeed, "J/(K rad)"),
            Default("\"0 J/(K rad)\""),
            "the same per rotational speed, added to it",
        );
        let thickness = "thickness of the coating";
        self.key("coating.thickness", not_negative(Length, "um"), Required, thickness);
        self.substance(["coating.conductivity", "coating.density", "coating.specific_heat"]);

        self.section = "thermal.pin";
        self.substance(substance);
        self.key("area", area, Required, "cross-section of the pin");
        self.key("length", positive(Length, "mm"), Required, "length of the pin up to its holder");
        self.key("cooling", cooling, Default("\"0 W/K\""), "heat lost to the holder per temperature above the ambient");
    }

    fn emission(&mut self) {
        self.section = "emission";
        let fraction = Number(Range::FRACTION);
        self.key("pm10_fraction", fraction, Default("0"), "fraction of the emitted mass that is airborne as PM10");
        self.key("pm25_fraction", fraction, Default("0"), "fraction of the emitted mass that is airborne as PM2.5");
        let number = not_negative(NumberPerMass, "1/kg");
        self.key("number_per_mass", number, Default("\"0 1/kg\""), "particles per mass of PM10");
        let density = positive(Density, "kg/m^3");
        self.key("pin_density", density, Required, "density of what wears off the pin");
        self.key("disc_density", density, Required, "density of what wears off the disc");
        let factor = "factor of the number of particles over the temperature of the contact; needs [thermal]";
        self.key("number_factor", Kind::Factor, Optional, factor);
    }

    /// Sources of the heights of a body: a file, random numbers or nothing.
    pub(super) fn heights(&mut self) {
        self.key("file", InputFile, OneOf, "measured heights: .sdf .h5 .nc .txt .xyz .csv .npy .npz .png .tif");
        self.key(
            "dataset",
            Text,
            Optional,
            "dataset in an HDF5 file, array in an .npz: metres, shape (columns, rows); number of a table in a text",
        );
        let time = not_negative(Time, "s");
        self.key("at", time, Optional, "time of the map of a run file that is taken; without it the last one is");
        self.key("unit", LengthUnit, Optional, "what the number 1 stands for, for text, .npy and decimal images");
        self.key(
            "pitch",
            Kind::Lengths { count: 2, single: true, unit: "um", range: Range::POSITIVE },
            Optional,
            "distance of points, or those along x and y, for files that do not state it",
        );
        let range = Kind::Lengths { count: 2, single: false, unit: "um", range: Range::ANY };
        self.key("height_range", range, Optional, "heights of black and white, for images");
        let decimal = Choice(&const { words(&choices::DECIMAL) });
        self.key("decimal", decimal, Optional, "decimal mark of a text file, where its content does not tell it");
        self.key("skip", Integer(0), Optional, "lines of a text file before the table that are not read");
        self.key(
            "profile_lay",
            Choice(&const { words(&choices::LAY) }),
            Optional,
            "the file is a profile: whether its surface has grooves along or across sliding, or no direction",
        );
        self.key("synthetic.seed", Integer(0), Default("0"), "seed of the random heights");
        self.key("synthetic.rms_height", not_negative(Length, "um"), Required, "realised rms height");
        let micrometres = positive(Length, "um");
        self.key("synthetic.correlation_length", micrometres, OneOf, "length l of the autocorrelation exp(-(r/l)^2)");
        let across = "another length l across the sliding direction: a lay";
        self.key("synthetic.correlation_length_across", micrometres, Optional, across);
        self.key(
            "synthetic.roll_off",
            micrometres,
            OneOf,
            "wavelength from which down the spectrum falls as a power law",
        );
        self.key(
            "synthetic.hurst",
            Number(Range::FRACTION),
            Optional,
            "Hurst exponent of the power law, 0 rough to 1 smooth; required beside roll_off",
        );
        self.key("synthetic.short_cutoff", micrometres, Optional, "wavelength at which the power law ends");
        self.key("synthetic.patch", positive(Length, "mm"), Optional, "length after which the heights repeat");
        self.key("synthetic.skewness", Number(Range::ANY), Default("0"), "skewness of the heights");
        self.key("synthetic.kurtosis", Number(ABOVE_1), Default("3"), "kurtosis of the heights, 3 for normal ones");
        self.key("flat", True, OneOf, "all heights zero");
        self.key("mirror", Bool, Default("false"), "whether the heights are a view of the face, to be mirrored");
    }

    /// Preparation of the heights before the first step.
    pub(super) fn preparation(&mut self) {
        self.straightening();
        self.key(
            "level",
            Choice(&const { words(&choices::LEVEL) }),
            Default("\"none\""),
            "form that is taken out: none, the mean, the plane, second order",
        );
        let slope = "slope beyond which points of spikes and pits are taken out";
        self.key("outlier_slope", Number(Range::POSITIVE), Optional, slope);
        let outliers = "robust standard deviations from the median beyond which points are taken out";
        self.key("outliers", Number(Range::POSITIVE), Optional, outliers);
        let fills = Choice(&const { words(&choices::FILL) });
        self.key("fill", fills, Optional, "what missing points and outliers get; without it they are an error");
        self.key("pixel", positive(Length, "um"), Optional, "pixel pitch in place of the file's own");
        let nesting_index = positive(Length, "um");
        self.key(
            "s_filter",
            nesting_index,
            Optional,
            "nesting index of a Gaussian filter that takes out shorter waves",
        );
        self.key("l_filter", nesting_index, Optional, "nesting index of a Gaussian filter that takes out longer waves");
        self.key("cutoff", not_negative(Length, "um"), Optional, "height above the mean at which peaks are cut");
        let repeat = "whether the patch is tiled over the ring or pin, mirrored from tile to tile";
        self.key("repeat", Bool, Computed("`false`"), repeat);
        let extend = "random heights with the statistics of the patch in place of the patch itself";
        self.key("extend", Choice(&const { words(&choices::EXTEND) }), Optional, extend);
        self.key("extend_seed", Integer(0), Computed("`0`"), "seed of the random heights of `extend`");
        self.key("scale", Number(Range::ANY), Default("1"), "factor of the heights");
    }

    fn straightening(&mut self) {
        let range = |range| Kind::Lengths { count: 2, single: false, unit: "mm", range };
        let along = "part that is kept along the sliding direction: from, to, from the first corner";
        self.key("crop.along", range(Range::NOT_NEGATIVE), Optional, along);
        let across = "part that is kept across the sliding direction: from, to, outward";
        self.key("crop.across", range(Range::NOT_NEGATIVE), Optional, across);
        let centre = "centre of the ring of which the patch is a sector, along and across from the first corner";
        self.key("unroll.centre", range(Range::ANY), Required, centre);
        let radii = "inner and outer radius that are kept; without them the largest rectangle that was measured";
        self.key("unroll.radii", range(Range::NOT_NEGATIVE), Optional, radii);
        let turn = "how far the heights are turned, counterclockwise; interpolated between quarters of a turn";
        self.key("rotate", quantity(Angle, "deg", Range::ANY), Optional, turn);
        let flips = Choice(&const { words(&choices::FLIP) });
        self.key("flip", flips, Optional, "reverses the heights along or across the sliding direction");
    }
}
