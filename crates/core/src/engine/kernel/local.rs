//! One pass over the pin with local debris: deposits and wear of a step, and the pairs of the next step against a bracket
//! (model 4L, 4.2, and 4.1 of the next step).
//!
//! Which pairs touch is known from the reading. Some columns of a strip at a time, debris first comes upon open cells, as
//! [`super::deposit`] has it; that leaves what touches as it is at the start of the step, and then that wears.

use super::cells::{Behind, MOST_UNUSUAL, Strip, Sweep};
use super::deposit::{COLUMNS, deposit};
use super::edge::Edge;
use super::instructions::kernel;
use super::local_ordinary::sweep_ordinary_locally;
use super::moved::{Moved, SeldomEvent, StripMoved, note_seldom};
use super::pairs::Pairs;
use super::read::Span;
use super::reading::{Reading, StripReading};
use super::rules::{Conditions, Rules, StripRules};
use super::worn::{Cells, wear};
use crate::engine::lanes::{Chunk, LANES, Lanes, Mask};
use crate::engine::parts::Needs;
use crate::engine::pin_strips::PinStrips;
use crate::engine::strips::DiscSector;

/// The sweep that does what a scene needs and nothing else; chosen once per run.
pub(super) fn sweep_locally(needs: Needs) -> Sweep {
    match (needs.distinct, needs.disc_wears) {
        (false, false) => sweep_local::<false, false>,
        (false, true) => sweep_local::<false, true>,
        (true, false) => sweep_local::<true, false>,
        (true, true) => sweep_local::<true, true>,
    }
}

kernel! {
    /// Sweeps a span.
    pub fn sweep_local<const DISTINCT, const DISC_WEARS>(
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
fn sweep_strips<L: Lanes, const DISTINCT: bool, const DISC_WEARS: bool>(
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
        let mut strip = Strip::new::<L, DISTINCT, true>(index, pin, disc, span, joined);
        let strip_rules = StripRules::<L>::new(rules, conditions, index);
        let (mut strip_moved, mut next) = (StripMoved::<L>::new(), StripReading::<L, DISTINCT>::new());
        let edge = Edge::strip(conditions.ahead, index);
        strip.pin.touches[span.columns] = edge.touches;
        let some = strip.extent.some.clone();
        let mut behind = strip.behind::<L, DISTINCT>(some.start);
        let mut unusual = 0;
        for first in some.clone().step_by(COLUMNS) {
            deposit::<DISTINCT, DISC_WEARS>(rules, conditions, &edge, &mut strip, first, moved);
            let (mut column, end) = (first, some.end.min(first + COLUMNS));
            while column < end {
                if !DISTINCT && rules.shortcut && unusual <= MOST_UNUSUAL {
                    column = sweep_ordinary_locally::<L, DISTINCT, DISC_WEARS>(
                        &strip_rules,
                        &mut strip,
                        column..end,
                        &mut behind,
                        &mut next,
                    );
                    if column == end {
                        break;
                    }
                    unusual += 1;
                }
                behind = update::<L, DISTINCT, DISC_WEARS>(
                    &strip_rules,
                    &mut strip,
                    column,
                    behind,
                    &mut strip_moved,
                    &mut moved.seldom,
                    &mut next,
                    reading,
                );
                column += 1;
            }
        }
        strip_moved.store::<DISTINCT, true>(index, moved);
        next.store(index, reading);
    }
}

/// Wears the eight cells of a column, and reads what they do with what lies behind; returns what lies behind the next.
#[inline(always)]
#[expect(clippy::too_many_arguments, reason = "what is summed stays in registers")]
fn update<L: Lanes, const DISTINCT: bool, const DISC_WEARS: bool>(
    rules: &StripRules<L>,
    strip: &mut Strip,
    column: usize,
    behind: Behind<L>,
    moved: &mut StripMoved<L>,
    seldom: &mut Vec<SeldomEvent>,
    next: &mut StripReading<L, DISTINCT>,
    reading: &mut Reading,
) -> Behind<L> {
    let fields = [&*strip.pin.height, &*strip.pin.substrate, &*strip.disc_height, &*strip.disc_substrate];
    let cells = Cells::<L>::load::<DISTINCT, DISC_WEARS, true>(fields, strip.pin.resin[column], [column, column]);
    let worn = wear::<L, DISTINCT, DISC_WEARS, true>(rules, cells);
    if DISTINCT {
        moved.lost_pin = rules.plus_loss(moved.lost_pin, worn.lost_pin);
        if DISC_WEARS {
            moved.lost_disc = rules.plus_loss(moved.lost_disc, worn.lost_disc);
        }
    } else if worn.worn_through.any() {
        let (mut heights, mut gaps) = (Chunk([0.0; LANES]), Chunk([0.0; LANES]));
        (worn.b_p - cells.z_p).store(&mut heights);
        (cells.z_p - cells.z_d).store(&mut gaps);
        note_seldom(seldom, &heights, &gaps, 0, worn.worn_through.byte(), rules.strip);
    }
    let z_p = L::select(worn.worn_through, worn.b_p, worn.z_p);
    let b_p = worn.b_p.greater(z_p);
    z_p.store(&mut strip.pin.height[column]);
    b_p.store(&mut strip.pin.substrate[column]);
    if DISC_WEARS {
        worn.z_d.store(&mut strip.disc_height[column]);
        worn.b_d.store(&mut strip.disc_substrate[column]);
    }

    // 4.1 of the next step.
    let pin_secondary = z_p.below(b_p);
    strip.pin.plateau[column] = (pin_secondary | !worn.on_resin).byte();
    let pairs = Pairs { on_resin: worn.on_resin, pin_secondary, disc_secondary: behind.secondary };
    let place = [strip.index, strip.first + column];
    strip.pin.touches[column] = next.add(z_p - behind.height, pairs, &rules.bracket, place, reading).byte();
    let nothing = L::Mask::of_byte(0);
    Behind { height: worn.z_d, secondary: if DISTINCT { worn.b_d.below(worn.z_d) } else { nothing } }
}
