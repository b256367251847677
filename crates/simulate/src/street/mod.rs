//! A street around a car with five radars: parked and moving cars, a wall, a guard rail, poles and
//! people as points that scatter, of which each radar's data cubes are made. Bit for bit the same
//! natively and in wasm.

mod layout;
mod view;

pub use view::VisibleTarget;

use crate::cube::{CubeOptions, simulate_cube};
use crate::error::SimulateError;
use crate::waveforms::waveform_corner;
use boresight_core::drive::{Mounting, RADARSCENES_SENSORS};
use boresight_core::presets::preset;
use boresight_core::{Complex32, Random, Waveform};
use boresight_math::error::check_range;
use boresight_options::{Described, Flat, Naming, check, columns};
use ndarray::Array5;
use serde::{Deserialize, Serialize, Serializer};
use std::f64::consts::{FRAC_PI_3, PI};

/// Names of the radars, by the way they look.
pub const STREET_RADARS: [&str; 5] = ["right", "front-right", "front-left", "left", "rear"];

/// The radar that looks back, in the middle of the rear bumper.
const REAR: Mounting = Mounting { x_m: -1.0, y_m: 0.0, yaw_rad: PI };

/// Power of a 0 dB target over the noise, both of a raw sample, dB. With the powers of
/// [`VisibleTarget`], 1 m^2 at 40 m stands 20 dB above the noise in its range-Doppler cell under
/// Hann windows.
pub const STREET_SNR_DB: f64 = 38.0;

/// What a street is made from.
#[derive(Debug, Clone, Copy, PartialEq, Described, Serialize, Deserialize)]
#[serde(default)]
pub struct StreetOptions {
    /// The things in it come from stream 0 of this seed, the cube of radar `i` from one that stream
    /// `i + 1` gives.
    pub seed: u64,
    /// Speed of the car along x. The faster it is, the farther Doppler tells apart what stands at
    /// one range in different directions.
    #[option(default = 6.0, range = -30..=30)]
    pub ego_speed_mps: f64,
}

/// What a point belongs to.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Described, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum StreetKind {
    /// A car at the kerb.
    ParkedCar,
    /// A rail on posts, over which radars see.
    GuardRail,
    /// House fronts.
    Wall,
    /// A lamp post or a tree.
    Pole,
    /// Somebody on foot.
    Pedestrian,
    /// A car that drives.
    Vehicle,
}

impl StreetKind {
    /// Loss of what lies behind it, dB: under and over a car some power gets through.
    fn loss_db(self) -> Option<f64> {
        match self {
            Self::ParkedCar | Self::Vehicle => Some(10.0),
            Self::Wall => Some(40.0),
            Self::GuardRail | Self::Pole | Self::Pedestrian => None,
        }
    }
}

/// A point that scatters, in the car's frame.
#[derive(Debug, Clone, Copy, PartialEq, Described, Serialize)]
pub struct StreetTarget {
    /// Ahead of the rear axle.
    pub x_m: f64,
    /// Left of the centre line.
    pub y_m: f64,
    /// Velocity ahead over ground.
    pub vx_mps: f64,
    /// Velocity to the left over ground.
    pub vy_mps: f64,
    /// Radar cross-section.
    pub rcs_dbsm: f64,
    /// What it belongs to.
    pub kind: StreetKind,
    /// Index of that thing's outline.
    pub outline: usize,
}

/// The shape of a thing on the ground.
#[derive(Debug, Clone, PartialEq, Described, Serialize)]
pub struct StreetOutline {
    /// What it is.
    pub kind: StreetKind,
    /// Corners in the car's frame: of a polygon, the two ends of a line, or one point.
    #[option(described_as = Flat<Corners>)]
    #[serde(serialize_with = "as_columns")]
    pub corners_m: Vec<[f64; 2]>,
}

/// Corners as columns.
#[derive(Described, Serialize)]
struct Corners {
    /// Ahead of the rear axle: corners of a polygon, the two ends of a line, or one point.
    #[serde(serialize_with = "columns::serialize")]
    x_m: Vec<f64>,
    /// Left of the centre line.
    #[serde(serialize_with = "columns::serialize")]
    y_m: Vec<f64>,
}

fn as_columns<S: Serializer>(corners: &[[f64; 2]], serializer: S) -> Result<S::Ok, S::Error> {
    let column = |axis: usize| corners.iter().map(|corner| corner[axis]).collect();
    Flat(Corners { x_m: column(0), y_m: column(1) }).serialize(serializer)
}

/// A radar on the car.
#[derive(Debug, Clone, Copy, PartialEq, Described, Serialize)]
pub struct StreetRadar {
    /// `right`, `front-right`, `front-left`, `left` or `rear`: by the way it looks.
    pub name: &'static str,
    /// Its place and direction.
    pub mounting: Mounting,
    /// The preset of its array.
    pub array: &'static str,
    /// Its waveform.
    pub waveform: Waveform,
    /// Half width of what it sees.
    pub field_of_view_rad: f64,
}

/// The street at the start of a frame.
#[derive(Debug, Clone, PartialEq, Described, Serialize)]
#[option(name = "StreetScene")]
pub struct Street {
    /// What it was made from.
    options: Flat<StreetOptions>,
    /// The car's radars, the four of the `RadarScenes` car as mounted there, and one that looks back.
    pub radars: Vec<StreetRadar>,
    /// All points.
    pub targets: Vec<StreetTarget>,
    /// All things.
    pub outlines: Vec<StreetOutline>,
}

impl Street {
    /// Lays out a street.
    ///
    /// # Errors
    /// [`boresight_core::InputError::OutOfRange`] for a speed beyond 30 m/s either way.
    pub fn new(options: StreetOptions) -> Result<Self, SimulateError> {
        check(&options, Naming::Rust)?;
        let radar = |(name, mounting): (&'static str, Mounting)| StreetRadar {
            name,
            mounting,
            array: "lrr48",
            waveform: waveform_corner(),
            field_of_view_rad: FRAC_PI_3,
        };
        let mountings = RADARSCENES_SENSORS.into_iter().map(|(_, mounting)| mounting).chain([REAR]);
        let radars = STREET_RADARS.into_iter().zip(mountings).map(radar).collect();
        let (targets, outlines) = layout::layout(&mut Random::new(options.seed, 0));
        Ok(Self { options: options.into(), radars, targets, outlines })
    }

    /// The options.
    pub fn options(&self) -> &StreetOptions {
        &self.options
    }

    /// Points that radar `radar` (an index) sees: in its field of view, in no deep
    /// shadow, and not far below the noise.
    ///
    /// # Errors
    /// [`boresight_core::InputError::OutOfRange`] for a radar there is not.
    pub fn visible(&self, radar: usize) -> Result<Vec<VisibleTarget>, SimulateError> {
        check_range("radar", radar as f64, 0.0, self.radars.len() as f64 - 1.0)?;
        Ok(view::visible(self, &self.radars[radar]))
    }

    /// Whether house fronts stand between two places (x and y in the car's frame, m), so that a
    /// radar in one shows nothing true in the other.
    pub fn is_behind_wall(&self, from_m: [f64; 2], place_m: [f64; 2]) -> bool {
        view::is_behind_wall(self, from_m, place_m)
    }

    /// A frame of radar `radar` (an index), 1 x loops x transmitters x receivers x samples, of the
    /// points it sees.
    ///
    /// # Errors
    /// As [`Street::visible`] and [`simulate_cube`].
    pub fn cube(
        &self,
        radar: usize,
    ) -> Result<(Array5<Complex32>, Vec<VisibleTarget>), SimulateError> {
        let targets = self.visible(radar)?;
        let StreetRadar { array, waveform, .. } = self.radars[radar];
        let options = CubeOptions {
            snr_db: STREET_SNR_DB,
            seed: Random::new(self.options.seed, radar as u64 + 1).bits(),
            ..CubeOptions::default()
        };
        let echoes: Vec<_> = targets.iter().map(|target| *target.echo).collect();
        Ok((simulate_cube(&waveform, &preset(array)?, &echoes, &options)?, targets))
    }
}
