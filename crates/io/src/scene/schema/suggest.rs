//! What to say about a key that no scene has.

use super::key::{Key, is_below, join};
use super::lookup::{find, is_table, keys};
use crate::text::short;

/// Likeness (0 to 1, strsim's normalised Damerau-Levenshtein) from which a name counts as mistyped.
const LIKE: f64 = 0.6;

/// Keys that one may expect but that have no meaning where they stand: end of the path, why, what to use.
const EXPLAINED: &[(&str, &str)] = &[
    (
        "materials.pin_resin.specific_wear_rate",
        "resin has no specific wear rate, it loses a whole height at once when it touches: give wear_height",
    ),
    ("disc_primary.wear_height", ONLY_RESIN),
    ("disc_secondary.wear_height", ONLY_RESIN),
    ("pin_primary.wear_height", ONLY_RESIN),
    ("pin_secondary.wear_height", ONLY_RESIN),
];
const ONLY_RESIN: &str = "only materials.pin_resin loses a wear height: give specific_wear_rate";

/// Letters of a name that may be mistyped: more than any has. To compare takes time in proportion to them, for each candidate.
const LONGEST: usize = 200;

/// The candidate that is most like `name`, if one is like enough.
pub(crate) fn nearest<'a>(name: &str, candidates: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    if name.len() > LONGEST {
        return None;
    }
    let likeness = |candidate: &str| strsim::normalized_damerau_levenshtein(&name.to_lowercase(), candidate);
    candidates
        .into_iter()
        .map(|candidate| (likeness(candidate), candidate))
        .filter(|(likeness, _)| *likeness >= LIKE)
        .max_by(|a, b| a.0.total_cmp(&b.0))
        .map(|(_, candidate)| candidate)
}

/// What to say about the unknown key `name` in the table `table`.
pub(crate) fn unknown(table: &str, name: &str) -> String {
    let path = join(table, name);
    if let Some((_, why)) = EXPLAINED.iter().find(|(end, _)| path.ends_with(end)) {
        return format!("unknown key: {why}");
    }
    if find(name).is_some() {
        return "unknown key here, it belongs at the top, before the first table".to_owned();
    }
    if table.split('.').any(|part| part == name) {
        return format!("unknown key, keys below [{table}] stand without the name of the table before them");
    }
    let tables = tables().into_iter().filter(|other| known(&join(other, name)));
    if let Some((first, more)) = of_the_same_body(table, tables.collect()).split_first() {
        let more: String = more.iter().map(|table| format!(" or [{table}]")).collect();
        return format!("unknown key here, it belongs in [{first}]{more}");
    }
    let siblings = children(table);
    if let Some(sibling) = nearest(name, siblings.iter().map(String::as_str)) {
        return format!("unknown key, did you mean \"{sibling}\"?");
    }
    let elsewhere = || keys().iter().filter(|key| !key.section.is_empty());
    let like = nearest(name, elsewhere().map(|key| key.name));
    if let Some(key) = elsewhere().find(|key| Some(key.name) == like) {
        return format!("unknown key, did you mean \"{}\" in [{}]?", key.name, key.section);
    }
    let place = if table.is_empty() { "a scene".to_owned() } else { format!("[{}]", short(table)) };
    format!("unknown key, {place} has {}", siblings.join(", "))
}

/// Of several tables those of the same body (disc, pin, ...) as `table`, if there are any.
fn of_the_same_body(table: &str, tables: Vec<String>) -> Vec<String> {
    let body = |table: &str| table.split('.').next().map(str::to_owned);
    let same: Vec<_> = tables.iter().filter(|other| body(other) == body(table)).cloned().collect();
    if same.is_empty() { tables } else { same }
}

fn known(path: &str) -> bool {
    find(path).is_some() || is_table(path)
}

/// Names directly below a table, in the order of docs/scenes.md.
pub(super) fn children(table: &str) -> Vec<String> {
    let mut names: Vec<String> = Vec::new();
    for path in keys().iter().map(Key::path) {
        let rest = if table.is_empty() {
            path.as_str()
        } else if is_below(&path, table) {
            &path[table.len() + 1..]
        } else {
            continue;
        };
        let name = rest.split('.').next().unwrap_or(rest);
        if !names.iter().any(|known| known == name) {
            names.push(name.to_owned());
        }
    }
    names
}

/// Every table below the top, in the order of docs/scenes.md.
fn tables() -> Vec<String> {
    let mut tables: Vec<String> = Vec::new();
    for key in keys() {
        for table in [Some(key.section.to_owned()), key.inline_table()].into_iter().flatten() {
            if !table.is_empty() && !tables.contains(&table) {
                tables.push(table);
            }
        }
    }
    tables
}

#[cfg(test)]
mod tests {
    use super::*;

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
}
