//! What a radar sees of a street.

use super::{Street, StreetKind, StreetRadar};
use crate::cube::CubeTarget;
use boresight_core::Direction;
use boresight_options::{Described, Flat};
use serde::Serialize;
use std::f64::consts::FRAC_PI_2;

/// Nearest point that is simulated, m.
const NEAREST_M: f64 = 1.0;
/// Share of the unambiguous range up to which points are simulated.
const FARTHEST: f64 = 0.95;
/// Power of 1 m^2 at [`REFERENCE_M`] on boresight, dB.
const REFERENCE_DB: f64 = -60.0;
const REFERENCE_M: f64 = 40.0;
/// Within this range sensitivity no longer grows, as in every receiver that must not saturate.
const SATURATION_M: f64 = 8.0;
/// Loss of the antennas at the edge of the field of view, both ways, dB.
const EDGE_LOSS_DB: f64 = 8.0;

/// Points in a deeper shadow are not simulated, dB.
const DEEPEST_SHADOW_DB: f64 = 25.0;

/// Weaker points are not simulated: in their range-Doppler cell they lie 10 dB below the noise, dB.
const WEAKEST_DB: f64 = -90.0;

/// A point of the street as a radar sees it.
#[derive(Debug, Clone, Copy, PartialEq, Described, Serialize)]
pub struct VisibleTarget {
    /// Index among the street's targets.
    pub target: usize,
    /// Range, rate, direction and power in the radar's frame.
    pub echo: Flat<CubeTarget>,
}

/// The points in the radar's field of view that nothing hides.
pub(super) fn visible(street: &Street, radar: &StreetRadar) -> Vec<VisibleTarget> {
    let mounting = radar.mounting;
    let (sin, cos) = libm::sincos(mounting.yaw_rad);
    let farthest_m = FARTHEST * radar.waveform.max_range_m();
    let ego_mps = street.options.ego_speed_mps;
    let hiding: Vec<(f64, Edges)> = street
        .outlines
        .iter()
        .filter_map(|outline| Some((outline.kind.loss_db()?, edges(&outline.corners_m))))
        .collect();
    let origin = [mounting.x_m, mounting.y_m];
    let see = |(index, target): (usize, &super::StreetTarget)| {
        let (dx, dy) = (target.x_m - origin[0], target.y_m - origin[1]);
        let range_m = (dx * dx + dy * dy).sqrt();
        let azimuth_rad = libm::atan2(dy * cos - dx * sin, dx * cos + dy * sin);
        let edge = azimuth_rad / radar.field_of_view_rad.min(FRAC_PI_2);
        if !(NEAREST_M..=farthest_m).contains(&range_m) || edge.abs() > 1.0 {
            return None;
        }
        let point = [target.x_m, target.y_m];
        let hides = |(_, edges): &&(f64, Edges)| stands_between(origin, point, edges);
        let shadow_db: f64 = hiding.iter().filter(hides).map(|(loss, _)| loss).sum();
        if shadow_db > DEEPEST_SHADOW_DB {
            return None;
        }
        let rate_mps = ((target.vx_mps - ego_mps) * dx + target.vy_mps * dy) / range_m;
        let spreading_db = 40.0 * libm::log10(REFERENCE_M / range_m.max(SATURATION_M));
        let power_db =
            target.rcs_dbsm + spreading_db - EDGE_LOSS_DB * edge * edge - shadow_db + REFERENCE_DB;
        if power_db < WEAKEST_DB {
            return None;
        }
        let direction = Direction::azimuth(azimuth_rad);
        let echo = CubeTarget {
            range_m,
            rate_mps,
            direction: direction.into(),
            power_db,
            phase_rad: None,
        };
        Some(VisibleTarget { target: index, echo: echo.into() })
    };
    street.targets.iter().enumerate().filter_map(see).collect()
}

/// Whether house fronts stand between two places.
pub(super) fn is_behind_wall(street: &Street, from: [f64; 2], place: [f64; 2]) -> bool {
    let mut walls = street.outlines.iter().filter(|outline| outline.kind == StreetKind::Wall);
    walls.any(|wall| stands_between(from, place, &edges(&wall.corners_m)))
}

/// Whether the line of sight from `a` to `b` crosses one of the edges.
fn stands_between(a: [f64; 2], b: [f64; 2], edges: &[[[f64; 2]; 2]]) -> bool {
    edges.iter().any(|[c, d]| cross(a, b, *c, *d))
}

/// Sides of an outline, each by its ends.
type Edges = Vec<[[f64; 2]; 2]>;

/// The sides of a polygon; of two points the line between them.
fn edges(corners_m: &[[f64; 2]]) -> Edges {
    let next = corners_m.iter().cycle().skip(1);
    corners_m.iter().zip(next).map(|(a, b)| [*a, *b]).collect()
}

/// Whether the segments from `a` to `b` and from `c` to `d` cross, touching not counted.
fn cross(a: [f64; 2], b: [f64; 2], c: [f64; 2], d: [f64; 2]) -> bool {
    let side = |p: [f64; 2], q: [f64; 2], r: [f64; 2]| {
        (q[0] - p[0]) * (r[1] - p[1]) - (q[1] - p[1]) * (r[0] - p[0])
    };
    side(a, b, c) * side(a, b, d) < 0.0 && side(c, d, a) * side(c, d, b) < 0.0
}
