//! The mesh of a scene in cells and in lengths, and the round pin.

use std::fs;

use plateau_core::model::mesh::{Mesh, Outline};
use plateau_core::observe::schedule::SampleEvery;
use plateau_io::scene;

use crate::fixtures::place;
use crate::good_scenes::{good, load};

#[test]
fn a_mesh_in_lengths_is_that_in_rows_and_columns() {
    // By hand: 4 mm in 200 µm are 20 rows, 2π · 22 mm/200 µm = 691.2 columns, of which 8 mm take 40.0.
    let lengths = ["pin_width=4 mm", "pin_length=8 mm", "cell_size=200 um", "mean_radius=22 mm"];
    let lengths: Vec<String> = lengths.iter().map(|set| format!("mesh.{set}")).collect();
    let of = |sets: &[String]| scene::load(&good("minimal.toml"), sets).unwrap_or_else(|error| panic!("{error}"));
    let in_lengths = of(&lengths);
    let cells = ["rows=20", "disc_columns=691", "pin_columns=40"].map(|set| format!("mesh.{set}"));
    let in_cells = of(&cells);
    assert_eq!(in_lengths.parameters, in_cells.parameters);
    // What is one revolution follows from it, and the keys of the other way are gone.
    assert_eq!(in_lengths.output.sample_every, SampleEvery::Steps(691));
    assert!(!in_lengths.resolved.contains("rows") && in_lengths.resolved.contains("cell_size = \"200 um\""));
    // And back again.
    let (_folder, path) = place("resolved.toml");
    fs::write(&path, &in_lengths.resolved).unwrap();
    let radii = ["mesh.inner_radius=20 mm".to_owned(), "mesh.outer_radius=24 mm".to_owned()];
    let again = scene::load(&path, &[&cells[..], &radii].concat()).unwrap();
    assert_eq!(again.parameters, in_cells.parameters);
    assert!(!again.resolved.contains("cell_size"));
    // Table 2 of the paper. By hand: 2π · 22 mm/50 µm = 2764.6, so 2765 columns of 49.99 µm, of which 8 mm take 160.02.
    let finer = [&lengths[..], &["mesh.cell_size=50 um".to_owned()]].concat();
    assert_eq!(of(&finer).parameters.mesh, Mesh::new(80, 2765, 160, 20e-3, 24e-3).unwrap());
}

#[test]
fn a_round_pin_is_given_by_its_width_or_its_diameter() {
    let round = load("round.toml", &[]).parameters.mesh;
    // By hand: the longest arc, 2 · 2/√(22² − 2²) rad, in columns of 2π/691 rad: 20.08.
    assert_eq!([round.rows(), round.disc_columns(), round.pin_columns()], [20, 691, 20]);
    assert_eq!(round.outline(), Outline::Disc { radius: 2e-3 });
    let counts = ["mesh.rows=20", "mesh.disc_columns=691", "mesh.pin_columns=20"];
    let sets = [&counts[..], &["mesh.shape=disc", "mesh.pin_diameter=4 mm"]].concat();
    assert_eq!(load("minimal.toml", &sets).parameters.mesh, round);
    // A rectangle takes the place of the round pin, and the other way round.
    let rectangle = ["mesh.shape=rectangle", "mesh.pin_length=4 mm"];
    assert_eq!(load("round.toml", &rectangle).parameters.mesh.outline(), Outline::Rectangle);
    let (_folder, path) = place("rectangle.toml");
    fs::write(&path, load("round.toml", &rectangle).resolved).unwrap();
    let again = scene::load(&path, &["mesh.shape=disc".to_owned()]).unwrap();
    assert_eq!(again.parameters.mesh, round);
}
