//! What the fit is without some of its observations, in closed form.
//!
//! With the rows Q of an orthogonal basis of the model at the observations of a point and their residuals e, the fit without
//! them misses them by (I − Q·Qᵀ)⁻¹·e.

use nalgebra::{DMatrix, DVector};

use super::result::Effects;

/// An observation whose own weight in its fit comes this near to 1 has a coefficient of its own.
const SOLE: f64 = 1e-9;

impl Effects {
    /// An orthogonal basis of the model, one row for each observation with a response; none if the settings do not fit.
    pub(super) fn basis(&self) -> Option<DMatrix<f64>> {
        let inner = &self.inner;
        let matrix = inner.regressors.matrix(&inner.usable).ok()?;
        Some(matrix.select_columns(&inner.fit.kept) * &inner.fit.root)
    }

    /// The mean response of each point with what the fit without all its observations makes of it; none of a point on which a
    /// term depends alone.
    pub(crate) fn held_out(&self) -> Option<Vec<Option<[f64; 2]>>> {
        let usable = &self.inner.usable;
        let basis = self.basis()?;
        let mut members = vec![Vec::new(); usable.point_count()];
        usable.points.iter().enumerate().for_each(|(observation, point)| members[*point].push(observation));
        let mut held_out = vec![None; members.len()];
        for (own, held_out) in members.iter().zip(&mut held_out) {
            let rows = basis.select_rows(own);
            let left = DMatrix::identity(own.len(), own.len()) - &rows * rows.transpose();
            let eigen = left.symmetric_eigen();
            if eigen.eigenvalues.iter().any(|value| *value < SOLE) {
                continue;
            }
            let residuals =
                DVector::from_iterator(own.len(), own.iter().map(|observation| self.fitted[*observation].residual));
            let along = eigen.eigenvectors.tr_mul(&residuals).component_div(&eigen.eigenvalues);
            let missed = &eigen.eigenvectors * along;
            let mean = own.iter().map(|observation| usable.responses[*observation]).sum::<f64>() / own.len() as f64;
            *held_out = Some([mean, mean - missed.mean()]);
        }
        Some(held_out)
    }

    /// How much each observation determines its own fitted value (leverage, 0 to 1), and how far all fitted values would move without
    /// it (D of R. D. Cook, Technometrics 19, 15–18 (1977), doi:10.1080/00401706.1977.10489493; NaN where there is no error, or it
    /// has a coefficient of its own), in the order of [`fitted`](Self::fitted).
    pub fn influences(&self) -> Vec<[f64; 2]> {
        let fit = &self.inner.fit;
        let standardised = self.standardised_residuals();
        let of = |(at, leverage): (usize, &f64)| {
            let residual = standardised.as_ref().map_or(f64::NAN, |all| all[at]);
            [*leverage, residual * residual * leverage / ((1.0 - leverage) * fit.kept.len() as f64)]
        };
        fit.leverages.iter().enumerate().map(of).collect()
    }

    /// Residuals by their standard deviations, each of which depends on how much the observation determines its own fit
    /// (internally studentised), in the order of [`fitted`](Self::fitted); none without an error. An observation with a
    /// coefficient of its own has NaN.
    pub fn standardised_residuals(&self) -> Option<Vec<f64>> {
        let deviation = self.residual_standard_deviation?;
        let standardised = self.fitted.iter().zip(&self.inner.fit.leverages).map(|(fitted, leverage)| {
            let free = 1.0 - leverage;
            if free > SOLE { fitted.residual / (deviation * free.sqrt()) } else { f64::NAN }
        });
        Some(standardised.collect())
    }
}
