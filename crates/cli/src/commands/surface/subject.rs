//! One surface with what there is to tell of it.

use std::path::Path;

use plateau_core::model::mesh::Mesh;
use plateau_core::model::state::InitialSurfaces;
use plateau_core::surface::describe::{Description, Grid};
use plateau_core::surface::{Body, Level, Patch, implausible, level};
use plateau_io::surface::{Measured, Patches};

use super::comparison::Comparison;
use super::describe::describe;
use super::figure_data::FigureData;
use super::recorded::{NamedHeights, turn_pin};
use crate::failure::Failure;
use crate::message;

/// A surface that was read or prepared, described.
pub struct Subject {
    /// The file, or the body of the scene.
    pub name: String,
    /// Of a map of a run file what it is: the end of its name.
    pub map: String,
    /// What the file is, or that a scene made it.
    pub origin: String,
    /// Points along x.
    pub columns: usize,
    /// Points along y.
    pub rows: usize,
    /// Distance of the points along x and y, m, if known.
    pub pitch: Option<[f64; 2]>,
    /// The form that was taken out.
    pub level: &'static str,
    /// What the file says of itself, or what the scene did.
    pub notes: Vec<String>,
    /// What is wrong with the file.
    pub warnings: Vec<String>,
    /// Its parameters.
    pub description: Description,
    /// The patch that the scene made it of, if it did of one.
    pub comparison: Option<Comparison>,
}

impl Subject {
    /// The heights of a file, with the form taken out.
    pub fn of_heights(heights: NamedHeights, form: Level, figures: Option<&mut FigureData>) -> Result<Self, Failure> {
        let NamedHeights { name, map, body, measured } = heights;
        let closed = body == Some(Body::Disc);
        let Measured { format, columns, rows, pitch, mut heights, notes, mut warnings, .. } = measured;
        // What a run has made of its surfaces is as it is.
        let is_measured = body.is_none();
        let stand_in = is_measured.then(|| implausible::stand_in(&heights)).flatten();
        level(&mut heights, rows, form, closed);
        let grid = Grid { columns, rows, pitch, heights: &heights };
        let points = heights.len();
        let none = || Failure::input(format!("{name}: none of its {points} points has a height"));
        let description = describe(&name, &grid)?.ok_or_else(none)?;
        // Numbers that stand for no height make odd heights of any unit.
        if is_measured && stand_in.is_none() {
            warnings.extend(implausible::odd_units(&heights, rows, pitch, description.heights.root_mean_square_height));
        }
        warnings.extend(stand_in);
        for warning in &warnings {
            message::warning(format_args!("{name}: {warning}"));
        }
        if let Some(figures) = figures {
            figures.add(&title(&name), body, &grid, &description)?;
        }
        Ok(Self {
            name,
            map,
            origin: format.to_string(),
            columns,
            rows,
            pitch,
            level: level_name(form, closed),
            notes,
            warnings,
            comparison: None,
            description,
        })
    }

    /// The disc and the pin of a scene, peaks positive on both.
    pub fn of_scene(
        scene: &Path,
        mesh: &Mesh,
        surfaces: InitialSurfaces,
        patches: Patches,
        report: &[String],
        form: Level,
        mut figures: Option<&mut FigureData>,
    ) -> Result<[Self; 2], Failure> {
        let mut of_body = |body: Body, name: &str, mut heights: Vec<f64>, patch: Option<Patch>| {
            let closed = body == Body::Disc;
            level(&mut heights, mesh.rows(), form, closed);
            let (columns, rows) = (body.columns(mesh), mesh.rows());
            let pitch = Some([mesh.column_width(), mesh.row_height()]);
            let grid = Grid { columns, rows, pitch, heights: &heights };
            let description = describe(name, &grid)?;
            let description = description.ok_or_else(|| Failure::input("the mesh has no cells"))?;
            // The patch that it was made of comes first.
            let comparison = match patch {
                Some(patch) => Comparison::of(body, name, patch, mesh, form, figures.as_deref_mut())?,
                None => None,
            };
            if let Some(figures) = &mut figures {
                figures.add(name, Some(body), &grid, &description)?;
            }
            let own = |line: &&String| line.starts_with(&format!("{name}."));
            Ok(Self {
                name: name.to_owned(),
                map: String::new(),
                origin: format!("prepared by {}", scene.display()),
                columns,
                rows,
                pitch,
                level: level_name(form, closed),
                notes: report.iter().filter(own).cloned().collect(),
                warnings: Vec::new(),
                comparison,
                description,
            })
        };
        let mut pin_height = surfaces.pin_height;
        turn_pin(&mut pin_height, mesh);
        let disc = of_body(Body::Disc, "disc", surfaces.disc_height, patches.disc)?;
        Ok([disc, of_body(Body::Pin, "pin", pin_height, patches.pin)?])
    }

    /// Points that the grid has.
    pub fn points(&self) -> usize {
        self.columns * self.rows
    }

    /// Fraction of the points that have a height.
    pub fn coverage(&self) -> f64 {
        self.description.measured as f64 / self.points() as f64
    }
}

/// A file by its name, without its folder.
fn title(name: &str) -> String {
    Path::new(name).file_name().map_or(name.to_owned(), |name| name.to_string_lossy().into())
}

/// The form that is taken out of a surface, or of one that closes round the ring.
fn level_name(level: Level, closed: bool) -> &'static str {
    match (level, closed) {
        (Level::None, _) => "nothing",
        (Level::Mean, _) => "mean",
        (Level::Plane, false) => "least-squares plane",
        (Level::Plane, true) => "mean and radial slope",
        (Level::Quadratic, false) => "least-squares quadric",
        (Level::Quadratic, true) => "mean, radial slope and curvature",
    }
}
