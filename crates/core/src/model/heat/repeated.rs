//! Very many equal sub-steps of the chain at once: a pause may last for years.
//!
//! A sub-step is a linear map, and the map of twice as many sub-steps is that map applied twice. The map is kept as the heat that
//! each node gives to each other one, which is the same in both directions, and to the ambient. All of it is positive and only
//! added and multiplied, so every part keeps its digits, also where the capacities are very unlike; what stays in a node is its
//! capacity less what it gives, so no heat is lost or made.

use super::sub_step::{Excess, NODES, SubStep};

/// So many sub-steps as one map.
struct Exchange {
    /// Heat that a node at 1 K gives to each other one, J/K, and what stays in it.
    given: [[f64; NODES]; NODES],
    /// Heat that it gives to the ambient, J/K.
    lost: [f64; NODES],
    /// What the power alone makes of a chain at the temperature of the ambient, K.
    heated: Excess,
    /// Heat of the power that goes to the ambient, J.
    lost_of_power: f64,
}

/// Takes so many sub-steps; the heat lost in them, J.
pub(super) fn advance(step: &SubStep, excess: &mut Excess, count: u64) -> f64 {
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
    /// A single sub-step.
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

    /// Of nodes with these capacities (J/K), with what stays in them.
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

    /// θ of every node after them, K.
    fn after(&self, capacity: &[f64; NODES], excess: &Excess) -> Excess {
        std::array::from_fn(|node| dot(&self.given[node], excess) / capacity[node] + self.heated[node])
    }

    /// Twice as many.
    fn twice(&self, capacity: &[f64; NODES]) -> Self {
        // θ of each node that a node at 1 K brings about, K.
        let excess = self.given.map(|given| std::array::from_fn(|node| given[node] / capacity[node]));
        let given = excess.map(|excess: Excess| std::array::from_fn(|node| dot(&excess, &self.given[node])));
        let lost = std::array::from_fn(|node| self.lost[node] + dot(&excess[node], &self.lost));
        let lost_of_power = 2.0 * self.lost_of_power + dot(&self.lost, &self.heated);
        Self::new(capacity, given, lost, self.after(capacity, &self.heated), lost_of_power)
    }
}
