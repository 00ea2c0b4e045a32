//! What a study shows: the analysis of its results, and what is said of it.
//!
//! | what | where |
//! |---|---|
//! | what the results tell of the factors | [`analysis`] |
//! | which effects cannot be told from each other | [`aliases`] |
//! | the unit in which a factor is read | [`reading`] |
//! | which model is fitted, and what it misses | [`model`] |
//! | how well a model fits, in a line | [`quality`] |
//! | which runs repeat another one | [`repeated`] |

pub mod aliases;
pub mod analysis;
pub mod model;
pub mod quality;
pub mod reading;
pub mod repeated;
