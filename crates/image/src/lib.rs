//! Images of what a radar sees: targets or spectra of detected cells added into a
//! range-azimuth-Doppler cube or a range-azimuth map by summation splatting, maps of several radars
//! resampled into a bird's-eye view, and a measure of how much of such a view is not target.
//!
//! Powers are linear. Azimuth axes are uniform in its sine, as the resolution of an array is.

mod axis;
mod error;
mod sidelobes;
mod splat;
mod view;

pub use axis::Axis;
pub use error::ImageError;
pub use sidelobes::{Gate, LIT_DB, SidelobeMeasure, sidelobe_measure};
pub use splat::{Grid, Outside, RangeAzimuthDoppler, RangeAzimuthMap, SpectrumPlan, Target};
pub use view::{BirdsEyeView, NO_RADAR, ViewGrid, birds_eye_view};
