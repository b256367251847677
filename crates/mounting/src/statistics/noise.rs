//! How detections scatter about the Doppler curve of their scan.

use super::frames::Frame;
use super::robust::{deviation, median};
use super::{Noise, Row, Untold};
use boresight_math::linalg::small::{add_outer, inverse, times};

/// Azimuths at which the noise is told, deg, and how far on either side detections count for it.
const AT_DEG: [f64; 4] = [0.0, 30.0, 50.0, 65.0];
const WITHIN_DEG: f64 = 5.0;

/// Beyond this a detection has nothing to do with the curve; from this it is a soft outlier, m/s.
const OUTLIER_MPS: f64 = 1.0;
const SOFT_MPS: f64 = 0.3;

/// Groups by slope at one azimuth, and the fewest detections of a group.
const GROUPS: usize = 10;
const LEAST_GROUP: usize = 50;

/// Unknown variances: of range rate at standstill, its growth with the square of the speed, and of
/// azimuth at each place.
const UNKNOWNS: usize = 2 + AT_DEG.len();

/// A detection near one of the azimuths.
struct Near {
    slope_mps: f64,
    speed_mps: f64,
    residual_mps: f64,
}

/// Shares of outliers, and standard deviations of range rate and azimuth. A detection's residual has
/// the variance `sigma_d^2 + growth v^2 + slope^2 sigma_a^2`: at each azimuth and side the slope grows
/// with the speed `v`, and is small along the car's way, so weighted least squares through the
/// variances of groups of equal slope tells all of them.
pub(super) fn noise(frames: &[Frame], untold: &mut Vec<Untold>) -> Noise {
    let mut near: Vec<Vec<Near>> = (0..2 * AT_DEG.len()).map(|_| vec![]).collect();
    let (mut outliers, mut soft, mut all) = (0_u64, 0_u64, 0_u64);
    for frame in frames {
        let speed_mps = frame.speed_mps();
        for residual in frame.residuals() {
            let size = residual.residual_mps.abs();
            all += 1;
            outliers += u64::from(size > OUTLIER_MPS);
            soft += u64::from((SOFT_MPS..=OUTLIER_MPS).contains(&size));
            let azimuth_deg = residual.azimuth_rad.to_degrees();
            for (place, at_deg) in AT_DEG.iter().enumerate() {
                if (azimuth_deg.abs() - at_deg).abs() < WITHIN_DEG && size < 3.0 * OUTLIER_MPS {
                    near[2 * place + usize::from(azimuth_deg < 0.0)].push(Near {
                        slope_mps: residual.slope_mps.abs(),
                        speed_mps,
                        residual_mps: residual.residual_mps,
                    });
                }
            }
        }
    }
    let share = |count: u64| count as f64 / all as f64;
    let mut result = Noise {
        outlier_share: share(outliers),
        soft_outlier_share: share(soft),
        range_rate_sigma_mps: f64::NAN,
        azimuth_sigma_rad: [f64::NAN; 4],
    };
    if all == 0 {
        let why = "no scan shows the radar's motion at more than 3 m/s";
        untold.push(Untold::new(Row::Outliers, why));
        untold.push(Untold::new(Row::Noise, why));
        return result;
    }
    let speeds: Vec<f64> = frames.iter().map(Frame::speed_mps).collect();
    let Some((variances, seen)) = variances(&mut near) else {
        untold.push(Untold::new(Row::Noise, "the speeds are too alike, or the detections too few"));
        return result;
    };
    let typical = median(&speeds);
    result.range_rate_sigma_mps = (variances[0] + variances[1] * typical * typical).sqrt();
    for (place, sigma) in result.azimuth_sigma_rad.iter_mut().enumerate() {
        if seen[place] {
            *sigma = variances[place + 2].sqrt();
        }
    }
    result
}

/// The unknown variances, none of them negative, and for each place whether it was seen.
fn variances(near: &mut [Vec<Near>]) -> Option<([f64; UNKNOWNS], [bool; AT_DEG.len()])> {
    let mut rows: Vec<([f64; UNKNOWNS], f64, f64)> = vec![];
    let mut seen = [false; AT_DEG.len()];
    for (at, ones) in near.iter_mut().enumerate() {
        if ones.len() < 4 * LEAST_GROUP {
            continue;
        }
        seen[at / 2] = true;
        boresight_math::order::sort_ascending(ones, |one| one.slope_mps);
        for group in ones.chunks((ones.len() / GROUPS).max(LEAST_GROUP)) {
            let count = group.len() as f64;
            let mean = |of: fn(&Near) -> f64| group.iter().map(of).sum::<f64>() / count;
            let residuals: Vec<f64> = group.iter().map(|one| one.residual_mps).collect();
            let variance = deviation(&residuals, 0.0).powi(2).max(1e-12);
            let mut row = [0.0; UNKNOWNS];
            row[0] = 1.0;
            row[1] = mean(|one| one.speed_mps * one.speed_mps);
            row[2 + at / 2] = mean(|one| one.slope_mps * one.slope_mps);
            // A variance by `count` values is good to its own size times root 2 / count.
            rows.push((row, variance, count / (2.0 * variance * variance)));
        }
    }
    if rows.is_empty() {
        return None;
    }
    let mut used = [true; UNKNOWNS];
    for (place, seen) in seen.iter().enumerate() {
        used[place + 2] = *seen;
    }
    // What comes out negative is left out, the most negative first.
    for _ in 0..=UNKNOWNS {
        let (mut normal, mut right) = ([[0.0; UNKNOWNS]; UNKNOWNS], [0.0; UNKNOWNS]);
        for (row, variance, weight) in &rows {
            let row: [f64; UNKNOWNS] = std::array::from_fn(|i| if used[i] { row[i] } else { 0.0 });
            add_outer(&mut normal, &row, *weight);
            for (right, value) in right.iter_mut().zip(row) {
                *right += weight * value * variance;
            }
        }
        for (i, used) in used.iter().enumerate() {
            if !used {
                normal[i][i] = 1.0;
            }
        }
        let found = times(&inverse(&normal)?, &right);
        let lowest = (0..UNKNOWNS).min_by(|a, b| found[*a].total_cmp(&found[*b]))?;
        if found[lowest] >= 0.0 {
            return Some((found, seen));
        }
        used[lowest] = false;
    }
    None
}
