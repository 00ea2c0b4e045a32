//! How much memory a run takes.

use plateau_core::observe::Map;
use plateau_core::observe::extra::Extra;
use plateau_core::surface::Body;

use super::{HeightSettings, Scene};

/// Copies of a map that exist at once: one on its way to the writer, one that it writes; and of a field that a series is
/// measured of, that of one worker and that of all.
const COPIES: u128 = 2;

const FLOAT: u128 = size_of::<f64>() as u128;
const STATUS: u128 = size_of::<u8>() as u128;

/// Bytes that a run of the scene keeps in memory at its peak: state and working arrays, and beside them the larger of
/// the surfaces while they are made and the maps on their way to the file.
///
/// Measured surfaces come on top, as large as their files. Surfaces that are extended by statistics count as for a patch of a few
/// rows.
pub fn memory_estimate(scene: &Scene) -> u64 {
    let mesh = &scene.parameters.mesh;
    let counts = [mesh.rows(), mesh.disc_columns(), mesh.pin_columns()].map(|count| count as u64);
    let run = estimate(counts, &scene.output.maps, &scene.output.extras, scene.adaptive.is_some());
    // One body after the other, before there is a simulation.
    let extended = |settings: &HeightSettings, body: Body| {
        settings.preparation.extend.map_or(0, |_| field(body.columns(mesh), mesh.rows(), body == Body::Disc))
    };
    run.max(extended(&scene.disc_surface, Body::Disc)).max(extended(&scene.pin_surface, Body::Pin))
}

/// Bytes of the field from which heights of a body are taken that are extended by statistics: a complex number, an
/// autocorrelation, its power and a height for every cell of the padded grid.
fn field(columns: usize, rows: usize, closed: bool) -> u64 {
    let padded = |cells: usize| (cells + 1).next_power_of_two() as u64;
    let columns = if closed { columns as u64 } else { padded(columns) };
    columns.saturating_mul(padded(rows)).saturating_mul(5 * FLOAT as u64)
}

/// As [`memory_estimate`], for a mesh of `rows`, `disc_columns` and `pin_columns` that need not exist; saturates.
pub(super) fn estimate(
    [rows, disc_columns, pin_columns]: [u64; 3],
    maps: &[Map],
    extras: &[&Extra],
    chooses_acceleration: bool,
) -> u64 {
    let cells = |columns: u64| u128::from(rows) * u128::from(columns);
    let (disc, pin) = (cells(disc_columns), cells(pin_columns));
    let sum = |parts: &[(u128, u128)]| {
        parts.iter().fold(0_u128, |sum, (count, bytes)| sum.saturating_add(count.saturating_mul(*bytes)))
    };
    // A run that chooses its acceleration has a scout with a state of its own.
    let simulations = if chooses_acceleration { 2 } else { 1 };
    // Height and substrate of both, the pin's base, two working arrays over the pin, radius and area of every row.
    let state = sum(&[(disc, 2 * FLOAT), (pin, 4 * FLOAT + STATUS), (rows.into(), 2 * FLOAT)]);
    let surfaces = sum(&[(disc, 2 * FLOAT), (pin, 2 * (FLOAT + STATUS))]);
    let size = |map: &Map| {
        let bytes = if map.is_status() { STATUS } else { FLOAT };
        (if map.on_disc() { disc } else { pin }, COPIES * bytes)
    };
    let gathered = extras.iter().filter_map(|extra| extra.request.as_ref()).flat_map(|request| request.maps);
    let output = sum(&maps.iter().chain(gathered).map(size).collect::<Vec<_>>());
    u64::try_from(state.saturating_mul(simulations).saturating_add(surfaces.max(output))).unwrap_or(u64::MAX)
}

#[cfg(test)]
mod tests {
    use plateau_core::observe::EXTRAS;

    use super::*;

    #[test]
    fn counts_every_array() {
        // By hand, 2 rows, 10 disc and 3 pin columns (20 and 6 cells): state 20·16 + 6·(32 + 1) + 2·16 = 550,
        // surfaces 20·16 + 6·18 = 428; maps: two snapshots of disc height and pin status 2·(20·8 + 6) = 332.
        let (maps, none) = ([Map::DiscHeight, Map::PinStatus], []);
        assert_eq!(estimate([2, 10, 3], &maps, &none, false), 550 + 428);
        // All seven: disc 20·17, pin 6·(17 + 8), twice.
        assert_eq!(estimate([2, 10, 3], &Map::CHOICES, &none, false), 550 + 2 * (20 * 17 + 6 * 25));
        // With the heights of both and the pressure, and the pressure and temperature of the contact, own and gathered.
        assert_eq!(
            estimate([2, 10, 3], &Map::CHOICES, EXTRAS, false),
            550 + 2 * (20 * 17 + 6 * 25) + 16 * (20 + 6 + 6 + 6 + 6)
        );
        assert_eq!(estimate([u64::MAX; 3], &maps, EXTRAS, true), u64::MAX);
    }

    #[test]
    fn a_field_is_larger_than_its_body() {
        // By hand: 800 rows are padded to 1024; the ring closes, the pin's 100 columns are padded to 128.
        assert_eq!(field(13_800, 800, true), 13_800 * 1024 * 40);
        assert_eq!(field(100, 800, false), 128 * 1024 * 40);
    }
}
