//! What a radar sees from where it is: ranges, azimuths, shadows, and the strength of echoes.

use boresight_core::Random;
use std::f64::consts::FRAC_PI_3;
use std::f64::consts::PI;

/// Detections lie within plus and minus this azimuth, rad.
pub const FIELD_OF_VIEW_RAD: f64 = FRAC_PI_3;

/// Nearest and farthest detections, m.
pub const RANGE_M: [f64; 2] = [0.5, 100.0];

/// Bins of the shadows over the field of view: one degree where that is plus and minus 60.
pub(crate) const BINS: usize = 120;

/// Cross-section that is detected half the time at [`REFERENCE_M`] on boresight, dBsm.
const REFERENCE_DBSM: f64 = -6.0;
const REFERENCE_M: f64 = 40.0;

/// Where the radar is during a scan.
pub(crate) struct View {
    pub(crate) x_m: f64,
    pub(crate) y_m: f64,
    pub(crate) sin: f64,
    pub(crate) cos: f64,
    /// Azimuths within which it sees.
    pub(crate) field_of_view_rad: f64,
    /// Loss by the antenna's pattern at 60 deg, dB.
    pub(crate) edge_loss_db: f64,
    /// Nearest thing that throws a shadow, and the shadow's loss, by azimuth.
    pub(crate) shadows: [(f64, f64); BINS],
}

/// Something that may be detected, relative to the radar.
pub(crate) struct Echo {
    pub(crate) range_m: f64,
    pub(crate) azimuth_rad: f64,
    pub(crate) rcs_dbsm: f64,
    /// Velocity on the ground, m/s.
    pub(crate) velocity_mps: [f64; 2],
    pub(crate) class: u8,
    pub(crate) track: u32,
    /// Extent towards the radar of what it belongs to, m: it throws no shadow on itself.
    pub(crate) depth_m: f64,
    /// Cosine of its elevation: 1 where everything is flat.
    pub(crate) elevation_cos: f64,
}

impl Echo {
    /// The echo of a point.
    pub(crate) fn new(range_m: f64, azimuth_rad: f64, velocity_mps: [f64; 2], class: u8) -> Self {
        Self {
            range_m,
            azimuth_rad,
            rcs_dbsm: 0.0,
            velocity_mps,
            class,
            track: 0,
            depth_m: 0.0,
            elevation_cos: 1.0,
        }
    }
}

impl View {
    /// Range and azimuth of a place on the ground.
    pub(crate) fn polar(&self, x_m: f64, y_m: f64) -> (f64, f64) {
        let (dx, dy) = (x_m - self.x_m, y_m - self.y_m);
        let (forward, left) = (dx * self.cos + dy * self.sin, dy * self.cos - dx * self.sin);
        ((dx * dx + dy * dy).sqrt(), libm::atan2(left, forward))
    }

    /// The place on the ground at a range and azimuth.
    pub(crate) fn place(&self, range_m: f64, azimuth_rad: f64) -> [f64; 2] {
        let (sin, cos) = libm::sincos(azimuth_rad);
        [
            self.x_m + range_m * (self.cos * cos - self.sin * sin),
            self.y_m + range_m * (self.sin * cos + self.cos * sin),
        ]
    }

    /// Shades what lies behind an outline.
    pub(crate) fn shade(&mut self, outline: &[[f64; 2]], loss_db: f64) {
        let (mut low, mut high, mut nearest) = (PI, -PI, f64::INFINITY);
        for corner in outline {
            let (range, azimuth) = self.polar(corner[0], corner[1]);
            low = azimuth.min(low);
            high = azimuth.max(high);
            nearest = range.min(nearest);
        }
        // Behind the radar azimuths wrap around; nothing there throws a shadow into view.
        if nearest > RANGE_M[1]
            || high - low > 2.5
            || high < -self.field_of_view_rad
            || low > self.field_of_view_rad
        {
            return;
        }
        for bin in self.bin_of(low)..=self.bin_of(high) {
            let shadow = &mut self.shadows[bin];
            if nearest < shadow.0 || loss_db > shadow.1 + 8.0 {
                *shadow = (nearest, loss_db);
            }
        }
    }

    /// Whether the radar sees there.
    pub(crate) fn holds(&self, range_m: f64, azimuth_rad: f64) -> bool {
        azimuth_rad.abs() <= self.field_of_view_rad && (RANGE_M[0]..=RANGE_M[1]).contains(&range_m)
    }

    fn bin_of(&self, azimuth_rad: f64) -> usize {
        let place = (azimuth_rad / self.field_of_view_rad + 1.0) * 0.5 * BINS as f64;
        (place.max(0.0) as usize).min(BINS - 1)
    }

    /// The azimuth in single precision, rounded into the field of view.
    pub(crate) fn within(&self, azimuth_rad: f64) -> f32 {
        within(azimuth_rad, self.field_of_view_rad)
    }
}

/// The azimuth in single precision, rounded into a field of view.
pub(crate) fn within(azimuth_rad: f64, field_of_view_rad: f64) -> f32 {
    // The single nearest to the limit may lie above it.
    let most = (field_of_view_rad as f32).next_down();
    (azimuth_rad as f32).clamp(-most, most)
}

/// What arrives of an echo that is detected.
pub(crate) struct Received {
    /// Cross-section as this scan sees it, dBsm.
    pub(crate) observed_dbsm: f64,
    /// Strength over the threshold, dB.
    pub(crate) strength_db: f64,
}

/// Strength over the threshold, dB, of an observed cross-section: range to the fourth, the antenna's
/// pattern and shadows.
pub(crate) fn strength_db(echo: &Echo, view: &View, observed_dbsm: f64) -> f64 {
    let (shadow_from_m, shadow_db) = view.shadows[view.bin_of(echo.azimuth_rad)];
    let shadow = if echo.range_m > shadow_from_m + echo.depth_m { shadow_db } else { 0.0 };
    let edge = echo.azimuth_rad / FIELD_OF_VIEW_RAD;
    // Within 8 m sensitivity no longer grows, as in every receiver that must not saturate.
    let spreading = 40.0 * libm::log10(REFERENCE_M / echo.range_m.max(8.0));
    observed_dbsm + spreading - view.edge_loss_db * edge * edge - shadow - REFERENCE_DBSM
}

/// Detects an echo or not: exponentially fluctuating power (Swerling 1) over a threshold.
pub(crate) fn received(
    echo: &Echo,
    view: &View,
    gain_db: f64,
    random: &mut Random,
) -> Option<Received> {
    let fluctuation = 10.0 * libm::log10((-libm::log(1.0 - random.unit())).max(1e-9));
    let observed_dbsm = echo.rcs_dbsm + fluctuation;
    let strength_db = strength_db(echo, view, observed_dbsm) + gain_db;
    (strength_db >= 0.0).then_some(Received { observed_dbsm, strength_db })
}
