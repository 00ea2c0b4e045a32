//! Studies and the points of their designs: what is accepted has runs, and each of them a scene or a reason why not.

use std::fs;
use std::path::Path;

use plateau_io::study::factor::Values;
use plateau_io::study::plan::Plan;
use plateau_io::study::{DesignSource, Study};
use plateau_study::design::Kind;
use proptest::prelude::*;

use super::harness::Fuzz;
use super::lines::changed;

/// Points of designs that are made: more are legal, and take long.
const FEW: usize = 2000;

fn data(name: &str) -> String {
    fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join("../../data").join(name)).unwrap()
}

fn folder() -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    fs::create_dir(folder.path().join("scenes")).unwrap();
    fs::create_dir(folder.path().join("studies")).unwrap();
    for scene in ["quick.toml", "cermet.toml", "stops.toml", "cermet-hot.toml"] {
        fs::write(folder.path().join("scenes").join(scene), data(&format!("scenes/{scene}"))).unwrap();
    }
    for table in ["debris.csv", "foundation.csv"] {
        fs::write(folder.path().join("studies").join(table), data(&format!("studies/{table}"))).unwrap();
    }
    folder
}

#[test]
fn changed_studies_are_accepted_or_refused() {
    let folder = folder();
    let path = folder.path().join("studies/changed.toml");
    let seeds = ["answer", "debris", "foundation", "friction", "roughness"];
    let mut seeds: Vec<String> = seeds.iter().map(|name| data(&format!("studies/{name}.toml"))).collect();
    for design in
        ["central-composite", "box-behnken", "latin-hypercube", "sobol", "plackett-burman", "fractional-factorial"]
    {
        seeds.push(study_of(design));
    }
    Fuzz { corpus: "studies", cases: 600, least_accepted: 20 }.run(changed(seeds), |content| {
        fs::write(&path, content).unwrap();
        check(&path)
    });
}

#[test]
fn changed_points_are_accepted_or_refused() {
    let folder = folder();
    let path = folder.path().join("studies/debris.toml");
    fs::write(&path, data("studies/debris.toml")).unwrap();
    let table = path.with_extension("csv");
    Fuzz { corpus: "points", cases: 300, least_accepted: 20 }.run(
        changed(vec![data("studies/debris.csv")]),
        |content| {
            fs::write(&table, content).unwrap();
            check(&path)
        },
    );
}

fn study_of(design: &str) -> String {
    let more = match design {
        "latin-hypercube" | "sobol" => "points = 8",
        "fractional-factorial" => "resolution = 3",
        "central-composite" => "alpha = \"rotatable\"\ncentre_points = 3",
        _ => "",
    };
    crate::studies::Study::new("../scenes/quick.toml", design, more)
        .load("range = [\"5 N\", \"20 N\"]")
        .fibres("range = [0.1, 0.5]")
        .factor("heights", "disc.prepare.scale", "range = [0.5, 2.0]")
        .response("pool", "/series/pool", "reaches = 0.9")
        .text()
}

fn check(path: &Path) -> Result<bool, TestCaseError> {
    let study = match Study::load(path) {
        Ok(study) => study,
        Err(error) => {
            prop_assert!(!error.to_string().is_empty());
            return Ok(false);
        }
    };
    if points(&study).is_none_or(|points| points > FEW) {
        return Ok(true);
    }
    match Plan::new(study) {
        Err(error) => prop_assert!(!error.to_string().is_empty()),
        Ok(plan) => {
            prop_assert_eq!(plan.order().len(), plan.runs());
            for number in plan.order().take(2) {
                let run = plan.run(number);
                prop_assert_eq!(run.levels.len(), plan.study().factors.len());
                if let Err(error) = plan.scene(&run) {
                    prop_assert!(!error.to_string().is_empty());
                }
            }
        }
    }
    Ok(true)
}

/// About how many points the design has, at most.
fn points(study: &Study) -> Option<usize> {
    let levels = study.factors.iter().map(|factor| match &factor.values {
        Values::Levels(levels) => levels.len().max(1),
        Values::Range { .. } => 2,
    });
    let all = levels.fold(1_usize, usize::saturating_mul);
    match &study.source {
        DesignSource::File(points) => Some(points.len()),
        DesignSource::Kind(kind, _) => match kind {
            Kind::LatinHypercube { points, .. } | Kind::Sobol { points } => Some(*points),
            Kind::CentralComposite { centre, .. } => centre[0].checked_add(centre[1]),
            Kind::BoxBehnken { centre } => Some(*centre),
            _ => Some(all),
        },
    }
}
