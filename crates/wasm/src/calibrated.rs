//! Arrays with what is known of their errors.

use crate::carry::read_named;
use crate::error::{BindingError, Fallible};
use crate::read::{Fields, Read, wrong_type};
use boresight_core::{Array, ArrayCalibration};
use boresight_formats::RadarConfig;
use wasm_bindgen::JsValue;

/// What a calibration may be given as.
const EXPECTED: &str = "an object as calibrateArray gives it, or 'none'";

/// The array and the calibration that options name.
#[derive(Default)]
pub struct ArrayChoice {
    array: Option<Array>,
    calibration: Calibrate,
}

/// By what an array is calibrated.
#[derive(Default)]
enum Calibrate {
    /// What the board's configuration says, where there is one.
    #[default]
    AsConfigured,
    /// Nothing.
    Not,
    /// What was given.
    By(Box<ArrayCalibration>),
}

impl ArrayChoice {
    /// Reads `array` and `calibration`, either of which may be absent.
    pub fn read(fields: &mut Fields) -> Fallible<Self> {
        let array = fields.optional("array")?;
        let calibration = match fields.raw("calibration")? {
            None => Calibrate::AsConfigured,
            Some(value) => read_calibration(&value, &fields.path_of("calibration"))?,
        };
        Ok(Self { array, calibration })
    }

    /// The array, which has to be named.
    ///
    /// # Errors
    /// Where it is not; a calibration of another array.
    pub fn required(self) -> Fallible<Array> {
        let array = self.array.ok_or_else(|| BindingError::Missing {
            what: "array".into(),
            expected: Array::EXPECTED.into(),
        })?;
        match self.calibration {
            Calibrate::By(calibration) => Ok(array.calibrated(&calibration)?),
            Calibrate::AsConfigured | Calibrate::Not => Ok(array),
        }
    }

    /// The array, or else a board's; calibrated as said, or else by the board's configuration.
    ///
    /// # Errors
    /// Where neither array is known; a calibration of another array.
    pub fn or_board(self, board: Option<&Array>, config: &RadarConfig) -> Fallible<Array> {
        let array = self.array.or_else(|| board.cloned()).ok_or_else(|| BindingError::Missing {
            what: "array".into(),
            expected: "an array, since that of the platform is not known".into(),
        })?;
        match self.calibration {
            Calibrate::By(calibration) => Ok(array.calibrated(&calibration)?),
            Calibrate::AsConfigured => Ok(config.compensated(&array)?),
            Calibrate::Not => Ok(array),
        }
    }
}

/// Reads a calibration.
pub fn array_calibration(value: &JsValue, path: &str) -> Fallible<ArrayCalibration> {
    let calibration: ArrayCalibration = read_named(value, path)?;
    calibration.check()?;
    Ok(calibration)
}

fn read_calibration(value: &JsValue, path: &str) -> Fallible<Calibrate> {
    match value.as_string() {
        Some(name) if name == "none" => Ok(Calibrate::Not),
        Some(_) => Err(wrong_type(path, EXPECTED, value)),
        None => Ok(Calibrate::By(Box::new(array_calibration(value, path)?))),
    }
}
