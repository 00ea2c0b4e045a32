use std::f64::consts::TAU;
use plateau_core::mesh::Mesh;
use plateau_core::surface::{Body, HeightSynthesis};
use sha2::{Digest, Sha256};
fn digest(heights: &[f64]) -> String {
    let mut digest = Sha256::new();
    heights.iter().for_each(|height| digest.update(height.to_le_bytes()));
    digest.finalize().iter().map(|byte| format!("{byte:02x}")).collect()
}
#[test]
fn bits() {
    let half = 0.5 * 24.0 * TAU / 100.0 * 0.8;
    let mesh = Mesh::new(24, 100, 30, 1.0 - half, 1.0 + half).unwrap();
    for (body, patch) in [(Body::Disc, None), (Body::Pin, None), (Body::Disc, Some(0.7))] {
        let recipe = HeightSynthesis { seed: 7, rms_height: 3e-6, correlation_length: 0.2, patch };
        println!("{body:?} {patch:?} {}", digest(&recipe.field(body, &mesh).unwrap()));
    }
}
