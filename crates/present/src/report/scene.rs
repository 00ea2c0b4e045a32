//! Scenes, and in which keys those of several runs differ.

use std::collections::{BTreeMap, BTreeSet};

use plateau_io::scene::values;

use super::outcome::UNKNOWN;

/// A row for every key that does not have the same value in all scenes: the key, and its value in each.
pub fn differences(scenes: &[&toml::Table]) -> Vec<Vec<String>> {
    let scenes: Vec<_> = scenes.iter().map(|scene| values(scene)).collect();
    let all: BTreeSet<_> = scenes.iter().flat_map(BTreeMap::keys).collect();
    let differs = |key: &String| scenes.iter().any(|scene| scene.get(key) != scenes[0].get(key));
    let row = |key: &String| {
        let texts = scenes.iter().map(|scene| match scene.get(key) {
            Some(toml::Value::String(text)) => text.clone(),
            value => value.map_or_else(|| UNKNOWN.into(), toml::Value::to_string),
        });
        std::iter::once(key.clone()).chain(texts).collect()
    };
    all.into_iter().filter(|key| differs(key)).map(row).collect()
}

#[cfg(test)]
mod tests {
    use super::differences;

    #[test]
    fn keys_that_differ_are_found_at_any_depth() {
        let parse = |text: &str| text.parse::<toml::Table>().unwrap();
        let one = parse("title = 'a'\n[disc.surface]\nsynthetic = { seed = 1, patch = '8 mm' }\nmirror = false");
        let other = parse("title = 'a'\n[disc.surface]\nsynthetic = { seed = 2 }\nmirror = false");
        let expected = [["disc.surface.synthetic.patch", "8 mm", "–"], ["disc.surface.synthetic.seed", "1", "2"]];
        assert_eq!(differences(&[&one, &other]), expected);
        assert!(differences(&[&one, &one]).is_empty());
        assert!(differences(&[]).is_empty());
    }
}
