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
