//! Peaks of a spectrum on the grid.

use crate::grid::Grid;
use crate::options::EstimatorOptions;
use boresight_core::{Array, Direction};

/// A local maximum.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Peak {
    /// Where the parabola through its neighbours, in dB, has its top.
    pub direction: Direction,
    /// Linear value at the grid point.
    pub value: f64,
    /// Grid point, elevation-major.
    pub index: usize,
}

/// Finds peaks within the field of view, the sector without grating lobes and the dynamic range.
#[derive(Debug, Clone)]
pub struct PeakFinder {
    /// Period of the spectrum in `sin(azimuth)`, for elements on a lattice.
    period: Option<f64>,
    /// Whether the last azimuth's right neighbour is the first one.
    wraps: bool,
    /// Whether the azimuth grid ends where angles end, so that a maximum there counts.
    closed: bool,
    range: f64,
    most: usize,
}

impl PeakFinder {
    /// For spectra of an array on a grid; of the options, dynamic range and number of peaks count.
    pub fn new(array: &Array, grid: &Grid, options: &EstimatorOptions) -> Self {
        let spacing = array.lattice().map(|lattice| lattice.spacing);
        let whole = grid.sines.len() == grid.full_points;
        Self {
            period: spacing.map(|spacing| 2.0 / spacing),
            wraps: whole && spacing.is_some_and(|d| (d - d.round()).abs() < 1e-9 && d > 0.5),
            closed: whole,
            range: 10f64.powf(-options.dynamic_range_db / 10.0),
            most: options.max_peaks,
        }
    }

    /// Peaks within the dynamic range of the strongest, strongest first.
    pub fn find(&self, grid: &Grid, values: &[f64]) -> Vec<Peak> {
        let mut peaks = Vec::new();
        self.find_into(grid, values, &mut peaks);
        peaks
    }

    /// The same into a vector whose memory is used again.
    pub fn find_into(&self, grid: &Grid, values: &[f64], peaks: &mut Vec<Peak>) {
        self.maxima(grid, values, peaks);
        let floor = peaks.first().map_or(0.0, |peak| peak.value * self.range);
        peaks.retain(|peak| peak.value >= floor);
        peaks.truncate(self.most);
    }

    /// The `count` highest peaks, whatever their height.
    pub fn highest(&self, grid: &Grid, values: &[f64], count: usize) -> Vec<Peak> {
        let mut peaks = Vec::new();
        self.maxima(grid, values, &mut peaks);
        peaks.truncate(count);
        peaks
    }

    fn maxima(&self, grid: &Grid, values: &[f64], peaks: &mut Vec<Peak>) {
        let azimuths = grid.azimuth_rad.len();
        let elevations = grid.elevation_rad.len();
        debug_assert_eq!(values.len(), azimuths * elevations);
        peaks.clear();
        for e in 0..elevations {
            if elevations > 1 && (e == 0 || e + 1 == elevations) {
                continue;
            }
            let row = &values[e * azimuths..(e + 1) * azimuths];
            for a in 0..azimuths {
                // Most points are told by the neighbours that need no care.
                if (a > 0 && row[a - 1] >= row[a]) || (a + 1 < azimuths && row[a + 1] > row[a]) {
                    continue;
                }
                if self.is_maximum(values, azimuths, elevations, a, e) {
                    peaks.push(self.interpolated(grid, values, a, e));
                }
            }
        }
        boresight_math::order::sort_in_place(peaks, |p, q| {
            q.value.total_cmp(&p.value).then(p.index.cmp(&q.index)).is_lt()
        });
        self.within_one_period(grid, peaks);
    }

    /// Index of the azimuth beside `a`, if there is one.
    fn beside(&self, azimuths: usize, a: usize, step: isize) -> Option<usize> {
        match a.checked_add_signed(step) {
            Some(b) if b < azimuths => Some(b),
            _ if self.wraps => Some((a + azimuths).saturating_add_signed(step) % azimuths),
            _ => None,
        }
    }

    fn is_maximum(
        &self,
        v: &[f64],
        azimuths: usize,
        elevations: usize,
        a: usize,
        e: usize,
    ) -> bool {
        let here = v[e * azimuths + a];
        let mut rises = false;
        for de in -1..=1isize {
            let Some(row) = e.checked_add_signed(de).filter(|&row| row < elevations) else {
                continue;
            };
            for da in -1..=1isize {
                if da == 0 && de == 0 {
                    continue;
                }
                let Some(column) = self.beside(azimuths, a, da) else {
                    if self.closed {
                        continue;
                    }
                    return false;
                };
                let there = v[row * azimuths + column];
                let before = de < 0 || (de == 0 && da < 0);
                if there > here || (before && there == here) || here.is_nan() {
                    return false;
                }
                rises |= here > there;
            }
        }
        rises
    }

    fn interpolated(&self, grid: &Grid, v: &[f64], a: usize, e: usize) -> Peak {
        let azimuths = grid.azimuth_rad.len();
        let at = |e: usize, a: usize| v[e * azimuths + a];
        let beside = |step| self.beside(azimuths, a, step);
        let mut sine = grid.sines[a];
        if let (Some(left), Some(right)) = (beside(-1), beside(1)) {
            let step = 2.0 / grid.full_points as f64;
            sine += step * parabola_top(at(e, left), at(e, a), at(e, right));
        }
        let mut elevation_rad = grid.elevation_rad[e];
        if e > 0 && e + 1 < grid.elevation_rad.len() {
            let step = grid.elevation_rad[1] - grid.elevation_rad[0];
            elevation_rad += step * parabola_top(at(e - 1, a), at(e, a), at(e + 1, a));
        }
        if sine < -1.0 && self.wraps {
            sine += 2.0;
        }
        let azimuth_rad = sine.clamp(-1.0, 1.0).asin();
        let index = e * azimuths + a;
        Peak { direction: Direction::new(azimuth_rad, elevation_rad), value: v[index], index }
    }

    /// Where the lattice is coarser than one half wavelength, moves every peak into the sector
    /// without grating lobes and keeps one of those that coincide there.
    fn within_one_period(&self, grid: &Grid, peaks: &mut Vec<Peak>) {
        let Some(period) = self.period.filter(|&period| period < 2.0 - 1e-9) else {
            return;
        };
        let step = 2.0 / grid.full_points as f64;
        let mut kept: Vec<Peak> = Vec::with_capacity(peaks.len());
        for peak in peaks.iter() {
            let sine = wrap(peak.direction.azimuth_rad.sin(), period);
            let same =
                |other: &Peak| wrap(other.direction.azimuth_rad.sin() - sine, period).abs() < step;
            if !kept.iter().any(same) {
                let direction = Direction::azimuth(sine.clamp(-1.0, 1.0).asin());
                kept.push(Peak { direction, ..*peak });
            }
        }
        *peaks = kept;
    }
}

/// `x` moved by whole periods into `[-period / 2, period / 2)`.
pub(crate) fn wrap(x: f64, period: f64) -> f64 {
    x - period * (x / period + 0.5).floor()
}

/// Offset, in steps within -0.5..=0.5, of the top of the parabola through the logarithms of three
/// values, the middle one being the largest.
pub(crate) fn parabola_top(left: f64, middle: f64, right: f64) -> f64 {
    let log = |x: f64| x.clamp(f64::MIN_POSITIVE, f64::MAX).ln();
    let (l, m, r) = (log(left), log(middle), log(right));
    let bend = l - 2.0 * m + r;
    if bend < 0.0 { (0.5 * (l - r) / bend).clamp(-0.5, 0.5) } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn finder(array: &Array, options: &EstimatorOptions) -> (PeakFinder, Grid) {
        let grid = Grid::new(array, options);
        (PeakFinder::new(array, &grid, options), grid)
    }

    #[test]
    fn a_gaussian_lobe_is_found_between_grid_points() {
        let options = EstimatorOptions { grid_points: 128, ..EstimatorOptions::default() };
        let (finder, grid) = finder(&Array::ula(4).unwrap(), &options);
        // In dB a Gaussian is a parabola, so interpolation is exact.
        let lobe = |u: f64, at: f64| (-((u - at) / 0.05).powi(2)).exp();
        let values: Vec<f64> =
            grid.sines.iter().map(|&u| lobe(u, 0.3037) + 1e-3 * lobe(u, -0.5)).collect();
        let peaks = finder.find(&grid, &values);
        assert_eq!(peaks.len(), 1, "the second lobe is 30 dB down");
        assert!((peaks[0].direction.azimuth_rad.sin() - 0.3037).abs() < 1e-9);
        assert_eq!(finder.highest(&grid, &values, 5).len(), 2);
    }

    #[test]
    fn the_grid_of_a_half_wavelength_lattice_is_a_circle() {
        let options = EstimatorOptions { grid_points: 64, ..EstimatorOptions::default() };
        let (finder, grid) = finder(&Array::ula(4).unwrap(), &options);
        let values: Vec<f64> =
            grid.sines.iter().map(|&u| (-(wrap(u - 0.995, 2.0) / 0.1).powi(2)).exp()).collect();
        let peaks = finder.find(&grid, &values);
        assert_eq!(peaks.len(), 1);
        assert!((peaks[0].direction.azimuth_rad.sin() - 0.995).abs() < 1e-9, "{peaks:?}");
    }

    #[test]
    fn grating_lobes_count_once() {
        let options = EstimatorOptions { grid_points: 100, ..EstimatorOptions::default() };
        let array = Array::new(&[[0.0; 3], [0.0, 3.0, 0.0]]).unwrap();
        let (finder, grid) = finder(&array, &options);
        let period = 2.0 / 3.0;
        let values: Vec<f64> =
            grid.sines.iter().map(|&u| (-(wrap(u - 0.9, period) / 0.05).powi(2)).exp()).collect();
        let peaks = finder.find(&grid, &values);
        assert_eq!(peaks.len(), 1);
        let wanted = wrap(0.9, period);
        assert!((peaks[0].direction.azimuth_rad.sin() - wanted).abs() < 1e-6, "{peaks:?}");
    }

    #[test]
    fn slopes_toward_the_edge_and_flat_spectra_have_no_peak() {
        let options = EstimatorOptions { field_of_view_rad: 0.5, ..EstimatorOptions::default() };
        let (finder, grid) = finder(&Array::ula(4).unwrap(), &options);
        let rising: Vec<f64> = grid.sines.iter().map(|&u| u.exp()).collect();
        assert!(finder.find(&grid, &rising).is_empty());
        assert!(finder.find(&grid, &vec![1.0; grid.len()]).is_empty());
        assert!(finder.find(&grid, &vec![f64::NAN; grid.len()]).is_empty());
    }

    #[test]
    fn a_lobe_over_two_angles() {
        let array = boresight_core::presets::preset("awr1843").unwrap();
        let (finder, grid) = finder(&array, &EstimatorOptions::default());
        let values: Vec<f64> = (0..grid.len())
            .map(|g| {
                let at = grid.direction(g);
                let (du, de) = (at.azimuth_rad.sin() - 0.2, at.elevation_rad - 0.1);
                (-(du / 0.1).powi(2) - (de / 0.2).powi(2)).exp()
            })
            .collect();
        let peaks = finder.find(&grid, &values);
        assert_eq!(peaks.len(), 1);
        assert!((peaks[0].direction.elevation_rad - 0.1).abs() < 1e-9);
        assert!((peaks[0].direction.azimuth_rad.sin() - 0.2).abs() < 1e-9);
    }
}
