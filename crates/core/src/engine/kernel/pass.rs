//! One pass over the pin: deposits and wear of a step, and the pairs of the next step against a bracket (model 4L, 4.2, and
//! 4.1 of the next step).
//!
//! In the next step the disc column under pin column j lies under column j + 1. So when column j + 1 has been updated, the
//! new heights of that pair are at hand, and are read on the way. Which pairs touch is known from the reading. Debris first
//! comes upon the open cells of a strip, as [`super::deposit`] has it; that leaves what touches as it is at the start of the
//! step, and then that wears. With a transport length the deposit wears, too, and the pairs are read after it.
//!
//! In most steps nothing out of the ordinary happens to most cells. Eight such cells at a time are done with few
//! instructions ([`super::ordinary`]), which also show where something else happens; those eight are then done by all rules. What a reading
//! seldom finds is looked for after a strip, in bytes that it leaves: in every column that would be a branch which goes either way.

use super::deposit::deposit;
use super::edges::wear_before_deposit;
use super::instructions::{InstructionSet, kernel, with_build_up};
use super::moved::{Moved, SeldomEvent, StripMoved};
use super::ordinary::pass_over_ordinary;
use super::pairs::Pairs;
use super::read::{Span, read_span};
use super::reading::{Reading, SeldomColumns, StripReading};
use super::rules::{Conditions, Rules, StripRules};
use super::strip::Strip;
use super::worn_column::{store_worn, wear_and_note, wear_any_and_note};
use crate::engine::lanes::{Lanes, Mask};
use crate::engine::parts::{Needs, build_up};
use crate::engine::strips::{DiscSector, PinStrips};

/// Columns of a strip with something out of the ordinary after which it is not looked for any more.
const MOST_UNUSUAL: usize = 12;

/// A pass over a span; the flag is [`joined`](crate::engine::sector::Segment::joined): the pair that the first pin column has in the next step
/// is read, too.
pub type Pass =
    fn(InstructionSet, &Rules, &Conditions, &mut PinStrips, &mut DiscSector, Span, bool, &mut Moved, &mut Reading);

/// The pass that does what a scene needs and nothing else; chosen once per run.
pub fn pass(needs: Needs) -> Pass {
    match (needs.build_up(), needs.disc_wears) {
        (build_up::NONE, false) => pass_over_span::<{ build_up::NONE }, false, false>,
        (build_up::NONE, true) => pass_over_span::<{ build_up::NONE }, true, false>,
        _ if needs.transport.is_some() => with_build_up!(needs, pass_over_span, true),
        _ => with_build_up!(needs, pass_over_span, false),
    }
}

/// Passes over a span.
#[expect(clippy::too_many_arguments, reason = "the kernel's own")]
fn pass_over_span<const BUILD_UP: u8, const DISC_WEARS: bool, const TRANSPORT: bool>(
    set: InstructionSet,
    rules: &Rules,
    conditions: &Conditions,
    pin: &mut PinStrips,
    disc: &mut DiscSector,
    span: Span,
    joined: bool,
    moved: &mut Moved,
    reading: &mut Reading,
) {
    // A strip stays near the processor in between.
    for strip in 0..pin.height.strips() {
        if TRANSPORT {
            wear_before_deposit::<BUILD_UP, DISC_WEARS>(set, rules, conditions, pin, disc, span, strip, moved);
        }
        if BUILD_UP != build_up::NONE {
            deposit::<BUILD_UP, DISC_WEARS, TRANSPORT>(set, rules, conditions, pin, disc, span, strip, moved);
        }
        if TRANSPORT {
            let turned = span.turned(pin.extent(strip, span.first..span.first + span.columns), joined);
            read_span::<BUILD_UP>(set, pin, disc, turned, strip..strip + 1, &conditions.bracket, reading);
        } else {
            wear_strip::<BUILD_UP, DISC_WEARS>(set, rules, conditions, pin, disc, span, strip, joined, moved, reading);
        }
    }
}

kernel! {
    /// Wears a strip of a span, and reads its pairs of the next step.
    pub fn wear_strip<const BUILD_UP: u8, const DISC_WEARS: bool>(
        rules: &Rules,
        conditions: &Conditions,
        pin: &mut PinStrips,
        disc: &mut DiscSector,
        span: Span,
        index: usize,
        joined: bool,
        moved: &mut Moved,
        reading: &mut Reading,
    ) = pass_over_strip
}

#[inline(always)]
#[expect(clippy::too_many_arguments, reason = "the kernel's own")]
fn pass_over_strip<L: Lanes, const BUILD_UP: u8, const DISC_WEARS: bool>(
    rules: &Rules,
    conditions: &Conditions,
    pin: &mut PinStrips,
    disc: &mut DiscSector,
    span: Span,
    index: usize,
    joined: bool,
    moved: &mut Moved,
    reading: &mut Reading,
) {
    let mut strip = Strip::new::<L, BUILD_UP>(index, pin, disc, span, joined);
    let strip_rules = StripRules::<L>::new(rules, conditions, index);
    let (mut strip_moved, mut next) = (StripMoved::<L>::new(), StripReading::<L, BUILD_UP>::new());
    let some = strip.extent.clone();
    reading.begin_strip(some.end);
    let mut unusual = 0;
    let (mut column, mut block_end) = (some.start, some.start);
    while column < some.end {
        if column == block_end {
            block_end = strip.fetch_next::<BUILD_UP, DISC_WEARS>(column, some.end);
        }
        if BUILD_UP != build_up::DISTINCT && rules.shortcut && column > some.start && unusual <= MOST_UNUSUAL {
            column = pass_over_ordinary::<L, BUILD_UP, DISC_WEARS>(
                &strip_rules,
                &mut strip,
                column..block_end,
                &mut next,
                &mut reading.reached,
            );
            if column == block_end {
                continue;
            }
            unusual += 1;
        }
        update::<L, BUILD_UP, DISC_WEARS>(
            &strip_rules,
            &mut strip,
            column,
            &mut strip_moved,
            &mut moved.seldom,
            &mut next,
            reading,
        );
        column += 1;
    }
    strip_moved.store::<BUILD_UP, DISC_WEARS>(&strip_rules, index, some.len(), moved);
    next.store(index, reading);
    let mut seldom = SeldomColumns::of(&mut reading.reached, strip.pin.touches, strip.pin.plateau);
    while let Some(column) = seldom.next::<L>(&reading.reached) {
        let (z_p, behind) = (L::load(&strip.pin.height[column]), strip.behind::<L, BUILD_UP>(column));
        let pairs = Pairs {
            on_resin: L::Mask::of_byte(strip.pin.resin[column]),
            pin_secondary: strip.pin_secondary::<L, BUILD_UP>(column),
            disc_secondary: behind.secondary,
        };
        let (bare, place) = (!strip.pin.plateau[column], [index, strip.first + column]);
        let bracket = &strip_rules.bracket;
        StripReading::<L, BUILD_UP>::note_seldom(z_p - behind.height, bare, pairs, bracket, place, reading);
    }
}

/// Wears the eight cells of a column, and reads what they do with what lies behind.
#[inline(always)]
fn update<L: Lanes, const BUILD_UP: u8, const DISC_WEARS: bool>(
    rules: &StripRules<L>,
    strip: &mut Strip,
    column: usize,
    moved: &mut StripMoved<L>,
    seldom: &mut Vec<SeldomEvent>,
    next: &mut StripReading<L, BUILD_UP>,
    reading: &mut Reading,
) {
    let worn = if BUILD_UP == build_up::DISTINCT {
        wear_and_note::<L, BUILD_UP, DISC_WEARS>(rules, strip, column, moved, seldom)
    } else {
        wear_any_and_note::<L, BUILD_UP, DISC_WEARS>(rules, strip, column, seldom)
    };
    let (z_p, pin_secondary) = store_worn::<L, BUILD_UP, DISC_WEARS>(strip, column, &worn);

    // 4.1 of the next step.
    let behind = strip.behind::<L, BUILD_UP>(column);
    let pairs = Pairs { on_resin: worn.on_resin, pin_secondary, disc_secondary: behind.secondary };
    let gap = z_p - behind.height;
    [strip.pin.touches[column], reading.reached[column]] =
        next.add(gap, pairs, &rules.bracket, strip.index, &mut reading.overlap);
}
