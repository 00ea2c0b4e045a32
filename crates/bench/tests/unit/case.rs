use super::*;

/// Table 2 of the paper.
const PAPER: MeshSize = MeshSize { rows: 80, pin_columns: 161, disc_columns: 2764 };

#[test]
fn a_larger_mesh_has_cells_pressure_and_speed_of_the_scene() {
    let scene = Source::new(None, Vec::new(), 0.0);
    let paper = scene.parameters().unwrap();
    assert_eq!(mesh_size(&paper), PAPER);
    for size in [PAPER.times(4), PAPER.longer(3), MeshSize::FULL_PAD, MeshSize::QUICK] {
        let scaled = scene.on(size).unwrap().parameters().unwrap();
        assert_eq!(mesh_size(&scaled), size);
        let pairs = [
            (paper.mesh.row_height(), scaled.mesh.row_height()),
            (paper.mesh.column_width(), scaled.mesh.column_width()),
            (paper.normal_force / paper.mesh.pin_area(), scaled.normal_force / scaled.mesh.pin_area()),
            (paper.angular_velocity * paper.mesh.mean_radius(), scaled.angular_velocity * scaled.mesh.mean_radius()),
        ];
        for (paper, scaled) in pairs {
            // A dozen roundings of 1.1e-16 each; the width is a difference of radii up to 50 times as large.
            assert!((scaled / paper - 1.0).abs() < 1e-13, "{size}: {scaled} for {paper}");
        }
    }
}
