//! Images of what a radar sees: targets or spectra of detected cells added into a
//! range-azimuth-Doppler cube or a range-azimuth map by summation splatting, maps of several radars
//! resampled into a bird's-eye view, and measures of how much of such a view, or of points, is not target.
//!
//! Powers are linear. Azimuth axes are uniform in its sine, as the resolution of an array is.
//!
//! # Example
//!
//! ```
//! use boresight_core::Mounting;
//! use boresight_image::{Grid, RangeAzimuthDoppler, Target, ViewGrid, birds_eye_view};
//!
//! // A target 20 m ahead of a radar that looks to the left.
//! let mut cube = RangeAzimuthDoppler::new(Grid::new([0.0, 40.0], 81, 1.2, 121)?, None)?;
//! cube.add_target(&Target {
//!     range_m: 20.0,
//!     rate_mps: 0.0,
//!     azimuth_rad: 0.0,
//!     power: 4.0,
//!     confidence: 1.0,
//! })?;
//! let map = cube.to_map();
//! assert_eq!(map.power[[40, 60]], 4.0);
//!
//! let left = Mounting { x_m: 0.0, y_m: 0.0, yaw_rad: std::f64::consts::FRAC_PI_2 };
//! let view = birds_eye_view(&[(&map, left)], ViewGrid::new([-30.0, 30.0], [-30.0, 30.0], 0.5)?)?;
//! let lit = view.power.indexed_iter().max_by(|a, b| a.1.total_cmp(b.1));
//! let place = lit.map(|((ahead, left), _)| (view.grid.x_m.value(ahead), view.grid.y_m.value(left)));
//! assert!(place.is_some_and(|(x_m, y_m)| x_m.hypot(y_m - 20.0) < 0.5), "{place:?}");
//! # Ok::<(), boresight_image::ImageError>(())
//! ```

mod axis;
mod columns;
mod error;
mod gate;
mod hidden;
mod options;
mod points;
mod sidelobes;
mod splat;
mod view;

pub use axis::Axis;
pub use columns::{MapColumns, ViewColumns};
pub use error::ImageError;
pub use gate::Gate;
pub use hidden::{HiddenMeasure, hidden_measure};
pub use options::{GridOptions, ViewGridOptions};
pub use points::{PointMeasure, PointsAtHalf, RadarPoints, point_measure};
pub use sidelobes::{LIT_DB, SidelobeMeasure, sidelobe_measure};
pub use splat::{Grid, Outside, RangeAzimuthDoppler, RangeAzimuthMap, SpectrumPlan, Target};
pub use view::{BirdsEyeView, NO_RADAR, ViewGrid, birds_eye_view};
