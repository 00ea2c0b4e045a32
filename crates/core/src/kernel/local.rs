//! One pass over the pin with local debris: wear and deposits of a step, and the pairs of the next step against a bracket
//! (model 4.2, 4L, and 4.1 of the next step).
//!
//! What a cell gets depends on what the cell ahead of it loses, so a column is worn one column before it is finished.

use super::cells::{Behind, Strip};
use super::edge::Ahead;
use super::instructions::kernel;
use super::lanes::{Chunk, Integers, LANES, Lanes, Mask};
use super::moved::{Moved, SeldomEvent, StripMoved, note_deposits, note_seldom};
use super::pairs::Pairs;
use super::read::Span;
use super::reading::{Reading, StripReading};
use super::rules::{Conditions, Rules, StripRules};
use super::sweep::Sweep;
use super::worn::{Cells, Worn, wear};
use crate::parts::Needs;
use crate::strips::{DiscSector, PinStrips};

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
        let rules = StripRules::<L>::new(rules, conditions, index);
        let mut strip = Strip::new::<L, DISTINCT, true>(index, pin, disc, span, joined);
        let edge = Ahead::of_edge(conditions.ahead, &rules, index);
        let (mut strip_moved, mut next) = (StripMoved::<L>::new(), StripReading::<L, DISTINCT>::new());
        let mut behind = strip.behind::<L, DISTINCT>(0);
        let (mut cells, mut worn) = strip.wear::<L, DISTINCT, DISC_WEARS>(&rules, 0);
        for column in 0..span.columns {
            let mut ahead = edge;
            let mut next_worn = (cells, worn);
            if column + 1 < span.columns {
                next_worn = strip.wear::<L, DISTINCT, DISC_WEARS>(&rules, column + 1);
                let plateau = strip.pin.plateau[column + 1];
                ahead = Ahead::new::<DISTINCT, DISC_WEARS>(&rules, &next_worn.0, &next_worn.1, plateau);
            }
            behind = finish::<L, DISTINCT, DISC_WEARS>(
                &rules,
                &mut strip,
                column,
                &cells,
                &worn,
                ahead,
                behind,
                &mut strip_moved,
                &mut moved.seldom,
                &mut next,
                reading,
            );
            (cells, worn) = next_worn;
        }
        strip_moved.store::<DISTINCT, true>(index, moved);
        next.store(index, reading);
    }
}

impl Strip<'_> {
    /// Wears the eight cells of a column, without changing them.
    #[inline(always)]
    fn wear<L: Lanes, const DISTINCT: bool, const DISC_WEARS: bool>(
        &self,
        rules: &StripRules<L>,
        column: usize,
    ) -> (Cells<L>, Worn<L>) {
        let fields = [&*self.pin.height, &*self.pin.substrate, &*self.disc_height, &*self.disc_substrate];
        let cells = Cells::load::<DISTINCT, DISC_WEARS, true>(fields, self.pin.resin[column], [column, column]);
        (cells, wear::<L, DISTINCT, DISC_WEARS, true>(rules, cells))
    }
}

/// Compacts debris of the column ahead in the eight cells of a worn column, stores them, and reads what they do with what
/// lies behind; returns what lies behind the next.
#[inline(always)]
#[expect(clippy::too_many_arguments, reason = "what is summed stays in registers")]
fn finish<L: Lanes, const DISTINCT: bool, const DISC_WEARS: bool>(
    rules: &StripRules<L>,
    strip: &mut Strip,
    column: usize,
    cells: &Cells<L>,
    worn: &Worn<L>,
    ahead: Ahead<L>,
    behind: Behind<L>,
    moved: &mut StripMoved<L>,
    seldom: &mut Vec<SeldomEvent>,
    next: &mut StripReading<L, DISTINCT>,
    reading: &mut Reading,
) -> Behind<L> {
    // 4.2 Build-up on resin that is worn through.
    if DISTINCT {
        moved.spared_pin = moved.spared_pin.plus(rules.loss(worn.spared_pin));
        if DISC_WEARS {
            moved.spared_disc = moved.spared_disc.plus(rules.loss(worn.spared_disc));
        }
    } else if worn.worn_through.any() {
        let (mut heights, mut raw_losses) = (Chunk([0.0; LANES]), Chunk([0.0; LANES]));
        (worn.b_p - cells.z_p).store(&mut heights);
        worn.raw_pin.store(&mut raw_losses);
        note_seldom(seldom, &heights, &raw_losses, 0, worn.worn_through.byte(), rules.strip);
    }
    let z_p = L::select(worn.worn_through, worn.b_p, worn.z_p);
    let b_p = worn.b_p.greater(z_p);

    // 4L
    let reference = rules.reference_height();
    let flush = L::select(ahead.plateau, z_p.lesser(ahead.height), z_p);
    let (to_plateau, to_reference) = (z_p - flush, reference - worn.z_d);
    let room = worn.clearance.lesser(to_plateau + to_reference);
    let deposit = room.lesser(ahead.caught).only(!worn.touches);
    let on_pin = deposit.lesser(to_plateau);
    let on_disc = deposit - on_pin;
    // Neither beyond the plateau ahead nor above the reference, in rounded numbers too.
    let z_p = (z_p - on_pin).greater(flush);
    let z_d = (worn.z_d + on_disc).lesser(reference);
    let of_resin = ahead.resin & rules.zero.below(deposit);
    if of_resin.any() {
        let (mut pin_heights, mut disc_heights) = (Chunk([0.0; LANES]), Chunk([0.0; LANES]));
        on_pin.store(&mut pin_heights);
        on_disc.store(&mut disc_heights);
        note_deposits(seldom, &pin_heights, &disc_heights, of_resin.byte(), rules.strip);
    }
    moved.deposited_pin = moved.deposited_pin.plus(rules.deposit(on_pin.only(!of_resin)));
    moved.deposited_disc = moved.deposited_disc.plus(rules.deposit(on_disc.only(!of_resin)));

    z_p.store(&mut strip.pin.height[column]);
    b_p.store(&mut strip.pin.substrate[column]);
    z_d.store(&mut strip.disc_height[column]);
    if DISC_WEARS {
        worn.b_d.store(&mut strip.disc_substrate[column]);
    }

    // 4.1 of the next step.
    let pin_secondary = z_p.below(b_p);
    strip.pin.plateau[column] = (pin_secondary | !worn.on_resin).byte();
    let pairs = Pairs { on_resin: worn.on_resin, pin_secondary, disc_secondary: behind.secondary };
    next.add(z_p - behind.height, pairs, &rules.bracket, strip.index, reading);
    let nothing = L::Mask::of_byte(0);
    Behind { height: z_d, secondary: if DISTINCT { worn.b_d.below(z_d) } else { nothing } }
}
