//! The physics of Plateau: a pin of friction material on a rough, coated brake disc, after Riva, Perricone and
//! Wahlström (Tribology in Industry 41, 2019).
//!
//! # Symbols
//! | symbol | unit | meaning | where |
//! |---|---|---|---|
//! | r_i, A_i, Δθ | m, m², rad | radius and area of a row's cells, angle of a column | [`mesh`](model::mesh) |
//! | E, ν, κ | Pa, 1, 1/Pa | Young's modulus, Poisson ratio, specific wear rate by (body, status) | [`material`](model::material) |
//! | h_m | m | height that resin loses when it touches | [`material`](model::material) |
//! | F_N, ω, h, m | N, rad/s, m, 1 | load, rotational speed, foundation height, time acceleration | [`parameters`](model::parameters) |
//! | z_d, b_d, z_p, b_p | m | surface and substrate height of disc and pin | [`state`](model::state) |
//! | k = E*/h | Pa/m | stiffness per area of a pair | `engine::coefficients` |
//! | δ, u, p | m, m, Pa | displacement of the pin, overlap, pressure p = k u | `engine::contact` |
//! | M, s, η, β | m³, m, 1, 1 | debris pool, its share per open cell, captured fraction, pad share | [`step`](model::step) |
//!
//! # One step
//! | model | equation | as it is read | in the engine |
//! |---|---|---|---|
//! | 4.1 pairs | 1/E* = (1−ν_p²)/E_p + (1−ν_d²)/E_d, k = E*/h | [`pairs`](model::step::pairs) | `coefficients::Coefficients` |
//! | 4.1 load balance | g = z_p − z_d, Σ k A (δ − g)₊ = F_N | [`balance`](model::step::balance) | `contact::Contact::balance` |
//! | 4.2 wear | Δh = κ p ds, or u (1 − exp(−κ k ds)); resin h_m; build-up first | [`wear`](model::step::wear) | `coefficients::Coefficients`, `wear` |
//! | 4.2a strength | p > σ_b: build-up on resin breaks away | [`break_away`](model::step::break_away) | `kernel::worn` |
//! | 4L local debris | d = min(γ, a_p + a_d, η w/A); emitted += worn + returned − deposited | [`deposit_locally`](model::step::deposit_locally) | `kernel::deposit` |
//! | 4L transport length | d = min(γ, a_p + a_d, v̄), v̄ = η Σ v/L | [`deposit_over`](model::step::deposit_over) | `kernel::edges`, `kernel::deposit` |
//! | 4P destruction | a build-up on resin with no plateau ahead returns to the pool | [`destroy`](model::step::destroy) | pooled debris is the plain model's |
//! | 4P formation | d = min(γ, s), s = M/S | [`form`](model::step::form) | |
//! | 4P balance | M ← M + η worn + returned − deposited | [`pool`](model::step::pool) | |
//! | 4.6 advance | t += m Δt | [`advance`](model::step::advance) | `worker` |
//! | 9 operation | the load of a step is its mean over the step's angle | [`cycle`](model::cycle) | the same |
//! | 10 to 12 friction, heat, emission | booked after each step, from sums that the load balance has | [`accounts`](model::accounts) | the same |
//!
//! [`Simulation`](simulation::Simulation) takes the steps and reports (5). [`model::step`] is all of it as it is read, cell by
//! cell. The [`engine`] takes the same steps: `worker` takes the rules in turn,
//! those of eight cells are `kernel::worn` (4.2), that of a cell that gets debris `kernel::deposit` (4L). Scenes with pooled debris
//! (4P) run on the plain model.
//!
//! # How a step is carried out
//! - One pass over the pin a step. In the next step the disc column under pin column j lies under column j + 1, so the
//!   pass that updates the cells also reads the gaps of the next step, against a bracket around the displacement that is
//!   expected (`forecast`): sums over the pairs that surely touch, and a list of the few of which it is not sure. The
//!   load is piecewise linear, so that this is enough to solve the balance exactly (`contact`).
//! - Eight cells of one strip at a time (`strips`), the same source for every instruction set ([`kernel`](engine::kernel)).
//! - Between two steps the complete state can be taken out and put into another simulation ([`checkpoint`](simulation::checkpoint)).
//! - Sums are integers, so they do not depend on the order of the cells (`exact`, `sums`).
//! - The ring is divided into sectors (`sector`) that belong to workers: threads or processes that tell each other those
//!   sums and hand on the pin columns that cross from sector to sector ([`comm`](engine::comm)).
//!
//! # Range of validity
//! The load balance knows the normal load alone: friction, heat and emission are booked after each step and act back on the
//! wear rates and on friction only. No inertia. Cells deform independently (Winkler). Time acceleration m > 1 is
//! an approximation. The explicit wear rule overshoots when the stiffness number Π = κ k m r Δθ exceeds 1 and is
//! unstable above 2 ([`parameters::Parameters::stiffness_number`](model::parameters::Parameters::stiffness_number)); the exponential rule never is.

pub mod acceleration;
pub mod engine;
pub mod model;
pub mod observe;
mod paper;
pub mod simulation;
pub mod surface;
