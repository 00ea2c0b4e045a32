//! Effects: what the responses of a design tell of its factors.
//!
//! [`analyse`] fits a [`Model`] by least squares and tests each of its terms against the error. Two levels and ranges
//! are coded from −1 to 1, more levels by contrasts that sum to zero, so that single factors are averages over the
//! others whatever interactions the model has. Sums of squares are of type III.
//!
//! ```
//! use plateau_study::design::Setting;
//! use plateau_study::effects::{Factor, FactorKind, Observation, Options, analyse};
//!
//! let factors = [
//!     Factor { name: "load".into(), kind: FactorKind::Range { low: 100.0, high: 200.0 } },
//!     Factor { name: "pad".into(), kind: FactorKind::Categorical(vec!["soft".into(), "hard".into()]) },
//! ];
//! let wear = [(-1.0, 0, [4.1, 4.3]), (1.0, 0, [8.0, 8.4]), (-1.0, 1, [2.1, 2.2]), (1.0, 1, [3.9, 4.2])];
//! let observations: Vec<Observation> = wear
//!     .iter()
//!     .enumerate()
//!     .flat_map(|(point, (load, pad, responses))| {
//!         let settings = vec![Setting::Coded(*load), Setting::Level(*pad)];
//!         let observation = |(replicate, response): (usize, &f64)| {
//!             Observation { settings: settings.clone(), replicate, run: 2 * point + replicate, response: *response }
//!         };
//!         responses.iter().enumerate().map(observation).collect::<Vec<_>>()
//!     })
//!     .collect();
//! let effects = analyse(&factors, &observations, &Options::default())?;
//! let load = effects.terms[0].estimate.unwrap();
//! assert!((load.effect - 2.95).abs() < 1e-12);
//! assert!(load.uncertainty.unwrap().p < 0.001);
//! assert_eq!(effects.terms[2].label, "load × pad");
//! assert_eq!(effects.error.to_string(), "replicates");
//! # Ok::<(), plateau_study::effects::EffectsError>(())
//! ```

mod analysis;
mod box_cox;
mod curvature;
mod distribution;
mod equation;
mod error;
mod factor;
mod fit;
mod held_out;
mod lenth;
mod means;
mod misfit;
mod model;
mod no_squares;
mod observation;
mod prediction;
mod pure_error;
mod regressors;
mod residual;
mod response_surface;
mod result;
mod selection;
mod spread;
mod terms;
mod transform;

pub use analysis::{Options, analyse};
pub use box_cox::{Advice, BoxCox};
pub use curvature::Curvature;
pub use distribution::normal_quantiles;
pub(crate) use distribution::t_quantile;
pub use equation::{Equation, EquationTerm, Variable};
pub use error::EffectsError;
pub use factor::{Factor, FactorKind};
pub use lenth::{Lenth, half_normal_quantiles};
pub use means::Cell;
pub use misfit::{Better, Misfit};
pub use model::Model;
pub use no_squares::{NoSquares, no_squares};
pub use observation::Observation;
pub use response_surface::{Nature, Polynomial, Stationary, Surface};
pub use result::{
    Effects, ErrorSource, Estimate, Fitted, HalfNormal, LeftOut, Prediction, Residual, ResidualParts, Squares, Term,
    Test, Uncertainty,
};
pub use selection::{Selection, select};
pub(crate) use spread::Variance;
pub use transform::Transform;
