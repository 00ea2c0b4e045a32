//! The JSON document from which the scripts of the page draw charts, maps and figures.

use plateau_io::run_file::{ReadError, RunFile};
use plotters::style::RGBColor;
use serde::Serialize;

use super::maps::{PageMap, maps};
use super::pack;
use super::picture::Picture;
use super::reduction::Reduction;
use super::series::Recorded;
use crate::colour::viridis;
use crate::quantity::{STATUS_LOOKS, StatusLook, Unit};

/// All of it.
#[derive(Debug, Serialize)]
pub struct Document {
    /// The runs, in the order of the command line.
    pub runs: Vec<Run>,
    /// Colours of heights and pressures from the lowest to the highest.
    colours: Vec<String>,
    /// Names and colours of the statuses.
    statuses: Vec<StatusName>,
    /// Figures.
    pictures: Vec<PagePicture>,
}

/// A run.
#[derive(Debug, Serialize)]
pub struct Run {
    label: String,
    mesh: PageMesh,
    /// Samples of the run file.
    samples: usize,
    /// Times of those samples that any series has here, s, packed.
    time: String,
    series: Vec<PageSeries>,
    /// Times of maps in the run file.
    map_times: usize,
    /// Its maps; filled in last, with the room that is left.
    pub maps: Vec<PageMap>,
}

#[derive(Debug, Serialize)]
struct PageMesh {
    rows: usize,
    disc_columns: usize,
    pin_columns: usize,
    /// m.
    inner_radius: f64,
    /// m.
    row_height: f64,
    /// Arc length at the mean radius, m.
    column_width: f64,
}

#[derive(Debug, Serialize)]
struct PageSeries {
    name: String,
    label: String,
    unit: Unit,
    /// Where the times of its points are among `time` of the run, packed.
    at: String,
    /// The values, SI, packed.
    values: String,
}

#[derive(Debug, Serialize)]
struct StatusName {
    code: u8,
    name: String,
    colour: String,
}

#[derive(Debug, Serialize)]
struct PagePicture {
    name: String,
    caption: String,
    svg: String,
}

impl Document {
    /// The document without maps.
    pub fn new(runs: &[RunFile], labels: &[String], series: &[Vec<Recorded>], pictures: &[Picture]) -> Self {
        let runs = runs.iter().zip(labels).zip(series);
        let pictures = pictures.iter().map(|picture| PagePicture {
            name: picture.name.clone(),
            caption: picture.caption.clone(),
            svg: pack::text(&picture.svg),
        });
        Self {
            runs: runs.map(|((run, label), series)| Run::new(run, label, series)).collect(),
            colours: (0..=255).map(|index| hexadecimal(viridis(f64::from(index) / 255.0))).collect(),
            statuses: STATUS_LOOKS.iter().map(StatusName::of).collect(),
            pictures: pictures.collect(),
        }
    }

    /// Puts the maps in, reduced until the document takes no more than `size` bytes where that is possible.
    ///
    /// # Errors
    /// [`ReadError::Damaged`].
    pub fn add_maps(&mut self, runs: &[RunFile], size: usize) -> Result<(), ReadError> {
        let budget = size.saturating_sub(self.to_json().len());
        let mut reduction = Reduction::NONE;
        loop {
            for (run, file) in self.runs.iter_mut().zip(runs) {
                run.maps = maps(file, reduction)?;
            }
            let taken: usize = self.runs.iter().flat_map(|run| &run.maps).map(PageMap::size).sum();
            match reduction.stronger(taken, budget) {
                Some(stronger) if taken > budget => reduction = stronger,
                _ => return Ok(()),
            }
        }
    }

    /// The document as text.
    pub fn to_json(&self) -> String {
        // Texts, numbers and lists of them can always be written.
        serde_json::to_string(self).unwrap_or_default()
    }
}

impl Run {
    fn new(file: &RunFile, label: &str, series: &[Recorded]) -> Self {
        let mut used: Vec<usize> = series.iter().flat_map(|series| &series.at).copied().collect();
        used.sort_unstable();
        used.dedup();
        let time: Vec<f64> = used.iter().map(|index| file.time()[*index]).collect();
        let mesh = file.mesh();
        Self {
            label: label.to_owned(),
            mesh: PageMesh {
                rows: mesh.rows(),
                disc_columns: mesh.disc_columns(),
                pin_columns: mesh.pin_columns(),
                inner_radius: mesh.radius().first().map_or(0.0, |first| first - 0.5 * mesh.row_height()),
                row_height: mesh.row_height(),
                column_width: mesh.column_width(),
            },
            samples: file.time().len(),
            time: pack::doubles(&time),
            series: series.iter().map(|series| PageSeries::new(series, &used)).collect(),
            map_times: file.map_time().len(),
            maps: Vec::new(),
        }
    }
}

impl Run {
    /// What the run is called.
    pub fn label(&self) -> &str {
        &self.label
    }

    /// In words, how its maps differ from those of the run file.
    pub fn maps_note(&self) -> String {
        if self.maps.is_empty() {
            return "No maps recorded.".into();
        }
        let times = self.maps.iter().map(|map| map.times.len()).max().unwrap_or(0);
        let left_out =
            if times < self.map_times { format!(" ({times} of {} times)", self.map_times) } else { String::new() };
        let maps: Vec<String> = self.maps.iter().filter(|map| !map.is_status).map(PageMap::step_note).collect();
        let blocks: Vec<String> = [true, false].into_iter().filter_map(|on_disc| self.block_note(on_disc)).collect();
        format!("Maps{left_out} are rounded: {}.{}", maps.join(", "), blocks.concat())
    }

    fn block_note(&self, on_disc: bool) -> Option<String> {
        let map = self.maps.iter().find(|map| map.on_disc == on_disc)?;
        let [columns, rows] = map.block;
        let body = if on_disc { "disc" } else { "pin" };
        (columns * rows > 1).then(|| {
            format!(
                " A pixel of the {body} stands for {columns} by {rows} cells (columns by rows): their mean, or the status of \
                 most of them."
            )
        })
    }
}

impl PageSeries {
    /// `used` are the samples whose times are on the page.
    fn new(series: &Recorded, used: &[usize]) -> Self {
        let at: Vec<usize> = series.at.iter().map(|index| used.partition_point(|used| used < index)).collect();
        Self {
            name: series.name.clone(),
            label: series.long_name.clone(),
            unit: series.unit.clone(),
            at: pack::indices(&at),
            values: pack::singles(series.values.iter().copied()),
        }
    }
}

impl StatusName {
    fn of(look: &StatusLook) -> Self {
        let name = format!("{} ({})", look.name, look.made_of);
        Self { code: look.status as u8, name, colour: hexadecimal(look.colour) }
    }
}

fn hexadecimal(colour: RGBColor) -> String {
    format!("{:02x}{:02x}{:02x}", colour.0, colour.1, colour.2)
}
