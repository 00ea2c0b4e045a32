use super::super::exclusions::GROUPS;
use super::*;

#[test]
fn every_path_is_there_once_and_every_group_member_is_a_key_or_table() {
    let mut paths: Vec<_> = keys().iter().map(Key::path).collect();
    paths.sort();
    let count = paths.len();
    paths.dedup();
    assert_eq!(paths.len(), count);
    for group in GROUPS {
        for (member, companions) in group.members {
            let path = join(group.section, member);
            assert!(find(&path).is_some() || is_table(&path), "{path}");
            for companion in *companions {
                assert!(find(&join(group.section, companion)).is_some(), "{companion}");
            }
        }
    }
}

#[test]
fn a_misplaced_or_mistyped_key_is_told_where_it_belongs() {
    let keys = [
        ("mesh", "row"),
        ("", "contacts"),
        ("mesh", "normal_force"),
        ("disc.prepare", "seed"),
        ("contact", "level"),
        ("output", "title"),
        ("", "normal_forces"),
        ("operation", "operation"),
        ("disc.prepare", "disc"),
        ("contact", "zzz"),
        ("materials.pin_resin", "specific_wear_rate"),
        ("materials.pin_primary", "wear_height"),
    ];
    insta::assert_snapshot!(keys.map(|(table, key)| format!("[{table}] {key}: {}", unknown(table, key))).join("\n"));
}
