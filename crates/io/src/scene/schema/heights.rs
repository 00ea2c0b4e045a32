//! The keys of the heights of a body, disc or pin, and of their preparation.

use super::choices::{self, words};
use super::key::{Kind, Need};
use super::range::Range;
use super::table::{Table, length};
use crate::units::Dimension::Time;
use Kind::{Bool, Choice, InputFile, Integer, LengthUnit, Number, Text, True};
use Need::{Computed, Default, OneOf, Optional, Required};

const ABOVE_1: Range = Range::new(1.0, false, f64::INFINITY, false);

impl Table {
    /// Where the heights of a body come from: a file, random numbers or nothing.
    pub(super) fn heights(&mut self) {
        self.key("file", InputFile, OneOf, "measured heights: .sdf .x3p .txt .xyz .csv .npy .npz .h5 .png .tif");
        self.key(
            "dataset",
            Text,
            Optional,
            "dataset in an HDF5 file, array in an .npz: metres, shape (columns, rows); number of a table in a text",
        );
        let time = Kind::Quantity { dimension: Time, unit: "s", range: Range::NOT_NEGATIVE };
        self.key("at", time, Optional, "time of the map of a run file that is taken; without it the last one is");
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

    /// What is done to them before the first step.
    pub(super) fn preparation(&mut self) {
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
