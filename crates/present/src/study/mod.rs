//! What a study shows: the analysis of its results, and what is said of it.
//!
//! | what | where |
//! |---|---|
//! | what the results tell of the factors | [`analysis`] |
//! | what a fit to an experiment tells, in words | [`fit`] |
//! | the unit in which a factor is read | [`reading`] |
//! | which model is fitted, and what it misses | [`model`] |
//! | how well a model fits, what cannot be told apart, what repeats | [`words`] |

pub mod analysis;
pub mod fit;
pub mod model;
pub mod reading;
pub mod words;
