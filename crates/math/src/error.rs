//! Errors: what was wrong, what was expected and what was given.

use thiserror::Error;

/// The parts of an error a program can act on or a page can lay out.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Details {
    /// The argument, field, file part or quantity that was wrong.
    pub what: String,
    /// What would have been accepted.
    pub expected: String,
    /// What was given.
    pub given: String,
}

impl Details {
    /// Collects the three parts.
    pub fn new(
        what: impl Into<String>,
        expected: impl Into<String>,
        given: impl Into<String>,
    ) -> Self {
        Self { what: what.into(), expected: expected.into(), given: given.into() }
    }
}

/// What every error of the workspace can say of itself, beside its message.
pub trait Diagnose: std::error::Error {
    /// A stable, machine-readable name in kebab case, such as `not-finite`.
    fn code(&self) -> &'static str;

    /// What was wrong, expected and given.
    fn details(&self) -> Details;
}

/// Errors of arguments, shared by all crates.
#[derive(Debug, Clone, PartialEq, Error)]
#[non_exhaustive]
pub enum InputError {
    /// Something that needs at least one entry has none.
    #[error("{what} is empty; expected {expected}")]
    Empty {
        /// The argument.
        what: String,
        /// What would have been accepted.
        expected: String,
    },
    /// A NaN or an infinity where a finite number is needed.
    #[error("{what} is {} at index {index}; expected finite numbers", number(*given))]
    NotFinite {
        /// The argument.
        what: String,
        /// Position of the first offender, counted in C order.
        index: usize,
        /// The offender.
        given: f64,
    },
    /// A wrong number of entries or axes.
    #[error("{what} has shape {given:?}; expected {expected}")]
    Shape {
        /// The argument.
        what: String,
        /// The shape asked for, in words.
        expected: String,
        /// The shape given.
        given: Vec<usize>,
    },
    /// A number outside its range.
    #[error("{what} is {}; expected {expected}", number(*given))]
    OutOfRange {
        /// The argument.
        what: String,
        /// The range, in words.
        expected: String,
        /// The number given.
        given: f64,
    },
    /// More than one call may take (`boresight_core::limits`).
    #[error("{what} would take {given:.3e} {measure}; expected {}", at_most(measure, *most))]
    TooLarge {
        /// What would be done or allocated.
        what: String,
        /// Of what: `operations` or `bytes`.
        measure: &'static str,
        /// The limit.
        most: f64,
        /// What it would take.
        given: f64,
    },
    /// A name that is not in a fixed list.
    #[error("{what} {given:?} is not known; expected one of {expected}")]
    Unknown {
        /// What the name names.
        what: String,
        /// The accepted names.
        expected: String,
        /// The name given.
        given: String,
    },
    /// Text that does not have the form asked for.
    #[error("{what} {given:?} is malformed; expected {expected}")]
    Malformed {
        /// What the text is.
        what: String,
        /// The form, in words.
        expected: String,
        /// The text given.
        given: String,
    },
    /// A valid value that cannot be used with other arguments or for this task.
    #[error("{what} {given} cannot be used here; expected {expected}")]
    Incompatible {
        /// The argument.
        what: String,
        /// What would have been accepted, and why.
        expected: String,
        /// The value given.
        given: String,
    },
    /// A calibration of another array.
    #[error("the calibration is of {expected}; the array has {given}")]
    OtherArray {
        /// Transmitters and receivers of the calibration, in words.
        expected: String,
        /// Those of the array.
        given: String,
    },
    /// A matrix that has to be positive definite is not.
    #[error("{what} is not positive definite: pivot {index} is {}", number(*given))]
    NotPositiveDefinite {
        /// The matrix.
        what: String,
        /// Row of the failing pivot.
        index: usize,
        /// Value of the failing pivot.
        given: f64,
    },
    /// An iteration reached its bound before it converged.
    #[error("{what} did not converge in {iterations} iterations")]
    NotConverged {
        /// The quantity computed.
        what: String,
        /// Iterations carried out.
        iterations: usize,
    },
}

impl Diagnose for InputError {
    fn code(&self) -> &'static str {
        match self {
            Self::Empty { .. } => "empty",
            Self::NotFinite { .. } => "not-finite",
            Self::Shape { .. } => "shape",
            Self::OutOfRange { .. } => "out-of-range",
            Self::TooLarge { .. } => "too-large",
            Self::Unknown { .. } => "unknown-name",
            Self::Malformed { .. } => "malformed",
            Self::Incompatible { .. } => "incompatible",
            Self::OtherArray { .. } => "other-array",
            Self::NotPositiveDefinite { .. } => "not-positive-definite",
            Self::NotConverged { .. } => "not-converged",
        }
    }

    fn details(&self) -> Details {
        match self {
            Self::Empty { what, expected } => Details::new(what, expected, "nothing"),
            Self::NotFinite { what, index, given } => {
                Details::new(what, "finite numbers", format!("{} at index {index}", number(*given)))
            }
            Self::Shape { what, expected, given } => {
                Details::new(what, expected, format!("{given:?}"))
            }
            Self::OutOfRange { what, expected, given } => {
                Details::new(what, expected, number(*given))
            }
            Self::TooLarge { what, measure, most, given } => {
                Details::new(what, at_most(measure, *most), format!("{given:.3e} {measure}"))
            }
            Self::Unknown { what, expected, given }
            | Self::Malformed { what, expected, given }
            | Self::Incompatible { what, expected, given } => Details::new(what, expected, given),
            Self::OtherArray { expected, given } => Details::new("calibration", given, expected),
            Self::NotPositiveDefinite { what, index, given } => Details::new(
                what,
                "a positive definite matrix",
                format!("pivot {} in row {index}", number(*given)),
            ),
            Self::NotConverged { what, iterations } => Details::new(
                what,
                "convergence",
                format!("no convergence in {iterations} iterations"),
            ),
        }
    }
}

/// A number as messages show it: in scientific notation where it would otherwise have many zeros.
#[must_use]
pub fn number(value: f64) -> String {
    let decimal = value == 0.0 || !value.is_finite() || (1e-5..1e16).contains(&value.abs());
    if decimal { value.to_string() } else { format!("{value:e}") }
}

/// Finds what has a name among all there are.
///
/// # Errors
/// [`InputError::Unknown`], listing the known names.
pub fn named<T: Copy>(
    what: &str,
    all: &[T],
    name: impl Fn(T) -> &'static str,
    given: &str,
) -> Result<T, InputError> {
    all.iter().copied().find(|&one| name(one) == given).ok_or_else(|| InputError::Unknown {
        what: what.into(),
        expected: all.iter().map(|&one| name(one)).collect::<Vec<_>>().join(", "),
        // A name may be a whole file.
        given: given.chars().take(40).collect(),
    })
}

/// Checks that a number lies in `low..=high`.
///
/// # Errors
/// [`InputError::OutOfRange`], also for NaN.
pub fn check_range(what: &str, given: f64, low: f64, high: f64) -> Result<(), InputError> {
    if given >= low && given <= high {
        return Ok(());
    }
    let expected = if high == f64::INFINITY {
        format!("a number of at least {low}")
    } else {
        format!("a number from {low} to {high}")
    };
    Err(InputError::OutOfRange { what: what.into(), expected, given })
}

/// Checks that a number is finite and greater than zero.
///
/// # Errors
/// [`InputError::OutOfRange`], also for NaN and infinity.
pub fn check_positive(what: &str, given: f64) -> Result<(), InputError> {
    if given > 0.0 && given.is_finite() {
        return Ok(());
    }
    Err(InputError::OutOfRange {
        what: what.into(),
        expected: "a finite number greater than 0".into(),
        given,
    })
}

/// Checks that all numbers are finite.
///
/// # Errors
/// [`InputError::NotFinite`] for the first that is not.
pub fn check_finite(what: &str, numbers: impl IntoIterator<Item = f64>) -> Result<(), InputError> {
    for (index, given) in numbers.into_iter().enumerate() {
        if !given.is_finite() {
            return Err(InputError::NotFinite { what: what.into(), index, given });
        }
    }
    Ok(())
}

/// Checks that numbers are finite in single precision; `what` names them.
///
/// # Errors
/// [`InputError::NotFinite`] for the first that is not.
pub fn check_single(what: &dyn Fn() -> String, numbers: &[f64]) -> Result<(), InputError> {
    let kept = || numbers.iter().map(|&number| number as f32);
    // All are looked at, so that it is vectorised.
    if kept().fold(true, |all, number| all & number.is_finite()) {
        return Ok(());
    }
    check_finite(&what(), kept().map(f64::from))
}

/// The most of a measure, in words.
fn at_most(measure: &str, most: f64) -> String {
    format!("at most {most:.3e}, limits.{measure}: ask for less, or raise it")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn extreme_numbers_are_shown_in_scientific_notation() {
        let shown = [0.0, -0.25, 1e-5, 123_456.0, 1e16, -1e300, 5e-324, f64::INFINITY].map(number);
        let expected = ["0", "-0.25", "0.00001", "123456", "1e16", "-1e300", "5e-324", "inf"];
        assert_eq!(shown, expected);
        let error =
            InputError::OutOfRange { what: "x".into(), expected: "less".into(), given: 1e300 };
        assert_eq!(error.to_string(), "x is 1e300; expected less");
        assert_eq!(error.details().given, "1e300");
    }
}
