//! What local debris keeps besides (model 4L). That worn = deposited + emitted is the balance residual, the pool being 0.

use plateau_core::model::parameters::{DebrisRule, Parameters};
use plateau_core::model::state::InitialSurfaces;
use plateau_core::observe::Sample;

/// The laws of a case; a pool has none of them.
#[derive(Debug, Clone, Copy)]
pub struct LocalLaws {
    /// z_ref, m: highest initial height of the disc; none where debris is pooled.
    reference_height: Option<f64>,
}

impl LocalLaws {
    /// Those of a simulation with these parameters that starts from these surfaces.
    pub fn of(parameters: &Parameters, surfaces: &InitialSurfaces) -> Self {
        let is_local = parameters.plateaus.debris == DebrisRule::Local;
        let highest = surfaces.disc_height.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        Self { reference_height: is_local.then_some(highest) }
    }

    /// The law that is broken after a step, if one is; `disc` are the heights then, m.
    pub fn broken(&self, sample: &Sample, disc: &[f64]) -> Option<&'static str> {
        let reference_height = self.reference_height?;
        if disc.iter().any(|height| *height > reference_height) {
            return Some("the disc grew above its highest initial height");
        }
        if sample.pool != 0.0 {
            return Some("debris in a pool");
        }
        if sample.returned != 0.0 {
            return Some("a plateau fell for want of support");
        }
        None
    }
}

#[cfg(test)]
mod tests {
    use super::super::case::{Case, paper};
    use super::super::surfaces::rough;
    use super::*;

    #[test]
    fn a_broken_law_is_told_where_debris_is_local() {
        let parameters = paper(2, 5, 3);
        let pooled = Case::new("a case", parameters.clone(), rough(&parameters.mesh));
        let local = pooled.clone().with_local_debris();
        let highest = local.surfaces.disc_height.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        let [pooled, local] = [pooled, local].map(|case| LocalLaws::of(&case.parameters, &case.surfaces));

        let sound = Sample::default();
        let (with_pool, with_return) =
            (Sample { pool: 1e-30, ..sound.clone() }, Sample { returned: 1e-30, ..sound.clone() });
        assert_eq!(local.broken(&sound, &[highest]), None);
        assert!(local.broken(&sound, &[highest.next_up()]).is_some());
        assert!(local.broken(&with_pool, &[highest]).is_some());
        assert!(local.broken(&with_return, &[highest]).is_some());
        assert_eq!(pooled.broken(&with_pool, &[highest.next_up()]), None);
    }
}
