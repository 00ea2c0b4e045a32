//! What each table of a scene is for.

/// Path of every table and what it is for; the first is the top of a scene.
const TABLES: &[(&str, &str)] = &[
    ("", "a simulation of a pin on a coated disc"),
    ("mesh", "the ring that the pin slides on, and its cells"),
    ("operation", "load, speed and how long"),
    ("operation.cycle", "load and speed that change with time, see docs/cycles.md"),
    ("contact", "the elastic foundation that carries the load"),
    ("materials", "stiffness and wear of what touches"),
    ("materials.disc_primary", "the disc's coating"),
    ("materials.disc_secondary", "compacted debris on the disc"),
    ("materials.pin_primary", "the pin's fibres"),
    ("materials.pin_secondary", "compacted debris on the pin"),
    ("materials.pin_resin", "the pin between its fibres"),
    ("plateaus", "how wear debris becomes secondary plateaus"),
    ("friction", "friction of what touches, see docs/friction-heat.md; without this table there is no friction"),
    ("friction.secondary", "where compacted debris has another friction"),
    ("friction.resin", "where resin has another friction"),
    ("thermal", "heat of friction and what it changes; needs [friction]"),
    ("thermal.disc", "the disc below its coating, and how it is cooled"),
    ("thermal.disc.coating", "the disc's coating, as heat sees it"),
    ("thermal.pin", "the pin as heat sees it"),
    ("emission", "how much of the debris that leaves the contact is airborne"),
    ("disc", "the disc's initial surface"),
    ("disc.surface", "where the disc's initial heights come from"),
    ("disc.surface.synthetic", "random heights with given statistics"),
    ("disc.prepare", "what is done to the disc's heights, in this order"),
    ("disc.prepare.crop", "the part of the heights that is kept"),
    ("disc.prepare.unroll", "makes arc length and radius of a sector of a ring that was measured in x and y"),
    ("pin", "the pin's fibres and initial surface"),
    ("pin.base", "where the pin has fibre and where resin"),
    ("pin.base.synthetic", "random fibres with given statistics"),
    ("pin.surface", "where the pin's initial heights come from; they grow away from the disc"),
    ("pin.surface.synthetic", "random heights with given statistics"),
    ("pin.prepare", "what is done to the pin's heights, in this order"),
    ("pin.prepare.crop", "the part of the heights that is kept"),
    ("pin.prepare.unroll", "makes arc length and radius of a sector of a ring that was measured in x and y"),
    ("numerics", "how time is stepped, and on how many cores"),
    ("numerics.time_acceleration", "acceleration that the run chooses itself, see docs/accuracy.md"),
    ("output", "the run file and what is written to it"),
];

/// What a table is for, in one line; `None` if no scene has it.
pub fn table_meaning(path: &str) -> Option<&'static str> {
    TABLES.iter().find(|(known, _)| *known == path).map(|(_, meaning)| *meaning)
}

#[cfg(test)]
mod tests {
    use super::super::key::Key;
    use super::super::lookup::{is_table, keys};
    use super::*;

    #[test]
    fn every_table_of_the_keys_is_explained_and_no_other() {
        for path in keys().iter().map(Key::path) {
            for (end, _) in path.match_indices('.') {
                assert!(table_meaning(&path[..end]).is_some(), "{}", &path[..end]);
            }
        }
        for (path, _) in TABLES {
            assert!(is_table(path), "{path}");
        }
    }
}
