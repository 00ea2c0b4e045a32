//! How layers of a scene combine: files that extend others, `--set`, alternatives, and the resolved scene.

use std::f64::consts::TAU;
use std::path::Path;

use plateau_core::model::material::Material;
use plateau_core::model::state::Base;
use plateau_core::observe::Map;
use plateau_core::observe::schedule::SampleEvery;
use plateau_core::surface::{Extension, FibreSynthesis, Fill, HeightSynthesis, Level, Preparation};
use plateau_io::input::sha256_of;
use plateau_io::scene::{self};
use plateau_io::scene::{BaseSource, HeightSettings, HeightSource, Scene, Workers};
use plateau_io::surface::ReadOptions;

use crate::good_scenes::{good, input, load};

#[test]
fn a_text_is_a_scene_as_its_file_is() {
    let set = "operation.normal_force=\"3 N\"";
    let text = std::fs::read_to_string(good("extending.toml")).unwrap();
    let found = scene::of_layers(&good("extending.toml"), Some(&text), &[&[set.to_owned()]]).unwrap();
    let expected = load("extending.toml", &[set]);
    assert_eq!(found.resolved, expected.resolved);
    // The text itself is in no file.
    assert_eq!(found.files, expected.files[1..]);
    assert_eq!(found.parameters.normal_force, 3.0);
    let error = scene::of_text(Path::new("mine"), "version = 1\nextends = \"none.toml\"\n").unwrap_err().to_string();
    assert!(error.starts_with("mine:2:11: extends: cannot read none.toml"), "{error}");
}

#[test]
fn a_later_list_of_changes_may_choose_another_alternative() {
    let sets = ["operation.duration=\"2 s\"", "operation.steps=7"].map(|set| [set.to_owned()]);
    let path = good("minimal.toml");
    assert_eq!(scene::of_layers(&path, None, &[&sets[0], &sets[1]]).unwrap().steps, 7);
    let error = scene::load(&path, &sets.concat()).unwrap_err().to_string();
    assert!(error.contains("duration and steps are given together"), "{error}");
}

#[test]
fn an_extending_scene_overrides_key_by_key_and_removes_the_other_alternatives() {
    let scene = load("extending.toml", &[]);
    assert_eq!(scene.title, "measured");
    let files = ["extending.toml", "parts/measured.toml", "parts/../minimal.toml"].map(good);
    assert_eq!(scene.files, files.map(|file| (file.clone(), sha256_of(&std::fs::read(file).unwrap()))));
    assert_eq!(scene.parameters.angular_velocity, 850.0 * TAU / 60.0);
    // 0.5 s at ten revolutions in one: 0.5 · 850/60 · 276/10 = 195.5 steps.
    assert_eq!(scene.steps, 196);
    // Key by key like the primary plateau, but for what is given.
    let materials = &scene.parameters.materials;
    assert_eq!(materials.pin_secondary, Material { poisson_ratio: 0.3, ..materials.pin_primary });
    // Files are relative to the scene that names them.
    assert_eq!(
        scene.disc_surface,
        HeightSettings {
            source: HeightSource::File { path: input("parts/../surfaces/cermet.sdf"), options: ReadOptions::default() },
            mirror: true,
            preparation: Preparation { level: Level::Mean, fill: Some(Fill::Level), repeat: true, ..Preparation::NONE },
        }
    );
    assert_eq!(
        scene.pin_surface.source,
        HeightSource::File { path: input("pin.npy"), options: ReadOptions::default() }
    );
    let fibres = FibreSynthesis { seed: 0, fibre_fraction: 0.3, fibre_length: 4e-4, fibre_width: 1e-4 };
    assert_eq!((scene.pin_base, scene.pin_base_mirror), (BaseSource::Synthetic(fibres), true));
    assert_eq!(scene.workers, Workers::Auto);
    assert_eq!(scene.output.sample_every, SampleEvery::Time(1.0));
    assert_eq!(scene.output.maps, [Map::DiscHeight, Map::Pressure]);
    assert_eq!(scene.output.maps_at, [0.0, 0.5]);
    assert_eq!(scene.output.checkpoint_every, 60.0);
    let [debris, warning] = &scene.warnings[..] else { panic!("{:?}", scene.warnings) };
    assert_eq!((debris.key.as_str(), debris.found.as_str()), ("plateaus.debris", "not given"));
    let warning = warning.to_string();
    assert!(
        warning.starts_with("tests/scenes/good/extending.toml:17:11: output.maps_at: maps at 3600 s, "),
        "{warning}"
    );
}

#[test]
fn set_overrides_the_scene() {
    let scene = load(
        "extending.toml",
        &[
            "mesh.rows = 4",
            "mesh.rows=5",
            "operation.steps=7",
            "operation.normal_force=30 N",
            "contact.foundation_height=\"60 um\"",
            "disc.surface.file=other.sdf",
            "disc.surface.dataset=/height",
            "pin.base.uniform=none",
            "pin.surface.synthetic={ seed = 18446744073709551615, rms_height = \"1 um\", correlation_length = \"2 um\" }",
            "output.maps=[]",
            "output.sample_every_steps=3",
        ],
    );
    let parameters = &scene.parameters;
    assert_eq!((parameters.mesh.rows(), scene.steps), (5, 7));
    assert_eq!((parameters.normal_force, parameters.foundation_height), (30.0, 6e-5));
    let options = ReadOptions { dataset: Some("/height".to_owned()), ..ReadOptions::default() };
    assert_eq!(scene.disc_surface.source, HeightSource::File { path: input("other.sdf"), options });
    assert_eq!(scene.pin_base, BaseSource::Uniform(Base::Resin));
    assert_eq!(scene.seeds, [("pin.surface.synthetic.seed".to_owned(), u64::MAX)]);
    assert_eq!((scene.output.maps.len(), scene.output.sample_every), (0, SampleEvery::Steps(3)));
    // A key of a table leaves the others of it.
    let scene = load("full.toml", &["pin.surface.synthetic.seed=9", "disc.surface.flat=true"]);
    let synthesis = HeightSynthesis::gaussian(9, 0.5e-6, 100e-6);
    assert_eq!(scene.pin_surface.source, HeightSource::Synthetic(synthesis));
    assert_eq!(scene.disc_surface.source, HeightSource::Flat);
}

#[test]
fn tiling_and_extending_replace_each_other() {
    // full.toml tiles its disc.
    let extended = load("full.toml", &["disc.prepare.extend=statistics"]);
    let Preparation { repeat, extend, .. } = extended.disc_surface.preparation;
    assert_eq!((repeat, extend), (false, Some(Extension::Statistics { seed: 0 })));
    assert_eq!(extended.seeds[0], ("disc.prepare.extend_seed".to_owned(), 0));
    let seeded = load("full.toml", &["disc.prepare.extend=statistics", "disc.prepare.extend_seed=12"]);
    assert_eq!(seeded.disc_surface.preparation.extend, Some(Extension::Statistics { seed: 12 }));
    // The scene's step is left out, and both are named.
    let warnings: Vec<String> = extended.warnings.iter().map(ToString::to_string).collect();
    let named = warnings.iter().filter(|warning| {
        warning.starts_with("--set disc.prepare.extend=statistics: disc.prepare.extend: it takes the place of repeat (")
    });
    assert_eq!(named.count(), 1, "{warnings:?}");
    assert!(load("full.toml", &[]).warnings.iter().all(|warning| !warning.found.contains("takes the place")));
    assert_eq!(load("full.toml", &["pin.prepare.repeat=true"]).pin_surface.preparation.extend, None);
}

#[test]
fn a_resolved_scene_reads_back_alike() {
    let folder = tempfile::tempdir().unwrap();
    for (name, sets) in [
        ("full.toml", &[][..]),
        ("minimal.toml", &[]),
        ("minimal.toml", &["operation.sliding_speed=0.1 km/h", "contact.load_tolerance=1e-13", "output.maps=[]"]),
        ("minimal.toml", &["title='quoted \" and \\ µ'", "disc.prepare.scale=-0.1", "pin.prepare.cutoff=0.3 um"]),
        ("extending.toml", &["operation.rotational_speed=123.456 rpm", "numerics.workers=3"]),
        ("full.toml", &["pin.surface.synthetic.correlation_length_across=20 um", "disc.prepare.outliers=4.5"]),
        (
            "full.toml",
            &[
                "pin.surface.synthetic={ rms_height = '1 um', roll_off = '0.3 mm', hurst = 1, short_cutoff = '0.2 mm' }",
                "pin.surface.synthetic.skewness=-0.5",
            ],
        ),
        (
            "full.toml",
            &["disc.prepare.extend=statistics", "pin.prepare.extend=statistics", "pin.prepare.extend_seed=7"],
        ),
        ("hot.toml", &["thermal.ambient=0 degC", "thermal.wear_rate_factor=[['100.1 degC', 0.3]]"]),
        ("vector-flat.toml", &[]),
        ("vector-rough.toml", &[]),
        ("vector-track.toml", &["operation.duration=0.1 min"]),
    ] {
        let scene = load(name, sets);
        let path = folder.path().join("resolved.toml");
        std::fs::write(&path, &scene.resolved).unwrap();
        let again = scene::load(&path, &[]).unwrap_or_else(|error| panic!("{error}\n{}", scene.resolved));
        let content = |scene: Scene| {
            (
                (scene.title, scene.parameters, scene.disc_surface, scene.pin_surface, scene.resin_recess),
                (scene.pin_base, scene.pin_base_mirror, scene.workers, scene.output, scene.seeds, scene.resolved),
            )
        };
        assert_eq!(again.files.iter().map(|(file, _)| file).collect::<Vec<_>>(), [&path]);
        assert_eq!(content(again), content(scene));
    }
}

#[test]
fn a_resolved_scene_says_everything_in_the_order_of_the_format() {
    let resolved = load("extending.toml", &[]).resolved;
    let folder = std::path::absolute("tests/scenes/good").unwrap();
    insta::assert_snapshot!("resolved", resolved.replace(folder.to_str().unwrap(), "[folder]"));
}

/// The path of `minimal.toml` as TOML has it.
fn minimal() -> toml::Value {
    toml::Value::from(&*std::path::absolute(good("minimal.toml")).unwrap().to_string_lossy())
}

/// What a scene is warned of with these words.
fn warned(path: &Path, words: &str) -> Vec<String> {
    let scene = scene::load(path, &[]).unwrap();
    let warnings = scene.warnings.iter().map(ToString::to_string);
    warnings.filter(|warning| warning.contains(words)).collect()
}

#[test]
fn none_takes_out_a_step_that_is_inherited() {
    let folder = tempfile::tempdir().unwrap();
    let write = |name: &str, extends: &toml::Value, steps: &str| {
        let path = folder.path().join(name);
        std::fs::write(&path, format!("extends = {extends}\n[disc.prepare]\n{steps}\n")).unwrap();
        path
    };
    let steps = "cutoff = \"3 um\"\noutliers = 6\nfill = \"level\"\nl_filter = \"1 mm\"\nextend = \"statistics\"\nextend_seed = 3\n\
        crop = { along = [\"1 mm\", \"9 mm\"] }\nunroll = { centre = [\"4 mm\", \"-20 mm\"] }";
    write("base.toml", &minimal(), steps);
    let base = toml::Value::from("base.toml");
    let all = ["cutoff", "outliers", "fill", "l_filter", "extend", "crop", "unroll"];
    let none = all.map(|step| format!("{step} = \"none\"")).join("\n");
    let kept = scene::load(&write("kept.toml", &base, "cutoff = \"4 um\""), &[]).unwrap();
    let preparation = kept.disc_surface.preparation;
    assert_eq!((preparation.cutoff, preparation.outliers, preparation.l_filter), (Some(4e-6), Some(6.0), Some(1e-3)));
    let path = write("none.toml", &base, &none);
    let taken_out = scene::load(&path, &[]).unwrap();
    assert_eq!(taken_out.disc_surface.preparation, Preparation::NONE);
    // What is stored with a run is as if there had never been such steps, so that any reader of scenes takes it.
    assert_eq!(taken_out.resolved.matches("cutoff").count(), kept.resolved.matches("cutoff").count() - 1);
    assert!(["fill = ", "extend_seed", "crop", "unroll"].iter().all(|step| !taken_out.resolved.contains(step)));
    // Later layers count, here --set; and a word that is not known is refused.
    let set = |argument: &str| scene::load(&path, &[argument.to_owned()]);
    assert_eq!(set("disc.prepare.cutoff=5 um").unwrap().disc_surface.preparation.cutoff, Some(5e-6));
    let none =
        scene::load(folder.path().join("kept.toml").as_path(), &["disc.prepare.cutoff=none".to_owned()]).unwrap();
    assert_eq!(none.disc_surface.preparation, Preparation { cutoff: None, ..preparation });
    for unknown in ["cutoff=never", "crop=never", "crop.along=never"] {
        assert!(set(&format!("disc.prepare.{unknown}")).is_err(), "{unknown}");
    }
    assert!(set("disc.surface.unit=none").is_err() && set("disc.surface.synthetic=none").is_err());
    let uncropped = ["disc.prepare.crop=none", "disc.prepare.unroll=none"].map(str::to_owned);
    let kept = scene::load(&folder.path().join("kept.toml"), &uncropped).unwrap();
    assert_eq!(kept.disc_surface.preparation, Preparation { crop: None, unroll: None, ..preparation });
}

#[test]
fn a_constant_beside_an_inherited_cycle_is_told_to_change_nothing() {
    let folder = tempfile::tempdir().unwrap();
    let write = |name: &str, text: String| {
        let path = folder.path().join(name);
        std::fs::write(&path, text).unwrap();
        path
    };
    write("loads.csv", "time [s],normal_force [N]\n0,4\n9,6\n".to_owned());
    let cycle = "cycle.file = \"loads.csv\"";
    let stop = write("stop.toml", format!("extends = {}\n[operation]\n{cycle}\n", minimal()));
    let own = |constant: &str| write("own.toml", format!("extends = \"stop.toml\"\n[operation]\n{constant}\n"));
    let warned = |path: &Path| warned(path, "beside a cycle that has a column of its own");
    // The constant that the cycle was laid over is there in every scene with a cycle.
    assert_eq!(warned(&stop), [""; 0]);
    let said = warned(&own("normal_force = \"40 N\""));
    assert!(said.len() == 1 && said[0].contains("own.toml:3:16: operation.normal_force"), "{said:?}");
    // There is no column of speed.
    assert_eq!(warned(&own("rotational_speed = \"500 rpm\"")), [""; 0]);
    assert_eq!(warned(&own(&format!("normal_force = \"40 N\"\n{cycle}"))), [""; 0]);
}

#[test]
fn a_vehicle_that_brakes_while_its_disc_does_not_is_wondered_at() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("scene.toml");
    std::fs::write(&path, format!("extends = {}\n[operation]\ncycle.file = \"loads.csv\"\n", minimal())).unwrap();
    let warned = |table: &str| {
        std::fs::write(folder.path().join("loads.csv"), table).unwrap();
        warned(&path, "road_speed")
    };
    let said = warned("time [s],normal_force [N],road_speed [km/h]\n0,4,50\n9,6,0\n");
    assert!(said.len() == 1 && said[0].contains("scene.toml:3:14: operation.cycle.file"), "{said:?}");
    assert!(said[0].contains("road_speed changes while the disc turns at one speed"), "{said:?}");
    // A vehicle at one speed, and a disc that brakes with it.
    assert_eq!(warned("time [s],normal_force [N],road_speed [km/h]\n0,4,50\n9,6,50\n"), [""; 0]);
    assert_eq!(warned("time [s],sliding_speed [m/s],road_speed [km/h]\n0,4,50\n9,0,0\n"), [""; 0]);
}
