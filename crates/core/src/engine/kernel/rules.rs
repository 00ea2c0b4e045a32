//! Rules of a scene and conditions of a step, as the kernels need them.

use super::edge::{Edge, Reach};
use super::pairs::{ChunkTable, Entries};
use super::reading::{Bracket, BracketLanes};
use crate::engine::coefficients::Coefficients;
use crate::engine::exact::Quantum;
use crate::engine::lanes::{Integers, Lanes};
use crate::engine::parts::Needs;
use crate::model::material::Status;
use crate::model::parameters::Parameters;

/// Rules of a scene, the same in every step until its coefficients change.
#[derive(Debug, Clone, PartialEq)]
pub struct Rules {
    /// Raw loss of the pin per overlap, negative: the kernels have −u at hand.
    pub(super) pin_loss: ChunkTable,
    /// Raw loss of the disc per overlap, negative.
    pub(super) disc_loss: ChunkTable,
    pub(super) fibre: ChunkTable,
    pub(super) coating: ChunkTable,
    /// Wear height h_m, m.
    pub(super) wear_height: f64,
    /// Clearance −σ_b/k on the coating and on the disc's build-up, m: with less, build-up on resin breaks away; none where it
    /// never does.
    pub(super) strength: Option<[f64; 2]>,
    /// Level z_ref up to which local debris fills the disc, m.
    pub(super) reference_height: f64,
    /// Captured fraction η, of plateaus and of resin, 1.
    captured_fraction: f64,
    captured_resin_fraction: f64,
    /// Columns over which debris is spread: [`Needs::transport`].
    pub transport: Option<usize>,
    /// Number of these columns: L, or 1 without a transport length.
    pub(super) reach: usize,
    /// Reach where nothing lies ahead.
    pub(super) nothing_ahead: Reach,
    /// Factor η/L of v̄, 1; 0 without a transport length.
    pub(super) transport_part: f64,
    /// True if cells to which nothing out of the ordinary happens are done with few instructions; the results are the same.
    pub(super) shortcut: bool,
}

impl Rules {
    /// The rules of a scene whose disc was at most `reference_height` (m) high at the start.
    pub fn new(parameters: &Parameters, coefficients: &Coefficients, reference_height: f64, shortcut: bool) -> Self {
        let (materials, plateaus) = (&parameters.materials, &parameters.plateaus);
        let transport = Needs::of(parameters).transport;
        let reach = transport.unwrap_or(1);
        Self {
            pin_loss: ChunkTable::new(&coefficients.pin, -1.0),
            disc_loss: ChunkTable::new(&coefficients.disc, -1.0),
            fibre: ChunkTable::new(&coefficients.fibre, 1.0),
            coating: ChunkTable::new(&coefficients.coating, 1.0),
            wear_height: materials.wear_height,
            strength: materials.strength.map(|strength| {
                [false, true].map(|on_secondary| {
                    let modulus = materials.combined_modulus(Status::Secondary, on_secondary);
                    -strength * parameters.foundation_height / modulus
                })
            }),
            reference_height,
            captured_fraction: plateaus.captured_fraction,
            captured_resin_fraction: plateaus.captured_of_resin(),
            transport,
            reach,
            nothing_ahead: Reach::none(reach),
            transport_part: parameters
                .transport_columns()
                .map_or(0.0, |columns| plateaus.captured_fraction / columns as f64),
            shortcut,
        }
    }
}

/// Conditions of a step, which change from one to the next.
#[derive(Debug, Clone, Copy)]
pub struct Conditions<'a> {
    /// Displacement δ, m.
    pub displacement: f64,
    /// The column ahead of the last of the span, if there is one.
    pub ahead: Option<&'a Edge>,
    /// Quantum of the deposits, m.
    pub deposit_quantum: Quantum,
    /// Coarse quantum of the losses, and fine one of what that leaves of them, m.
    pub loss_quanta: [Quantum; 2],
    /// Displacements between which the next load balance is expected.
    pub bracket: Bracket,
    /// The strip of the mesh that is the first of the worker.
    pub first_strip: usize,
}

impl<'a> Conditions<'a> {
    /// Returns the reach ahead of a strip of the worker.
    pub(super) fn ahead_of(&self, strip: usize, rules: &'a Rules) -> &'a Reach {
        self.ahead.map_or(&rules.nothing_ahead, |edge| &edge.strips[strip])
    }
}

/// Rules and conditions of a strip, for eight cells at a time.
pub(super) struct StripRules<'a, L: Lanes> {
    pub rules: &'a Rules,
    pub conditions: &'a Conditions<'a>,
    /// Strip of the mesh.
    pub strip: usize,
    pub zero: L,
    pub displacement: L,
    /// Number whose last bit is worth a quantum of the deposits.
    deposit_anchor: L,
    /// Numbers whose last bits are worth a coarse and a fine quantum of the losses.
    loss_anchors: [L; 2],
    pub bracket: BracketLanes<L>,
    /// Raw loss of the pin per overlap, negative.
    pub pin_loss: Entries<L>,
    /// Raw loss of the disc per overlap, negative.
    pub disc_loss: Entries<L>,
    /// Ratio Δh_sub/Δh of the fibre below a build-up, 1.
    pub fibre: Entries<L>,
    /// Ratio Δh_sub/Δh of the coating below a build-up, 1.
    pub coating: Entries<L>,
}

impl<'a, L: Lanes> StripRules<'a, L> {
    #[inline(always)]
    pub fn new(rules: &'a Rules, conditions: &'a Conditions, strip: usize) -> Self {
        let strip = conditions.first_strip + strip;
        Self {
            rules,
            conditions,
            strip,
            zero: L::splat(0.0),
            displacement: L::splat(conditions.displacement),
            deposit_anchor: L::splat(conditions.deposit_quantum.anchor()),
            loss_anchors: [L::splat(conditions.loss_quanta[0].anchor()), L::splat(conditions.loss_quanta[1].anchor())],
            bracket: BracketLanes::new(&conditions.bracket),
            pin_loss: rules.pin_loss.strip(strip),
            disc_loss: rules.disc_loss.strip(strip),
            fibre: rules.fibre.strip(strip),
            coating: rules.coating.strip(strip),
        }
    }

    /// Wear height h_m, m.
    #[inline(always)]
    pub fn wear_height(&self) -> L {
        L::splat(self.rules.wear_height)
    }

    /// Part of losses that may be compacted behind, m.
    #[inline(always)]
    pub fn captured(&self, lost: L) -> L {
        lost * L::splat(self.rules.captured_fraction)
    }

    /// Part of the wear height of resin that may be compacted behind, m.
    #[inline(always)]
    pub fn captured_of_resin(&self) -> L {
        self.wear_height() * L::splat(self.rules.captured_resin_fraction)
    }

    /// Adds a deposit (m) to a sum of anchored ones.
    #[inline(always)]
    pub fn plus_deposit(&self, sum: L::Integers, height: L) -> L::Integers {
        sum.plus((self.deposit_anchor + height).bits())
    }

    /// Sum of so many anchored deposits in quanta.
    #[inline(always)]
    pub fn deposits(&self, sum: L::Integers, terms: usize) -> L::Integers {
        without(sum, self.conditions.deposit_quantum, terms)
    }

    /// Adds a loss (m) to the sums of losses anchored in coarse quanta, and of what those leave in fine ones.
    #[inline(always)]
    pub fn plus_loss(&self, [coarse, fine]: [L::Integers; 2], height: L) -> [L::Integers; 2] {
        let [coarse_anchor, fine_anchor] = self.loss_anchors;
        let anchored = coarse_anchor + height;
        let rest = fine_anchor + (height - (anchored - coarse_anchor));
        [coarse.plus(anchored.bits()), fine.plus(rest.bits())]
    }

    /// Sums of so many anchored losses in quanta.
    #[inline(always)]
    pub fn losses(&self, [coarse, fine]: [L::Integers; 2], terms: usize) -> [L::Integers; 2] {
        let [coarse_quantum, fine_quantum] = self.conditions.loss_quanta;
        [without(coarse, coarse_quantum, terms), without(fine, fine_quantum, terms)]
    }
}

/// A sum of so many terms without their anchors.
#[inline(always)]
fn without<I: Integers>(sum: I, quantum: Quantum, terms: usize) -> I {
    sum.minus(I::splat((quantum.anchor().to_bits() as i64).wrapping_mul(terms as i64)))
}
