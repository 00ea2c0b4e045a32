//! The keys of the mesh: in cells or in lengths, under a rectangle or a round pin.

use super::choices::{self, words};
use super::key::{Choose, Kind, Need};
use super::range::Range;
use super::table::{Table, length};
use Kind::{Choice, Integer};
use Need::{Computed, OfWay, Optional};

/// A round pin.
pub(super) const PIN_IS_ROUND: Choose = Choose { key: "mesh.shape", value: "disc" };
/// A pin that covers all its rows and columns.
pub(super) const PIN_IS_A_RECTANGLE: Choose = Choose { key: "mesh.shape", value: "rectangle" };

/// Adds them.
pub(super) fn add(table: &mut Table) {
    table.section = "mesh";
    let millimetres = length("mm", Range::POSITIVE);
    let needed = OfWay(None);
    table.key("inner_radius", millimetres, needed, "inner radius of the ring");
    table.key("outer_radius", millimetres, needed, "outer radius of the ring");
    table.key("rows", Integer(1), needed, "cells along the radius");
    table.key("disc_columns", Integer(1), needed, "cells around the ring");
    table.key("pin_columns", Integer(1), needed, "cells that the pin covers along the ring, at most disc_columns");
    let diameter =
        "diameter of a round pin in the middle of these rows and columns; required there with shape = \"disc\"";
    table.key("pin_diameter", millimetres, Optional, diameter);
    table.key("pin_width", millimetres, needed, "width of the pin along the radius; of a round pin its diameter");
    let of_rectangle = OfWay(Some(PIN_IS_ROUND));
    table.key("pin_length", millimetres, of_rectangle, "length of the pin along sliding, at the mean radius");
    table.key("cell_size", length("um", Range::POSITIVE), needed, "about how large a cell is, in both directions");
    table.key("mean_radius", millimetres, needed, "radius of the middle of the track");
    let shapes = Choice(&const { words(&choices::SHAPE) });
    table.key("shape", shapes, Computed("`\"rectangle\"`"), "outline of the pin seen from above");
}
