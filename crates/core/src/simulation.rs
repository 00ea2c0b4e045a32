//! One step of the model, and the state it advances (model section 4).

use thiserror::Error;

use crate::contact::{Contact, ContactError};
use crate::debris::{Debris, Transfer};
use crate::filling::Filling;
use crate::history::History;
use crate::kernel::{DiscColumn, InstructionSet, Outlook, PinColumn, PinView, Update, update};
use crate::pair::Coefficients;
use crate::parameters::Parameters;
use crate::parts::Needs;
use crate::state::{Base, Disc, InitialSurfaces, Pin};

/// Why a simulation cannot start or go on.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum SimulationError {
    /// The initial surfaces do not have the mesh's size.
    #[error("the initial surfaces do not fit the mesh: expected {disc} disc cells and {pin} pin cells")]
    Size {
        /// Cells of the disc mesh.
        disc: usize,
        /// Cells of the pin mesh.
        pin: usize,
    },
    /// An initial height is infinite or not a number.
    #[error("{count} of the {surface}'s initial heights are not finite")]
    Height {
        /// Disc or pin.
        surface: &'static str,
        /// How many.
        count: usize,
    },
    /// The load balance failed.
    #[error("step {step}: {source}")]
    Contact {
        /// The step, counted from 1.
        step: u64,
        /// What went wrong.
        source: ContactError,
    },
}

/// A pin on a disc, and everything that happened to them so far.
#[derive(Debug, Clone)]
pub struct Simulation {
    pub(crate) parameters: Parameters,
    coefficients: Coefficients,
    needs: Needs,
    instructions: InstructionSet,
    update: Update,
    pub(crate) disc: Disc,
    pub(crate) pin: Pin,
    pub(crate) contact: Contact,
    pub(crate) debris: Debris,
    pub(crate) history: History,
    pub(crate) filling: Filling,
    transfer: Transfer,
    /// A column of resin: what the last column of the pin has before it.
    nothing_ahead: Pin,
    pub(crate) step: u64,
    /// Columns by which the disc was turned before the first step.
    pub(crate) first_step: u64,
}

impl Simulation {
    /// The state at t = 0: no build-up, no debris.
    ///
    /// # Errors
    /// [`SimulationError`] when the surfaces do not fit the mesh or hold a height that is not finite.
    pub fn new(parameters: Parameters, surfaces: InitialSurfaces) -> Result<Self, SimulationError> {
        let mesh = &parameters.mesh;
        if !surfaces.fits(mesh) {
            return Err(SimulationError::Size { disc: mesh.disc_cells(), pin: mesh.pin_cells() });
        }
        for (surface, heights) in [("disc", &surfaces.disc_height), ("pin", &surfaces.pin_height)] {
            let count = heights.iter().filter(|height| !height.is_finite()).count();
            if count > 0 {
                return Err(SimulationError::Height { surface, count });
            }
        }
        let disc = Disc::new(surfaces.disc_height);
        let needs = Needs::of(&parameters);
        let instructions = InstructionSet::best();
        Ok(Self {
            coefficients: Coefficients::new(&parameters),
            update: update(needs),
            needs,
            instructions,
            contact: Contact::new(mesh, instructions),
            debris: Debris::new(mesh, &parameters.plateaus),
            history: History::new(mesh.disc_columns()),
            filling: Filling::new(mesh, &disc),
            transfer: Transfer::new(mesh.rows()),
            nothing_ahead: Pin::new(vec![0.0; mesh.rows()], vec![Base::None; mesh.rows()]),
            disc,
            pin: Pin::new(surfaces.pin_height, surfaces.pin_base),
            step: 0,
            first_step: 0,
            parameters,
        })
    }

    /// Starts with the disc turned by `columns` columns: step n faces the columns that step n + `columns` would face.
    pub fn with_disc_turned(mut self, columns: u64) -> Self {
        self.first_step = columns;
        self
    }

    /// One step:
    ///
    /// | model | what happens | where |
    /// |---|---|---|
    /// | 4.1 | every pin cell faces the disc cell under it | [`Contact::face`] |
    /// | 4.1 | the displacement that carries the load | [`Contact::balance`] |
    /// | 4.4 | debris at hand for each open cell | [`Debris::spread`] |
    /// | 4.2 to 4.4 | wear, destruction and formation in every cell | [`crate::wear`], [`crate::plateau`] |
    /// | 4.5 | debris balance | [`Debris::settle`] |
    /// | 4.6 | the disc turns by one column | |
    ///
    /// # Errors
    /// [`SimulationError::Contact`] when the load balance leaves the finite numbers; the state is then that before the
    /// step.
    pub fn advance(&mut self) -> Result<(), SimulationError> {
        let Parameters { mesh, normal_force, load_tolerance, .. } = &self.parameters;
        let turned = self.first_step + self.step;
        self.contact.face(mesh, &self.coefficients.stiffness, self.needs.distinct, &self.disc, &self.pin, turned);
        self.contact
            .balance(mesh, *normal_force, *load_tolerance)
            .map_err(|source| SimulationError::Contact { step: self.step + 1, source })?;
        self.debris.spread(mesh, self.contact.touching());
        self.transfer.clear();
        self.update_columns(turned);
        self.debris.settle(&self.parameters.mesh, &self.transfer);
        self.history.record(self.contact.area(&self.parameters.mesh), self.parameters.step_time());
        self.step += 1;
        Ok(())
    }

    /// Wear, destruction and formation in every column of the pin and the disc column under it (model 4.2 to 4.4).
    fn update_columns(&mut self, turned: u64) {
        let Parameters { mesh, plateaus, materials, .. } = &self.parameters;
        let (rows, last) = (mesh.rows(), mesh.pin_columns() - 1);
        for column in 0..=last {
            let cells = mesh.column(column);
            let (height, height_after) = self.pin.height[cells.start..].split_at_mut(rows);
            let (substrate, substrate_after) = self.pin.substrate[cells.start..].split_at_mut(rows);
            let ahead = if column < last {
                let base = &self.pin.base[mesh.column(column + 1)];
                PinView { height: &height_after[..rows], substrate: &substrate_after[..rows], base }
            } else {
                self.nothing_ahead.view(0..rows)
            };
            let outlook = Outlook {
                displacement: self.contact.displacement(),
                share: self.debris.share(),
                pad_share: plateaus.pad_share,
                wear_height: materials.wear_height,
                ahead,
            };
            let under = mesh.column(mesh.disc_column(column, turned));
            (self.update)(
                self.instructions,
                PinColumn { height, substrate, base: &self.pin.base[cells] },
                DiscColumn { height: &mut self.disc.height[under.clone()], substrate: &mut self.disc.substrate[under] },
                &outlook,
                &self.coefficients,
                &mut self.transfer,
            );
        }
    }

    /// Uses another instruction set than the widest that the processor has; the results are the same.
    pub fn with_instructions(mut self, instructions: InstructionSet) -> Self {
        self.instructions = instructions;
        self.contact = Contact::new(&self.parameters.mesh, instructions);
        self
    }

    /// The instruction set of the kernels.
    pub fn instructions(&self) -> InstructionSet {
        self.instructions
    }

    /// What the simulation was told.
    pub fn parameters(&self) -> &Parameters {
        &self.parameters
    }

    /// The disc as it is now.
    pub fn disc(&self) -> &Disc {
        &self.disc
    }

    /// The pin as it is now.
    pub fn pin(&self) -> &Pin {
        &self.pin
    }

    /// The contact of the last step.
    pub fn contact(&self) -> &Contact {
        &self.contact
    }

    /// Debris account.
    pub fn debris(&self) -> &Debris {
        &self.debris
    }

    /// Steps done.
    pub fn steps_done(&self) -> u64 {
        self.step
    }
}
