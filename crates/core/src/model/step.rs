//! One step (model 4).
//!
//! Fields are column by column: the pin cell in row i and column j is number j · rows + i, and its neighbour in the sliding
//! direction is number (j + 1) · rows + i. Pairs are in the same order; a cell beyond the pin's outline has none.

use std::iter::successors;

use crate::model::error::ContactError;
use crate::model::friction::{ContactSums, StatusContact};
use crate::model::material::Status;
use crate::model::parameters::{DebrisRule, Integrator, Parameters};
use crate::model::state::{State, disc_status};
use crate::model::totals::Volumes;

/// Displacements from this size on are out of the range of the model, m.
pub const REACH: f64 = 1e199;

/// Contact of a step, and volumes moved in it.
#[derive(Debug, Clone, PartialEq)]
pub struct Step {
    /// F_N, or F̄_n of a cycle, N.
    pub load: f64,
    /// δ, m.
    pub displacement: f64,
    /// p of every pin cell, Pa; 0 where it does not touch.
    pub pressure: Vec<f64>,
    /// True where a pin cell touches.
    pub contact: Vec<bool>,
    /// Status of every pin cell at the start of the step.
    pub pin_status: Vec<Status>,
    /// Volumes moved, m³.
    pub moved: Volumes,
}

impl Step {
    /// Sums over the contact for friction (model 10).
    pub fn sums(&self, parameters: &Parameters) -> ContactSums {
        let mut statuses = [StatusContact::default(); 3];
        let cells = self.contact.iter().zip(&self.pressure).zip(&self.pin_status);
        for (((touches, pressure), status), area) in cells.zip(parameters.mesh.area().iter().cycle()) {
            if *touches {
                let of = &mut statuses[*status as usize];
                (of.area, of.load) = (of.area + area, of.load + pressure * area);
            }
        }
        let area = statuses.iter().map(|status| status.area).sum();
        ContactSums { load: self.load, area, statuses: Some(statuses) }
    }
}

/// A pin cell and the disc cell under it, as they are at the start of a step.
#[derive(Debug, Clone, Copy)]
pub struct Pair {
    /// Number of the pin cell.
    pub pin: usize,
    /// i.
    pub row: usize,
    /// A_i, m².
    pub area: f64,
    /// Number of the disc cell.
    pub disc: usize,
    /// Status of the pin cell.
    pub pin_status: Status,
    /// Status of the disc cell.
    pub disc_status: Status,
    /// g = z_p − z_d, m.
    pub gap: f64,
    /// k, Pa/m.
    pub stiffness: f64,
    /// True if the neighbour in the sliding direction is a plateau; false where there is none.
    pub plateau_ahead: bool,
    /// Place of the neighbour's pair among the pairs, if there is one.
    pub ahead: Option<usize>,
}

/// Actual losses of a pair in a step, m.
#[derive(Debug, Clone, Copy, Default)]
pub struct Loss {
    /// Δh_p of a plateau.
    pub pin: f64,
    /// Δh_p of resin.
    pub resin: f64,
    /// Δh_d.
    pub disc: f64,
    /// Build-up of the pin that broke away, m.
    pub returned: f64,
}

/// Takes one step under the load of the operation, which is no braking torque.
///
/// # Errors
/// [`ContactError`] when no displacement carries the load.
pub fn advance(parameters: &Parameters, state: &mut State) -> Result<Step, ContactError> {
    advance_under(parameters.load_of(state.steps + 1), parameters, state)
}

/// Takes one step under a load, N: every rule sees the statuses, gaps and contact of its start.
///
/// # Errors
/// [`ContactError`] when no displacement carries the load.
pub fn advance_under(load: f64, parameters: &Parameters, state: &mut State) -> Result<Step, ContactError> {
    let pairs = pairs(parameters, state);
    let displacement = balance(load, &pairs)?;
    let overlaps: Vec<f64> = pairs.iter().map(|pair| (displacement - pair.gap).max(0.0)).collect();
    let worn = |(pair, overlap): (&Pair, &f64)| {
        let loss = wear(parameters, state, pair, *overlap);
        Loss { returned: break_away(parameters, state, pair, *overlap), ..loss }
    };
    let losses: Vec<Loss> = pairs.iter().zip(&overlaps).map(worn).collect();
    let cells = parameters.mesh.pin_cells();
    let mut step = Step {
        load,
        displacement,
        pressure: vec![0.0; cells],
        contact: vec![false; cells],
        pin_status: vec![Status::Resin; cells],
        moved: match parameters.plateaus.debris {
            DebrisRule::Local => match parameters.transport_columns() {
                None => deposit_locally(parameters, state, &pairs, displacement, &losses),
                Some(columns) => deposit_over(columns, parameters, state, &pairs, displacement, &losses),
            },
            DebrisRule::Contact | DebrisRule::Track => pool(parameters, state, &pairs, displacement, &losses),
        },
    };
    for (pair, overlap) in pairs.iter().zip(overlaps) {
        step.pressure[pair.pin] = pair.stiffness * overlap;
        step.contact[pair.pin] = overlap > 0.0;
        step.pin_status[pair.pin] = pair.pin_status;
    }
    state.steps += 1;
    Ok(step)
}

/// Model 1 and 2: each pin cell with the disc cell that the coming step turns under it, and their statuses; cells beyond the
/// pin's outline are left out.
pub fn pairs(parameters: &Parameters, state: &State) -> Vec<Pair> {
    let Parameters { mesh, materials, foundation_height, .. } = parameters;
    let State { disc, pin, steps, turned, .. } = state;
    let statuses: Vec<Status> = pin.statuses().collect();
    let present: Vec<usize> = (0..mesh.pin_cells()).filter(|cell| mesh.is_present(*cell)).collect();
    let pair = |cell: usize| {
        let (column, row) = (cell / mesh.rows(), cell % mesh.rows());
        let below = mesh.column(mesh.disc_column(column, turned + steps)).start + row;
        let (pin_status, disc_status) = (statuses[cell], disc_status(disc.height[below], disc.substrate[below]));
        let ahead = present.binary_search(&(cell + mesh.rows())).ok();
        Pair {
            pin: cell,
            row,
            area: mesh.area()[row],
            disc: below,
            pin_status,
            disc_status,
            gap: pin.height[cell] - disc.height[below],
            stiffness: materials.combined_modulus(pin_status, disc_status == Status::Secondary) / foundation_height,
            plateau_ahead: ahead.is_some_and(|ahead| statuses[present[ahead]] != Status::Resin),
            ahead,
        }
    };
    present.iter().map(|cell| pair(*cell)).collect()
}

/// Model 4.1: δ, m, with Σ k A (δ − g)₊ = F_N.
///
/// The load is piecewise linear in δ and rises from gap to gap: with the gaps in order, the solution is found on the first
/// piece on which it lies.
///
/// # Errors
/// [`ContactError::NotFinite`] when heights, stiffness or load leave the range of numbers, [`ContactError::NotCarried`] when
/// rounding leaves no overlap.
pub fn balance(normal_force: f64, pairs: &[Pair]) -> Result<f64, ContactError> {
    let mut in_order: Vec<&Pair> = pairs.iter().collect();
    in_order.sort_by(|a, b| a.gap.total_cmp(&b.gap));
    let lowest = in_order[0].gap;
    // Σ k A and Σ k A (g − lowest) over the pairs that touch.
    let (mut slope, mut moment) = (0.0, 0.0);
    let mut displacement = lowest;
    for (pair, next) in in_order.iter().zip(in_order.iter().skip(1).map(|pair| pair.gap).chain([f64::INFINITY])) {
        slope += pair.stiffness * pair.area;
        moment += pair.stiffness * pair.area * (pair.gap - lowest);
        displacement = lowest + (normal_force + moment) / slope;
        if displacement <= next {
            break;
        }
    }
    if !(displacement.abs() < REACH && normal_force.is_finite()) {
        return Err(ContactError::NotFinite { displacement, load: slope * (displacement - lowest), normal_force });
    }
    if displacement <= lowest {
        return Err(ContactError::NotCarried { displacement, normal_force });
    }
    Ok(displacement)
}

/// Model 4.2: wears a pair, if it overlaps, by Archard's law, Δh = κ p ds or its exponential form, resin by h_m, build-up before what is below
/// it; returns the losses of its two cells, m.
pub fn wear(parameters: &Parameters, state: &mut State, pair: &Pair, overlap: f64) -> Loss {
    if overlap == 0.0 {
        return Loss::default();
    }
    let cell = pair.pin;
    let Parameters { mesh, materials, time_acceleration, .. } = parameters;
    let sliding = time_acceleration * mesh.radius()[pair.row] * mesh.column_angle();
    // Δh, m, of a cell with the wear rate `own` that faces one with `other`.
    let raw = |own: f64, other: f64| match parameters.integrator {
        Integrator::Explicit => own * (pair.stiffness * overlap) * sliding,
        Integrator::Exponential if own == 0.0 => 0.0,
        Integrator::Exponential => {
            let decayed = -libm::expm1(-(own + other) * pair.stiffness * sliding);
            overlap * decayed * (own / (own + other))
        }
    };
    let State { disc, pin, .. } = state;
    let on_resin = pin.base[cell].is_resin();
    let on_secondary = pair.disc_status == Status::Secondary;
    let rate_of_disc = materials.disc(on_secondary).specific_wear_rate;
    let rate_of_pin = materials.pin_wear_rate(pair.pin_status, on_secondary);

    let build_up = pin.substrate[cell] - pin.height[cell];
    let fibre = if on_resin { 0.0 } else { raw(materials.pin_wear_rate(Status::Primary, on_secondary), rate_of_disc) };
    let of_pin = match pair.pin_status {
        Status::Resin => [0.0, materials.wear_height],
        _ => build_up_first(build_up, raw(rate_of_pin, rate_of_disc), fibre),
    };
    pin.height[cell] = after(of_pin, build_up, pin.height[cell], pin.substrate[cell], 1.0);
    pin.substrate[cell] = pin.substrate[cell].max(pin.height[cell]);

    let build_up = disc.height[pair.disc] - disc.substrate[pair.disc];
    let coating = raw(materials.disc_primary.specific_wear_rate, rate_of_pin);
    let of_disc = build_up_first(build_up, raw(rate_of_disc, rate_of_pin), coating);
    disc.height[pair.disc] = after(of_disc, build_up, disc.height[pair.disc], disc.substrate[pair.disc], -1.0);
    disc.substrate[pair.disc] = disc.substrate[pair.disc].min(disc.height[pair.disc]);

    let [pin, disc] = [of_pin, of_disc].map(|[build_up, substrate]| build_up + substrate);
    match pair.pin_status {
        Status::Resin => Loss { resin: pin, disc, ..Loss::default() },
        _ => Loss { pin, disc, ..Loss::default() },
    }
}

/// Model 4.2a: breaks away build-up on resin that is pressed harder than its strength; returns what wear left of it, m.
pub fn break_away(parameters: &Parameters, state: &mut State, pair: &Pair, overlap: f64) -> f64 {
    let Some(strength) = parameters.materials.strength else { return 0.0 };
    let (pin, cell) = (&mut state.pin, pair.pin);
    let is_pressed = overlap > 0.0 && pair.stiffness * overlap > strength;
    if !(is_pressed && pair.pin_status == Status::Secondary && pin.base[cell].is_resin()) {
        return 0.0;
    }
    let build_up = pin.substrate[cell] - pin.height[cell];
    pin.height[cell] = pin.substrate[cell];
    build_up
}

/// Losses of a cell from its build-up t and from its substrate, m: t first, then (1 − t/Δh) of the substrate's own raw loss.
fn build_up_first(build_up: f64, raw: f64, raw_of_substrate: f64) -> [f64; 2] {
    match build_up {
        0.0 => [0.0, raw],
        t if raw < t => [raw, 0.0],
        t => [t, (1.0 - t / raw) * raw_of_substrate],
    }
}

/// The height of a cell that lost so much of its build-up and substrate; `direction` is that in which wear moves it.
fn after([of_build_up, of_substrate]: [f64; 2], build_up: f64, height: f64, substrate: f64, direction: f64) -> f64 {
    // A build-up that is worn through leaves exactly the substrate.
    if build_up > 0.0 && of_build_up == build_up {
        substrate + direction * of_substrate
    } else {
        height + direction * (of_build_up + of_substrate)
    }
}

/// Captured part of a loss, m: η of it, with an η of its own for resin if it is given.
fn captured(parameters: &Parameters, loss: &Loss) -> f64 {
    let rules = &parameters.plateaus;
    rules.captured_fraction * (loss.pin + loss.disc) + rules.captured_of_resin() * loss.resin
}

/// Σ A Δh over some pairs, by what wore, and what broke away, m³.
fn worn<'a>(worn: impl Iterator<Item = (&'a Pair, &'a Loss)>) -> Volumes {
    worn.fold(Volumes::default(), |sum, (pair, loss)| Volumes {
        returned: sum.returned + pair.area * loss.returned,
        worn_pin: sum.worn_pin + pair.area * loss.pin,
        worn_resin: sum.worn_resin + pair.area * loss.resin,
        worn_disc: sum.worn_disc + pair.area * loss.disc,
        ..sum
    })
}

/// Model 4L, local debris: what the pair ahead lost fills the gap behind it, and the rest leaves the contact.
pub fn deposit_locally(
    parameters: &Parameters,
    state: &mut State,
    pairs: &[Pair],
    displacement: f64,
    losses: &[Loss],
) -> Volumes {
    let mut moved = worn(pairs.iter().zip(losses));
    for pair in pairs {
        // The neighbour's own deposit comes after: pairs are in order, so its height is that after wear.
        let touches = displacement > pair.gap;
        let Some(ahead) = pair.ahead.filter(|_| parameters.plateaus.formation && !touches) else { continue };
        let plateau = pair.plateau_ahead.then(|| state.pin.height[pairs[ahead].pin]);
        compact(captured(parameters, &losses[ahead]), pair, plateau, displacement, state, &mut moved);
    }
    moved.emitted = emitted(&moved);
    moved
}

/// Fills the gap of an open pair, d = min(γ, a_p + a_d, caught), with what is caught of debris, m: first the pin, up to the height of the plateau
/// ahead if there is one (a_p), then the disc, up to its highest initial height (a_d).
fn compact(caught: f64, pair: &Pair, plateau: Option<f64>, displacement: f64, state: &mut State, moved: &mut Volumes) {
    let State { disc, pin, reference_height, .. } = state;
    let (z_p, z_d) = (pin.height[pair.pin], disc.height[pair.disc]);
    let clearance = z_p - z_d - displacement;
    let to_plateau = plateau.map_or(0.0, |plateau| (z_p - plateau).max(0.0));
    let to_reference = (*reference_height - z_d).max(0.0);
    let deposit = clearance.min(to_plateau + to_reference).min(caught).max(0.0);
    let on_pin = deposit.min(to_plateau);
    pin.height[pair.pin] -= on_pin;
    disc.height[pair.disc] += deposit - on_pin;
    moved.deposited_pin += pair.area * on_pin;
    moved.deposited_disc += pair.area * (deposit - on_pin);
}

/// Volume that finds no room and leaves the contact, worn + returned − deposited, m³.
fn emitted(moved: &Volumes) -> f64 {
    let Volumes { worn_pin, worn_resin, worn_disc, returned, deposited_pin, deposited_disc, .. } = moved;
    worn_pin + worn_resin + worn_disc + returned - deposited_pin - deposited_disc
}

/// Model 4L with a transport length of so many columns: what plateaus lose within that length ahead of an edge fills the open
/// cells within that length behind it, and the rest leaves the contact.
pub fn deposit_over(
    columns: usize,
    parameters: &Parameters,
    state: &mut State,
    pairs: &[Pair],
    displacement: f64,
    losses: &[Loss],
) -> Volumes {
    let mut moved = worn(pairs.iter().zip(losses));
    // Room on the pin is that beside the neighbour before any deposit of this step.
    let height_worn = state.pin.height.clone();
    let touches = |place: usize| displacement > pairs[place].gap;
    // The place of the pair behind another.
    let mut behind = vec![None; pairs.len()];
    for (place, pair) in pairs.iter().enumerate() {
        pair.ahead.into_iter().for_each(|ahead| behind[ahead] = Some(place));
    }
    let is_edge = |place: &usize| !touches(*place) && pairs[*place].ahead.is_some_and(touches);
    for edge in (0..pairs.len()).filter(|place| parameters.plateaus.formation && is_edge(place)) {
        let gathered = successors(pairs[edge].ahead, |place| pairs[*place].ahead).take_while(|place| touches(*place));
        let lost = |place: usize| match pairs[place].pin_status {
            Status::Resin => 0.0,
            _ => losses[place].pin + losses[place].disc,
        };
        let sum: f64 = gathered.take(columns).map(lost).sum();
        let share = parameters.plateaus.captured_fraction * sum / columns as f64;
        let open = successors(Some(edge), |place| behind[*place]).take_while(|place| !touches(*place));
        for pair in open.take(columns).map(|place| &pairs[place]) {
            let ahead = pair.ahead.filter(|_| pair.plateau_ahead);
            let plateau = ahead.map(|ahead| height_worn[pairs[ahead].pin]);
            compact(share, pair, plateau, displacement, state, &mut moved);
        }
    }
    moved.emitted = emitted(&moved);
    moved
}

/// Model 4P, pooled debris: destruction, formation and balance of each pool.
pub fn pool(parameters: &Parameters, state: &mut State, pairs: &[Pair], displacement: f64, losses: &[Loss]) -> Volumes {
    let (mut all, rules) = (Volumes::default(), &parameters.plateaus);
    for pool in 0..state.pools.len() {
        let is_of_pool = |row| rules.debris == DebrisRule::Contact || row == pool;
        let of_pool = || pairs.iter().zip(losses).filter(|(pair, _)| is_of_pool(pair.row));
        let mut moved = worn(of_pool());
        let captured = of_pool().map(|(pair, loss)| pair.area * captured(parameters, loss)).sum::<f64>();
        let pairs: Vec<&Pair> = of_pool().map(|(pair, _)| pair).collect();
        if rules.destruction {
            moved.returned += destroy(state, &pairs);
        }
        let mut is_emptied = false;
        if rules.formation {
            let volume = state.pools[pool];
            ([moved.deposited_pin, moved.deposited_disc], is_emptied) =
                form(rules.pad_share, volume, state, &pairs, displacement);
        }
        let rest = if is_emptied { 0.0 } else { state.pools[pool] - moved.deposited_pin - moved.deposited_disc };
        state.pools[pool] = rest + captured + moved.returned;
        // Not what remains of the captured volume: with η = 1 nothing is emitted, not even what rounding leaves.
        let [of_plateaus, of_resin] =
            [rules.captured_fraction, rules.captured_of_resin()].map(|captured| 1.0 - captured);
        moved.emitted = of_plateaus * (moved.worn_pin + moved.worn_disc) + of_resin * moved.worn_resin;
        all = all + moved;
    }
    all
}

/// Model 4P, destruction: takes off build-up on resin that no plateau ahead supported; returns its volume, m³.
pub fn destroy(state: &mut State, pairs: &[&Pair]) -> f64 {
    let pin = &mut state.pin;
    let mut returned = 0.0;
    for pair in pairs {
        let cell = pair.pin;
        if pin.base[cell].is_resin() && pin.height[cell] < pin.substrate[cell] && !pair.plateau_ahead {
            returned += pair.area * (pin.substrate[cell] - pin.height[cell]);
            pin.height[cell] = pin.substrate[cell];
        }
    }
    returned
}

/// Model 4P, formation: spreads a pool (m³) evenly over the cells that do not touch; returns the volumes on pin and disc, m³, and
/// whether every cell got its whole share.
pub fn form(pad_share: f64, pool: f64, state: &mut State, pairs: &[&Pair], displacement: f64) -> ([f64; 2], bool) {
    let State { disc, pin, .. } = state;
    let open = || pairs.iter().filter(|pair| displacement <= pair.gap);
    let open_area: f64 = open().map(|pair| pair.area).sum();
    if open_area == 0.0 {
        return ([0.0, 0.0], false);
    }
    // Rounding may leave a trace of debt in a pool that has given nearly all.
    let share = (pool / open_area).max(0.0);
    let (mut deposited, mut is_emptied) = ([0.0, 0.0], true);
    for pair in open() {
        let clearance = pin.height[pair.pin] - disc.height[pair.disc] - displacement;
        let deposit = clearance.max(0.0).min(share);
        let on_pin = if pair.plateau_ahead { pad_share * deposit } else { 0.0 };
        pin.height[pair.pin] -= on_pin;
        disc.height[pair.disc] += deposit - on_pin;
        deposited = [deposited[0] + pair.area * on_pin, deposited[1] + pair.area * (deposit - on_pin)];
        is_emptied &= deposit == share;
    }
    (deposited, is_emptied)
}
