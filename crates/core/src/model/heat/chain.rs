//! Holder – 8 pin layers – contact – 8 disc layers – air (model 11, one chain), and its sub-steps by implicit Euler.

use serde::{Deserialize, Serialize};

use crate::model::sums::RunningSum;
use crate::model::thermal::{Substance, Thermal};

/// Heat capacities of the chain, from the holder to the disc's last layer.
const NODES: usize = 16;
/// Layers of each body.
const LAYERS: usize = NODES / 2;
/// Thickness of each layer over that of the one nearer to the contact, 1.
const GROWTH: f64 = 1.4;
/// Longest sub-step, s.
const LONGEST: f64 = 0.1;
/// Most sub-steps that are taken one by one; more are taken at once (`Exchange`), at a cost that hardly depends on how many they are.
const MOST_ONE_BY_ONE: u64 = 10_000;

/// θ of every node, K.
type Excess = [f64; NODES];

/// Contact as a link of the chain.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Link {
    /// Conduction through this resistance R of the disc's face, K/W.
    Closed(f64),
    /// No conduction: the pin is lifted.
    Open,
}

/// One body, its layers counted from the contact.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Body {
    /// Heat capacity of each layer, J/K.
    capacity: [f64; LAYERS],
    /// Conductance from the middle of each layer to that of the next, W/K.
    conductance: [f64; LAYERS - 1],
    /// Resistance from the middle of the first layer to its face, K/W.
    face: f64,
}

impl Body {
    fn new(substance: &Substance, area: f64, length: f64) -> Self {
        let growth: [f64; LAYERS] = std::array::from_fn(|layer| GROWTH.powi(layer as i32));
        let whole: f64 = growth.iter().sum();
        let thickness = growth.map(|growth| length * growth / whole);
        let Substance { conductivity, density, specific_heat } = substance;
        Self {
            capacity: thickness.map(|thickness| density * specific_heat * area * thickness),
            conductance: std::array::from_fn(|layer| {
                conductivity * area / ((thickness[layer] + thickness[layer + 1]) / 2.0)
            }),
            face: thickness[0] / 2.0 / (conductivity * area),
        }
    }

    /// Σ C θ, J.
    fn stored(&self, excess: &[f64; LAYERS]) -> f64 {
        self.capacity.iter().zip(excess).map(|(capacity, excess)| capacity * excess).sum()
    }

    /// Mean of θ, weighted by heat capacity, K.
    fn mean(&self, excess: &[f64; LAYERS]) -> f64 {
        self.stored(excess) / self.capacity.iter().sum::<f64>()
    }
}

/// The chain of a scene.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Chain {
    pin: Body,
    disc: Body,
    /// H_p, W/K.
    pin_cooling: f64,
    /// H₀, W/K.
    disc_cooling: f64,
    /// H₁, J/(K rad).
    disc_cooling_per_speed: f64,
}

/// Temperatures of the chain, as excess over the ambient, and what went in and out.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct ChainState {
    /// θ of the layers from the holder to the disc's last, K. Where they hardly change any more, what a sub-step adds
    /// is lost in their rounding, so they are sums that keep it.
    excess: [RunningSum; NODES],
    /// θ of the contact, K; none where the pin is lifted.
    pub contact: Option<f64>,
    /// Power into the disc in the last sub-step, W.
    pub into_disc: f64,
    /// Heat of friction so far, J.
    gained: RunningSum,
    /// Heat that went to the air and the holder, J.
    lost: RunningSum,
}

impl ChainState {
    /// State with all at ambient temperature, and in contact.
    pub fn at_rest() -> Self {
        Self { contact: Some(0.0), ..Self::default() }
    }

    /// θ of every layer, K.
    fn excess(&self) -> [f64; NODES] {
        self.excess.map(|excess| excess.value())
    }

    /// θ of the layers next to the contact, of pin and disc, K.
    fn faces(&self) -> [f64; 2] {
        [LAYERS - 1, LAYERS].map(|layer| self.excess[layer].value())
    }
}

/// Means of the chain over the ambient, and its balance.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ChainReport {
    /// Mean θ of the disc, K.
    pub disc: f64,
    /// Mean θ of the pin, K.
    pub pin: f64,
    /// Heat lost so far, J.
    pub lost: f64,
    /// (gained − lost − stored)/gained; 0 where nothing was gained.
    pub residual: f64,
}

/// Number of equal sub-steps of at most 0.1 s in a time (s).
pub fn sub_steps(time: f64) -> u64 {
    // As in the number of steps of a run, rounding of the time must not make one more.
    ((time / LONGEST - 1e-9).ceil() as u64).max(1)
}

impl Chain {
    /// The chain of these bodies.
    pub fn new(thermal: &Thermal) -> Self {
        let Thermal { disc, pin, .. } = thermal;
        Self {
            pin: Body::new(&pin.substance, pin.area, pin.length),
            disc: Body::new(&disc.substance, disc.area, disc.thickness),
            pin_cooling: pin.cooling,
            disc_cooling: disc.cooling,
            disc_cooling_per_speed: disc.cooling_per_speed,
        }
    }

    /// Advances a state by `count` sub-steps of `time` (s) each under a power (W) of friction, at a speed
    /// (rad/s): implicit Euler.
    pub fn advance(&self, state: &mut ChainState, count: u64, time: f64, power: f64, speed: f64, link: Link) {
        let disc_cooling = self.disc_cooling + self.disc_cooling_per_speed * speed;
        // From the contact to the middle of the first layer of pin and disc, W/K, with R in series.
        let links = match link {
            Link::Closed(resistance) => Some([1.0 / self.pin.face, 1.0 / (resistance + self.disc.face)]),
            Link::Open => None,
        };
        // The contact has no heat capacity: its power is parted, and the first layers are linked through it.
        let (through, parts) = match links {
            Some([pin, disc]) => (pin * disc / (pin + disc), [pin, disc].map(|link| power * (link / (pin + disc)))),
            None => (0.0, [0.0, 0.0]),
        };
        // Along the chain: the pin from its holder to the contact, then the disc.
        let (capacity, conductance) = self.along(through);
        let (mut outward, mut gain) = ([0.0; NODES], [0.0; NODES]);
        (outward[0], outward[LAYERS]) = (self.pin_cooling, disc_cooling);
        (gain[LAYERS - 1], gain[LAYERS]) = (parts[0], parts[1]);
        let step = SubStep::new(time, capacity, conductance, outward, gain);
        if count > MOST_ONE_BY_ONE {
            let mut excess = state.excess();
            state.lost.add(advance_repeatedly(&step, &mut excess, count));
            state.excess = excess.map(RunningSum::from);
        } else {
            let mut excess = state.excess();
            for _ in 0..count {
                let rise = step.rise(&excess);
                for (node, sum) in state.excess.iter_mut().enumerate() {
                    sum.add(rise[node]);
                    excess[node] = sum.value();
                }
                state.lost.add(step.lost(&excess));
            }
        }
        state.gained.add(power * time * count as f64);
        let [first_of_pin, first_of_disc] = state.faces();
        state.contact = links.map(|[pin, disc]| (power + pin * first_of_pin + disc * first_of_disc) / (pin + disc));
        // Of the difference of the layers: that to the contact is lost in rounding where the disc conducts very well.
        state.into_disc =
            links.map_or(0.0, |[pin, disc]| disc / (pin + disc) * (power + pin * (first_of_pin - first_of_disc)));
    }

    /// θ of a contact that closes without power, through this resistance (K/W), K.
    pub fn closing(&self, state: &ChainState, resistance: f64) -> f64 {
        let [pin, disc] = [1.0 / self.pin.face, 1.0 / (resistance + self.disc.face)];
        let [first_of_pin, first_of_disc] = state.faces();
        (pin * first_of_pin + disc * first_of_disc) / (pin + disc)
    }

    /// Heat capacity of every layer, J/K, and conductance to the next, W/K, from the holder to the disc's last layer.
    fn along(&self, through: f64) -> ([f64; NODES], [f64; NODES - 1]) {
        let (mut capacity, mut conductance) = ([0.0; NODES], [0.0; NODES - 1]);
        for layer in 0..LAYERS {
            capacity[LAYERS - 1 - layer] = self.pin.capacity[layer];
            capacity[LAYERS + layer] = self.disc.capacity[layer];
            if layer + 1 < LAYERS {
                conductance[LAYERS - 2 - layer] = self.pin.conductance[layer];
                conductance[LAYERS + layer] = self.disc.conductance[layer];
            }
        }
        conductance[LAYERS - 1] = through;
        (capacity, conductance)
    }

    /// Means and balance of a state.
    pub fn report(&self, state: &ChainState) -> ChainReport {
        let (gained, lost) = (state.gained.value(), state.lost.value());
        let excess = state.excess();
        let pin = std::array::from_fn(|layer| excess[LAYERS - 1 - layer]);
        let disc = std::array::from_fn(|layer| excess[LAYERS + layer]);
        let stored = self.pin.stored(&pin) + self.disc.stored(&disc);
        ChainReport {
            disc: self.disc.mean(&disc),
            pin: self.pin.mean(&pin),
            lost,
            residual: if gained == 0.0 { 0.0 } else { (gained - lost - stored) / gained },
        }
    }
}

/// A sub-step of the chain under a power that does not change.
struct SubStep {
    /// Length of the sub-step, s.
    pub time: f64,
    /// Heat capacity of each node, J/K.
    pub capacity: [f64; NODES],
    /// Conductance to the next node, W/K.
    pub conductance: [f64; NODES - 1],
    /// Conductance to the ambient, W/K.
    pub outward: [f64; NODES],
    /// Power of friction into each node, W.
    pub power: [f64; NODES],
    elimination: Elimination,
}

impl SubStep {
    /// Sub-step over a time (s) with these heat capacities (J/K), conductances to the next node and outward (W/K), and powers
    /// (W).
    pub fn new(
        time: f64,
        capacity: [f64; NODES],
        conductance: [f64; NODES - 1],
        outward: [f64; NODES],
        power: [f64; NODES],
    ) -> Self {
        let elimination = Elimination::new(&capacity.map(|capacity| capacity / time), &conductance, &outward);
        Self { time, capacity, conductance, outward, power, elimination }
    }

    /// Rise of θ of every node, K.
    pub fn rise(&self, excess: &Excess) -> Excess {
        let mut gain = self.power;
        for node in 0..NODES {
            gain[node] -= self.outward[node] * excess[node];
            if let Some(conductance) = self.conductance.get(node) {
                let flow = conductance * (excess[node] - excess[node + 1]);
                gain[node] -= flow;
                gain[node + 1] += flow;
            }
        }
        // Solved for the rise, not for the temperature: what is stored keeps its digits over many sub-steps.
        self.elimination.solve(gain)
    }

    /// θ of every node, K, that balances what flows into each, W: nothing is subtracted, so where all flows are positive every one
    /// keeps its digits.
    pub fn balanced(&self, inflow: [f64; NODES]) -> Excess {
        self.elimination.solve(inflow)
    }

    /// Heat that goes to the ambient in a sub-step that ends with these temperatures, J.
    pub fn lost(&self, excess: &Excess) -> f64 {
        let flows = self.outward.iter().zip(excess).map(|(outward, excess)| outward * excess);
        flows.sum::<f64>() * self.time
    }
}

/// Gaussian elimination of a symmetric tridiagonal matrix, done once for many right-hand sides.
struct Elimination {
    /// Factor by which the row before is added to each row.
    factor: [f64; NODES],
    pivot: [f64; NODES],
    /// Conductance to the next row, W/K; off the diagonal stands its negative.
    conductance: [f64; NODES - 1],
}

impl Elimination {
    fn new(inertia: &[f64; NODES], conductance: &[f64; NODES - 1], outward: &[f64; NODES]) -> Self {
        let (mut factor, mut pivot) = ([0.0; NODES], [0.0; NODES]);
        // What a pivot is without the link to the next node: a sum of what is positive, so that nothing cancels.
        let mut own = 0.0;
        for node in 0..NODES {
            let before = if node == 0 { 0.0 } else { conductance[node - 1] };
            factor[node] = if node == 0 { 0.0 } else { before / pivot[node - 1] };
            own = inertia[node] + outward[node] + factor[node] * own;
            pivot[node] = own + conductance.get(node).copied().unwrap_or(0.0);
        }
        Self { factor, pivot, conductance: *conductance }
    }

    fn solve(&self, mut values: [f64; NODES]) -> [f64; NODES] {
        for node in 1..NODES {
            values[node] += self.factor[node] * values[node - 1];
        }
        values[NODES - 1] /= self.pivot[NODES - 1];
        for node in (0..NODES - 1).rev() {
            values[node] = (values[node] + self.conductance[node] * values[node + 1]) / self.pivot[node];
        }
        values
    }
}

/// Very many equal sub-steps of the chain at once, for a pause may last for years.
///
/// A sub-step is a linear map, and the map of twice as many sub-steps is that map applied twice. The map is kept as the heat that
/// each node gives to each other one, which is the same in both directions, and to the ambient. All of it is positive and only
/// added and multiplied, so every part keeps its digits, also where the capacities are very unlike; what stays in a node is its
/// capacity less what it gives, so no heat is lost or made.
struct Exchange {
    /// Heat that a node at 1 K gives to each other one, J/K, and what stays in it.
    given: [[f64; NODES]; NODES],
    /// Heat that a node at 1 K gives to the ambient, J/K.
    lost: [f64; NODES],
    /// θ of every node, K, when the power alone has heated a chain at the temperature of the ambient.
    heated: Excess,
    /// Heat of the power that goes to the ambient, J.
    lost_of_power: f64,
}

/// Takes so many sub-steps; returns the heat lost in them, J.
fn advance_repeatedly(step: &SubStep, excess: &mut Excess, count: u64) -> f64 {
    let (mut exchange, mut left, mut lost) = (Exchange::of(step), count, 0.0);
    loop {
        if left % 2 == 1 {
            lost += dot(&exchange.lost, excess) + exchange.lost_of_power;
            *excess = exchange.after(&step.capacity, excess);
        }
        left /= 2;
        if left == 0 {
            return lost;
        }
        exchange = exchange.twice(&step.capacity);
    }
}

fn dot(one: &[f64; NODES], other: &[f64; NODES]) -> f64 {
    one.iter().zip(other).map(|(one, other)| one * other).sum()
}

impl Exchange {
    /// Exchange of a single sub-step.
    fn of(step: &SubStep) -> Self {
        let (mut given, mut lost) = ([[0.0; NODES]; NODES], [0.0; NODES]);
        for node in 0..NODES {
            let mut inflow = [0.0; NODES];
            inflow[node] = step.capacity[node] / step.time;
            let excess = step.balanced(inflow);
            given[node] = std::array::from_fn(|other| step.capacity[other] * excess[other]);
            lost[node] = step.lost(&excess);
        }
        let heated = step.balanced(step.power);
        Self::new(&step.capacity, given, lost, heated, step.lost(&heated))
    }

    /// Exchange of nodes with these capacities (J/K), with what stays in them.
    fn new(
        capacity: &[f64; NODES],
        given: [[f64; NODES]; NODES],
        lost: [f64; NODES],
        heated: Excess,
        lost_of_power: f64,
    ) -> Self {
        // The same in both directions, also as it is rounded.
        let one_way = |node: usize, other: usize| given[node.min(other)][node.max(other)];
        let mut given: [[f64; NODES]; NODES] = std::array::from_fn(|node| {
            std::array::from_fn(|other| if other == node { 0.0 } else { one_way(node, other) })
        });
        for (node, given) in given.iter_mut().enumerate() {
            given[node] = (capacity[node] - given.iter().sum::<f64>() - lost[node]).max(0.0);
        }
        Self { given, lost, heated, lost_of_power }
    }

    /// θ of every node after the sub-steps, K.
    fn after(&self, capacity: &[f64; NODES], excess: &Excess) -> Excess {
        std::array::from_fn(|node| dot(&self.given[node], excess) / capacity[node] + self.heated[node])
    }

    /// Exchange of twice as many sub-steps.
    fn twice(&self, capacity: &[f64; NODES]) -> Self {
        // θ of each node that a node at 1 K brings about, K.
        let excess = self.given.map(|given| std::array::from_fn(|node| given[node] / capacity[node]));
        let given = excess.map(|excess: Excess| std::array::from_fn(|node| dot(&excess, &self.given[node])));
        let lost = std::array::from_fn(|node| self.lost[node] + dot(&excess[node], &self.lost));
        let lost_of_power = 2.0 * self.lost_of_power + dot(&self.lost, &self.heated);
        Self::new(capacity, given, lost, self.after(capacity, &self.heated), lost_of_power)
    }
}
