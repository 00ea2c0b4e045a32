//! One pass over the pin: wear, destruction and formation of a step with pooled debris or none, and the pairs of the next
//! step against a bracket (model 4.2, 4P, and 4.1 of the next step). With local debris: [`super::local`].
//!
//! In the next step the disc column under pin column j lies under column j + 1. So when column j + 1 has been updated,
//! the new heights of that pair are at hand, and are read on the way.
//!
//! In most steps nothing out of the ordinary happens to most cells: those that touch are plateaus and wear, those that
//! are open get the even deposit, and statuses stay. Eight such cells at a time are done with few instructions, which
//! also show where something else happens; those eight are then done by all rules.

use std::ops::Range;

use super::cells::{MOST_UNUSUAL, Strip, Sweep, update};
use super::instructions::kernel;
use super::local::sweep_locally;
use super::moved::{Moved, StripMoved};
use super::ordinary::sweep_ordinary;
use super::read::Span;
use super::reading::{Reading, StripReading};
use super::rules::{Conditions, Rules, StripRules};
use crate::engine::lanes::Lanes;
use crate::engine::parts::Needs;
use crate::engine::pin_strips::PinStrips;
use crate::engine::presence::Extent;
use crate::engine::strips::DiscSector;

/// The sweep that does what a scene needs and nothing else; chosen once per run.
pub fn sweep(needs: Needs) -> Sweep {
    let Needs { distinct, disc_wears, forms, local, destroys } = needs;
    if local {
        return sweep_locally(needs);
    }
    // Build-up that is told apart, and plateaus that fall, are there only where plateaus form.
    match (forms, distinct, disc_wears, destroys) {
        (false, _, false, _) => sweep_span::<false, false, false, false>,
        (false, _, true, _) => sweep_span::<false, true, false, false>,
        (true, false, false, false) => sweep_span::<false, false, true, false>,
        (true, false, false, true) => sweep_span::<false, false, true, true>,
        (true, false, true, false) => sweep_span::<false, true, true, false>,
        (true, false, true, true) => sweep_span::<false, true, true, true>,
        (true, true, false, false) => sweep_span::<true, false, true, false>,
        (true, true, false, true) => sweep_span::<true, false, true, true>,
        (true, true, true, false) => sweep_span::<true, true, true, false>,
        (true, true, true, true) => sweep_span::<true, true, true, true>,
    }
}

kernel! {
    /// Sweeps a span.
    pub fn sweep_span<const DISTINCT, const DISC_WEARS, const FORMS, const DESTROYS>(
        rules: &Rules,
        conditions: &Conditions,
        pin: &mut PinStrips,
        disc: &mut DiscSector,
        span: Span,
        joined: bool,
        moved: &mut Moved,
        reading: &mut Reading,
    ) = sweep_strips
}

#[inline(always)]
#[expect(clippy::too_many_arguments, reason = "the kernel's own")]
fn sweep_strips<L: Lanes, const DISTINCT: bool, const DISC_WEARS: bool, const FORMS: bool, const DESTROYS: bool>(
    rules: &Rules,
    conditions: &Conditions,
    pin: &mut PinStrips,
    disc: &mut DiscSector,
    span: Span,
    joined: bool,
    moved: &mut Moved,
    reading: &mut Reading,
) {
    for index in 0..pin.height.strips() {
        let mut strip = Strip::new::<L, DISTINCT, FORMS>(index, pin, disc, span, joined);
        let strip_rules = StripRules::<L>::new(rules, conditions, index);
        let Extent { some, whole } = strip.extent.clone();
        let (mut column, mut unusual) = (some.start, 0);
        while column < some.end {
            // Where not all cells are there, before and behind those columns where they are.
            let mut end = if column < whole.start { whole.start } else { some.end };
            if whole.contains(&column) {
                end = whole.end;
                if !DISTINCT && rules.shortcut && unusual <= MOST_UNUSUAL {
                    let ordinary = sweep_ordinary::<L, DISC_WEARS, FORMS, DESTROYS>;
                    column = ordinary(&strip_rules, &mut strip, column..end, moved, reading);
                    end = end.min(column + 1);
                }
            }
            sweep_any::<L, DISTINCT, DISC_WEARS, FORMS, DESTROYS>(
                &strip_rules,
                &mut strip,
                column..end,
                moved,
                reading,
            );
            (column, unusual) = (end, unusual + 1);
        }
    }
}

/// Sweeps some columns of a strip, whatever happens to their cells.
#[inline(always)]
fn sweep_any<L: Lanes, const DISTINCT: bool, const DISC_WEARS: bool, const FORMS: bool, const DESTROYS: bool>(
    rules: &StripRules<L>,
    strip: &mut Strip,
    columns: Range<usize>,
    moved: &mut Moved,
    reading: &mut Reading,
) {
    if columns.is_empty() {
        return;
    }
    let mut strip_moved = StripMoved::<L>::new();
    let mut next = StripReading::<L, DISTINCT>::new();
    let mut behind = strip.behind::<L, DISTINCT>(columns.start);
    for column in columns {
        behind = update::<L, DISTINCT, DISC_WEARS, FORMS, DESTROYS>(
            rules,
            strip,
            column,
            behind,
            &mut strip_moved,
            &mut moved.seldom,
            &mut next,
            reading,
        );
    }
    strip_moved.store::<DISTINCT, FORMS>(strip.index, moved);
    next.store(strip.index, reading);
}
