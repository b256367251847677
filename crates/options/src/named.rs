//! Enums without data by name.

use crate::description::{Choice, Described, Kind};
use boresight_math::error::{InputError, named};

/// An enum without data that is described: its names are those of its description.
pub trait Named: Described + Copy + 'static {
    /// All of it, in order.
    const VARIANTS: &'static [Self];

    /// Its place among [`Named::VARIANTS`].
    fn place(self) -> usize;

    /// Its description.
    #[must_use]
    fn choice() -> &'static Choice {
        match Self::KIND {
            Kind::Choice(choice) => choice,
            // What derives this trait describes a choice.
            _ => &Choice { name: "", doc: "", variants: &[] },
        }
    }

    /// Its name in options, on the command line and in results.
    #[must_use]
    fn name(self) -> &'static str {
        Self::choice().variants.get(self.place()).map_or("", |(name, _)| name)
    }

    /// The one of a name.
    ///
    /// # Errors
    /// [`InputError::Unknown`], listing the known names; `what` is what the name names.
    fn from_name(what: &str, name: &str) -> Result<Self, InputError> {
        named(what, Self::VARIANTS, Self::name, name)
    }
}
