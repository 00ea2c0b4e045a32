//! The table of keys.

use plateau_core::observe::EXTRAS;

use super::choices::{self, words};
use super::table::{Table, length};
use super::{CYCLE, Choose, Group, Key, Kind, Meaningless, Need, Range, Role};
use super::{mesh, optional_parts};
use crate::units::Dimension::{Area, Force, Pressure, RotationalSpeed, SpecificWearRate, Speed, Time};
use Kind::{Bool, Choice, CountOr, InputFile, Integer, LengthUnit, Maps, Number, NumberOr, Rows, Text, Times, True};
use Need::{Computed, Default, OneOf, Optional, Required, RequiredUnless, RequiredWithout, SameAs};

const HEIGHT_SOURCES: &[(&str, &[&str])] = &[("file", FILE), ("synthetic", &[]), ("flat", &[])];
const FILE: &[&str] = &["dataset", "unit", "pitch", "height_range", "decimal", "skip", "profile_lay"];
const IMAGE: &[&str] = &["threshold", "pixel", "smooth", "despeckle", "rotate", "fibres"];

const TEXTURES: &[(&str, &[&str])] = &[
    ("synthetic.correlation_length", &["synthetic.correlation_length_across"]),
    ("synthetic.roll_off", &["synthetic.hurst", "synthetic.short_cutoff"]),
];

/// What is done where a patch is smaller than ring or pin.
const BEYOND_THE_PATCH: &[(&str, &[&str])] = &[("repeat", &[]), ("extend", &["extend_seed"])];

/// Keys that exclude each other.
pub const GROUPS: &[Group] = &[
    Group {
        section: "operation",
        members: &[("rotational_speed", &[]), ("sliding_speed", &[])],
        required: true,
        unless: Some(CYCLE),
    },
    Group { section: "operation", members: &[("duration", &[]), ("steps", &[])], required: true, unless: Some(CYCLE) },
    Group {
        section: "operation",
        members: &[("cycle.file", &[]), ("cycle.points", &[])],
        required: true,
        unless: None,
    },
    Group { section: "disc.surface", members: HEIGHT_SOURCES, required: true, unless: None },
    Group { section: "disc.surface", members: TEXTURES, required: true, unless: None },
    Group { section: "disc.prepare", members: BEYOND_THE_PATCH, required: false, unless: None },
    Group {
        section: "pin.base",
        members: &[("synthetic", &[]), ("image", IMAGE), ("file", &["dataset"]), ("uniform", &[])],
        required: true,
        unless: None,
    },
    Group { section: "pin.surface", members: HEIGHT_SOURCES, required: true, unless: None },
    Group { section: "pin.surface", members: TEXTURES, required: true, unless: None },
    Group { section: "pin.prepare", members: BEYOND_THE_PATCH, required: false, unless: None },
    Group {
        section: "output",
        members: &[("sample_every", &[]), ("sample_every_steps", &[])],
        required: false,
        unless: None,
    },
    Group { section: "plateaus", members: &[("debris", &[]), ("debris_pool", &[])], required: false, unless: None },
];

const DEBRIS_IS_LOCAL: Choose = Choose { key: "plateaus.debris", value: "local" };

/// Keys that have no meaning beside a value of another key.
pub const MEANINGLESS: &[Meaningless] = &[
    Meaningless { beside: mesh::PIN_IS_ROUND, key: "mesh.pin_length", reason: "a round pin is as long as it is wide" },
    Meaningless {
        beside: mesh::PIN_IS_A_RECTANGLE,
        key: "mesh.pin_diameter",
        reason: "a rectangle covers all rows and pin_columns",
    },
    Meaningless {
        beside: DEBRIS_IS_LOCAL,
        key: "plateaus.pad_share",
        reason: "local debris goes to the pin up to the plateau ahead and then to the disc",
    },
    Meaningless {
        beside: DEBRIS_IS_LOCAL,
        key: "plateaus.destruction",
        reason: "with local debris no plateau falls for want of support, it goes when it is worn through",
    },
];

const POISSON_RATIO: Range = Range::new(-1.0, false, 0.5, true);
const BETWEEN_0_AND_1: Range = Range::new(0.0, false, 1.0, false);
const ABOVE_1: Range = Range::new(1.0, false, f64::INFINITY, false);
const AT_LEAST_1: Range = Range::new(1.0, true, f64::INFINITY, false);

const fn time(range: Range) -> Kind {
    Kind::Quantity { dimension: Time, unit: "s", range }
}

pub(super) fn all() -> Vec<Key> {
    let mut table = Table::new(Role::Nothing);
    table.key("version", Integer(1), Required, "version of the scene format: 1");
    table.key("title", Text, Computed("the scene file's name"), "title of the run");
    table.key("extends", Text, Optional, "scene that this one takes as its base, relative to this file");

    table.role = Role::Physics;
    mesh::add(&mut table);

    table.section = "operation";
    let force = Kind::Quantity { dimension: Force, unit: "N", range: Range::POSITIVE };
    table.key("normal_force", force, RequiredWithout(CYCLE), "force that presses the pin on the disc");
    let rotation = Kind::Quantity { dimension: RotationalSpeed, unit: "rpm", range: Range::POSITIVE };
    table.key("rotational_speed", rotation, OneOf, "rotational speed of the disc");
    let speed = Kind::Quantity { dimension: Speed, unit: "m/s", range: Range::POSITIVE };
    table.key("sliding_speed", speed, OneOf, "sliding speed at the mean radius");
    table.key("duration", time(Range::POSITIVE), OneOf, "physical time to simulate").role = Role::Length;
    table.key("steps", Integer(1), OneOf, "steps to simulate, each by one column of cells").role = Role::Length;
    table.key(
        "cycle.file",
        InputFile,
        OneOf,
        "load and speed over time: .csv whose header has units, such as time [s], normal_force [N], rotational_speed [rpm]",
    );
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
        length("um", Range::POSITIVE),
        Required,
        "height h of the elastic foundation, which is E*/h stiff per area",
    );
    let tolerance = Number(BETWEEN_0_AND_1);
    table.key("load_tolerance", tolerance, Default("1e-9"), "accepted |sum k A u - F| / F").role = Role::Nothing;

    table.material("materials.disc_primary", None);
    table.material("materials.disc_secondary", Some("materials.disc_primary"));
    table.material("materials.pin_primary", None);
    table.material("materials.pin_secondary", Some("materials.pin_primary"));
    table.section = "materials.pin_resin";
    table.elasticity(Required);
    let wear_height = length("um", Range::NOT_NEGATIVE);
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
    table.key("formation", Bool, Default("true"), "whether plateaus form at all");
    table.key("destruction", Bool, Default("true"), "whether unsupported plateaus of the pin break up, with a pool");

    optional_parts::add(&mut table);

    table.section = "disc.surface";
    table.heights();
    table.section = "disc.prepare";
    table.preparation();

    table.section = "pin.base";
    table.key("synthetic.seed", Integer(0), Default("0"), "seed of the random fibres");
    table.key("synthetic.fibre_fraction", Number(Range::FRACTION), Required, "area fraction that is fibre");
    table.key("synthetic.fibre_length", length("um", Range::POSITIVE), Required, "length of a fibre from end to end");
    table.key("synthetic.fibre_width", length("um", Range::POSITIVE), Required, "width of a fibre");
    table.key("image", InputFile, OneOf, "micrograph of the pin: .png .tif");
    table.key("pixel", length("um", Range::POSITIVE), Optional, "distance of the image's pixels; required beside it");
    let rotations = Choice(&const { words(&choices::ROTATE) });
    table.key("rotate", rotations, Computed("`\"0 deg\"`"), "how far the image is turned, counterclockwise");
    table.key("smooth", length("um", Range::NOT_NEGATIVE), Optional, "standard deviation of a Gaussian over the image");
    let threshold = NumberOr(Range::FRACTION, "otsu");
    table.key(
        "threshold",
        threshold,
        Computed("`\"otsu\"`"),
        "grey level, black 0 to white 1, that parts fibre and resin",
    );
    let fibres = Choice(&const { words(&choices::FIBRES) });
    table.key("fibres", fibres, Computed("`\"bright\"`"), "which side of the threshold is fibre");
    let area = Kind::Quantity { dimension: Area, unit: "um^2", range: Range::NOT_NEGATIVE };
    table.key("despeckle", area, Optional, "area below which specks of fibre, then holes in it, are removed");
    table.key("file", InputFile, OneOf, "HDF5 file with the fibre map");
    table.key("dataset", Text, Optional, "dataset in the file: integers, 0 none, 1 primary, shape (pin_columns, rows)");
    let uniform = Choice(&const { words(&choices::UNIFORM) });
    table.key("uniform", uniform, OneOf, "all cells alike: fibre or resin");
    table.key("mirror", Bool, Default("false"), "whether the map is a view of the pin's face, to be mirrored");

    table.section = "pin.surface";
    table.heights();
    table.key(
        "resin_recess",
        length("um", Range::ANY),
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

    table.role = Role::Series;
    table.section = "output";
    let file = "run file, relative to the working directory";
    table.key("file", Text, Computed("the scene file's name with .h5"), file).role = Role::Nothing;
    table.key("sample_every", time(Range::POSITIVE), OneOf, "physical time between samples");
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
    table.key("checkpoint_every", time(Range::POSITIVE), usual, checkpoint_every).role = Role::Nothing;
    table.keys
}

impl Table {
    fn elasticity(&mut self, need: Need) {
        let modulus = Kind::Quantity { dimension: Pressure, unit: "Pa", range: Range::POSITIVE };
        self.key("youngs_modulus", modulus, need, "Young's modulus");
        self.key("poisson_ratio", Number(POISSON_RATIO), need, "Poisson's ratio");
    }

    fn material(&mut self, section: &'static str, like: Option<&'static str>) {
        self.section = section;
        let need = like.map_or(Required, SameAs);
        self.elasticity(need);
        let rate = Kind::Quantity { dimension: SpecificWearRate, unit: "1/Pa", range: Range::NOT_NEGATIVE };
        self.key("specific_wear_rate", rate, need, "worn volume per force and sliding distance");
    }

    fn heights(&mut self) {
        self.key("file", InputFile, OneOf, "measured heights: .sdf .x3p .txt .xyz .csv .npy .npz .h5 .png .tif");
        self.key("dataset", Text, Optional, "dataset in an HDF5 file, array in an .npz: metres, shape (columns, rows)");
        self.key("unit", LengthUnit, Optional, "what the number 1 stands for, for text, .npy and decimal images");
        let pitch = Kind::Lengths { count: 2, single: true, unit: "um", range: Range::POSITIVE };
        self.key(
            "pitch",
            pitch,
            Optional,
            "distance of points, or those along x and y, for files that do not state it",
        );
        let range = Kind::Lengths { count: 2, single: false, unit: "um", range: Range::ANY };
        self.key("height_range", range, Optional, "heights of black and white, for images");
        let decimal = Choice(&const { words(&choices::DECIMAL) });
        self.key("decimal", decimal, Optional, "decimal mark of a text file, where its content does not tell it");
        self.key("skip", Integer(0), Optional, "lines of a text file before the table that are not read");
        let lay = Choice(&const { words(&choices::LAY) });
        self.key(
            "profile_lay",
            lay,
            Optional,
            "the file is a profile: whether its surface has grooves along or across sliding, or no direction",
        );
        self.key("synthetic.seed", Integer(0), Default("0"), "seed of the random heights");
        self.key("synthetic.rms_height", length("um", Range::NOT_NEGATIVE), Required, "realised rms height");
        let positive = length("um", Range::POSITIVE);
        self.key("synthetic.correlation_length", positive, OneOf, "length l of the autocorrelation exp(-(r/l)^2)");
        let across = "another length l across the sliding direction: a lay";
        self.key("synthetic.correlation_length_across", positive, Optional, across);
        self.key("synthetic.roll_off", positive, OneOf, "wavelength from which down the spectrum falls as a power law");
        self.key(
            "synthetic.hurst",
            Number(Range::FRACTION),
            Optional,
            "Hurst exponent of the power law, 0 rough to 1 smooth; required beside roll_off",
        );
        self.key("synthetic.short_cutoff", positive, Optional, "wavelength at which the power law ends");
        self.key("synthetic.patch", length("mm", Range::POSITIVE), Optional, "length after which the heights repeat");
        self.key("synthetic.skewness", Number(Range::ANY), Default("0"), "skewness of the heights");
        self.key("synthetic.kurtosis", Number(ABOVE_1), Default("3"), "kurtosis of the heights, 3 for normal ones");
        self.key("flat", True, OneOf, "all heights zero");
        self.key("mirror", Bool, Default("false"), "whether the heights are a view of the face, to be mirrored");
    }

    fn preparation(&mut self) {
        self.straightening();
        let levels = Choice(&const { words(&choices::LEVEL) });
        self.key(
            "level",
            levels,
            Default("\"none\""),
            "form that is taken out: none, the mean, the plane, second order",
        );
        let slope = "slope beyond which points of spikes and pits are taken out";
        self.key("outlier_slope", Number(Range::POSITIVE), Optional, slope);
        let outliers = "robust standard deviations from the median beyond which points are taken out";
        self.key("outliers", Number(Range::POSITIVE), Optional, outliers);
        let fills = Choice(&const { words(&choices::FILL) });
        self.key("fill", fills, Optional, "what missing points and outliers get; without it they are an error");
        self.key("pixel", length("um", Range::POSITIVE), Optional, "pixel pitch in place of the file's own");
        let nesting_index = length("um", Range::POSITIVE);
        self.key(
            "s_filter",
            nesting_index,
            Optional,
            "nesting index of a Gaussian filter that takes out shorter waves",
        );
        self.key("l_filter", nesting_index, Optional, "nesting index of a Gaussian filter that takes out longer waves");
        self.key("cutoff", length("um", Range::NOT_NEGATIVE), Optional, "height above the mean at which peaks are cut");
        let repeat = "whether the patch is tiled over the ring or pin, mirrored from tile to tile";
        self.key("repeat", Bool, Computed("`false`"), repeat);
        let extend = "random heights with the statistics of the patch in place of the patch itself";
        self.key("extend", Choice(&const { words(&choices::EXTEND) }), Optional, extend);
        self.key("extend_seed", Integer(0), Computed("`0`"), "seed of the random heights of `extend`");
        self.key("scale", Number(Range::ANY), Default("1"), "factor of the heights");
    }
}
