use super::*;

#[test]
fn a_scene_is_told_from_a_study() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("scene.toml");
    let said = |text: &str| {
        std::fs::write(&path, text).unwrap();
        Study::load(&path).unwrap_err().to_string()
    };
    let scene = format!("{}: this is a scene, expected a study; `plateau run` and", path.display());
    for text in ["version = 1\n[mesh]\nrows = 8\n", "extends = \"quick.toml\"\n"] {
        assert!(said(text).starts_with(&scene), "{}", said(text));
    }
    assert!(!said("version = 1\ndesign = \"sobol\"\n[mesh]\n").contains("this is a scene"));
}

#[test]
fn seeds_of_synthetic_and_of_extended_surfaces_are_seeds() {
    let is_seed = |key: &str| schema::find(key).is_some_and(schema::Key::is_seed);
    assert!(
        ["disc.surface.synthetic.seed", "disc.prepare.extend_seed", "pin.prepare.extend_seed"]
            .iter()
            .all(|key| is_seed(key))
    );
    assert!(!["mesh.rows", "disc.seed", "disc.prepare.extend"].iter().any(|key| is_seed(key)));
}
