//! What friction brings in is lost or stored, over very many intervals.

use super::thermal;
use crate::scenes::few_or_all;
use plateau_core::model::heat::chain::{Chain, ChainState, Link, sub_steps};

/// Residual of the energy balance after so many intervals of a time (s) each, each followed by a pause of another time
/// if it is above 0.
fn residual(chain: &Chain, intervals: u64, time: f64, pause: f64, link: Link) -> f64 {
    let mut state = ChainState::at_rest();
    for interval in 0..intervals {
        // Powers of no pattern.
        let power = 30.0 + 25.0 * (interval as f64 * 0.7).sin();
        chain.advance(&mut state, sub_steps(time), time / sub_steps(time) as f64, power, 90.0, Link::Closed(0.1));
        if pause > 0.0 {
            chain.advance(&mut state, sub_steps(pause), pause / sub_steps(pause) as f64, 0.0, 0.0, link);
        }
    }
    chain.report(&state).residual
}

#[test]
fn heat_balances_over_very_many_intervals() {
    let intervals = few_or_all(100_000, 1_000_000);
    let uncooled = |cooling| {
        let mut thermal = thermal();
        (thermal.disc.cooling, thermal.pin.cooling) = (cooling, 0.0);
        Chain::new(&thermal)
    };
    let chain = Chain::new(&thermal());
    for (chain, time, pause, link) in [
        (chain, 0.0706, 0.0, Link::Open),
        (chain, 0.0706, 0.05, Link::Open),
        (chain, 0.0706, 0.05, Link::Closed(1.7)),
        (chain, 1e-4, 0.0, Link::Open),
        (uncooled(0.0), 0.01, 0.0, Link::Open),
        (uncooled(1e-3), 0.01, 0.0, Link::Open),
    ] {
        let residual = residual(&chain, intervals, time, pause, link);
        assert!(residual.abs() <= 1e-12, "{time} {pause} {link:?}: {residual:e}");
    }
}
