//! One peak out of the detections a target makes, and where it lies between the cells.

use crate::cfar::Detection;
use ndarray::ArrayView2;

/// A local maximum of the power map.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Peak {
    /// The cell.
    pub detection: Detection,
    /// Where the maximum lies between the cells, in range bins.
    pub range_bin: f64,
    /// Where the maximum lies between the cells, in Doppler bins, from -0.5 to the number of bins
    /// less 0.5.
    pub doppler_bin: f64,
    /// Power at the maximum, of the parabolas through the cell and its neighbours.
    pub power: f64,
}

/// Peaks and what was left out.
#[derive(Debug, Clone, PartialEq)]
pub struct Peaks {
    /// Peaks, in the order of the detections.
    pub peaks: Vec<Peak>,
    /// Detections on the slope of another peak.
    pub grouped: usize,
}

/// Keeps the detections that are the largest of their eight neighbours, Doppler wrapping, and
/// interpolates them. Of equal neighbours the first in range and Doppler stays.
///
/// Detections outside the map are counted as grouped.
pub fn group_peaks(power: ArrayView2<f32>, detections: &[Detection]) -> Peaks {
    let peaks: Vec<Peak> = detections
        .iter()
        .filter(|detection| is_peak(power, detection))
        .map(|detection| interpolate(power, *detection))
        .collect();
    let grouped = detections.len() - peaks.len();
    Peaks { peaks, grouped }
}

/// A detection with the vertex of the parabolas, in dB, through it and its neighbours along range
/// and along Doppler. At the edge of the range axis it stays at its bin.
pub fn interpolate(power: ArrayView2<f32>, detection: Detection) -> Peak {
    let (ranges, dopplers) = power.dim();
    let Detection { range_bin: r, doppler_bin: d, .. } = detection;
    let at = |r: usize, d: usize| f64::from(power[[r, d % dopplers]]);
    let along_range = if r > 0 && r + 1 < ranges {
        vertex([at(r - 1, d), at(r, d), at(r + 1, d)])
    } else {
        (0.0, 0.0)
    };
    let along_doppler = if dopplers > 2 {
        vertex([at(r, d + dopplers - 1), at(r, d), at(r, d + 1)])
    } else {
        (0.0, 0.0)
    };
    Peak {
        detection,
        range_bin: r as f64 + along_range.0,
        doppler_bin: d as f64 + along_doppler.0,
        power: detection.power * (along_range.1 + along_doppler.1).exp(),
    }
}

/// Offset of the vertex of the parabola through the logarithms of three powers at -1, 0 and 1,
/// within half a cell, and its height over the middle (natural logarithm of power).
fn vertex(powers: [f64; 3]) -> (f64, f64) {
    if powers.iter().any(|&p| p <= 0.0) {
        return (0.0, 0.0);
    }
    let [a, b, c] = powers.map(f64::ln);
    let curvature = a - 2.0 * b + c;
    if curvature >= 0.0 {
        return (0.0, 0.0);
    }
    let offset = (0.5 * (a - c) / curvature).clamp(-0.5, 0.5);
    (offset, -0.25 * (a - c) * offset)
}

/// The peak that a cell belongs to: where going on to the strongest of eight neighbours ends, Doppler wrapping. It is the
/// cell itself where [`group_peaks`] keeps it; nothing for a cell outside the map.
pub fn peak_of(
    power: ArrayView2<f32>,
    [mut range_bin, mut doppler_bin]: [usize; 2],
) -> Option<[usize; 2]> {
    let (ranges, dopplers) = power.dim();
    if range_bin >= ranges || doppler_bin >= dopplers {
        return None;
    }
    loop {
        let here = (range_bin, doppler_bin);
        let best = neighbours(power.dim(), here)
            .fold(here, |best, cell| if outranks(power, cell, best) { cell } else { best });
        if best == here {
            return Some([range_bin, doppler_bin]);
        }
        (range_bin, doppler_bin) = best;
    }
}

fn is_peak(power: ArrayView2<f32>, detection: &Detection) -> bool {
    let (ranges, dopplers) = power.dim();
    let here = (detection.range_bin, detection.doppler_bin);
    here.0 < ranges
        && here.1 < dopplers
        && neighbours(power.dim(), here).all(|cell| !outranks(power, cell, here))
}

/// The cells around a cell, Doppler wrapping.
fn neighbours(
    (ranges, dopplers): (usize, usize),
    (r, d): (usize, usize),
) -> impl Iterator<Item = (usize, usize)> {
    let rows = r.saturating_sub(1)..(r + 2).min(ranges);
    rows.flat_map(move |row| [dopplers - 1, 0, 1].map(|step| (row, (d + step) % dopplers)))
        .filter(move |cell| *cell != (r, d))
}

/// Whether a cell is the stronger of two, of equal ones the first.
fn outranks(power: ArrayView2<f32>, cell: (usize, usize), other: (usize, usize)) -> bool {
    power[cell] > power[other] || (power[cell] == power[other] && cell < other)
}

#[cfg(test)]
mod tests {
    use super::*;
    use ndarray::Array2;

    fn detection(range_bin: usize, doppler_bin: usize, power: f64) -> Detection {
        Detection { range_bin, doppler_bin, power, noise_power: 1.0, threshold: 2.0 }
    }

    /// A Gaussian bump, whose logarithm is a parabola, on a map of 12 x 16.
    fn bump(range: f64, doppler: f64) -> Array2<f32> {
        Array2::from_shape_fn((12, 16), |(r, d)| {
            let dr = r as f64 - range;
            let dd = (d as f64 - doppler + 8.0).rem_euclid(16.0) - 8.0;
            (100.0 * (-0.7 * dr * dr - 0.4 * dd * dd).exp()) as f32
        })
    }

    fn all(map: &Array2<f32>) -> Vec<Detection> {
        map.indexed_iter()
            .filter(|(_, p)| **p > 1.0)
            .map(|((r, d), &p)| detection(r, d, p.into()))
            .collect()
    }

    #[test]
    fn a_target_is_one_peak_where_it_is_across_the_wrap() {
        for (range, doppler) in [(5.3, 7.2), (6.0, -0.4), (4.6, 15.4), (3.49, 8.0)] {
            let map = bump(range, doppler);
            let detections = all(&map);
            let found = group_peaks(map.view(), &detections);
            assert_eq!(found.peaks.len(), 1);
            assert_eq!(found.grouped, detections.len() - 1);
            let peak = found.peaks[0];
            assert!((peak.range_bin - range).abs() < 1e-5);
            let error = (peak.doppler_bin - doppler + 8.0).rem_euclid(16.0) - 8.0;
            assert!(error.abs() < 1e-5, "{error}");
            assert!((peak.power - 100.0).abs() < 1e-3);
            assert!((-0.5..15.5).contains(&peak.doppler_bin));
        }
    }

    #[test]
    fn plateaus_keep_one_cell_and_edges_stay_whole() {
        let map = Array2::from_elem((3, 5), 2.0_f32);
        let found = group_peaks(map.view(), &all(&map));
        assert_eq!((found.peaks.len(), found.grouped), (1, 14));
        let mut map = Array2::from_elem((3, 1), 0.0_f32);
        map[[0, 0]] = 4.0;
        let found = group_peaks(map.view(), &[detection(0, 0, 4.0), detection(9, 9, 4.0)]);
        assert_eq!((found.peaks[0].range_bin, found.grouped), (0.0, 1));
    }
}
