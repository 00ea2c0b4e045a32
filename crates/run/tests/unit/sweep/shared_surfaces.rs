use std::fs;
use std::path::Path;

use plateau_io::{scene, surface};

use super::*;

/// A scene of a small mesh with such settings, below `lines` of its own.
fn scene_of(folder: &Path, lines: &str, sets: &[&str]) -> Scene {
    let base = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../data/scenes/quick.toml");
    let path = folder.join("scene.toml");
    fs::write(&path, format!("version = 1\nextends = '{}'\n{lines}", base.display())).unwrap();
    let sets: Vec<String> = sets.iter().map(|set| (*set).to_owned()).collect();
    scene::load(&path, &sets).unwrap()
}

#[test]
fn runs_with_other_surfaces_do_not_share_them() {
    let folder = tempfile::tempdir().unwrap();
    let shared = SharedSurfaces::default();
    let scene = scene_of(folder.path(), "", &[]);
    assert!(shared.find(&scene).is_none());
    let loaded = Arc::new(surface::load(&scene).unwrap());
    shared.keep(&scene, &loaded);

    let sets = ["operation.normal_force=7 N", "materials.pin_primary.specific_wear_rate=2e-14 1/Pa"];
    let other = scene_of(folder.path(), "", &sets);
    assert!(Arc::ptr_eq(&shared.find(&other).unwrap(), &loaded));
    let seeds = ["disc.surface", "pin.base", "pin.surface"].map(|table| format!("{table}.synthetic.seed=8"));
    for set in
        seeds.iter().map(String::as_str).chain(["pin.base.mirror=true", "mesh.rows=12", "disc.prepare.cutoff=2 um"])
    {
        assert!(shared.find(&scene_of(folder.path(), "", &[set])).is_none(), "{set}");
    }
}

#[test]
fn surfaces_of_files_are_read_for_each_run() {
    let folder = tempfile::tempdir().unwrap();
    let shared = SharedSurfaces::default();
    fs::write(folder.path().join("disc.txt"), "1 2 3 4 5 6\n".repeat(40)).unwrap();
    let disc = "[disc.surface]\nfile = 'disc.txt'\npitch = '200 um'\nunit = 'um'\n[disc.prepare]\nrepeat = true\n";
    let scene = scene_of(folder.path(), disc, &[]);
    shared.keep(&scene, &Arc::new(surface::load(&scene).unwrap()));
    assert!(shared.find(&scene).is_none());
}

#[test]
fn what_is_kept_has_a_bound() {
    let folder = tempfile::tempdir().unwrap();
    let shared = SharedSurfaces::default();
    let scene = scene_of(folder.path(), "", &[]);
    let mut loaded = surface::load(&scene).unwrap();
    let kept = |shared: &SharedSurfaces| shared.0.lock().unwrap().len();
    shared.keep(&scene, &Arc::new(loaded.clone()));
    loaded.surfaces.disc_height = vec![0.0; MOST_BYTES / 8 - loaded.surfaces.disc_height.len()];
    shared.keep(&scene, &Arc::new(loaded.clone()));
    assert_eq!(kept(&shared), 1, "the older ones went");
    loaded.surfaces.disc_height = vec![0.0; MOST_BYTES / 8];
    shared.keep(&scene, &Arc::new(loaded));
    assert_eq!(kept(&shared), 0, "larger than what may be kept");
}
