//! What a run reports, and what is made of it.

mod acceleration;
mod drift;
mod event;
mod pressure_spread;
mod roughness;
mod running_in;
mod schedule;
mod window_mean;
