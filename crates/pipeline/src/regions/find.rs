//! Regions of a frame: detection along range, and the bins around each peak, still and turned to boresight.

use super::options::{RegionChainOptions, Rotation};
use super::result::RegionCounts;
use crate::chain::channels_of;
use crate::decoding::signs_of;
use crate::error::PipelineError;
use crate::options::usable_range_m;
use boresight_aoa::{Data, Estimator, EstimatorOptions, Method};
use boresight_core::correction::Correction;
use boresight_core::steering::steering_vector;
use boresight_core::{Array, Complex32, Complex64, Direction, InputError, Waveform};
use boresight_math::error::check_range;
use boresight_math::order::{descending, sort_descending};
use boresight_math::phasor::cis;
use boresight_signal::peaks::{Peak, group_peaks};
use boresight_signal::range::{range_doppler_coupling_m, range_of_bin_m};
use boresight_signal::region::{
    crop_region, range_power, range_spectrum, region_covariance, region_snapshots,
};
use boresight_signal::{BinNoise, Cfar, CfarAxes, CfarOptions, Region, Window, load_diagonal};
use ndarray::{Array2, Array3, ArrayView3, ArrayView4, Axis, Zip};
use std::f64::consts::PI;

/// Most looks of detection; it takes more for no more than so many.
const MOST_LOOKS: usize = 1024;

/// A plan for finding the regions of frames of one waveform seen by one array.
pub struct RegionFinder {
    waveform: Waveform,
    receivers: usize,
    array: Array,
    /// Channel of the cube of each element.
    channels: Vec<usize>,
    options: RegionChainOptions,
    limits: Region,
    cfar: Cfar,
    beam: Estimator,
}

/// A region that was found, ready for estimators.
#[derive(Debug, Clone, PartialEq)]
pub struct FoundRegion {
    /// Its strongest peak.
    pub peak: Peak,
    /// Its middle, the strongest bin under the window of regions.
    pub range_bin: usize,
    /// Range of the peak, m, corrected for the range rate.
    pub range_m: f64,
    /// Range rate by the phase between loops, m/s.
    pub rate_mps: f64,
    /// Peaks that belong to it.
    pub peaks: usize,
    /// Direction of its echoes together, rad.
    pub coarse_azimuth_rad: f64,
    /// Whether that direction was turned to boresight.
    pub rotated: bool,
    /// Range bins x elements x chirps; still, and turned if `rotated`.
    pub region: Array3<Complex32>,
}

impl FoundRegion {
    /// Its vectors as [`region_snapshots`]: elements x (bins x chirps).
    pub fn snapshots(&self) -> Array2<Complex64> {
        region_snapshots(self.region.view())
    }

    /// Its covariance as [`region_covariance`], loaded by a share of the mean element power.
    pub fn covariance(&self, loading: f64) -> Array2<Complex64> {
        let mut covariance = region_covariance(self.region.view());
        load_diagonal(&mut covariance, loading);
        covariance
    }

    /// The sine of the true azimuth of a direction in the region.
    pub fn sine(&self, direction: Direction) -> f64 {
        let offset = direction.azimuth_rad.sin();
        if self.rotated { offset + self.coarse_azimuth_rad.sin() } else { offset }
    }
}

/// Regions of a frame, strongest first, and what was left out.
#[derive(Debug, Clone, PartialEq)]
pub struct FoundRegions {
    /// The regions.
    pub regions: Vec<FoundRegion>,
    /// Power of each range bin, mean over elements and chirps, as detection saw it.
    pub profile: Vec<f64>,
    /// What was left out.
    pub counts: RegionCounts,
}

impl RegionFinder {
    /// Plans for frames of `waveform.loops` x `waveform.transmitters` x receivers x
    /// `waveform.samples`, whose channels are elements of the array as in [`crate::Chain::new`].
    ///
    /// # Errors
    /// [`InputError::Incompatible`] for real samples, which no network of regions was trained on; [`InputError::OutOfRange`]
    /// for options out of range, and where frames have fewer range bins or loops than a
    /// region; [`PipelineError::Channels`] for an array of other channels; [`PipelineError::Multiplexing`] for transmitters
    /// that send at once; what detection says of its window.
    pub fn new(
        waveform: &Waveform,
        receivers: usize,
        array: &Array,
        options: &RegionChainOptions,
    ) -> Result<Self, PipelineError> {
        options.check()?;
        waveform.check()?;
        waveform.check_complex()?;
        let Waveform { loops, transmitters, samples, .. } = *waveform;
        check_range("region bins", options.size.bins as f64, 1.0, samples as f64)?;
        check_range("region chirps", options.size.chirps as f64, 1.0, loops as f64)?;
        if !waveform.multiplexing.is_time_division() {
            return Err(PipelineError::Multiplexing);
        }
        let channels = channels_of(array, transmitters, receivers)?;
        let cfar = CfarOptions {
            axes: CfarAxes::Range,
            looks: loops.saturating_mul(channels.len()).min(MOST_LOOKS),
            noise: [Some(BinNoise::new(options.range_window, samples, 1)), None],
            ..options.cfar
        };
        let single = EstimatorOptions { max_peaks: 1, ..EstimatorOptions::default() };
        let usable = || usable_range_m(waveform);
        Ok(Self {
            waveform: *waveform,
            receivers,
            array: array.clone(),
            channels,
            options: *options,
            limits: Region {
                range_m: options.region.range_m.or_else(|| Some(usable())),
                ..options.region
            },
            cfar: Cfar::new(samples, 1, &cfar)?,
            beam: Estimator::new(Method::Bartlett, array, &single)?,
        })
    }

    /// The array.
    pub fn array(&self) -> &Array {
        &self.array
    }

    /// The waveform.
    pub fn waveform(&self) -> &Waveform {
        &self.waveform
    }

    /// The limits, with the range they have where none was given.
    pub fn limits(&self) -> &Region {
        &self.limits
    }

    /// The regions of a frame of loops x transmitters x receivers x samples.
    ///
    /// Peaks over range are taken from the strongest on. One that lies within the bins of a region is part of that
    /// region; every other begins its own. Bins wrap, as the transform's do. Regions may overlap, so around each peak
    /// that is not part of a region its main lobe is set to zero there.
    ///
    /// # Errors
    /// Another shape than planned; samples that are not finite.
    pub fn find(
        &mut self,
        frame: ArrayView4<'_, Complex32>,
    ) -> Result<FoundRegions, PipelineError> {
        let RegionChainOptions { range_window, region_window, .. } = self.options;
        let spectrum = self.spectrum(frame, region_window)?;
        let power = range_power(spectrum.view());
        let profile = if range_window == region_window {
            power.clone()
        } else {
            range_power(self.spectrum(frame, range_window)?.view())
        };
        let map = Array2::from_shape_fn((profile.len(), 1), |(bin, _)| profile[bin] as f32);
        let over = self.cfar.detect(map.view())?;
        let grouped = group_peaks(map.view(), &over);
        let mut counts = RegionCounts {
            cells_over_threshold: over.len(),
            grouped: grouped.grouped,
            ..RegionCounts::default()
        };
        let mut marks: Vec<Mark> =
            grouped.peaks.iter().map(|peak| self.mark(spectrum.view(), *peak)).collect();
        sort_descending(&mut marks, |mark| mark.peak.power);
        let groups = self.groups(&marks, &mut counts);
        let regions =
            groups.iter().map(|group| self.region(spectrum.view(), &power, &marks, group));
        Ok(FoundRegions { regions: regions.collect::<Result<_, _>>()?, profile, counts })
    }

    /// Loops x elements x range bins, without the known errors of the array.
    fn spectrum(
        &self,
        frame: ArrayView4<'_, Complex32>,
        window: Window,
    ) -> Result<Array3<Complex32>, PipelineError> {
        let Waveform { loops, transmitters, samples, .. } = self.waveform;
        let shape = [loops, transmitters, self.receivers, samples];
        if frame.shape() != shape {
            return Err(InputError::Shape {
                what: "frame".into(),
                expected: format!("{shape:?}"),
                given: frame.shape().to_vec(),
            }
            .into());
        }
        let mut spectrum = range_spectrum(frame, window)?;
        if let Some(correction) = self.array.correction() {
            for mut loop_of in spectrum.outer_iter_mut() {
                for mut bin in loop_of.columns_mut() {
                    let wide = |z: &Complex32| Complex64::new(z.re.into(), z.im.into());
                    let mut channels: Vec<Complex64> = bin.iter().map(wide).collect();
                    correction.apply(&mut channels);
                    let narrow = |z: &Complex64| Complex32::new(z.re as f32, z.im as f32);
                    bin.iter_mut().zip(&channels).for_each(|(to, from)| *to = narrow(from));
                }
            }
        }
        let mut spectrum = spectrum.select(Axis(1), &self.channels);
        for (mut element, sign) in spectrum.axis_iter_mut(Axis(1)).zip(signs_of(&self.array)) {
            element.mapv_inplace(|z| z * sign as f32);
        }
        Ok(spectrum)
    }

    /// Where a peak is and how its phase turns.
    fn mark(&self, spectrum: ArrayView3<'_, Complex32>, peak: Peak) -> Mark {
        let rows = spectrum.index_axis(Axis(2), peak.detection.range_bin);
        let loops = rows.len_of(Axis(0));
        let turn: Complex32 = (1..loops)
            .map(|at| {
                Zip::from(rows.row(at))
                    .and(rows.row(at - 1))
                    .fold(Complex32::default(), |sum, z, y| sum + z * y.conj())
            })
            .sum();
        let phase_rad = f64::from(turn.arg());
        let rate_mps = phase_rad / PI * self.waveform.max_rate_mps();
        Mark { peak, phase_rad, rate_mps, range_m: self.range_m(peak.range_bin, rate_mps) }
    }

    /// The peaks of each region, by number, the strongest first; regions by their strongest.
    fn groups(&self, marks: &[Mark], counts: &mut RegionCounts) -> Vec<Vec<usize>> {
        let mut groups: Vec<Vec<usize>> = vec![];
        let reach = self.reach();
        for (number, mark) in marks.iter().enumerate() {
            if !self.limits.contains(mark.range_m, mark.rate_mps) {
                counts.outside_region += 1;
                continue;
            }
            let bin = mark.bin();
            let holds = |group: &&mut Vec<usize>| self.steps(marks[group[0]].bin(), bin) <= reach;
            if let Some(group) = groups.iter_mut().find(holds) {
                group.push(number);
                counts.joined += 1;
            } else {
                groups.push(vec![number]);
            }
        }
        counts.beyond_limit = groups.len().saturating_sub(self.options.max_regions);
        groups.truncate(self.options.max_regions);
        groups
    }

    /// The bins around the first peak of a group, without the peaks of others, still, and turned where that is asked
    /// for.
    fn region(
        &mut self,
        spectrum: ArrayView3<'_, Complex32>,
        power: &[f64],
        marks: &[Mark],
        group: &[usize],
    ) -> Result<FoundRegion, PipelineError> {
        let first = marks[group[0]];
        let (bins, samples) = (self.options.size.bins, self.waveform.samples);
        // A window may move the maximum to a neighbour.
        let beside = [0, 1, samples - 1].map(|step| (first.bin() + step) % samples);
        let range_bin = beside
            .into_iter()
            .fold(first.bin(), |best, bin| if power[bin] > power[best] { bin } else { best });
        let mut region = crop_region(spectrum, range_bin, bins, self.options.size.chirps)?;
        let guard = self.options.cfar.guard_cells[0];
        let (own, others): (Vec<_>, Vec<_>) =
            (0..marks.len()).partition(|number| group.contains(number));
        for (at, mut part) in region.outer_iter_mut().enumerate() {
            let bin = (range_bin + samples - bins / 2 + at) % samples;
            let near = |numbers: &[usize]| {
                numbers.iter().any(|&number| self.steps(marks[number].bin(), bin) <= guard)
            };
            let is_beyond = self.steps(range_bin, bin) > self.reach();
            if is_beyond || (near(&others) && !near(&own)) {
                part.fill(Complex32::default());
            }
        }
        let transmitters = self.waveform.transmitters as f64;
        let still = |element: usize, chirp: usize| {
            let transmitter = (self.channels[element] / self.receivers) as f64;
            cis(-first.phase_rad * (chirp as f64 + transmitter / transmitters))
        };
        turn(&mut region, still);
        let coarse_azimuth_rad = self.coarse(region.view())?;
        let rotated = match self.options.rotation {
            Rotation::Never => false,
            Rotation::Outside => coarse_azimuth_rad.abs() > self.options.sector_rad,
            Rotation::Always => true,
        };
        if rotated {
            let response = steering_vector(&self.array, Direction::azimuth(coarse_azimuth_rad));
            turn(&mut region, |element, _| response[element].conj());
        }
        Ok(FoundRegion {
            peak: first.peak,
            range_bin,
            range_m: first.range_m,
            rate_mps: first.rate_mps,
            peaks: group.len(),
            coarse_azimuth_rad,
            rotated,
            region,
        })
    }

    /// Direction of a region's echoes, rad. Neighbours of an evenly spaced array differ in phase by the mean over the
    /// echoes, weighted by their powers, so that two lie to either side. Of another array it is the highest point of
    /// the conventional beamformer.
    fn coarse(&mut self, region: ArrayView3<'_, Complex32>) -> Result<f64, PipelineError> {
        let covariance = region_covariance(region);
        if let [first, second, ..] = self.array.positions()
            && self.array.is_uniform()
        {
            let turn: Complex64 = (1..self.array.len()).map(|k| covariance[[k, k - 1]]).sum();
            let sine = turn.arg() / (PI * (second[1] - first[1]));
            return Ok(sine.clamp(-1.0, 1.0).asin());
        }
        let snapshots = region.len_of(Axis(0)) * region.len_of(Axis(2));
        let data = Data::Covariance { matrix: covariance.view(), snapshots };
        let estimate = self.beam.estimate(data)?;
        if let Some(source) = estimate.sources.first() {
            return Ok(source.direction.azimuth_rad);
        }
        // The highest point is an end of the grid, and no peak.
        let spectrum = estimate.spectrum.unwrap_or_default();
        let best = descending(spectrum.values).first().copied().unwrap_or_default();
        Ok(spectrum.azimuth_rad.get(best).copied().unwrap_or_default())
    }

    /// Bins on each side of the middle that count.
    fn reach(&self) -> usize {
        let half = self.options.size.bins / 2;
        self.options.reach_bins.map_or(half, |reach| reach.min(half))
    }

    /// Steps between two range bins the shorter way round.
    fn steps(&self, a: usize, b: usize) -> usize {
        let apart = a.abs_diff(b);
        apart.min(self.waveform.samples - apart)
    }

    /// Range of a bin that need not be whole, m, corrected for the range rate.
    pub(super) fn range_m(&self, bin: f64, rate_mps: f64) -> f64 {
        range_of_bin_m(&self.waveform, self.waveform.samples, bin)
            - range_doppler_coupling_m(&self.waveform, rate_mps)
            - self.array.correction().map_or(0.0, Correction::range_bias_m)
    }
}

/// A peak over range with what its bin says.
#[derive(Debug, Clone, Copy)]
struct Mark {
    peak: Peak,
    /// From one loop to the next, mean over elements and loops.
    phase_rad: f64,
    rate_mps: f64,
    range_m: f64,
}

impl Mark {
    fn bin(&self) -> usize {
        self.peak.detection.range_bin
    }
}

/// Multiplies a region of range bins x elements x chirps by a factor of element and chirp.
fn turn(region: &mut Array3<Complex32>, factor: impl Fn(usize, usize) -> Complex64) {
    let (_, elements, chirps) = region.dim();
    let factors = Array2::from_shape_fn((elements, chirps), |(element, chirp)| {
        let factor = factor(element, chirp);
        Complex32::new(factor.re as f32, factor.im as f32)
    });
    for mut bin in region.outer_iter_mut() {
        bin *= &factors;
    }
}
