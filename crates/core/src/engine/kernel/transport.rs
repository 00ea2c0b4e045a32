//! Local debris over a transport length: what plateaus lose within that length ahead of an edge fills the open cells within
//! that length behind it (model 4L).
//!
//! One scan along a strip against the sliding direction, eight rows at a time, before any cell wears: what touches is worn in
//! passing. A cell knows of what lies ahead of it by a [`Reach`].

use super::deposit::taken_back;
use super::edge::{Edge, Reach};
use super::instructions::{InstructionSet, kernel, with_build_up};
use super::moved::{Moved, add};
use super::pairs::lanes_of;
use super::read::Span;
use super::rules::{Conditions, Rules, StripRules};
use super::strip::Strip;
use super::worn::{Cells, wear};
use crate::engine::lanes::{Chunk, Integers, LANES, Lanes, Mask};
use crate::engine::parts::{Needs, build_up};
use crate::engine::pin_strips::PinStrips;
use crate::engine::strips::DiscSector;

/// Compacts debris in all columns of a span in which no cell has worn yet; where an edge is given, nothing changes but that:
/// what the first column of the span means to the one behind it.
pub type Transport =
    fn(InstructionSet, &Rules, &Conditions, &mut PinStrips, &mut DiscSector, Span, &mut Moved, Option<&mut Edge>);

/// The transport that does what a scene needs and nothing else; chosen once per run.
pub fn transport(needs: Needs) -> Transport {
    with_build_up!(needs, deposit_over_span)
}

kernel! {
    /// Compacts debris in a span.
    pub fn deposit_over_span<const BUILD_UP: u8, const DISC_WEARS: bool>(
        rules: &Rules,
        conditions: &Conditions,
        pin: &mut PinStrips,
        disc: &mut DiscSector,
        span: Span,
        moved: &mut Moved,
        edge: Option<&mut Edge>,
    ) = deposit_over_strips
}

#[inline(always)]
fn deposit_over_strips<L: Lanes, const BUILD_UP: u8, const DISC_WEARS: bool>(
    rules: &Rules,
    conditions: &Conditions,
    pin: &mut PinStrips,
    disc: &mut DiscSector,
    span: Span,
    moved: &mut Moved,
    mut edge: Option<&mut Edge>,
) {
    let none = Reach::none(rules.transport.unwrap_or(1));
    for index in 0..pin.height.strips() {
        let mut strip = Strip::new::<L, BUILD_UP>(index, pin, disc, span, false);
        let strip_rules = StripRules::<L>::new(rules, conditions, index);
        let mut ahead = conditions.ahead.map_or(&none, |edge| &edge.reaches[index]);
        // Where the strip ends before the span, what is ahead belongs to cells that are not there.
        if strip.extent.end < span.columns {
            ahead = &none;
        }
        let first = match &mut edge {
            Some(edge) => {
                edge.reaches.push(none.clone());
                edge.reaches.last_mut()
            }
            None => None,
        };
        deposit_over::<L, BUILD_UP, DISC_WEARS>(&strip_rules, conditions, &mut strip, ahead, moved, first);
    }
}

/// Compacts debris in all columns of a strip; where `first` is given, nothing changes but that: what the first column means to
/// the column behind it.
#[inline(always)]
fn deposit_over<L: Lanes, const BUILD_UP: u8, const DISC_WEARS: bool>(
    rules: &StripRules<L>,
    conditions: &Conditions,
    strip: &mut Strip,
    ahead: &Reach,
    moved: &mut Moved,
    first: Option<&mut Reach>,
) {
    let changes = first.is_none();
    let reach = ahead.lost.len();
    let extent = strip.extent.clone();
    let mut lost = std::mem::take(&mut moved.lost);
    // What is there of another strip is overwritten before it is read.
    lost.resize(extent.end, Chunk([0.0; LANES]));
    lost.extend_from_slice(&ahead.lost);
    let mut touches = std::mem::take(&mut moved.touches);
    touches.clear();
    touches.extend_from_slice(&strip.pin.touches[..extent.end]);
    touches.extend_from_slice(&ahead.touches);

    let reference = L::splat(rules.rules.reference_height);
    let part = L::splat(rules.rules.transport_part);
    let one = L::splat(1.0);
    let (mut share, mut remaining) = (L::load(&ahead.share), L::load(&ahead.remaining));
    let (mut height_ahead, mut plateau_ahead) = (L::load(&ahead.height), ahead.plateau);
    let (mut on_pins, mut on_discs) = (L::Integers::splat(0), L::Integers::splat(0));
    let mut column = extent.end;
    while column > extent.start {
        column -= 1;
        let (z_p, z_d) = (L::load(&strip.pin.height[column]), L::load(&strip.disc_height[column]));
        let (touching, plateau) = (touches[column], strip.pin.plateau[column]);
        // Also where nothing touches: a branch that goes either way costs more.
        let worn = worn_of::<L, BUILD_UP, DISC_WEARS>(rules, strip, column);
        let worn_height = L::select(L::Mask::of_byte(touching), worn.height, z_p);
        worn.lost.only(L::Mask::of_byte(touching & plateau)).store(&mut lost[column]);
        let edges = !touching & touches[column + 1];
        if edges != 0 {
            let edges = L::Mask::of_byte(edges);
            share = L::select(
                edges,
                gathered::<L>(edges, &touches[column + 1..], &lost[column + 1..], reach) * part,
                share,
            );
            remaining = L::select(edges, L::splat(reach as f64), remaining);
        }
        let receivers = !touching & L::splat(0.0).below(remaining).byte() & present(strip, column);
        if changes {
            let flush = L::select(L::Mask::of_byte(plateau_ahead), z_p.lesser(height_ahead), z_p);
            let (to_plateau, to_reference) = (z_p - flush, (reference - z_d).greater(rules.zero));
            let clearance = z_p - z_d - rules.displacement;
            let deposit = clearance.lesser(to_plateau + to_reference).lesser(share);
            let gaining = L::Mask::of_byte(receivers) & rules.zero.below(deposit);
            if gaining.any() {
                let deposit = deposit.only(gaining);
                let on_pin = deposit.lesser(to_plateau);
                let on_disc = deposit - on_pin;
                // Neither beyond the plateau ahead nor above the reference, in rounded numbers too.
                let mut height = (z_p - on_pin).greater(flush);
                let mut disc_height = (z_d + on_disc).lesser(reference.greater(z_d));
                // Nor does a cell touch in the step in which it is filled up.
                let filled = gaining & (height - disc_height - rules.displacement).below(rules.zero);
                if filled.any() {
                    [height, disc_height] =
                        taken_back_of::<L>(filled.byte(), [z_p, z_d], [height, disc_height], conditions);
                }
                let substrate = L::load(&strip.pin.substrate[column]);
                let kept = L::select(gaining, substrate.greater(z_p), substrate);
                L::select(gaining, height, z_p).store(&mut strip.pin.height[column]);
                L::select(gaining, disc_height, z_d).store(&mut strip.disc_height[column]);
                kept.store(&mut strip.pin.substrate[column]);
                strip.pin.plateau[column] = plateau | (gaining & height.below(kept)).byte();
                on_pins = rules.plus_deposit(on_pins, on_pin);
                on_discs = rules.plus_deposit(on_discs, on_disc);
            }
        }
        remaining = (remaining - one).only(!L::Mask::of_byte(touching));
        (height_ahead, plateau_ahead) = (worn_height, plateau);
    }
    add::<L>(&mut moved.deposited_pin.0[strip.index], on_pins);
    add::<L>(&mut moved.deposited_disc.0[strip.index], on_discs);

    if let Some(first) = first.filter(|_| extent.start == 0) {
        height_ahead.store(&mut first.height);
        share.store(&mut first.share);
        remaining.greater(rules.zero).store(&mut first.remaining);
        first.plateau = plateau_ahead;
        first.touches.copy_from_slice(&touches[..reach]);
        first.lost.copy_from_slice(&lost[..reach]);
    }
    (moved.lost, moved.touches) = (lost, touches);
}

/// Eight cells after wear, and what plateaus among them and the disc under them lost, m.
struct WornColumn<L> {
    height: L,
    lost: L,
}

/// Wears the eight cells of a column without changing them; of no meaning for cells that do not touch.
#[inline(always)]
fn worn_of<L: Lanes, const BUILD_UP: u8, const DISC_WEARS: bool>(
    rules: &StripRules<L>,
    strip: &Strip,
    column: usize,
) -> WornColumn<L> {
    let fields = [&*strip.pin.height, &*strip.pin.substrate, &*strip.disc_height, &*strip.disc_substrate];
    let cells = Cells::<L>::load::<BUILD_UP, DISC_WEARS>(fields, strip.pin.resin[column], [column, column]);
    if BUILD_UP == build_up::DISTINCT {
        let worn = wear::<L, BUILD_UP, DISC_WEARS>(rules, cells);
        let ends = worn.worn_through | worn.broken;
        return WornColumn { height: L::select(ends, worn.b_p, worn.z_p), lost: worn.lost_pin + worn.lost_disc };
    }
    let clearance = cells.z_p - cells.z_d - rules.displacement;
    let raw = clearance * rules.pin_loss().plateau();
    let through = cells.on_resin & (cells.z_p + raw).at_least(cells.b_p);
    let mut lost = L::select(through, cells.b_p - cells.z_p, raw);
    if DISC_WEARS {
        lost = lost + clearance * rules.disc_loss().plateau();
    }
    let mut ends = through;
    if BUILD_UP == build_up::BRITTLE
        && let Some([least, _]) = rules.rules.strength
    {
        ends = ends | (cells.on_resin & clearance.below(L::splat(least)));
    }
    WornColumn { height: L::select(ends, cells.b_p, cells.z_p + raw), lost }
}

/// Σ v over the cells from the first of these columns on, as long as they touch, of at most `reach` columns; for some rows.
#[inline(always)]
fn gathered<L: Lanes>(rows: L::Mask, touches: &[u8], lost: &[Chunk], reach: usize) -> L {
    let (mut sum, mut run) = (L::splat(0.0), rows.byte());
    let mut column = 0;
    while column < reach {
        run &= touches[column];
        if run == 0 {
            break;
        }
        sum = sum + L::load(&lost[column]).only(L::Mask::of_byte(run));
        column += 1;
    }
    sum
}

/// Which cells of a column are there.
#[inline(always)]
fn present(strip: &Strip, column: usize) -> u8 {
    if strip.pin.present.is_empty() { u8::MAX } else { strip.pin.present[column] }
}

/// Heights of pin and disc, m, of which rounding leaves some touching: what is too much goes back.
#[cold]
#[inline(never)]
fn taken_back_of<L: Lanes>(filled: u8, before: [L; 2], after: [L; 2], conditions: &Conditions) -> [L; 2] {
    let chunk = |lanes: L| {
        let mut chunk = Chunk([0.0; LANES]);
        lanes.store(&mut chunk);
        chunk
    };
    let ([z_p, z_d], [mut height, mut disc_height]) = (before.map(chunk), after.map(chunk));
    for lane in lanes_of(filled) {
        [height.0[lane], disc_height.0[lane]] =
            taken_back([z_p.0[lane], z_d.0[lane]], [height.0[lane], disc_height.0[lane]], conditions.displacement);
    }
    [L::load(&height), L::load(&disc_height)]
}
