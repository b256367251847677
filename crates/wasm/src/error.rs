//! Errors that cross into JavaScript.

use crate::carry;
use boresight_aoa::AoaError;
use boresight_array_calibration::ArrayCalibrationError;
use boresight_core::{Details, Diagnose, InputError};
use boresight_formats::FormatError;
use boresight_image::ImageError;
#[cfg(feature = "drives")]
use boresight_mounting::MountingError;
use boresight_options::At;
use boresight_options::naming::camel_case;
#[cfg(feature = "drives")]
use boresight_options::naming::javascript;
use boresight_pipeline::PipelineError;
use boresight_signal::SignalError;
use boresight_simulate::SimulateError;
use serde::Serialize;
use thiserror::Error;
use wasm_bindgen::JsValue;

/// Maximum number of properties of one object. No function takes an object with nearly as many.
pub const MOST_KEYS: u32 = 65_536;

/// Result of a binding function.
pub type Fallible<T> = Result<T, BindingError>;

/// Why a call from JavaScript failed.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum BindingError {
    /// An argument is wrong in itself.
    #[error(transparent)]
    Argument(#[from] InputError),
    /// The estimators refused.
    #[error(transparent)]
    Aoa(#[from] AoaError),
    /// An array cannot be calibrated.
    #[error(transparent)]
    ArrayCalibration(#[from] ArrayCalibrationError),
    /// The calibration refused.
    #[cfg(feature = "drives")]
    #[error(transparent)]
    Calibrate(MountingError),
    /// A file cannot be read or written.
    #[error(transparent)]
    Format(#[from] FormatError),
    /// An image cannot be made.
    #[error(transparent)]
    Image(#[from] ImageError),
    /// A network cannot be loaded, or refused.
    #[cfg(feature = "neural")]
    #[error(transparent)]
    Neural(#[from] boresight_neural::NeuralError),
    /// The chain from frames to detections refused.
    #[error(transparent)]
    Pipeline(#[from] PipelineError),
    /// A step of signal processing refused.
    #[error(transparent)]
    Signal(#[from] SignalError),
    /// A simulation is impossible.
    #[error(transparent)]
    Simulate(#[from] SimulateError),
    /// A value of the wrong type.
    #[error("{what} is {given}; expected {expected}")]
    Type {
        /// Path of the value in the argument, such as `iaa.iterations`.
        what: String,
        /// The type asked for.
        expected: String,
        /// The value, in words.
        given: String,
    },
    /// A field that has to be there is not.
    #[error("{what} is missing; expected {expected}")]
    Missing {
        /// Path of the field.
        what: String,
        /// Its type.
        expected: String,
    },
    /// A field nobody asked for, most likely a slip of the pen.
    #[error("{what} is not an option; expected one of {expected}")]
    UnknownField {
        /// Path of the field.
        what: String,
        /// The fields there are.
        expected: String,
    },
    /// The data does not fit into the memory of the module.
    #[error("{what} needs {given} bytes; expected what fits into memory")]
    TooLarge {
        /// What was to be stored.
        what: String,
        /// Bytes asked for.
        given: usize,
    },
    /// An object has more properties than any function takes.
    #[error("{what} has {given} properties; expected at most {MOST_KEYS}")]
    TooManyKeys {
        /// The object.
        what: String,
        /// Its number of properties.
        given: u32,
    },
}

#[cfg(feature = "drives")]
impl From<MountingError> for BindingError {
    fn from(error: MountingError) -> Self {
        Self::Calibrate(error.renamed(javascript))
    }
}

impl Diagnose for BindingError {
    fn code(&self) -> &'static str {
        match self {
            Self::Argument(error) => error.code(),
            Self::Aoa(error) => error.code(),
            Self::ArrayCalibration(error) => error.code(),
            #[cfg(feature = "drives")]
            Self::Calibrate(error) => error.code(),
            Self::Format(error) => error.code(),
            Self::Image(error) => error.code(),
            #[cfg(feature = "neural")]
            Self::Neural(error) => error.code(),
            Self::Pipeline(error) => error.code(),
            Self::Signal(error) => error.code(),
            Self::Simulate(error) => error.code(),
            Self::Type { .. } => "wrong-type",
            Self::Missing { .. } => "missing",
            Self::UnknownField { .. } => "unknown-option",
            Self::TooLarge { .. } | Self::TooManyKeys { .. } => "too-large",
        }
    }

    fn details(&self) -> Details {
        match self {
            Self::Argument(error) => error.details(),
            Self::Aoa(error) => error.details(),
            Self::ArrayCalibration(error) => error.details(),
            #[cfg(feature = "drives")]
            Self::Calibrate(error) => error.details(),
            Self::Format(error) => error.details(),
            Self::Image(error) => error.details(),
            #[cfg(feature = "neural")]
            Self::Neural(error) => error.details(),
            Self::Pipeline(error) => error.details(),
            Self::Signal(error) => error.details(),
            Self::Simulate(error) => error.details(),
            Self::Type { what, expected, given } => Details::new(what, expected, given),
            Self::Missing { what, expected } => Details::new(what, expected, "nothing"),
            Self::UnknownField { what, expected } => {
                Details::new(what, expected, "an unknown option")
            }
            Self::TooLarge { what, given } => {
                Details::new(what, "what fits into memory", format!("{given} bytes"))
            }
            Self::TooManyKeys { what, given } => Details::new(
                what,
                format!("at most {MOST_KEYS} properties"),
                format!("{given} properties"),
            ),
        }
    }
}

impl BindingError {
    /// Says where the value was that serde refused, which it does not know itself.
    #[must_use]
    pub fn at(self, at: &At<'_>) -> Self {
        let placed = |what: String| if what.is_empty() { at.path() } else { what };
        match self {
            Self::Argument(InputError::Unknown { what, expected, given }) => {
                InputError::Unknown { what: placed(what), expected, given }.into()
            }
            Self::Type { what, expected, given } => {
                Self::Type { what: placed(what), expected, given }
            }
            Self::Missing { what, expected } if !what.contains(['.', '[']) => {
                let above = at.path();
                let what = if above.is_empty() { what } else { format!("{above}.{what}") };
                Self::Missing { what, expected }
            }
            other => other,
        }
    }
}

/// An error on its way to JavaScript.
#[derive(Serialize)]
struct PlainError {
    code: &'static str,
    message: String,
    what: String,
    expected: String,
    given: String,
}

impl From<BindingError> for JsValue {
    fn from(error: BindingError) -> Self {
        let Details { what, expected, given } = error.details();
        let name = in_camel_case(&what);
        let message = match name.as_str() {
            same if same == what => error.to_string(),
            renamed => error.to_string().replace(&what, renamed),
        };
        let code = error.code();
        carry::write(&PlainError { code, message, what: name, expected, given })
    }
}

/// The JavaScript name of an option (`gridPoints` for `grid_points`); other text stays as it is.
fn in_camel_case(what: &str) -> String {
    let is_name = |c: char| c.is_ascii_lowercase() || c.is_ascii_digit() || "_.[]".contains(c);
    if !what.chars().all(is_name) {
        return what.into();
    }
    camel_case(what)
}

#[cfg(test)]
mod tests {
    use super::in_camel_case;

    #[test]
    fn option_names_are_those_of_javascript() {
        assert_eq!(in_camel_case("nomp.false_alarm"), "nomp.falseAlarm");
        assert_eq!(in_camel_case("array preset"), "array preset");
        assert_eq!(in_camel_case("targets[2].power_db"), "targets[2].powerDb");
    }
}
