use super::*;

#[test]
fn every_default_is_a_value_of_its_own_key() {
    for key in schema::keys() {
        if let Need::Default(text) = key.need {
            let entry = layers::read_default(text).unwrap();
            interpret(&key.path(), key.kind, &entry, Path::new("scene.toml")).unwrap();
        }
    }
}
