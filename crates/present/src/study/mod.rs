//! What a study shows: the analysis of its results, and what is said of it.
//!
//! | what | where |
//! |---|---|
//! | what the results tell of the factors; a factor as it is analysed | [`analysis`], [`analysed_factor`] |
//! | the scale on which a model is fitted to a response | [`fit_scale`] |
//! | the fitted model as an equation, in words | [`equation`] |
//! | what is expected where no run was made, and how to name such a place | [`forecasts`], [`place`] |
//! | goals of an optimum, read from words | [`goals`] |
//! | what a fit to an experiment tells, in words; of a whole series | [`fit`], [`fit_series`] |
//! | what a design cannot tell | [`cautions`] |
//! | the unit in which a factor is read | [`reading`] |
//! | which model is fitted, and what it misses | [`model`] |
//! | how well a model fits, what cannot be told apart, what repeats | [`words`] |

pub mod analysed_factor;
pub mod analysis;
pub mod cautions;
pub mod equation;
pub mod fit;
pub mod fit_scale;
pub mod fit_series;
pub mod forecasts;
pub mod goals;
pub mod model;
pub mod place;
pub mod reading;
pub mod words;
