use std::fs;
use std::path::Path;

use plateau_io::study::record::Digests;
use plateau_io::{scene, surface};

use super::*;

/// A scene of a small mesh with the disc's heights in a file, with such settings.
fn scene_of(folder: &Path, sets: &[&str]) -> (Scene, Identity) {
    let rows = vec!["1 2 3 4 5 6\n"; 40].concat();
    if !folder.join("disc.txt").exists() {
        fs::write(folder.join("disc.txt"), rows).unwrap();
    }
    let base = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../data/scenes/quick.toml");
    let path = folder.join("scene.toml");
    let disc = "[disc.surface]\nfile = 'disc.txt'\npitch = '200 um'\nunit = 'um'\n[disc.prepare]\nrepeat = true\n";
    fs::write(&path, format!("version = 1\nextends = '{}'\n{disc}", base.display())).unwrap();
    let sets: Vec<String> = sets.iter().map(|set| (*set).to_owned()).collect();
    let scene = scene::load(&path, &sets).unwrap();
    let identity = Identity::expected(&scene, &Digests::default()).unwrap();
    (scene, identity)
}

#[test]
fn runs_with_other_surfaces_do_not_share_them() {
    let folder = tempfile::tempdir().unwrap();
    let shared = SharedSurfaces::default();
    let (scene, identity) = scene_of(folder.path(), &[]);
    assert!(shared.find(&scene, &identity).is_none());
    let loaded = Arc::new(surface::load(&scene).unwrap());
    shared.keep(&scene, &identity, &loaded);

    let (other, its_own) =
        scene_of(folder.path(), &["operation.normal_force=7 N", "materials.pin_primary.specific_wear_rate=2e-14 1/Pa"]);
    assert_ne!(its_own, identity);
    assert!(Arc::ptr_eq(&shared.find(&other, &its_own).unwrap(), &loaded));
    for set in ["pin.base.synthetic.seed=8", "pin.surface.synthetic.seed=8", "pin.base.mirror=true", "mesh.rows=12"] {
        let (other, its_own) = scene_of(folder.path(), &[set]);
        assert!(shared.find(&other, &its_own).is_none(), "{set}");
    }
    // The same scene, with another file of the same name.
    fs::write(folder.path().join("disc.txt"), vec!["1 2 3 4 5 7\n"; 40].concat()).unwrap();
    let (changed, its_own) = scene_of(folder.path(), &[]);
    assert!(shared.find(&changed, &its_own).is_none());
}

#[test]
fn what_is_kept_has_a_bound() {
    let folder = tempfile::tempdir().unwrap();
    let shared = SharedSurfaces::default();
    let (scene, identity) = scene_of(folder.path(), &[]);
    let mut loaded = surface::load(&scene).unwrap();
    let kept = |shared: &SharedSurfaces| shared.0.lock().unwrap().len();
    shared.keep(&scene, &identity, &Arc::new(loaded.clone()));
    loaded.surfaces.disc_height = vec![0.0; MOST_BYTES / 8 - loaded.surfaces.disc_height.len()];
    shared.keep(&scene, &identity, &Arc::new(loaded.clone()));
    assert_eq!(kept(&shared), 1, "the older ones went");
    loaded.surfaces.disc_height = vec![0.0; MOST_BYTES / 8];
    shared.keep(&scene, &identity, &Arc::new(loaded));
    assert_eq!(kept(&shared), 0, "larger than what may be kept");
}
