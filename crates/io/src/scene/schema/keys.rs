//! The table of keys.

use plateau_core::observe::EXTRAS;

use super::choices::{self, words};
use super::key::{Choose, Key, Kind, Need, Role};
use super::range::Range;
use super::table::{Table, length};
use super::{mesh, optional_parts};
use crate::units::Dimension::{Area, Force, Pressure, RotationalSpeed, SpecificWearRate, Speed, Time};
use Kind::{Bool, Choice, CountOr, InputFile, Integer, Maps, Number, NumberOr, Rows, Text, Times};
use Need::{Computed, Default, OneOf, Optional, Required, RequiredUnless, RequiredWithout, SameAs};

/// Full path of the key of m: a number, or a table with how the run chooses it.
pub(crate) const ACCELERATION: &str = "numerics.time_acceleration";
/// Full path of the table of the cycle.
pub(crate) const CYCLE: &str = "operation.cycle";

/// Debris goes into the gap behind the cell that wears, and there is no pool.
pub(super) const DEBRIS_IS_LOCAL: Choose = Choose { key: "plateaus.debris", value: "local" };

const POISSON_RATIO: Range = Range::new(-1.0, false, 0.5, true);
const BETWEEN_0_AND_1: Range = Range::new(0.0, false, 1.0, false);
const AT_LEAST_1: Range = Range::new(1.0, true, f64::INFINITY, false);

const fn time(range: Range) -> Kind {
    Kind::Quantity { dimension: Time, unit: "s", range }
}

/// Every key, in the order of docs/scenes.md.
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
}
