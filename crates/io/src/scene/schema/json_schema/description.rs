//! What an editor shows about a key.

use super::super::key::{Key, Kind, Need};
use super::super::range::Range;
use crate::units::Dimension;

/// Meaning, units, range, and what happens when the key is absent.
pub(super) fn of(key: &Key) -> String {
    let sentences = [Some(key.meaning.to_owned()), units(key.kind), range(key.kind), absent(key)];
    let sentences: Vec<_> = sentences.into_iter().flatten().collect();
    format!("{}.", sentences.join(". "))
}

fn units(kind: Kind) -> Option<String> {
    let dimension = match kind {
        Kind::Quantity { dimension, .. } => dimension,
        Kind::Lengths { .. } | Kind::LengthUnit => Dimension::Length,
        Kind::Times => Dimension::Time,
        _ => return None,
    };
    Some(format!("Units: {}", dimension.units()))
}

fn range(kind: Kind) -> Option<String> {
    let range = match kind {
        Kind::Quantity { range, .. } | Kind::Lengths { range, .. } => range,
        Kind::Number(range) | Kind::NumberOr(range, _) => range,
        _ => return None,
    };
    (range != Range::ANY).then(|| format!("Range: {range}"))
}

fn absent(key: &Key) -> Option<String> {
    match key.need {
        Need::Required => Some("Required".to_owned()),
        Need::RequiredWithout(table) => Some(format!("Required without [{table}]")),
        Need::Default(default) => Some(format!("Default: {default}")),
        Need::SameAs(table) => Some(format!("Default: as in [{table}]")),
        Need::Computed(what) => Some(format!("Default: {}", what.replace('`', ""))),
        Need::RequiredUnless(choose, default) => {
            Some(format!("Required; default with {} = \"{}\": {default}", choose.key, choose.value))
        }
        Need::OneOf => key.group().map(|group| {
            let count = match group.unless {
                Some(table) => format!("Without [{table}] one of"),
                None if group.required => "One of".to_owned(),
                None => "At most one of".to_owned(),
            };
            format!("{count} {}", group.names())
        }),
        Need::OfWay(unless) => {
            let but = unless.map(|choose| format!(", but for {} = \"{}\"", choose.key, choose.value));
            Some(format!("Required with the keys beside which it stands{}", but.unwrap_or_default()))
        }
        Need::Optional if key.may_be_none() => Some("With \"none\" it is not done, as without the key".to_owned()),
        Need::Optional => None,
    }
}
