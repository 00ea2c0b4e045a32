//! Synthetic heights are the same, bit for bit, on every machine and in every version.
//!
//! The digests are those of this program's own output, so they say nothing about whether the heights are right (that is
//! for the other tests of synthesis), only that they are the same everywhere.

use std::f64::consts::TAU;

use plateau_core::model::mesh::Mesh;
use plateau_core::surface::{Body, HeightSynthesis, Texture};
use sha2::{Digest, Sha256};

pub(crate) fn digest(heights: &[f64]) -> String {
    let mut digest = Sha256::new();
    heights.iter().for_each(|height| digest.update(height.to_le_bytes()));
    digest.finalize().iter().map(|byte| format!("{byte:02x}")).collect()
}

#[test]
fn the_bits_of_small_fields_are_known() {
    let half = 0.5 * 24.0 * TAU / 100.0 * 0.8;
    let mesh = Mesh::new(24, 100, 30, 1.0 - half, 1.0 + half).unwrap();
    let plain = HeightSynthesis::gaussian(7, 3e-6, 0.2);
    let lay = Texture::Correlation { along: 0.5, across: 0.1 };
    let power_law = Texture::PowerLaw { hurst: 0.8, roll_off: 1.0, short_cutoff: Some(0.2) };
    for (body, settings, expected) in [
        (Body::Disc, plain, "05aaaf736d28e9f31ce743f85b887fc6298a59c6f47e969ee062d6eea9d94228"),
        (Body::Pin, plain, "8cde53f8589b81e597271c16e2ef596fc594125a574e0bbcd8a2eb98e48c7588"),
        (
            Body::Disc,
            HeightSynthesis { patch: Some(0.7), ..plain },
            "1f24d189ccdf33281b59b126b7c682ad53171daa296574abe4b538c33fd3909b",
        ),
        (
            Body::Pin,
            HeightSynthesis { texture: lay, ..plain },
            "49956995344a67078bd8ef7f94e32fb6a4f97d7f1579a727c08157420f392f71",
        ),
        (
            Body::Disc,
            HeightSynthesis { texture: power_law, ..plain },
            "ca2bf4626eb5f49b428c0012408ecb322cfaee37283418828bbef6344d00e9c5",
        ),
        (
            Body::Disc,
            HeightSynthesis { skewness: -1.0, kurtosis: 5.0, ..plain },
            "1c8707440294c0043b7b57ae36ca230e52393ebe1be832f5ac16734aa2eaf6b6",
        ),
        (
            Body::Pin,
            HeightSynthesis { skewness: 0.5, kurtosis: 2.0, ..plain },
            "42c77c2efe0a44caaef892878651aa9f64afc17ae5818e937d2927e1fa8febf2",
        ),
        (
            Body::Disc,
            HeightSynthesis { texture: power_law, kurtosis: 6.0, patch: Some(1.5), ..plain },
            "0965d21fb7a3c164fb983db078a36e29bce2a1a74a2fe97aa5c3287649719377",
        ),
    ] {
        let found = digest(&settings.field(body, &mesh).unwrap());
        assert_eq!(found, expected, "{body:?} {settings:?}");
    }
}
