//! A sub-step of the chain by implicit Euler (model 11).

/// Heat capacities of the chain, from the holder to the disc's last layer.
pub(super) const NODES: usize = 16;

/// θ of every node, K.
pub(super) type Excess = [f64; NODES];

/// A sub-step of the chain under a power that does not change.
pub(super) struct SubStep {
    /// Its length, s.
    pub time: f64,
    /// Of each node, J/K.
    pub capacity: [f64; NODES],
    /// To the next node, W/K.
    pub conductance: [f64; NODES - 1],
    /// To the ambient, W/K.
    pub outward: [f64; NODES],
    /// Power of friction into each node, W.
    pub power: [f64; NODES],
    elimination: Elimination,
}

impl SubStep {
    /// Over a time (s) with these heat capacities (J/K), conductances to the next node and outward (W/K), and powers
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

    /// By how much each node gets warmer, K.
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
    /// Of each row, what the row before takes off it.
    factor: [f64; NODES],
    pivot: [f64; NODES],
    /// To the next row, negative off the diagonal.
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
