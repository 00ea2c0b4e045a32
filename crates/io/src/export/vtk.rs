//! Maps on the cells of ring and pin, as VTK's XML files: structured grids (.vts), one a moment, and a collection (.pvd)
//! that gives them their times.
//!
//! A cell of the grid is a cell of the mesh, in the same order; its four corners are in the plane z = 0, at the radii and
//! angles of the cell's edges. The heights are cell data like everything else. The ring closes: its last corners are its
//! first. Numbers are stored as they are, lowest byte first, behind the XML ("appended", "raw").

use std::io::{self, Write};

use plateau_core::model::mesh::Mesh;
use plateau_core::observe::{Map, MapValues};
use plateau_core::surface::Body;

use super::{ExportError, maps_of, name};
use crate::run_file::RunFile;

/// Writes the maps of a body at the time of that index as a structured grid.
///
/// # Errors
/// [`ExportError`] when a map cannot be read or the output takes no more.
pub fn write_grid(run: &RunFile, body: Body, index: usize, mut out: impl Write) -> Result<(), ExportError> {
    let grid = Grid { mesh: run.mesh(), columns: body.columns(run.mesh()), closed: body == Body::Disc };
    let maps: Vec<Map> = maps_of(run, body).collect();
    let base = if body == Body::Pin { run.pin_base()? } else { None };
    let names = maps.iter().map(|map| (name(*map), map.is_status()));
    let names: Vec<_> = names.chain(base.iter().map(|_| ("base", true))).collect();
    out.write_all(head(&grid, run.map_time()[index], &names).as_bytes())?;
    for map in maps {
        match run.map(map, index)? {
            Some(MapValues::Float(values)) => write_numbers(&mut out, &values)?,
            Some(MapValues::Status(values)) => write_bytes(&mut out, &values)?,
            // It was there a moment ago.
            None => {}
        }
    }
    if let Some(base) = base {
        write_bytes(&mut out, &base)?;
    }
    grid.write_points(&mut out)?;
    out.write_all(b"\n</AppendedData>\n</VTKFile>\n")?;
    Ok(out.flush()?)
}

/// Writes a collection: the files of a grid, each with its time.
///
/// # Errors
/// When the output takes no more.
pub fn write_collection(moments: &[(f64, String)], mut out: impl Write) -> io::Result<()> {
    writeln!(out, "<?xml version=\"1.0\"?>")?;
    writeln!(out, "<VTKFile type=\"Collection\" version=\"1.0\" byte_order=\"LittleEndian\">\n<Collection>")?;
    for (time, file) in moments {
        let file = quick_xml::escape::escape(file);
        writeln!(out, "<DataSet timestep=\"{time:?}\" group=\"\" part=\"0\" file=\"{file}\"/>")?;
    }
    writeln!(out, "</Collection>\n</VTKFile>")?;
    out.flush()
}

/// The corners of a body's cells.
struct Grid<'a> {
    mesh: &'a Mesh,
    columns: usize,
    closed: bool,
}

impl Grid<'_> {
    fn cells(&self) -> u64 {
        self.columns as u64 * self.mesh.rows() as u64
    }

    fn point_bytes(&self) -> u64 {
        (self.columns as u64 + 1) * (self.mesh.rows() as u64 + 1) * 3 * size_of::<f64>() as u64
    }

    fn write_points(&self, out: &mut impl Write) -> io::Result<()> {
        out.write_all(&self.point_bytes().to_le_bytes())?;
        let inner_radius = self.mesh.radius()[0] - 0.5 * self.mesh.row_height();
        let mut bytes = Vec::new();
        for column in 0..=self.columns {
            let column = if self.closed { column % self.columns } else { column };
            let (sine, cosine) = (column as f64 * self.mesh.column_angle()).sin_cos();
            bytes.clear();
            for row in 0..=self.mesh.rows() {
                let radius = inner_radius + row as f64 * self.mesh.row_height();
                bytes.extend([radius * cosine, radius * sine, 0.0].iter().flat_map(|value: &f64| value.to_le_bytes()));
            }
            out.write_all(&bytes)?;
        }
        Ok(())
    }
}

/// The XML before the numbers: what there is, and how far behind the mark `_` each array starts. Cell data that are
/// statuses take one byte, others eight; the points come last.
fn head(grid: &Grid, time: f64, cell_data: &[(&str, bool)]) -> String {
    let (rows, columns) = (grid.mesh.rows(), grid.columns);
    let extent = format!("0 {rows} 0 {columns} 0 0");
    let mut offset = 0;
    let mut arrays = String::new();
    for (name, is_status) in cell_data {
        let (kind, width) = if *is_status { ("UInt8", 1) } else { ("Float64", 8) };
        arrays += &format!("<DataArray type=\"{kind}\" Name=\"{name}\" format=\"appended\" offset=\"{offset}\"/>\n");
        offset += size_of::<u64>() as u64 + width * grid.cells();
    }
    format!(
        "<?xml version=\"1.0\"?>\n\
         <VTKFile type=\"StructuredGrid\" version=\"1.0\" byte_order=\"LittleEndian\" header_type=\"UInt64\">\n\
         <StructuredGrid WholeExtent=\"{extent}\">\n\
         <FieldData>\n\
         <DataArray type=\"Float64\" Name=\"TimeValue\" NumberOfTuples=\"1\" format=\"ascii\">{time:?}</DataArray>\n\
         </FieldData>\n\
         <Piece Extent=\"{extent}\">\n\
         <CellData>\n{arrays}</CellData>\n\
         <Points>\n\
         <DataArray type=\"Float64\" Name=\"Points\" NumberOfComponents=\"3\" format=\"appended\" offset=\"{offset}\"/>\n\
         </Points>\n\
         </Piece>\n\
         </StructuredGrid>\n\
         <AppendedData encoding=\"raw\">\n_"
    )
}

/// An array as it is appended: its bytes counted, then they themselves.
fn write_numbers(out: &mut impl Write, values: &[f64]) -> io::Result<()> {
    out.write_all(&(values.len() as u64 * size_of::<f64>() as u64).to_le_bytes())?;
    super::write_floats(out, values)
}

fn write_bytes(out: &mut impl Write, bytes: &[u8]) -> io::Result<()> {
    out.write_all(&(bytes.len() as u64).to_le_bytes())?;
    out.write_all(bytes)
}
