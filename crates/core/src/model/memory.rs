//! What a simulation keeps between two steps, whatever takes its steps.

use serde::{Deserialize, Serialize};

use crate::model::accounts::AccountsState;
use crate::model::clock::Clock;
use crate::model::history::{Course, History};
use crate::model::totals::Account;

/// Heights of disc and pin, m, column by column.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct Heights {
    /// z_d.
    pub disc_height: Vec<f64>,
    /// b_d.
    pub disc_substrate: Vec<f64>,
    /// z_p.
    pub pin_height: Vec<f64>,
    /// b_p.
    pub pin_substrate: Vec<f64>,
}

/// What is kept beside the heights.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Memory {
    /// What the steps so far were like.
    pub course: Course,
    /// When steps end.
    pub clock: Clock,
    /// m.
    pub time_acceleration: f64,
    /// What was moved.
    pub account: Account,
    /// Contact area over the steps so far.
    pub history: History,
    /// Of friction, heat and emission, where the scene asks for any.
    pub accounts: Option<AccountsState>,
}
