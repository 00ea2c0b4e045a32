//! Volume parameters (ISO 25178-2:2021, 4.5), per area.

use super::MaterialCurve;

/// Material ratio that parts peak from core.
const PEAK: f64 = 0.1;
/// Material ratio that parts core from dale.
const DALE: f64 = 0.8;

/// Volumes of material and void at the material ratios p = 10 % and q = 80 %, per area, m³/m².
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Volumes {
    /// Vm(p) of the peaks, Vmp.
    pub peak_material: f64,
    /// Vm(q) − Vm(p) of the core, Vmc.
    pub core_material: f64,
    /// Vv(p) − Vv(q) of the core, Vvc.
    pub core_void: f64,
    /// Vv(q) of the dales, Vvv.
    pub dale_void: f64,
}

impl Volumes {
    /// Those of a curve.
    pub fn of(curve: &MaterialCurve) -> Self {
        let (peak, dale) = (curve.height(PEAK), curve.height(DALE));
        let (peak_material, dale_void) = (curve.material_volume(peak), curve.void_volume(dale));
        Self {
            peak_material,
            core_material: curve.material_volume(dale) - peak_material,
            core_void: curve.void_volume(peak) - dale_void,
            dale_void,
        }
    }

    /// Vm(q), m³/m²: all material above the height at 80 %.
    pub fn material(&self) -> f64 {
        self.peak_material + self.core_material
    }

    /// Vv(p), m³/m²: all void below the height at 10 %.
    pub fn void(&self) -> f64 {
        self.core_void + self.dale_void
    }
}
