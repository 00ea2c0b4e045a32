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
    assert_eq!(unknown("mesh", "row"), "unknown key, did you mean \"rows\"?");
    assert_eq!(unknown("", "contacts"), "unknown key, did you mean \"contact\"?");
    assert_eq!(unknown("mesh", "normal_force"), "unknown key here, it belongs in [operation]");
    assert_eq!(unknown("disc.prepare", "seed"), "unknown key here, it belongs in [disc.surface.synthetic]");
    assert_eq!(unknown("contact", "level"), "unknown key here, it belongs in [disc.prepare] or [pin.prepare]");
    assert_eq!(unknown("output", "title"), "unknown key here, it belongs at the top, before the first table");
    assert_eq!(unknown("", "normal_forces"), "unknown key, did you mean \"normal_force\" in [operation]?");
    assert_eq!(
        unknown("operation", "operation"),
        "unknown key, keys below [operation] stand without the name of the table before them"
    );
    assert!(unknown("disc.prepare", "disc").contains("keys below [disc.prepare] stand without the name"));
    assert_eq!(unknown("contact", "zzz"), "unknown key, [contact] has foundation_height, load_tolerance");
    assert!(unknown("materials.pin_resin", "specific_wear_rate").contains("give wear_height"));
    assert!(unknown("materials.pin_primary", "wear_height").contains("give specific_wear_rate"));
}
