//! Values against the ranges of their descriptions.

use crate::description::{Described, Range};
use crate::naming;
use boresight_math::InputError;

/// Whose names and units errors use.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Naming {
    /// `field_of_view_rad`, radians.
    Rust,
    /// `fieldOfViewDeg`, degrees.
    JavaScript,
    /// `--field-of-view`, degrees.
    CommandLine,
}

/// Checks every number of a value against the range its field states.
///
/// # Errors
/// [`InputError::OutOfRange`] for the first out of its range, in the names and units of `naming`.
pub fn check<T: Described>(value: &T, naming: Naming) -> Result<(), InputError> {
    value.check(None, &At::top(naming))
}

/// The place of a value in what is checked or read.
#[derive(Debug, Clone, Copy)]
pub struct At<'a> {
    naming: Naming,
    above: Option<&'a At<'a>>,
    step: Step<'a>,
}

#[derive(Debug, Clone, Copy)]
enum Step<'a> {
    Top(&'a str),
    Field(&'a str),
    Item(usize),
}

impl At<'static> {
    /// The value itself.
    #[must_use]
    pub fn top(naming: Naming) -> Self {
        Self { naming, above: None, step: Step::Top("") }
    }
}

impl<'a> At<'a> {
    /// A value with a name of its own, such as that of an argument.
    #[must_use]
    pub fn named(naming: Naming, name: &'a str) -> Self {
        Self { naming, above: None, step: Step::Top(name) }
    }

    /// A field of the value, by its name in Rust.
    #[must_use]
    pub fn field<'b>(&'b self, name: &'b str) -> At<'b> {
        At { naming: self.naming, above: Some(self), step: Step::Field(name) }
    }

    /// An item of the value.
    #[must_use]
    pub fn item(&self, index: usize) -> At<'_> {
        At { naming: self.naming, above: Some(self), step: Step::Item(index) }
    }

    /// Name of the field that the value stands in, in Rust.
    fn field_name(&self) -> &'a str {
        match (self.step, self.above) {
            (Step::Field(name) | Step::Top(name), _) => name,
            (Step::Item(_), Some(above)) => above.field_name(),
            (Step::Item(_), None) => "",
        }
    }

    /// The place in words, such as `iaa.thresholdDb` or `--iaa-threshold`.
    #[must_use]
    pub fn path(&self) -> String {
        let above = self.above.map_or_else(String::new, At::path);
        match self.step {
            Step::Top(name) => name.into(),
            Step::Item(_) if self.naming == Naming::CommandLine => above,
            Step::Item(index) => format!("{above}[{index}]"),
            Step::Field(name) => {
                let (own, joint) = match self.naming {
                    Naming::Rust => (name.to_owned(), "."),
                    Naming::JavaScript => (naming::javascript(name), "."),
                    Naming::CommandLine => (naming::flag(name), "-"),
                };
                match above.as_str() {
                    "" if self.naming == Naming::CommandLine => format!("--{own}"),
                    "" => own,
                    above => format!("{above}{joint}{own}"),
                }
            }
        }
    }

    /// Checks a number of the value.
    pub(crate) fn number(&self, given: f64, range: Option<Range>) -> Result<(), InputError> {
        let Some(Range { low, high, above_low }) = range else { return Ok(()) };
        let is_angle = naming::is_angle(self.field_name());
        let [low_si, high_si] =
            if is_angle { [low.to_radians(), high.to_radians()] } else { [low, high] };
        // Not finite where nothing limits it from above is out of range, too.
        let finite = given < f64::INFINITY;
        if given <= high_si && finite && (given > low_si || given == low_si && !above_low) {
            return Ok(());
        }
        let in_degrees = is_angle && self.naming != Naming::Rust;
        let (low, high) = if in_degrees { (low, high) } else { (low_si, high_si) };
        let expected = match (above_low, high == f64::INFINITY) {
            (true, _) => format!("a finite number greater than {low}"),
            (false, true) => format!("a number of at least {low}"),
            (false, false) => format!("a number from {low} to {high}"),
        };
        let given = if in_degrees { naming::in_degrees(given) } else { given };
        Err(InputError::OutOfRange { what: self.path(), expected, given })
    }
}
