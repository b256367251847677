//! Summation splatting (Niklaus and Liu 2020): each target adds its power to the cells around it,
//! in bilinear (with Doppler: trilinear) shares.

use crate::axis::Axis;
use crate::error::ImageError;
use boresight_core::InputError;
use boresight_core::limits::check_bytes;
use boresight_math::error::{check_finite, check_range};
use boresight_options::Described;
use ndarray::{Array2, Array3, Axis as Dimension, s};
use serde::Serialize;
use std::f64::consts::FRAC_PI_2;

/// Memory of a cell: its power, and a copy for whoever asked.
const CELL_BYTES: usize = 8;

/// Largest power of a target or point.
const MOST_POWER: f64 = 1e30;

/// Largest azimuth either way: a right angle and rounding.
const MOST_AZIMUTH: f64 = FRAC_PI_2 + 1e-9;

/// Where the cells of an image lie.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Grid {
    /// Ranges, m.
    pub range_m: Axis,
    /// Sines of the azimuths.
    pub sine: Axis,
}

impl Grid {
    /// `ranges` points over `range_m`, and `azimuths` points, uniform in sine, over the field of
    /// view of half width `field_of_view_rad`.
    ///
    /// # Errors
    /// [`InputError::OutOfRange`] for a range below 0 or a field of view beyond 90 deg;
    /// [`InputError::TooLarge`] for too many cells.
    pub fn new(
        range_m: [f64; 2],
        ranges: usize,
        field_of_view_rad: f64,
        azimuths: usize,
    ) -> Result<Self, ImageError> {
        check_range("range_m", range_m[0], 0.0, 1e6)?;
        check_range("field_of_view_rad", field_of_view_rad, 1e-3, MOST_AZIMUTH)?;
        let limit = field_of_view_rad.sin();
        let grid = Self {
            range_m: Axis::new("range_m", range_m[0], range_m[1], ranges)?,
            sine: Axis::new("azimuths", -limit, limit, azimuths)?,
        };
        check_bytes("the map", &[ranges, azimuths], CELL_BYTES)?;
        Ok(grid)
    }

    /// Azimuths, rad.
    pub fn azimuth_rad(&self) -> Vec<f64> {
        self.sine.values().into_iter().map(|sine| sine.clamp(-1.0, 1.0).asin()).collect()
    }
}

/// A target to be added.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Target {
    /// Range, m.
    pub range_m: f64,
    /// Range rate, m/s; maps do not look at it.
    pub rate_mps: f64,
    /// Azimuth, rad.
    pub azimuth_rad: f64,
    /// Power, linear.
    pub power: f64,
    /// How sure it is, 0 to 1: a factor of the power.
    pub confidence: f64,
}

/// What fell, in whole or in part, beside the grid.
#[derive(Debug, Clone, Copy, PartialEq, Default, Described, Serialize)]
#[option(name = "OutsideGrid")]
pub struct Outside {
    /// Targets, or points of spectra.
    pub count: usize,
    /// Their power that is not in the image.
    pub power: f64,
}

impl Outside {
    fn add(&mut self, power: f64, inside_share: f64) {
        let share = 1.0 - inside_share;
        if share > 1e-9 {
            self.count += 1;
            self.power += share * power;
        }
    }
}

/// How the points of a spectrum fall on the azimuths of a grid.
///
/// A spectrum is a density over the sine of azimuth: each point stands for its neighbourhood, so
/// that an even spectrum gives an even image whatever the two grids are. Points spread linearly
/// over the wider of the two spacings.
#[derive(Debug, Clone)]
pub struct SpectrumPlan {
    points: Vec<SpectrumPoint>,
}

#[derive(Debug, Clone)]
struct SpectrumPoint {
    /// Its first cell, and the shares of it and the next ones.
    first: usize,
    shares: Vec<f32>,
    /// What all its shares sum up to, and how much of that is beside the grid.
    sum: f64,
    outside: f64,
}

impl SpectrumPlan {
    /// For spectra at ascending azimuths.
    ///
    /// # Errors
    /// [`InputError::OutOfRange`] for fewer than two azimuths, or ones that do not ascend within
    /// -90 to 90 deg.
    pub fn new(azimuth_rad: &[f64], grid: &Grid) -> Result<Self, ImageError> {
        check_range("azimuths of the spectra", azimuth_rad.len() as f64, 2.0, 65_536.0)?;
        for &azimuth in azimuth_rad {
            check_range("azimuth of a spectrum (rad)", azimuth, -MOST_AZIMUTH, MOST_AZIMUTH)?;
        }
        let sines: Vec<f64> = azimuth_rad.iter().map(|azimuth| azimuth.sin()).collect();
        let spacings: Vec<f64> = sines.windows(2).map(|pair| pair[1] - pair[0]).collect();
        if let Some(index) = spacings.iter().position(|&spacing| spacing <= 0.0) {
            return Err(InputError::OutOfRange {
                what: format!("azimuth {} of the spectra (rad)", index + 1),
                expected: "more than the one before".into(),
                given: azimuth_rad[index + 1],
            }
            .into());
        }
        let last = spacings.len() - 1;
        let point = |(i, &sine): (usize, &f64)| {
            let spacing = (spacings[i.saturating_sub(1)] + spacings[i.min(last)]) / 2.0;
            SpectrumPoint::new(sine, spacing, grid.sine)
        };
        Ok(Self { points: sines.iter().enumerate().map(point).collect() })
    }
}

impl SpectrumPoint {
    fn new(sine: f64, spacing: f64, axis: Axis) -> Self {
        let ratio = spacing / axis.step();
        let reach = ratio.max(1.0);
        let position = axis.position(sine);
        let (from, to) = ((position - reach).ceil() as i64, (position + reach).floor() as i64);
        let mut point = Self {
            first: from.clamp(0, axis.len() as i64) as usize,
            shares: vec![],
            sum: 0.0,
            outside: 0.0,
        };
        for cell in from..=to {
            let share = (1.0 - (cell as f64 - position).abs() / reach).max(0.0) * ratio / reach;
            point.sum += share;
            if (0..axis.len() as i64).contains(&cell) {
                point.shares.push(share as f32);
            } else {
                point.outside += share;
            }
        }
        point
    }
}

/// Power over range, range rate and azimuth.
#[derive(Debug, Clone, PartialEq)]
pub struct RangeAzimuthDoppler {
    /// Ranges and sines of azimuth.
    pub grid: Grid,
    /// Range rates, m/s; of a cube without Doppler `None`.
    rate_mps: Option<Axis>,
    /// Range x rate x azimuth, linear.
    pub power: Array3<f32>,
    /// What fell beside it.
    pub outside: Outside,
}

impl RangeAzimuthDoppler {
    /// An empty cube; without `rate_mps` one that is its own sum over Doppler.
    ///
    /// # Errors
    /// [`InputError::TooLarge`].
    pub fn new(grid: Grid, rate_mps: Option<Axis>) -> Result<Self, ImageError> {
        let shape = [grid.range_m.len(), rate_mps.map_or(1, |axis| axis.len()), grid.sine.len()];
        check_bytes("the range-azimuth-Doppler cube", &shape, CELL_BYTES)?;
        Ok(Self { grid, rate_mps, power: Array3::zeros(shape), outside: Outside::default() })
    }

    /// Range rates, m/s; none of a cube without Doppler.
    pub fn rate_mps(&self) -> Option<Axis> {
        self.rate_mps
    }

    /// Adds a target.
    ///
    /// # Errors
    /// Numbers that are not finite, a negative power, a confidence that is none.
    pub fn add_target(&mut self, target: &Target) -> Result<(), ImageError> {
        let Target { range_m, rate_mps, azimuth_rad, power, confidence } = *target;
        check_finite("azimuth_rad", [azimuth_rad])?;
        check_range("confidence", confidence, 0.0, 1.0)?;
        check_range("power", power, 0.0, MOST_POWER)?;
        let power = power * confidence;
        let places = self.places(range_m, rate_mps)?;
        // Behind the radar its image would lie in front of it.
        let is_ahead = azimuth_rad.abs() <= MOST_AZIMUTH;
        let columns = if is_ahead { self.grid.sine.shares(azimuth_rad.sin()) } else { [None; 2] };
        let mut inside = 0.0;
        for Place { row: [range, rate], share } in places.into_iter().flatten() {
            for (column, across) in columns.into_iter().flatten() {
                self.power[[range, rate, column]] += (power * share * across) as f32;
                inside += share * across;
            }
        }
        self.outside.add(power, inside);
        Ok(())
    }

    /// Adds the spectrum of a cell: linear powers at the azimuths of `plan`, which must have been
    /// made for this grid; at several elevations (elevation-major) the strongest of them. With
    /// `level` the spectrum is scaled so that its peak is that, as suits one whose height means
    /// nothing.
    ///
    /// # Errors
    /// Numbers that are not finite, a negative power, another number of points than planned.
    pub fn add_spectrum(
        &mut self,
        plan: &SpectrumPlan,
        range_m: f64,
        rate_mps: f64,
        power: &[f32],
        level: Option<f64>,
    ) -> Result<(), ImageError> {
        let points = plan.points.len();
        if power.is_empty() || !power.len().is_multiple_of(points) {
            let (what, expected) = ("a spectrum".into(), format!("[{points}] or a multiple"));
            return Err(InputError::Shape { what, expected, given: vec![power.len()] }.into());
        }
        let valid = |power: f32| (0.0..=f32::MAX).contains(&power);
        if let Some(index) = power.iter().position(|&power| !valid(power)) {
            let (what, given) = (format!("power {index} of a spectrum"), power[index].into());
            let expected = "a finite number from 0".into();
            return Err(InputError::OutOfRange { what, expected, given }.into());
        }
        check_range("level", level.unwrap_or(0.0), 0.0, MOST_POWER)?;
        let places = self.places(range_m, rate_mps)?;
        // Pseudo-spectra may be as high as numbers go; sums of what is added stay finite.
        let most = MOST_POWER as f32;
        let peak = power.iter().copied().fold(0.0_f32, f32::max).min(most);
        let gain = match level {
            Some(level) if peak > 0.0 => level / f64::from(peak),
            _ => 1.0,
        };
        let strongest = |point: usize| {
            let elevations = power[point..].iter().step_by(points).copied();
            f64::from(elevations.fold(0.0_f32, f32::max).min(most)) * gain
        };
        let inside: f64 = places.iter().flatten().map(|place| place.share).sum();
        let mut row = vec![0.0_f32; self.grid.sine.len()];
        for (index, point) in plan.points.iter().enumerate() {
            let power = strongest(index);
            let cells = row[point.first..].iter_mut().zip(&point.shares);
            cells.for_each(|(cell, share)| *cell += share * power as f32);
            self.outside.add(power * point.sum, inside * (1.0 - point.outside / point.sum));
        }
        for Place { row: [range, rate], share } in places.into_iter().flatten() {
            let cells = self.power.slice_mut(s![range, rate, ..]);
            cells.into_iter().zip(&row).for_each(|(cell, power)| *cell += power * share as f32);
        }
        Ok(())
    }

    /// The rows, by range and rate, around a place, and their shares in it.
    fn places(&self, range_m: f64, rate_mps: f64) -> Result<[Option<Place>; 4], ImageError> {
        check_finite("range_m and rate_mps", [range_m, rate_mps])?;
        let ranges = self.grid.range_m.shares(range_m);
        let rates = match self.rate_mps {
            Some(axis) => axis.shares(rate_mps),
            None => [Some((0, 1.0)), None],
        };
        let place = |a: usize, b: usize| {
            let ((range, along), (rate, across)) = (ranges[a]?, rates[b]?);
            Some(Place { row: [range, rate], share: along * across })
        };
        Ok([place(0, 0), place(0, 1), place(1, 0), place(1, 1)])
    }

    /// The sum over Doppler.
    pub fn to_map(&self) -> RangeAzimuthMap {
        RangeAzimuthMap {
            grid: self.grid,
            power: self.power.sum_axis(Dimension(1)),
            outside: self.outside,
        }
    }
}

/// A row of a cube, at one range and rate, and its share in a place between rows.
struct Place {
    row: [usize; 2],
    share: f64,
}

/// Power over range and azimuth.
#[derive(Debug, Clone, PartialEq)]
pub struct RangeAzimuthMap {
    /// Ranges and sines of azimuth.
    pub grid: Grid,
    /// Range x azimuth, linear.
    pub power: Array2<f32>,
    /// What fell beside it.
    pub outside: Outside,
}
