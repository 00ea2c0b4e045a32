//! Writes a test vector of a scene from the model as it is read:
//! `cargo run --release -p plateau-tests --example vector -- tests/vectors/local/scene.toml FOLDER`.
//! Slow: a millisecond for some ten thousand cells of the pin, every step.

use std::error::Error;
use std::path::Path;

use plateau_io::scene;
use plateau_tests::vector;

fn main() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [scene, folder] = &arguments[..] else { return Err("expected a scene file and a folder".into()) };
    vector::write(&scene::load(Path::new(scene), &[])?, Path::new(folder))
}
