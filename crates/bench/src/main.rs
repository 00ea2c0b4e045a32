//! Times one step of the model.
fn main() {}
