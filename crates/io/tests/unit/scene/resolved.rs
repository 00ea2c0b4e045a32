use super::*;

#[test]
fn a_former_name_is_the_present_one() {
    let differ = |present: &str, former: &str| {
        let [present, former] = [("debris", present), ("debris_pool", former)]
            .map(|(name, value)| format!("[plateaus]\n{name} = \"{value}\"\n"));
        differences(&present, &former.parse().unwrap()).len()
    };
    assert_eq!([differ("track", "track"), differ("contact", "track"), differ("local", "contact")], [0, 1, 1]);
}

#[test]
fn names_every_key_with_both_values() {
    let first = "version = 1\n[mesh]\nrows = 80\n[operation]\nnormal_force = \"47 N\"\nsteps = 9\n";
    let second = "version = 1\n[mesh]\nrows = 80\n[operation]\nnormal_force = \"50 N\"\n[disc.surface]\nflat = true\n";
    let difference = |key: &str, first: Option<&str>, second: Option<&str>| Difference {
        key: key.into(),
        first: first.map(str::to_owned),
        second: second.map(str::to_owned),
    };
    let second: Table = second.parse().unwrap();
    assert_eq!(
        differences(first, &second),
        [
            difference("disc.surface.flat", None, Some("true")),
            difference("operation.normal_force", Some("\"47 N\""), Some("\"50 N\"")),
            difference("operation.steps", Some("9"), None),
        ]
    );
    assert_eq!(differences(&second.to_string(), &second), []);
}
