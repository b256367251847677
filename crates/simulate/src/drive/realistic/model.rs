//! The numbers of the profile "radarscenes", in one place.
//!
//! They are measurements on two sequences of `RadarScenes` (Schumann et al. 2021; four 77 GHz
//! radars, 14,575 scans), rounded. `docs/simulated-drives.md` says which were tuned.

use std::f64::consts::PI;

const DEG: f64 = PI / 180.0;

/// Detections lie within plus and minus this azimuth, rad.
pub(crate) const FIELD_OF_VIEW_RAD: f64 = 70.0 * DEG;

/// Most detections a scan.
pub(crate) const MAX_DETECTIONS: usize = 500;

/// Loss by the antenna's pattern at 60 deg, dB; it grows with the square of azimuth.
pub(crate) const EDGE_LOSS_DB: f64 = 28.0;

/// Standard deviation of azimuth, rad: `sigma (1 + growth (azimuth / 60 deg)^2)`.
pub(crate) const AZIMUTH_SIGMA_RAD: f64 = 0.07 * DEG;
pub(crate) const AZIMUTH_GROWTH: f64 = 4.0;
pub(crate) const AZIMUTH_GROWTH_AT_RAD: f64 = 60.0 * DEG;

/// Standard deviation of range rate at standstill, m/s, and its growth with speed.
pub(crate) const RANGE_RATE_SIGMA_MPS: f64 = 0.03;
pub(crate) const RANGE_RATE_SIGMA_PER_SPEED: f64 = 0.001;

/// Standard deviation of range, m.
pub(crate) const RANGE_SIGMA_M: f64 = 0.1;

/// Length of the interval a range rate is measured over, s. Its middle lies the delay behind the
/// time stamp.
pub(crate) const COHERENT_INTERVAL_S: f64 = 0.04;

/// Delay of range rates behind their time stamp, s: from and to.
pub(crate) const DELAY_S: [f64; 2] = [0.02, 0.10];

/// Azimuth bias by the bumper and the phase centres: standard deviation, rad; its correlation, rad;
/// by how much it is larger towards the edge, from and to where it grows, rad.
pub(crate) const BIAS_SIGMA_RAD: f64 = 0.08 * DEG;
pub(crate) const BIAS_CORRELATION_RAD: f64 = 15.0 * DEG;
pub(crate) const BIAS_EDGE_FACTOR: f64 = 8.0;
pub(crate) const BIAS_EDGE_RAD: [f64; 2] = [58.0 * DEG, 62.0 * DEG];
/// Within this azimuth the curve has no mean (which would be a mounting angle), and its rms is told.
pub(crate) const BIAS_WITHIN_RAD: f64 = 55.0 * DEG;

/// Azimuth offsets that all reflectors of a patch of ground share, of radars that look aside: sides
/// of small and of large patches, m, and standard deviations of their offsets, rad.
pub(crate) const PATCHES_M: [f64; 2] = [8.0, 80.0];
pub(crate) const PATCH_SIGMAS_RAD: [f64; 2] = [0.12 * DEG, 0.06 * DEG];
/// By how much offsets are larger, by the direction of the radar: deg to the left, factor. Those that
/// look ahead see rails, walls and columns of cars at grazing angles.
pub(crate) const PATCH_FACTOR: [[f64; 2]; 4] =
    [[-85.0, 1.0], [-25.0, 2.7], [25.0, 2.7], [85.0, 1.0]];

/// Height of a radar above the ground, m.
pub(crate) const RADAR_HEIGHT_M: f64 = 0.5;
/// Elevations within which a radar sees, rad.
pub(crate) const ELEVATION_RAD: f64 = 12.0 * DEG;

/// Height of signs across motorways, m, how far apart they are, and of how many reflectors each is.
pub(crate) const GANTRY_HEIGHT_M: f64 = 5.5;
pub(crate) const GANTRY_EVERY_M: f64 = 400.0;
pub(crate) const GANTRY_REFLECTORS: usize = 12;

/// Further reflectors around each of the clean world: their mean number; how far they lie along the
/// road (at most) and away from it (mean of an exponential), m; their strength less the first's and
/// its spread, dB; the side of the squares of ground that are more or less crowded, m, and the spread
/// of that as a logarithm.
pub(crate) const COPIES: f64 = 4.0;
pub(crate) const COPY_ALONG_M: f64 = 3.0;
pub(crate) const COPY_AWAY_M: f64 = 16.0;
pub(crate) const COPY_DB: f64 = -2.0;
pub(crate) const COPY_SPREAD_DB: f64 = 6.0;
pub(crate) const CROWD_M: f64 = 80.0;
pub(crate) const CROWD_SIGMA: f64 = 0.45;

/// Mean number of detections a scan by the direction of the radar: deg to the left, count.
pub(crate) const MEAN_COUNT: [[f64; 2]; 4] =
    [[-85.0, 115.0], [-25.0, 225.0], [25.0, 225.0], [85.0, 125.0]];
/// Relative spread of it from scene to scene, and of one radar in it.
pub(crate) const COUNT_SPREAD: f64 = 0.22;
pub(crate) const COUNT_SPREAD_OF_RADAR: f64 = 0.1;

/// Mean share of ghosts by the direction of the radar: deg to the left, share; factors from scene
/// to scene from and to; what they are stronger than standing things, dB.
pub(crate) const GHOST_SHARE: [[f64; 2]; 4] =
    [[-85.0, 0.05], [-25.0, 0.09], [25.0, 0.11], [85.0, 0.06]];
pub(crate) const GHOST_FACTOR: [f64; 2] = [0.6, 1.4];
pub(crate) const GHOST_GAIN_DB: f64 = 6.0;
/// Detections of a ghost a scan, mean of each: from and to.
pub(crate) const GHOST_DETECTIONS: [f64; 2] = [1.0, 8.0];
/// Shares of kinds of ghosts: the own car, mirror images of movers, double bounces; the rest are
/// movers that nobody labelled.
pub(crate) const GHOST_KINDS: [f64; 3] = [0.1, 0.3, 0.2];
/// How long a ghost lives, s: from and to.
pub(crate) const GHOST_LIFE_S: [f64; 2] = [1.0, 5.0];

/// Share of soft outliers by the direction of the radar: deg to the left, share; their error of range
/// rate, m/s: from and to, either sign.
pub(crate) const SOFT_SHARE: [[f64; 2]; 4] =
    [[-85.0, 0.015], [-25.0, 0.035], [25.0, 0.035], [85.0, 0.02]];
pub(crate) const SOFT_MPS: [f64; 2] = [0.3, 1.0];

/// Points of a vehicle over those of the clean profile, whose radars give fewer detections.
pub(crate) const MOVER_FACTOR: f64 = 3.0;

/// Moving share over the one asked for, by the direction of the radar: deg to the left, factor.
pub(crate) const MOVING_FACTOR: [[f64; 2]; 4] =
    [[-85.0, 0.05], [-25.0, 0.65], [25.0, 1.0], [85.0, 0.4]];
/// Moving shares of scenes: share of the scenes, from, to.
pub(crate) const MOVING_SCENES: [[f64; 3]; 3] =
    [[0.75, 0.0, 0.1], [0.2, 0.1, 0.3], [0.05, 0.3, 0.8]];

/// Slip angle of the rear axle over lateral acceleration, rad/(m/s^2), outwards: mean and standard
/// deviation of cars; relative standard deviation from drive to drive.
pub(crate) const SLIP_GRADIENT_RAD: [f64; 2] = [0.0045, 0.0008];
pub(crate) const SLIP_SPREAD: f64 = 0.1;
/// Standard deviation of the angle between the car's x and its way straight ahead, rad.
pub(crate) const CRAB_SIGMA_RAD: f64 = 0.03 * DEG;

/// Standard deviation of the speed's scale; of a sample's white noise, m/s; its lag, s.
pub(crate) const SPEED_SCALE_SIGMA: f64 = 0.003;
pub(crate) const SPEED_SIGMA_MPS: f64 = 0.03;
pub(crate) const SPEED_LAG_S: f64 = 0.05;

/// Yaw rate of navigation: standard deviations of scale and of bias, rad/s; white noise, rad/s.
pub(crate) const NAVIGATION_SCALE_SIGMA: f64 = 0.002;
pub(crate) const NAVIGATION_BIAS_RADPS: f64 = 0.001 * DEG;
pub(crate) const NAVIGATION_SIGMA_RADPS: f64 = 0.03 * DEG;
/// Random walk of a series sensor's bias: 0.02 deg/s in a minute, in rad/s by root second.
pub(crate) const SERIES_WALK: f64 = 0.02 * DEG / 7.745_966_692_414_834;

/// Time constant of the yaw rate's low-pass of 10 Hz, s.
pub(crate) const YAW_RATE_LAG_S: f64 = 1.0 / (2.0 * PI * 10.0);

/// Cycle: its mean from and to, its jitter's standard deviation, its shortest and longest, s; the
/// share of scans that are lost.
pub(crate) const CYCLE_MEAN_S: [f64; 2] = [0.0736, 0.0744];
pub(crate) const CYCLE_SIGMA_S: f64 = 0.001;
pub(crate) const CYCLE_S: [f64; 2] = [0.071, 0.082];
pub(crate) const LOST_SHARE: f64 = 0.003;

/// What a table has for a radar that looks `yaw_rad` to the left of ahead: linear between its rows,
/// the first or last beyond them.
pub(crate) fn by_direction<const N: usize>(table: &[[f64; 2]; N], yaw_rad: f64) -> f64 {
    let turned = yaw_rad / (2.0 * PI);
    let yaw_deg = (turned - turned.round()) * 360.0;
    let after = table.iter().position(|row| row[0] >= yaw_deg).unwrap_or(N - 1);
    let [b, a] = [table[after], table[after.saturating_sub(1)]];
    if b[0] <= a[0] {
        return b[1];
    }
    let share = ((yaw_deg - a[0]) / (b[0] - a[0])).clamp(0.0, 1.0);
    a[1] + (b[1] - a[1]) * share
}
