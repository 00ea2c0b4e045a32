//! Heat of friction: one chain from the pin's holder to the air, and the temperature of the contact (model 11).
//!
//! | model 11 | file |
//! |---|---|
//! | disc, pin, coating; feedback | `../thermal.rs` |
//! | one chain, its sub-steps | `chain.rs` |
//! | passing under the pin, contact temperature map | `passing.rs` |
//! | order: intervals, pauses, what holds for the next interval | `account.rs` |

pub mod account;
pub mod chain;
pub mod passing;
