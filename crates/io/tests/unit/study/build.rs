use super::*;

#[test]
fn seeds_of_synthetic_and_of_extended_surfaces_are_seeds() {
    assert!(
        ["disc.surface.synthetic.seed", "disc.prepare.extend_seed", "pin.prepare.extend_seed"]
            .iter()
            .all(|key| is_seed(key))
    );
    assert!(!["mesh.rows", "disc.seed", "disc.prepare.extend"].iter().any(|key| is_seed(key)));
}
