//! Wear of one pair, for the debris that is caught behind it (model 4.2 and 4L): what [`super::worn::wear`] does to eight.

use super::edge::{Ahead, Edge, EdgeStrip};
use super::instructions::with_build_up;
use super::pairs::{PLATEAU, RESIN};
use super::read::Span;
use super::rules::{Conditions, Rules};
use crate::engine::coefficients::StatusPair;
use crate::engine::lanes::{Chunk, LANES};
use crate::engine::parts::{Needs, build_up};
use crate::engine::strips::{DiscSector, PinStrips};
use crate::model::material::Status;

/// A pair of cells at the start of a step; heights in m.
#[derive(Debug, Clone, Copy)]
pub(super) struct Cells {
    pub z_p: f64,
    pub b_p: f64,
    pub z_d: f64,
    pub b_d: f64,
    pub on_resin: bool,
}

impl Ahead {
    /// A pair that touches, after wear.
    #[inline(always)]
    pub fn new<const BUILD_UP: u8, const DISC_WEARS: bool>(
        rules: &Rules,
        row: usize,
        displacement: f64,
        cells: Cells,
    ) -> Self {
        let Cells { z_p, b_p, z_d, on_resin, .. } = cells;
        let clearance = z_p - z_d - displacement;
        if BUILD_UP == build_up::DISTINCT {
            return Self::of_distinct::<DISC_WEARS>(rules, row, clearance, cells);
        }
        let mut lost = clearance * rules.pin_loss.entry(PLATEAU, row);
        let (mut height, mut pair, mut of_resin) = (z_p + lost, PLATEAU, 0.0);
        // Seldom: bare resin, or resin whose build-up is worn through. Nothing is at least a number that is none, so this is
        // one branch, which hardly ever is another than the last.
        let ground = f64::from_bits(b_p.to_bits() | if on_resin { 0 } else { f64::NAN.to_bits() });
        if height >= ground {
            if z_p < b_p {
                (lost, height) = (b_p - z_p, b_p);
            } else {
                (lost, pair, of_resin, height) = (0.0, RESIN, rules.wear_height, f64::INFINITY);
            }
        }
        if DISC_WEARS {
            lost += clearance * rules.disc_loss.entry(pair, row);
        }
        if BUILD_UP == build_up::BRITTLE && on_resin && z_p < b_p && rules.breaks(clearance, false) {
            height = b_p;
        }
        Self { height, captured: rules.captured(lost, of_resin), plateau: pair == PLATEAU }
    }

    /// The same where build-up has properties of its own.
    fn of_distinct<const DISC_WEARS: bool>(rules: &Rules, row: usize, clearance: f64, cells: Cells) -> Self {
        let Cells { z_p, b_p, z_d, b_d, on_resin } = cells;
        let status = match (z_p < b_p, on_resin) {
            (true, _) => Status::Secondary,
            (false, true) => Status::Resin,
            (false, false) => Status::Primary,
        };
        let pair = StatusPair::new(status, b_d < z_d).index();
        let is_resin = status == Status::Resin;
        let raw = if is_resin { 0.0 } else { clearance * rules.pin_loss.entry(pair, row) };
        let below = if on_resin { 0.0 } else { rules.fibre.entry(pair, row) };
        let pin = wear(z_p, b_p, raw, below);
        let of_resin = if is_resin { rules.wear_height } else { 0.0 };
        let mut lost = pin.lost;
        if DISC_WEARS {
            let raw = clearance * rules.disc_loss.entry(pair, row);
            lost += wear(0.0 - z_d, 0.0 - b_d, raw, rules.coating.entry(pair, row)).lost;
        }
        let breaks = on_resin && status == Status::Secondary && rules.breaks(clearance, b_d < z_d);
        let height = match () {
            () if is_resin => f64::INFINITY,
            () if breaks => b_p,
            () => pin.height,
        };
        Self { height, captured: rules.captured(lost, of_resin), plateau: !is_resin }
    }
}

/// A cell of the pin after wear.
struct Worn {
    height: f64,
    lost: f64,
}

/// What [`crate::engine::wear::pin`] does to eight cells.
fn wear(height: f64, substrate: f64, raw: f64, below: f64) -> Worn {
    let build_up = substrate - height;
    if height < substrate && raw >= build_up {
        let deeper = (raw - build_up) * below;
        return Worn { height: substrate + deeper, lost: build_up + deeper };
    }
    Worn { height: height + raw, lost: raw }
}

/// Wears a column of pairs, the first of a span, without changing it.
pub type WearColumn = fn(&Rules, &Conditions, &PinStrips, &DiscSector, Span, &mut Edge);

/// The wear that does what a scene needs and nothing else; chosen once per run.
pub fn wear_column(needs: Needs) -> WearColumn {
    with_build_up!(needs, wear_first)
}

fn wear_first<const BUILD_UP: u8, const DISC_WEARS: bool>(
    rules: &Rules,
    conditions: &Conditions,
    pin: &PinStrips,
    disc: &DiscSector,
    span: Span,
    edge: &mut Edge,
) {
    edge.strips.clear();
    edge.strips.extend((0..pin.height.strips()).map(|strip| {
        let touches = pin.touches(strip)[span.first];
        let pin_chunks = [&pin.height, pin.substrate()].map(|field| field.chunk(strip, span.first));
        let disc_chunks = [&disc.height, disc.substrate()].map(|field| field.chunk(strip, span.over));
        let resin = pin.resin(strip)[span.first];
        let cell = |lane: usize| {
            if touches >> lane & 1 == 0 {
                return Ahead::default();
            }
            let of = |chunk: &Chunk| chunk.0[lane];
            let [z_p, b_p] = pin_chunks.map(of);
            let [z_d, b_d] = disc_chunks.map(of);
            let cells = Cells { z_p, b_p, z_d, b_d, on_resin: resin >> lane & 1 == 1 };
            let row = (conditions.first_strip + strip) * LANES + lane;
            Ahead::new::<BUILD_UP, DISC_WEARS>(rules, row, conditions.displacement, cells)
        };
        EdgeStrip { touches, cells: std::array::from_fn(cell) }
    }));
}
