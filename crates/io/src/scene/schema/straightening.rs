//! The keys that say how a measured patch comes to lie along the track.

use super::choices::{self, words};
use super::key::Kind::{self, Choice};
use super::key::Need::{Optional, Required};
use super::range::Range;
use super::table::Table;
use crate::units::Dimension::Angle;

impl Table {
    /// Adds them.
    pub(super) fn straightening(&mut self) {
        let range = |range| Kind::Lengths { count: 2, single: false, unit: "mm", range };
        let along = "part that is kept along the sliding direction: from, to, from the first corner";
        self.key("crop.along", range(Range::NOT_NEGATIVE), Optional, along);
        let across = "part that is kept across the sliding direction: from, to, outward";
        self.key("crop.across", range(Range::NOT_NEGATIVE), Optional, across);
        let centre = "centre of the ring of which the patch is a sector, along and across from the first corner";
        self.key("unroll.centre", range(Range::ANY), Required, centre);
        let radii = "inner and outer radius that are kept; without them the largest rectangle that was measured";
        self.key("unroll.radii", range(Range::NOT_NEGATIVE), Optional, radii);
        let angle = Kind::Quantity { dimension: Angle, unit: "deg", range: Range::ANY };
        let turn = "how far the heights are turned, counterclockwise; interpolated between quarters of a turn";
        self.key("rotate", angle, Optional, turn);
        let flips = Choice(&const { words(&choices::FLIP) });
        self.key("flip", flips, Optional, "reverses the heights along or across the sliding direction");
    }
}
