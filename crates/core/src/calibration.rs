//! What is known of how a real array departs from its plan.

use crate::array::{Array, Channel, Position};
use boresight_math::decibels::db_to_amplitude;
use boresight_math::error::{InputError, check_finite};
use boresight_math::phasor::cis;
use boresight_options::{Described, Naming, check};
use num_complex::Complex64;
use serde::{Deserialize, Serialize};

/// Positions of two arrays that differ by less than this are the same, half wavelengths.
const SAME_PLAN: f64 = 1e-6;

/// Errors of an array's channels, and how well they are known. The response to a plane wave is
/// `C diag(g exp(j phi)) a(p + d)`: gain `g`, phase `phi` and displacement `d` of each channel, and
/// coupling `C`. [`Array::calibrated`] takes them off snapshots.
#[derive(Debug, Clone, PartialEq, Default, Described, Serialize, Deserialize)]
#[serde(default)]
pub struct ArrayCalibration {
    /// Transmitters as planned, half wavelengths: x forward, y left, z up.
    #[option(required)]
    pub tx: Vec<Position>,
    /// Receivers as planned, half wavelengths.
    #[option(required)]
    pub rx: Vec<Position>,
    /// One a pair of transmitter and receiver, all receivers of a transmitter after each other.
    #[option(required)]
    pub channels: Vec<ChannelCalibration>,
    /// Mutual coupling, channels x channels of [re, im]; none where absent.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub coupling: Option<Vec<Vec<Complex64>>>,
    /// What measured ranges are too long by.
    #[option(range = -1000..=1000)]
    pub range_bias_m: f64,
    /// Standard deviation of that; absent where it was not measured.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub range_bias_std_m: Option<f64>,
    /// How it was found.
    pub method: CalibrationMethod,
    /// What these data do not determine; there it stays with the plan.
    pub not_identifiable: Vec<NotIdentifiable>,
    /// Cells it was made from.
    pub cells: usize,
    /// Cells that were left out, since they do not hold one plane wave.
    pub cells_left_out: usize,
    /// Frames it was made from.
    pub frames: usize,
    /// Power that is left of a single target's response once it is fitted, over that of the response.
    /// Estimators that are given it as their mismatch do not take the rest for targets.
    #[option(range = -300..=300)]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub residual_db: Option<f64>,
    /// Root mean square of what is left of the phase in each channel and cell.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub residual_phase_rad: Option<f64>,
    /// Root mean square of what is left of the gain.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub residual_gain_db: Option<f64>,
}

/// What is known of one channel.
#[derive(Debug, Clone, Copy, PartialEq, Default, Described, Serialize, Deserialize)]
#[serde(default)]
pub struct ChannelCalibration {
    /// Its gain over that of the plan.
    #[option(range = -100..=100)]
    pub gain_db: f64,
    /// Its phase over that of the plan.
    #[option(range = -3600..=3600)]
    pub phase_rad: f64,
    /// Standard deviation of the gain; absent where it is not known.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub gain_std_db: Option<f64>,
    /// Standard deviation of the phase; absent where it is not known.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub phase_std_rad: Option<f64>,
    /// Displacement, half wavelengths: x forward, y left, z up; none where absent.
    #[option(range = -1000..=1000)]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub displacement: Option<Position>,
    /// Standard deviation of each coordinate of it, half wavelengths.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub displacement_std: Option<Position>,
}

/// How a calibration was found.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Described, Serialize, Deserialize)]
#[option(name = "ArrayCalibrationMethod")]
#[serde(rename_all = "kebab-case")]
pub enum CalibrationMethod {
    /// It was given by hand.
    #[default]
    Given,
    /// From targets at known directions, such as corner reflectors.
    Reflector,
    /// From strong cells with one target each at an unknown direction.
    SelfCalibration,
    /// From a table of measured steering vectors.
    SteeringTable,
    /// From the coefficients in a board's configuration.
    BoardConfiguration,
}

/// What data may not determine.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Described, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum NotIdentifiable {
    /// A gain common to all channels; it counts as power of the targets.
    CommonGain,
    /// A phase common to all channels; it counts as phase of the targets.
    CommonPhase,
    /// A phase that rises linearly over the array: it turns all directions alike.
    Direction,
    /// Displacements that a target's phase or the phases of the channels make up for.
    Displacement,
    /// Coupling between channels.
    Coupling,
    /// What ranges are too long by.
    RangeBias,
}

impl ArrayCalibration {
    /// A calibration that changes nothing, for all channels of `array`.
    pub fn neutral(array: &Array) -> Self {
        let channels = array.tx().len() * array.rx().len();
        Self {
            tx: array.tx().to_vec(),
            rx: array.rx().to_vec(),
            channels: vec![ChannelCalibration::default(); channels],
            ..Self::default()
        }
    }

    /// Checks lengths and ranges.
    ///
    /// # Errors
    /// [`InputError`] naming the field.
    pub fn check(&self) -> Result<(), InputError> {
        self.check_named(Naming::Rust)
    }

    /// As [`ArrayCalibration::check`], in the names of `naming`.
    ///
    /// # Errors
    /// [`InputError`] naming the field.
    pub fn check_named(&self, naming: Naming) -> Result<(), InputError> {
        let count = Array::mimo(&self.tx, &self.rx)?.len();
        let wrong = |what: &str, expected: String, given: Vec<usize>| {
            Err(InputError::Shape { what: what.into(), expected, given })
        };
        if self.channels.len() != count {
            let expected = format!("[{count}], one a transmitter and receiver");
            return wrong("channels", expected, vec![self.channels.len()]);
        }
        if let Some(coupling) = &self.coupling {
            if let Some(row) = coupling.iter().find(|row| row.len() != count) {
                return wrong(
                    "coupling",
                    format!("[{count}, {count}]"),
                    vec![coupling.len(), row.len()],
                );
            }
            if coupling.len() != count {
                return wrong(
                    "coupling",
                    format!("[{count}, {count}]"),
                    vec![coupling.len(), count],
                );
            }
            check_finite("coupling", coupling.iter().flatten().flat_map(|z| [z.re, z.im]))?;
        }
        check(self, naming)
    }

    /// What a plane wave's response in each channel is multiplied by, coupling aside.
    pub fn factors(&self) -> Vec<Complex64> {
        let factor = |c: &ChannelCalibration| cis(c.phase_rad) * db_to_amplitude(c.gain_db);
        self.channels.iter().map(factor).collect()
    }

    /// Whether it changes nothing.
    pub fn is_neutral(&self) -> bool {
        let still = |c: &ChannelCalibration| {
            c.gain_db == 0.0 && c.phase_rad == 0.0 && c.displacement.is_none_or(|d| d == [0.0; 3])
        };
        self.channels.iter().all(still) && self.coupling.is_none() && self.range_bias_m == 0.0
    }

    /// Refuses an array of another plan than this was made for.
    ///
    /// # Errors
    /// [`InputError::OtherArray`].
    pub fn check_plan(&self, array: &Array) -> Result<(), InputError> {
        if same_plan(&self.tx, array.tx()) && same_plan(&self.rx, array.rx()) {
            return Ok(());
        }
        let said = |tx: &[Position], rx: &[Position]| {
            let channels = [tx.len(), rx.len()];
            let at = tx.iter().chain(rx).find(|p| **p != [0.0; 3]).copied().unwrap_or_default();
            format!("{} transmitters x {} receivers, one at {at:?}", channels[0], channels[1])
        };
        Err(InputError::OtherArray {
            expected: said(&self.tx, &self.rx),
            given: said(array.tx(), array.rx()),
        })
    }

    /// Displacement of a channel, half wavelengths.
    pub(crate) fn displacement(&self, channel: Channel) -> Position {
        let at = channel.tx * self.rx.len() + channel.rx;
        self.channels.get(at).and_then(|c| c.displacement).unwrap_or_default()
    }
}

fn same_plan(a: &[Position], b: &[Position]) -> bool {
    let near = |p: &Position, q: &Position| p.iter().zip(q).all(|(x, y)| (x - y).abs() < SAME_PLAN);
    a.len() == b.len() && a.iter().zip(b).all(|(p, q)| near(p, q))
}
