//! Heat, interval by interval, and the factors that hold for the next one (model 11, order).

use serde::{Deserialize, Serialize};

use super::chain::{Chain, ChainReport, ChainState, Link, sub_steps};
use super::passing::Passing;
use crate::model::cycle::{Kind, Pause};
use crate::model::mesh::Mesh;
use crate::model::parameters::Parameters;
use crate::model::thermal::Thermal;

/// Thermal model of a scene, made once.
#[derive(Debug, Clone, PartialEq)]
pub struct HeatModel {
    thermal: Thermal,
    chain: Chain,
    passing: Passing,
    /// Columns of the pin.
    columns: usize,
    /// Areas of the pin's cells by their place in their row, m², where the pin is no rectangle; else empty.
    chords: Vec<f64>,
    /// Δθ, rad.
    column_angle: f64,
    /// ΣA of the pin's mesh, m².
    area: f64,
}

impl HeatModel {
    /// Thermal model of a scene, if heat is reckoned.
    pub fn of(parameters: &Parameters) -> Option<Self> {
        let thermal = parameters.thermal.as_deref()?;
        let mesh = &parameters.mesh;
        Some(Self {
            thermal: thermal.clone(),
            chain: Chain::new(thermal),
            passing: Passing::of(&thermal.disc),
            columns: mesh.pin_columns(),
            chords: chords(mesh),
            column_angle: mesh.column_angle(),
            area: mesh.pin_area(),
        })
    }

    /// R, K/W, at a speed (rad/s).
    fn resistance(&self, speed: f64) -> f64 {
        if self.chords.is_empty() {
            return self.passing.resistance(self.columns, self.column_angle, self.area, speed);
        }
        self.passing.resistance_of_chords(&self.chords, self.column_angle, speed)
    }

    /// Response of the surface of the disc to a flux.
    pub fn passing(&self) -> &Passing {
        &self.passing
    }
}

/// Areas of the cells of a pin that are the first, second, … of their row, m²; none for a rectangle.
fn chords(mesh: &Mesh) -> Vec<f64> {
    let longest =
        if mesh.is_rectangle() { 0 } else { (0..mesh.rows()).map(|row| mesh.chord(row).len()).max().unwrap_or(0) };
    let area =
        |place: usize| (0..mesh.rows()).filter(|row| mesh.chord(*row).len() > place).map(|row| mesh.area()[row]).sum();
    (0..longest).map(area).collect()
}

/// The steps of an interval that has not ended.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
struct Interval {
    steps: u64,
    /// Friction work, J.
    work: f64,
    /// Time with load and speed, s.
    time: f64,
    /// Δψ, rad.
    angle: f64,
}

/// Factors that hold for the coming steps.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Factors {
    /// f_μ.
    pub friction: f64,
    /// f_κ.
    pub wear_rate: f64,
}

/// Temperatures and the heat of the steps so far.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct HeatAccount {
    state: ChainState,
    open: Interval,
    factors: Factors,
    /// R at the last interval's speed, K/W, and the part of its power that went into the disc.
    resistance: f64,
    share: f64,
    /// θ of the contact when the event began, K.
    start: f64,
    /// The largest θ of the contact at the end of an interval since then, K; none before the first.
    peak: Option<f64>,
}

/// Heat as it is reported. Temperatures in K.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct HeatReport {
    /// T_c; no number while the pin is lifted.
    pub contact: f64,
    /// Mean of the disc's layers.
    pub disc: f64,
    /// Mean of the pin's layers.
    pub pin: f64,
    /// T_f of the disc's face under the pin; no number while the pin is lifted.
    pub face: f64,
    /// χ: part of the power that goes into the disc; 0 before the first interval has ended, and in a pause.
    pub share: f64,
    /// Heat lost to the air and the holder, J.
    pub lost: f64,
    /// (gained − lost − stored)/gained.
    pub residual: f64,
    /// T_c when the event began; the temperature at which a lifted contact closes.
    pub event_start: f64,
    /// Largest T_c of the event; no number before its first interval has ended.
    pub event_peak: f64,
}

impl HeatAccount {
    /// Account with all at ambient temperature.
    pub fn new(model: &HeatModel) -> Self {
        Self {
            state: ChainState::at_rest(),
            open: Interval::default(),
            factors: model.factors_at(0.0),
            resistance: 0.0,
            share: 0.0,
            start: 0.0,
            peak: None,
        }
    }

    /// Factors that hold for the coming steps.
    pub fn factors(&self) -> Factors {
        self.factors
    }

    /// Adds a step with this friction work (J) in a time (s) with load and speed over an angle (rad).
    pub fn collect(&mut self, work: f64, time: f64, angle: f64) {
        let open = &mut self.open;
        *open = Interval {
            steps: open.steps + 1,
            work: open.work + work,
            time: open.time + time,
            angle: open.angle + angle,
        };
    }

    /// Steps of the interval that has not ended.
    pub fn steps(&self) -> u64 {
        self.open.steps
    }

    /// Ends the interval: the chain takes its mean power over its time. Returns T_c, K.
    pub fn end_interval(&mut self, model: &HeatModel) -> f64 {
        let Interval { work, time, angle, .. } = std::mem::take(&mut self.open);
        let (power, speed) = (work / time, angle / time);
        self.resistance = model.resistance(speed);
        let count = sub_steps(time);
        let link = Link::Closed(self.resistance);
        model.chain.advance(&mut self.state, count, time / count as f64, power, speed, link);
        self.share = if power > 0.0 { self.state.into_disc / power } else { 0.0 };
        let contact = self.state.contact.unwrap_or(f64::NAN);
        self.peak = Some(self.peak.map_or(contact, |peak| peak.max(contact)));
        model.thermal.ambient + contact
    }

    /// Takes the sub-steps of a pause that have ended until a time (s); tells whether that is all of them.
    pub fn pause(&mut self, model: &HeatModel, pause: &Pause, until: f64) -> bool {
        let (length, elapsed) = (pause.length, until - pause.start);
        let count = sub_steps(length);
        // Rounding of the times must not hide a sub-step that ends with `until`; late in a run, they are rounded by
        // more.
        let slack = 1e-9_f64.max(4.0 * f64::EPSILON * (pause.end / length) * count as f64);
        let part = if elapsed >= length { 1.0 } else { (elapsed / length).max(0.0) };
        let ended = ((part * count as f64 + slack).floor() as u64).min(count);
        if ended > 0 {
            self.resistance = model.resistance(0.0);
            let link = if pause.kind == Kind::Lifted { Link::Open } else { Link::Closed(self.resistance) };
            model.chain.advance(&mut self.state, ended, length / count as f64, 0.0, pause.speed, link);
            self.share = 0.0;
        }
        ended == count
    }

    /// Reads the factors at T_c; a lifted contact leaves them as they are.
    pub fn read_factors(&mut self, model: &HeatModel) {
        if let Some(contact) = self.state.contact {
            self.factors = model.factors_at(contact);
        }
    }

    /// Begins an event, after a pause.
    pub fn begin_event(&mut self, model: &HeatModel) {
        self.start = self.state.contact.unwrap_or_else(|| model.chain.closing(&self.state, model.resistance(0.0)));
        self.peak = None;
    }

    /// Reports temperatures and heat as they are now.
    pub fn report(&self, model: &HeatModel) -> HeatReport {
        let ambient = model.thermal.ambient;
        let ChainReport { disc, pin, lost, residual } = model.chain.report(&self.state);
        let contact = self.state.contact.unwrap_or(f64::NAN);
        HeatReport {
            contact: ambient + contact,
            disc: ambient + disc,
            pin: ambient + pin,
            face: ambient + (contact - self.state.into_disc * self.resistance),
            share: self.share,
            lost,
            residual,
            event_start: ambient + self.start,
            event_peak: self.peak.map_or(f64::NAN, |peak| ambient + peak),
        }
    }
}

impl HeatModel {
    /// The factors at an excess of T_c over the ambient, K.
    fn factors_at(&self, contact: f64) -> Factors {
        let temperature = self.thermal.ambient + contact;
        Factors {
            friction: self.thermal.friction_factor.at(temperature),
            wear_rate: self.thermal.wear_rate_factor.at(temperature),
        }
    }
}
