//! Regions of the range spectrum and the targets in each, as in Figure 4 of Sang et al., "DoA Estimation for FMCW
//! Radar by 3D-CNN" (2021): detection along range (CFAR), a region around each peak, a count of its targets, and the
//! angles of one or of two.
//!
//! [`RegionFinder`] finds regions. [`RegionChain`] hands each to a [`Counted`]: a counting network with networks for
//! one and for two targets, or any counter with estimators of a method. [`RegionChain::joint`] needs no networks: it
//! estimates ranges and azimuths jointly ([`RangeAngle`]) and adds targets while they are significant.
//!
//! What goes beyond the paper: the Doppler phase of the strongest peak is taken off a region, between transmitters
//! and between chirps, so that what moves looks like what stands; and a region is turned to its coarse angle, so that
//! networks for +-10 deg about boresight apply anywhere. Turning is exact for elements along a line: an answer `a`
//! means the azimuth whose sine is `sin a` plus the sine of the coarse angle. Degrees of answers so stretch by the
//! inverse cosine of the azimuth: at 60 deg one step is 2 deg.

mod find;
mod options;
mod result;

pub use find::{FoundRegion, FoundRegions, RegionFinder};
pub use options::{RegionChainOptions, Rotation};
pub use result::{RegionCounts, RegionFrame, RegionTarget, TargetRegion};

use crate::beam::mismatch_left_db;
use crate::capture::{Report, proceed};
use crate::error::PipelineError;
use crate::result::clipped;
use crate::source::FrameSource;
use boresight_aoa::{
    Counted, Data, EstimatorOptions, RangeAngle, RangeAngleTarget, SourceCount, Warning,
};
use boresight_core::Progress;
use boresight_core::steering::steering_matrix;
use boresight_core::{Array, Complex32, Complex64, Direction, InputError, Remark, Waveform};
use boresight_math::linalg::least_squares;
use boresight_math::order::sort_descending;
use boresight_options::decibels::finite_db;
use boresight_options::remark::Coded;
use boresight_signal::Window;
use boresight_signal::cfar::Detection;
use boresight_signal::peaks::interpolate;
use boresight_signal::range::{range_axis_m, range_of_bin_m};
use ndarray::{Array2, ArrayView4, Axis};
use std::ops::Range;

/// A plan for regions and their targets.
pub struct RegionChain {
    finder: RegionFinder,
    targets: Targets,
}

/// Estimator of the targets of a region.
enum Targets {
    Counted { counted: Box<Counted>, loading: f64 },
    Joint(Box<RangeAngle>),
}

/// The targets of a region.
struct Found {
    sources: usize,
    probability: Vec<f64>,
    targets: Vec<RegionTarget>,
    beyond_horizon: usize,
    warnings: Vec<Warning>,
}

impl RegionChain {
    /// Plans for frames as [`RegionFinder::new`]; the array is that of `counted`.
    ///
    /// # Errors
    /// As [`RegionFinder::new`].
    pub fn new(
        waveform: &Waveform,
        receivers: usize,
        options: &RegionChainOptions,
        counted: Counted,
    ) -> Result<Self, PipelineError> {
        let finder = RegionFinder::new(waveform, receivers, counted.array(), options)?;
        Ok(Self {
            finder,
            targets: Targets::Counted {
                counted: Box::new(counted),
                loading: options.count_loading,
            },
        })
    }

    /// Prepares for frames as [`RegionFinder::new`], with joint range-angle estimation instead of networks. Ignores the
    /// options `rotation`, `refine` and `count_loading`. With time-division multiplexing, the azimuth of a target is
    /// biased if its range rate differs from that of the strongest target of its region.
    ///
    /// # Errors
    /// Those of [`RegionFinder::new`] and [`RangeAngle::new`]; [`InputError::Incompatible`] if `region_window` is not
    /// rectangular, since other windows correlate the noise of neighbouring bins.
    pub fn joint(
        waveform: &Waveform,
        receivers: usize,
        array: &Array,
        options: &RegionChainOptions,
    ) -> Result<Self, PipelineError> {
        if options.region_window != Window::Rectangular {
            return Err(PipelineError::from(InputError::Incompatible {
                what: "window of regions without networks".into(),
                expected: Window::Rectangular.name().into(),
                given: options.region_window.name().into(),
            }));
        }
        let still = RegionChainOptions { rotation: Rotation::Never, ..*options };
        let finder = RegionFinder::new(waveform, receivers, array, &still)?;
        let mut angles = EstimatorOptions { sources: SourceCount::Auto, ..Default::default() };
        angles.nomp.false_alarm = options.false_alarm;
        angles.mismatch_db = options.mismatch_db.or_else(|| mismatch_left_db(array));
        let joint = RangeAngle::new(array, waveform.samples, options.size.bins, &angles)?;
        Ok(Self { finder, targets: Targets::Joint(Box::new(joint)) })
    }

    /// The array.
    pub fn array(&self) -> &Array {
        self.finder.array()
    }

    /// The waveform.
    pub fn waveform(&self) -> &Waveform {
        self.finder.waveform()
    }

    /// Regions and targets of one frame of loops x transmitters x receivers x samples.
    ///
    /// # Errors
    /// As [`RegionFinder::find`]; those of the estimators.
    pub fn process(
        &mut self,
        frame: ArrayView4<'_, Complex32>,
    ) -> Result<RegionFrame, PipelineError> {
        let FoundRegions { regions, profile, mut counts } = self.finder.find(frame)?;
        let mut warnings: Vec<Warning> = vec![];
        let mut answered = Vec::with_capacity(regions.len());
        for found in &regions {
            let Found { sources, probability, mut targets, beyond_horizon, warnings: said } =
                self.targets_of(found)?;
            counts.without_target += usize::from(sources == 0);
            counts.beyond_horizon += beyond_horizon;
            let before = targets.len();
            targets.retain(|target| {
                let direction = Direction::azimuth(target.azimuth_rad);
                self.finder.limits().contains_direction(target.range_m, direction)
            });
            counts.outside_region += before - targets.len();
            sort_descending(&mut targets, |target| target.power);
            let noise = found.peak.detection.noise_power.max(f64::MIN_POSITIVE);
            answered.push(TargetRegion {
                range_bin: found.range_bin,
                range_m: found.range_m,
                rate_mps: found.rate_mps,
                power: found.peak.power,
                snr: found.peak.power / noise,
                peaks: found.peaks,
                coarse_azimuth_rad: found.coarse_azimuth_rad,
                rotated: found.rotated,
                sources,
                probability,
                targets,
            });
            for warning in said {
                let is_new = warnings.iter().all(|known| known.code() != warning.code());
                // A region without a target is counted.
                if is_new && warning != Warning::NoSources {
                    warnings.push(warning);
                }
            }
        }
        Ok(RegionFrame {
            frame: 0,
            range_m: range_axis_m(self.waveform(), profile.len()),
            range_profile_db: profile.into_iter().map(finite_db).collect(),
            regions: answered,
            counts,
            warnings: warnings.iter().map(|w| Remark::new(w.code(), w.to_string())).collect(),
        })
    }

    /// Processes the frames in `frames` one by one and hands each result to `take`.
    ///
    /// # Errors
    /// As [`RegionChain::process`] and what the source gives; [`PipelineError::Cancelled`] if `report` breaks.
    pub fn each<S: FrameSource>(
        &mut self,
        source: &S,
        frames: Range<usize>,
        mut take: impl FnMut(RegionFrame),
        report: Report<'_>,
    ) -> Result<(), S::Error> {
        let total = frames.len();
        for (done, index) in frames.enumerate() {
            proceed(report, Progress { done, total })?;
            let frame = source.frame(index)?;
            let mut result = self.process(frame.samples.view())?;
            result.counts.clipped_samples = frame.clipped;
            result.warnings.extend(clipped(frame.clipped));
            result.frame = index;
            take(result);
        }
        proceed(report, Progress { done: total, total })?;
        Ok(())
    }

    fn targets_of(&mut self, found: &FoundRegion) -> Result<Found, PipelineError> {
        let (counted, loading) = match &mut self.targets {
            Targets::Joint(joint) => {
                let estimate = joint.estimate(found.region.view())?;
                let middle = (found.region.len_of(Axis(0)) / 2) as f64;
                let bin_m =
                    range_of_bin_m(self.finder.waveform(), self.finder.waveform().samples, 1.0);
                let target = |target: &RangeAngleTarget| RegionTarget {
                    range_m: self
                        .finder
                        .range_m(target.bin - middle + found.range_bin as f64, found.rate_mps),
                    azimuth_rad: target.azimuth_rad,
                    power: target.power,
                    confidence: None,
                    range_deviation_m: target.bin_deviation.map(|bin| bin * bin_m),
                    azimuth_deviation_rad: target.azimuth_deviation_rad,
                };
                return Ok(Found {
                    sources: estimate.targets.len(),
                    probability: vec![],
                    targets: estimate.targets.iter().map(target).collect(),
                    beyond_horizon: 0,
                    warnings: estimate.warnings,
                });
            }
            Targets::Counted { counted, loading } => (counted, *loading),
        };
        let snapshots = found.snapshots();
        let data = Data::Snapshots(snapshots.view());
        let covariance = found.covariance(loading);
        let (matrix, vectors) = (covariance.view(), snapshots.ncols());
        let count = counted.count(Data::Covariance { matrix, snapshots: vectors })?;
        let estimate = counted.estimate_of(count.sources, data)?;
        let directions: Vec<Direction> = estimate.sources.iter().map(|s| *s.direction).collect();
        let ranges_m = self.ranges_m(found, &directions);
        let mut targets = Vec::with_capacity(directions.len());
        let mut beyond_horizon = 0;
        for (source, range_m) in estimate.sources.iter().zip(ranges_m) {
            let sine = found.sine(*source.direction);
            if sine.abs() > 1.0 {
                beyond_horizon += 1;
                continue;
            }
            targets.push(RegionTarget {
                range_m,
                azimuth_rad: sine.asin(),
                power: source.power,
                confidence: source.confidence,
                range_deviation_m: None,
                azimuth_deviation_rad: None,
            });
        }
        Ok(Found {
            sources: count.sources,
            probability: count.probability.to_vec(),
            targets,
            beyond_horizon,
            warnings: estimate.warnings,
        })
    }

    /// Range of each source, m: that of the bin in which the amplitude that fits best is largest.
    fn ranges_m(&self, found: &FoundRegion, directions: &[Direction]) -> Vec<f64> {
        let region = &found.region;
        let (bins, elements, chirps) = region.dim();
        let steering = steering_matrix(self.array(), directions);
        let columns = region.view().permuted_axes([1, 0, 2]);
        let columns = columns.as_standard_layout();
        let wide = |z: &Complex32| Complex64::new(z.re.into(), z.im.into());
        let Ok(columns) = columns.map(wide).into_shape_with_order((elements, bins * chirps)) else {
            return vec![found.range_m; directions.len()];
        };
        // Directions that cannot be told apart are at the peak.
        let Ok(Some(signals)) = least_squares(steering.view(), columns.view()) else {
            return vec![found.range_m; directions.len()];
        };
        let of = |row: ndarray::ArrayView1<'_, Complex64>| {
            let power = |bin: usize| {
                let chirps = row.iter().skip(bin * chirps).take(chirps);
                chirps.map(|z| z.norm_sqr()).sum::<f64>() as f32
            };
            let map = Array2::from_shape_fn((bins, 1), |(bin, _)| power(bin));
            let best = strongest(&map);
            let cell = Detection {
                range_bin: best,
                doppler_bin: 0,
                power: map[[best, 0]].into(),
                noise_power: 0.0,
                threshold: 0.0,
            };
            let bin = interpolate(map.view(), cell).range_bin - (bins / 2) as f64;
            self.finder.range_m(bin + found.range_bin as f64, found.rate_mps)
        };
        signals.axis_iter(Axis(0)).map(of).collect()
    }
}

fn strongest(map: &Array2<f32>) -> usize {
    (0..map.nrows()).max_by(|&a, &b| map[[a, 0]].total_cmp(&map[[b, 0]])).unwrap_or_default()
}
