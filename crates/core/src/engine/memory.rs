//! What the engine keeps from step to step beside what every simulation does.

use serde::{Deserialize, Serialize};

use crate::engine::contact::Contact;
use crate::engine::forecast::Forecast;
use crate::engine::kernel::Bracket;
use crate::engine::quantum::Quantum;

/// What the engine keeps from step to step.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(crate) struct EngineMemory {
    pub contact: Contact,
    pub forecast: Forecast,
    pub bracket: Option<Bracket>,
    pub overlap_quantum: Quantum,
}
