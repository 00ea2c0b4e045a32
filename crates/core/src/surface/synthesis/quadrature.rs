//! Means over the normal distribution.

use std::f64::consts::TAU;

/// Points and weights of the trapezoidal rule for means over the standard normal distribution, from −`reach` to `reach`.
///
/// For smooth functions its error falls as exp(−2π²/step²), and with a singularity at the distance d from the real axis
/// as exp(−2πd/step).
pub(super) fn normal_nodes(step: f64, reach: f64) -> impl Iterator<Item = (f64, f64)> {
    let last = libm::ceil(reach / step) as i32;
    (-last..=last).map(move |index| {
        let x = f64::from(index) * step;
        (x, step * libm::exp(-0.5 * x * x) / TAU.sqrt())
    })
}
