//! Status of a cell, material properties by (body, status), stiffness of a pair (model sections 2 and 4.1; paper Eq. 5).

/// Status of a cell: resin, fibre or coating, or compacted wear debris.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[repr(u8)]
pub enum Status {
    /// Resin of the pin: carries little, wears by a whole wear height at once.
    Resin = 0,
    /// Fibre of the pin or coating of the disc.
    Primary = 1,
    /// Compacted debris on top of the substrate.
    Secondary = 2,
}

/// Properties of one (body, status).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Material {
    /// E, Pa.
    pub youngs_modulus: f64,
    /// ν, 1.
    pub poisson_ratio: f64,
    /// κ, 1/Pa = m³/(N·m). Not used for resin.
    pub specific_wear_rate: f64,
}

impl Material {
    /// (1 − ν²)/E, 1/Pa: what this side adds to the compliance of a pair.
    fn compliance(&self) -> f64 {
        (1.0 - self.poisson_ratio * self.poisson_ratio) / self.youngs_modulus
    }
}

/// The properties of every (body, status) (model section 3; paper Table 2).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Materials {
    /// Coating of the disc.
    pub disc_primary: Material,
    /// Compacted debris on the disc.
    pub disc_secondary: Material,
    /// Fibres of the pin.
    pub pin_primary: Material,
    /// Compacted debris on the pin.
    pub pin_secondary: Material,
    /// Resin of the pin; its wear rate plays no part.
    pub pin_resin: Material,
    /// h_m, m: the height that resin loses in a step in which it touches (paper Eq. 7).
    pub wear_height: f64,
    /// κ of fibres on compacted debris, 1/Pa, where that is another than on the coating (model 4.2).
    pub pin_primary_against_secondary: Option<f64>,
    /// κ of the pin's compacted debris on that of the disc, 1/Pa, where that is another than on the coating (model 4.2).
    pub pin_secondary_against_secondary: Option<f64>,
    /// σ_b, Pa: pressed harder, build-up on resin breaks away (model 4.2a); none where it never does.
    pub strength: Option<f64>,
}

impl Materials {
    /// Material of a pin cell.
    pub fn pin(&self, status: Status) -> &Material {
        match status {
            Status::Resin => &self.pin_resin,
            Status::Primary => &self.pin_primary,
            Status::Secondary => &self.pin_secondary,
        }
    }

    /// Material of a disc cell, which is never resin.
    pub fn disc(&self, secondary: bool) -> &Material {
        if secondary { &self.disc_secondary } else { &self.disc_primary }
    }

    /// κ of a pin cell on a disc cell, 1/Pa; 0 for resin, which does not wear by Archard's law.
    pub fn pin_wear_rate(&self, pin: Status, disc_secondary: bool) -> f64 {
        let against_secondary = match pin {
            Status::Resin => return 0.0,
            Status::Primary => self.pin_primary_against_secondary,
            Status::Secondary => self.pin_secondary_against_secondary,
        };
        against_secondary.filter(|_| disc_secondary).unwrap_or(self.pin(pin).specific_wear_rate)
    }

    /// Tells whether a pin cell wears in another way on compacted debris than on the coating.
    pub fn wears_by_counterface(&self) -> bool {
        [Status::Primary, Status::Secondary]
            .into_iter()
            .any(|pin| self.pin_wear_rate(pin, true) != self.pin_wear_rate(pin, false))
    }

    /// Materials with the wear rates of the pin's plateaus multiplied by a factor.
    pub fn with_wear_rate_factor(&self, factor: f64) -> Self {
        let mut materials = *self;
        let Self { pin_primary, pin_secondary, pin_primary_against_secondary, pin_secondary_against_secondary, .. } =
            &mut materials;
        for rate in [&mut pin_primary.specific_wear_rate, &mut pin_secondary.specific_wear_rate]
            .into_iter()
            .chain(pin_primary_against_secondary)
            .chain(pin_secondary_against_secondary)
        {
            *rate *= factor;
        }
        materials
    }

    /// E*, Pa: combined modulus of a pair, 1/E* = (1−ν_p²)/E_p + (1−ν_d²)/E_d (paper Eq. 5).
    pub fn combined_modulus(&self, pin: Status, disc_secondary: bool) -> f64 {
        1.0 / (self.pin(pin).compliance() + self.disc(disc_secondary).compliance())
    }
}

#[cfg(test)]
#[path = "../../tests/unit/model/material.rs"]
mod tests;
