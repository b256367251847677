//! Tables of measured steering vectors as an array's calibration.

use crate::cells::Cell;
use crate::error::ArrayCalibrationError;
use crate::options::{CalibrationModel, CalibrationOptions};
use crate::result::CalibrationResult;
use crate::self_calibration::calibrate;
use boresight_core::{Array, CalibrationMethod, Complex64, Direction, InputError};
use boresight_options::Described;
use ndarray::Array2;
use serde::{Deserialize, Serialize};

/// Most numbers of a table.
const MOST_NUMBERS: usize = 1 << 22;

/// Power of noise that a table's responses are taken to have, over theirs.
const NOISE: f64 = 1e-6;

/// Responses of all channels, measured at known directions, each but for a factor of its own.
#[derive(Debug, Clone, PartialEq, Default, Described, Serialize, Deserialize)]
#[serde(default)]
pub struct SteeringTable {
    /// Azimuth of each response, positive to the left.
    #[option(range = -90..=90, required)]
    pub azimuth_rad: Vec<f64>,
    /// Elevation of each, positive upwards; 0 where absent.
    #[option(range = -90..=90)]
    pub elevation_rad: Vec<f64>,
    /// Directions x channels of [re, im], all receivers of a transmitter after each other.
    #[option(required)]
    pub responses: Vec<Vec<Complex64>>,
}

impl SteeringTable {
    /// The calibration that turns the plan's responses into those of the table best: gain and phase of each channel, and
    /// coupling where the table has as many directions as channels. What it does not follow is in `residual_db`.
    ///
    /// # Errors
    /// As [`calibrate`]; [`InputError::Shape`] for responses of other channels than the array has.
    pub fn calibrate(&self, array: &Array) -> Result<CalibrationResult, ArrayCalibrationError> {
        let cells = self.cells(array)?;
        let options = CalibrationOptions {
            model: if cells.len() >= array.tx().len() * array.rx().len() {
                CalibrationModel::Coupling
            } else {
                CalibrationModel::Channels
            },
            // What a table holds is meant, however far it is from the plan.
            max_residual_db: 0.0,
            max_cells: cells.len().clamp(1, 4096),
            ..CalibrationOptions::default()
        };
        let mut result = calibrate(array, &cells, &options)?;
        result.calibration.method = CalibrationMethod::SteeringTable;
        Ok(result)
    }

    fn cells(&self, array: &Array) -> Result<Vec<Cell>, ArrayCalibrationError> {
        let channels = array.tx().len() * array.rx().len();
        let count = self.responses.len();
        let wrong = |what: &str, expected: String, given: Vec<usize>| {
            ArrayCalibrationError::from(InputError::Shape { what: what.into(), expected, given })
        };
        if count.saturating_mul(channels) > MOST_NUMBERS {
            return Err(wrong(
                "responses",
                format!("at most {MOST_NUMBERS} numbers"),
                vec![count, channels],
            ));
        }
        if self.azimuth_rad.len() != count {
            return Err(wrong("azimuth_rad", format!("[{count}]"), vec![self.azimuth_rad.len()]));
        }
        if ![0, count].contains(&self.elevation_rad.len()) {
            return Err(wrong(
                "elevation_rad",
                format!("[{count}]"),
                vec![self.elevation_rad.len()],
            ));
        }
        let cell = |index: usize| {
            let response = &self.responses[index];
            if response.len() != channels {
                return Err(wrong(
                    "responses",
                    format!("[{count}, {channels}]"),
                    vec![count, response.len()],
                ));
            }
            let column = Array2::from_shape_fn((channels, 1), |(k, _)| response[k]);
            let power = response.iter().map(Complex64::norm_sqr).sum::<f64>() / channels as f64;
            let elevation_rad = self.elevation_rad.get(index).copied().unwrap_or_default();
            let direction = Direction::new(self.azimuth_rad[index], elevation_rad);
            direction.check()?;
            Ok(Cell::of(column.view(), NOISE * power)?.at(direction))
        };
        (0..count).map(cell).collect()
    }
}
