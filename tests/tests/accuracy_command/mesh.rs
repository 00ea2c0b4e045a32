//! Runs with other cells: each is what `plateau run` makes of every so-many-th column of the surfaces on the finest mesh.

use plateau_tests::run_file::{StoredStatus, created};
use plateau_tests::table::{Row, number, relative_error};

use super::{
    QUANTITIES, WorkingDirectory, document, expect_near, means, measured, number_of, refusal, run, with_scene,
};

const EDITS: [(&str, &str); 1] = [("debris = \"local\"", "debris = \"local\"\ntransport_length = \"800 um\"")];

/// Writes every `stride`-th column of the initial surfaces of the finest run, and gives the settings that read them.
fn sampled(directory: &WorkingDirectory, stride: usize) -> Vec<String> {
    let finest = directory.run_file("finest.h5");
    let file = created(directory.path("sampled.h5"));
    for name in ["disc", "pin"] {
        let rows = *finest.shape(&format!("/{name}/height")).last().unwrap();
        let all = finest.map(&format!("/{name}/height"), 0);
        let values: Vec<f64> = all.chunks(rows).step_by(stride).flatten().copied().collect();
        let values = ndarray::ArrayView2::from_shape([values.len() / rows, rows], &values).unwrap();
        file.new_dataset_builder().with_data(values).create(name).unwrap();
        if name == "pin" {
            let all = finest.statuses("/pin/base");
            let base = all.chunks(rows).step_by(stride).flatten().map(|base| u8::from(*base == StoredStatus::primary));
            let base: Vec<u8> = base.collect();
            let base = ndarray::ArrayView2::from_shape([base.len() / rows, rows], &base).unwrap();
            file.new_dataset_builder().with_data(base).create("base").unwrap();
        }
    }
    file.close().unwrap();
    let sources = [("disc.surface", "disc"), ("pin.surface", "pin"), ("pin.base", "base")].map(|(key, dataset)| {
        let file = directory.path("sampled.h5");
        [format!("{key}.file={:?}", file.display().to_string()), format!("{key}.dataset=\"/{dataset}\"")]
    });
    let prepared = ["disc.prepare.cutoff=none", "pin.surface.resin_recess=0 um"].map(str::to_owned);
    sources.into_iter().flatten().chain(prepared).collect()
}

#[test]
fn runs_with_other_cells_have_samples_of_the_same_surfaces() {
    let directory = with_scene(&EDITS);
    let (text, rows) = measured(&directory, &["--ladder", "time_acceleration,mesh"]);
    assert!(text.contains("disc_columns = 1380, pin_columns = 80, time_acceleration = 1, run here"), "{text}");
    let settings = |row: &Row| -> Vec<String> {
        let key = |set: &str| set.replace("time_", "numerics.time_").replace("disc_c", "mesh.disc_c");
        row["setting"].split(", ").map(|set| key(set).replace("pin_c", "mesh.pin_c")).collect()
    };
    let halved = ["mesh.disc_columns=1380", "mesh.pin_columns=80", "numerics.time_acceleration=1"];
    let finest = run(&directory, "finest.h5", &halved);
    let reference: Vec<Vec<f64>> = QUANTITIES.iter().map(|(_, series)| means(&finest, series)).collect();
    drop(finest);
    // Every m from 1 on with the scene's and with doubled cells, every one above 1 with halved ones.
    let cells = |stride: usize| match stride {
        1 => "1380.0",
        4 => "345.0",
        _ => "",
    };
    for (stride, ladder, runs) in [(2, "time_acceleration", 5), (1, "mesh", 4), (4, "mesh", 5)] {
        let is_own = |row: &&Row| row["ladder"] == ladder && (stride == 2 || row["value"] == cells(stride));
        let own: Vec<_> = rows.iter().filter(is_own).collect();
        assert_eq!(own.len(), runs, "{text}");
        let surfaces = sampled(&directory, stride);
        for row in [own[0], own[runs - 1]] {
            let run = run(&directory, "run.h5", &[settings(row), surfaces.clone()].concat());
            for ((name, series), expected) in QUANTITIES.iter().zip(&reference) {
                let (found, error) =
                    (number(row, &format!("{name}_error")), relative_error(&means(&run, series), expected));
                expect_near(found, error, 1e-12, &format!("{}, {name}", row["setting"]));
            }
        }
    }
    // The reference's own error is that of the scene's cells with its time acceleration.
    let own = rows.iter().find(|row| row["setting"] == "time_acceleration = 1").unwrap();
    for (name, _) in QUANTITIES {
        let error = number_of(&document(&directory)["reference"][format!("{name}_error")]);
        expect_near(error, number(own, &format!("{name}_error")), 1e-15, name);
    }
}

#[test]
fn without_a_transport_length_the_cell_is_part_of_the_model() {
    let directory = with_scene(&[]);
    let reason = "the cell is part of the model of this scene, so the mesh is not varied";
    // Alone it leaves nothing to run, and that is why.
    let refused = refusal(&directory, &["scene.toml", "--ladder", "mesh"]);
    assert!(refused.contains(reason), "{refused}");
    let (text, rows) = measured(&directory, &["--ladder", "time_acceleration,mesh"]);
    assert!(text.contains(reason), "{text}");
    assert!(rows.iter().all(|row| row["ladder"] == "time_acceleration"), "{text}");
}

#[test]
fn surfaces_that_are_given_cell_for_cell_have_no_other_mesh() {
    let directory = with_scene(&EDITS);
    drop(run(&directory, "finest.h5", &["numerics.time_acceleration=20"]));
    let sets = sampled(&directory, 1).into_iter().flat_map(|set| ["--set".to_owned(), set]);
    let arguments: Vec<String> =
        ["--ladder", "time_acceleration,mesh"].map(str::to_owned).into_iter().chain(sets).collect();
    let (text, rows) = measured(&directory, &arguments.iter().map(String::as_str).collect::<Vec<_>>());
    assert!(text.contains("the mesh is not varied: with disc_columns = 1380"), "{text}");
    assert!(rows.iter().all(|row| row["ladder"] == "time_acceleration"), "{text}");
}

#[test]
fn a_mesh_in_lengths_is_not_varied() {
    let cells =
        "inner_radius = \"20 mm\"\nouter_radius = \"20.4 mm\"\nrows = 8\ndisc_columns = 690\npin_columns = 40\n";
    let lengths =
        "pin_width = \"0.4 mm\"\npin_length = \"7.5 mm\"\ncell_size = \"100 um\"\nmean_radius = \"20.2 mm\"\n";
    let directory = with_scene(&EDITS);
    let scene = directory.text("scene.toml");
    assert!(scene.contains(cells), "{scene}");
    directory.write("scene.toml", scene.replace(cells, lengths));
    let (text, rows) = measured(&directory, &["--ladder", "time_acceleration,mesh"]);
    assert!(text.contains("the mesh is not varied: columns cannot be set where it is given in lengths"), "{text}");
    assert!(rows.iter().all(|row| row["ladder"] == "time_acceleration"), "{text}");
}
