//! The chain for one frame.

use crate::beam::suited;
use crate::decoding::signs_of;
use crate::error::PipelineError;
use crate::folds::Folds;
use crate::options::{ChainOptions, usable_range_m};
use crate::result::{Counts, DetectedCell, Detection, FrameCells, FrameResult, clipped};
use boresight_aoa::{
    AoaError, CountSources, Data, Estimate, Estimator, EstimatorOptions, Estimators, Method,
};
use boresight_core::correction::Correction;
use boresight_core::{Array, Complex32, Complex64, Direction, Multiplexing, Remark, Waveform};
use boresight_math::decibels::power_to_db;
use boresight_math::order::sort_descending;
use boresight_options::remark::Coded;
use boresight_signal::peaks::{Peak, group_peaks, interpolate};
use boresight_signal::range::{range_doppler_coupling_m, range_of_bin_m};
use boresight_signal::{
    Cfar, CfarOptions, RangeDoppler, RangeDopplerMap, Region, doppler_division,
};
use ndarray::{Array1, Array3, ArrayView2, ArrayView3, ArrayView4, Axis};
use std::sync::Arc;

/// Least power in decibels of an empty cell, so that plots and tables need no infinities.
const FLOOR_DB: f64 = -300.0;

/// A plan for frames of one waveform seen by one array.
pub struct Chain {
    options: ChainOptions,
    array: Array,
    /// Channel of the cube (`tx * receivers + rx`) of each element of the array.
    pub(crate) channels: Vec<usize>,
    /// Sign that each of them is multiplied by ([`signs_of`]).
    pub(crate) signs: Vec<f64>,
    pub(crate) region: Region,
    pub(crate) transform: RangeDoppler,
    pub(crate) map: RangeDopplerMap,
    pub(crate) cfar: Cfar,
    pub(crate) folds: Option<Folds>,
    pub(crate) estimators: Estimators,
}

/// A cell to estimate angles in.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Cell {
    pub peak: Peak,
    pub range_m: f64,
    pub rate_mps: f64,
    /// Fold of the rate and its probability, if others were tried.
    pub fold: i32,
    pub fold_probability: Option<f64>,
}

/// Cells found in a power map.
pub(crate) struct Found {
    pub cells: Vec<Cell>,
    pub counts: Counts,
}

impl Chain {
    /// Plans for frames of `waveform.loops` x chirps of a loop x receivers x `waveform.samples`, whose channels are the elements of `array`: those of a MIMO array by
    /// their transmitter and receiver; of an array of plain positions, element `k` is channel
    /// `tx * receivers + rx`. What a calibrated array ([`Array::calibrated`]) knows of its errors is
    /// taken off snapshots and ranges.
    ///
    /// # Errors
    /// [`PipelineError::Channels`] if the array has other channels than the frames; what the steps
    /// say of their options.
    pub fn new(
        waveform: &Waveform,
        receivers: usize,
        array: &Array,
        options: &ChainOptions,
    ) -> Result<Self, PipelineError> {
        let ChainOptions { angle, threads, .. } = options;
        // Options are checked before: what suits the array is found on a grid.
        let estimators = || {
            let suited = suited(angle.method, array, &angle.options);
            Estimators::new(angle.method, array, &suited, *threads)
        };
        Self::plan(waveform, receivers, array, options, estimators)
    }

    /// As [`Chain::new`], with the sources of each cell counted by `counter` where the options ask for it.
    ///
    /// # Errors
    /// As [`Chain::new`] and [`Estimators::counted`].
    pub fn counted(
        waveform: &Waveform,
        receivers: usize,
        array: &Array,
        options: &ChainOptions,
        counter: &Arc<dyn CountSources>,
    ) -> Result<Self, PipelineError> {
        let ChainOptions { angle, threads, .. } = options;
        let estimators = || {
            let suited = suited(angle.method, array, &angle.options);
            Estimators::counted(angle.method, array, &suited, *threads, counter)
        };
        Self::plan(waveform, receivers, array, options, estimators)
    }

    /// As [`Chain::new`] with estimators made elsewhere, for that array: those of a network.
    ///
    /// # Errors
    /// As [`Chain::new`].
    pub fn with_estimators(
        waveform: &Waveform,
        receivers: usize,
        array: &Array,
        options: &ChainOptions,
        estimators: Estimators,
    ) -> Result<Self, PipelineError> {
        Self::plan(waveform, receivers, array, options, || Ok(estimators))
    }

    fn plan(
        waveform: &Waveform,
        receivers: usize,
        array: &Array,
        options: &ChainOptions,
        estimators: impl FnOnce() -> Result<Estimators, AoaError>,
    ) -> Result<Self, PipelineError> {
        options.check()?;
        waveform.check()?;
        let channels = channels_of(array, waveform.transmitters, receivers)?;
        let transform = RangeDoppler::new(waveform, receivers, &options.range_doppler)?;
        let map = transform.output();
        let (ranges, dopplers) = map.power.dim();
        let cfar = Cfar::new(ranges, dopplers, &cfar_options(options, &transform))?;
        Ok(Self {
            options: *options,
            array: array.clone(),
            region: Region {
                range_m: options.region.range_m.or_else(|| Some(usable_range_m(waveform))),
                ..options.region
            },
            transform,
            map,
            cfar,
            folds: Folds::new(waveform, array, &channels, options.doppler_folds)?,
            channels,
            signs: signs_of(array).collect(),
            estimators: estimators()?,
        })
    }

    /// The array.
    pub fn array(&self) -> &Array {
        &self.array
    }

    /// The options.
    pub fn options(&self) -> &ChainOptions {
        &self.options
    }

    /// The waveform.
    pub fn waveform(&self) -> &Waveform {
        self.transform.waveform()
    }

    /// Range of each range bin, m.
    pub fn range_m(&self) -> &[f64] {
        self.transform.range_m()
    }

    /// Range rate of each Doppler bin, m/s, ascending.
    pub fn rate_mps(&self) -> &[f64] {
        self.transform.rate_mps()
    }

    /// Detections in one frame of loops x chirps of a loop x receivers x samples.
    ///
    /// # Errors
    /// Another shape than planned; samples that are not finite; a method that needs more than one
    /// snapshot without averaging or smoothing.
    pub fn process(
        &mut self,
        frame: ArrayView4<'_, Complex32>,
    ) -> Result<FrameResult, PipelineError> {
        let (found, snapshots) = self.find(frame)?;
        self.conclude(found, snapshots.view())
    }

    /// Detected cells of one frame of loops x chirps of a loop x receivers x samples, without angles.
    ///
    /// # Errors
    /// Another shape than planned; samples that are not finite.
    pub fn cells(&mut self, frame: ArrayView4<'_, Complex32>) -> Result<FrameCells, PipelineError> {
        let (found, snapshots) = self.find(frame)?;
        Ok(frame_cells(found, snapshots))
    }

    /// Cells of a frame, and a snapshot of each: cells x elements x 1.
    fn find(
        &mut self,
        frame: ArrayView4<'_, Complex32>,
    ) -> Result<(Found, Array3<Complex64>), PipelineError> {
        self.transform.process(frame, &mut self.map)?;
        let mut found = self.detect()?;
        let mut raw = Array3::zeros((found.cells.len(), self.transform.channels(), 1));
        for (cell, mut rows) in found.cells.iter().zip(raw.outer_iter_mut()) {
            rows.index_axis_mut(Axis(1), 0).assign(&self.raw_snapshot(cell)?);
        }
        let snapshots = self.decoded(&mut found, &raw)?;
        Ok((found, snapshots))
    }

    /// The array's snapshot of a cell of the frame processed last, told apart by transmitters,
    /// their Doppler phase taken off.
    ///
    /// # Errors
    /// A bin outside the map.
    pub fn cell_snapshot(
        &self,
        range_bin: usize,
        doppler_bin: usize,
    ) -> Result<Array1<Complex64>, PipelineError> {
        let raw = self.map.snapshot(range_bin, doppler_bin)?.insert_axis(Axis(1));
        Ok(self.cell_snapshots_of(raw.view(), doppler_bin)?.column(0).to_owned())
    }

    /// Angles and spectrum of snapshots (elements x snapshots) of one cell, by any method, under the
    /// same adjustments as in the chain (see [`ChainOptions::angle`]).
    ///
    /// # Errors
    /// What the method says of array, options and snapshots.
    pub fn cell_spectrum(
        &self,
        snapshots: ArrayView2<'_, Complex64>,
        method: Method,
        options: &EstimatorOptions,
    ) -> Result<Estimate, PipelineError> {
        options.check()?;
        let options = suited(method, &self.array, options);
        let mut estimator = Estimator::new(method, &self.array, &options)?;
        Ok(estimator.estimate(Data::Snapshots(snapshots))?)
    }

    /// Cells of the power map above the threshold, grouped, within the region and the limit,
    /// strongest first.
    pub(crate) fn detect(&mut self) -> Result<Found, PipelineError> {
        let power = self.map.power.view();
        let over = self.cfar.detect(power)?;
        let mut counts = Counts { cells_over_threshold: over.len(), ..Counts::default() };
        let peaks = if self.options.peak_grouping {
            let grouped = group_peaks(power, &over);
            counts.grouped = grouped.grouped;
            grouped.peaks
        } else {
            over.iter().map(|detection| interpolate(power, *detection)).collect()
        };
        let mut cells: Vec<Cell> = peaks.into_iter().map(|peak| self.cell(peak)).collect();
        counts.other_bands = Region::retain(&mut cells, |cell| {
            let at = cell.peak.detection;
            !self.is_ghost([at.range_bin, at.doppler_bin])
        });
        if self.options.region.range_m.is_none() {
            let [nearest, furthest] = usable_range_m(self.waveform());
            counts.outside_usable_range =
                Region::retain(&mut cells, |cell| (nearest..=furthest).contains(&cell.range_m));
        }
        // The rate is not known before its fold.
        let rate_mps = if self.folds.is_some() { None } else { self.region.rate_mps };
        let region = Region { rate_mps, ..self.region };
        counts.outside_region =
            Region::retain(&mut cells, |cell| region.contains(cell.range_m, cell.rate_mps));
        sort_descending(&mut cells, |cell| cell.peak.power);
        counts.beyond_limit = cells.len().saturating_sub(self.options.max_detections);
        cells.truncate(self.options.max_detections);
        Ok(Found { cells, counts })
    }

    /// Whether a cell of the power map is the echo of a stronger target in another Doppler band, in Doppler division.
    pub(crate) fn is_ghost(&self, [range_bin, doppler_bin]: [usize; 2]) -> bool {
        let (waveform, power) = (self.waveform(), self.map.power.view());
        waveform.multiplexing == Multiplexing::DopplerDivision
            && doppler_division::is_ghost(power, range_bin, doppler_bin, waveform)
    }

    pub(crate) fn cell(&self, peak: Peak) -> Cell {
        let rates = self.transform.rate_mps();
        let step = match rates {
            [first, second, ..] => second - first,
            _ => 0.0,
        };
        let rate_mps = rates.first().copied().unwrap_or_default() + step * peak.doppler_bin;
        let range_m = self.cell_range_m(&peak, rate_mps);
        Cell { peak, range_m, rate_mps, fold: 0, fold_probability: None }
    }

    pub(crate) fn cell_range_m(&self, peak: &Peak, rate_mps: f64) -> f64 {
        let waveform = self.transform.waveform();
        let bins = self.transform.range_m().len();
        range_of_bin_m(waveform, bins, peak.range_bin)
            - range_doppler_coupling_m(waveform, rate_mps)
            - self.array.correction().map_or(0.0, Correction::range_bias_m)
    }

    /// Angles in the cells found in the power map, of which `snapshots` has cells x elements x
    /// snapshots, and everything a result holds.
    pub(crate) fn conclude(
        &mut self,
        found: Found,
        snapshots: ArrayView3<'_, Complex64>,
    ) -> Result<FrameResult, PipelineError> {
        let Found { cells, mut counts } = found;
        let estimates = self.estimators.estimate_batch(snapshots, false)?;
        let mut detections = vec![];
        for (index, cell) in cells.iter().enumerate() {
            let sources = estimates.sources_of(index);
            counts.without_angle += usize::from(sources.is_empty());
            detections.extend(sources.iter().map(|s| detection(cell, *s.direction, s.power)));
        }
        counts.outside_region += Region::retain(&mut detections, |d| {
            let direction = Direction::new(d.azimuth_rad, d.elevation_rad);
            self.region.contains_direction(d.range_m, direction)
        });
        sort_descending(&mut detections, |detection| detection.power);
        counts.beyond_limit += detections.len().saturating_sub(self.options.max_detections);
        detections.truncate(self.options.max_detections);
        let mut warnings: Vec<Remark> =
            estimates.warnings.iter().map(|w| Remark::new(w.first.code(), w.to_string())).collect();
        warnings.extend(counts.remarks(usable_range_m(self.waveform())));
        warnings.extend(clipped(counts.clipped_samples));
        let told = self.folds.as_ref().map_or(1, Folds::told);
        let profile = self.transform.range_profile(&self.map)?;
        Ok(FrameResult {
            frame: 0,
            frames: 1,
            calibrated: self.array.correction().is_some(),
            range_m: self.transform.range_m().to_vec(),
            rate_mps: self.transform.rate_mps().to_vec(),
            unambiguous_rate_mps: self.transform.waveform().max_rate_mps() * told as f64,
            range_profile_db: profile.into_iter().map(floored_db).collect(),
            range_doppler_db: self.map.power.mapv(|p| floored_db(f64::from(p)) as f32),
            detections,
            counts,
            warnings,
        })
    }
}

/// Cells with their snapshots, without angles.
pub(crate) fn frame_cells(found: Found, snapshots: Array3<Complex64>) -> FrameCells {
    let cell = |cell: &Cell| {
        let found = cell.peak.detection;
        DetectedCell {
            range_m: cell.range_m,
            rate_mps: cell.rate_mps,
            doppler_fold: cell.fold,
            power: cell.peak.power,
            snr: found.power / found.noise_power.max(f64::MIN_POSITIVE),
            range_bin: found.range_bin,
            doppler_bin: found.doppler_bin,
        }
    };
    FrameCells { cells: found.cells.iter().map(cell).collect(), snapshots, counts: found.counts }
}

fn detection(cell: &Cell, direction: Direction, power: f64) -> Detection {
    let found = cell.peak.detection;
    // What windows and transforms lose between bins, the parabolas give back.
    let straddling = if found.power > 0.0 { cell.peak.power / found.power } else { 1.0 };
    let [x_m, y_m, z_m] = direction.place_m(cell.range_m);
    Detection {
        frame: 0,
        range_m: cell.range_m,
        rate_mps: cell.rate_mps,
        doppler_fold: cell.fold,
        fold_probability: cell.fold_probability,
        azimuth_rad: direction.azimuth_rad,
        elevation_rad: direction.elevation_rad,
        x_m,
        y_m,
        z_m,
        power: power * straddling,
        snr: power / found.noise_power.max(f64::MIN_POSITIVE),
        range_bin: found.range_bin,
        doppler_bin: found.doppler_bin,
    }
}

/// Decibels of a power, no less than [`FLOOR_DB`].
fn floored_db(power: f64) -> f64 {
    power_to_db(power).max(FLOOR_DB)
}

/// Guard and training cells for padded transforms, and what follows from windows and channels.
fn cfar_options(options: &ChainOptions, transform: &RangeDoppler) -> CfarOptions {
    let padding = [options.range_doppler.range_padding, options.range_doppler.doppler_padding];
    let padded = |cells: [usize; 2]| [0, 1].map(|axis| cells[axis].saturating_mul(padding[axis]));
    CfarOptions {
        guard_cells: padded(options.cfar.guard_cells),
        training_cells: padded(options.cfar.training_cells),
        looks: transform.channels(),
        noise: transform.bin_noise(),
        ..options.cfar
    }
}

/// The channel of the frames each element of the array is.
pub(crate) fn channels_of(
    array: &Array,
    transmitters: usize,
    receivers: usize,
) -> Result<Vec<usize>, PipelineError> {
    let given = |what: String| PipelineError::Channels {
        expected: format!("{transmitters} transmitters x {receivers} receivers"),
        given: what,
    };
    let (tx, rx) = (array.tx().len(), array.rx().len());
    if (tx, rx) == (transmitters, receivers) {
        return Ok(array.channels().iter().map(|c| c.tx * receivers + c.rx).collect());
    }
    if tx == 1 && array.len() == transmitters * receivers {
        return Ok((0..array.len()).collect());
    }
    Err(given(format!("has {tx} transmitters x {rx} receivers, {} elements", array.len())))
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;
    use boresight_simulate::waveform_awr1642;

    #[test]
    fn guard_and_training_cells_grow_with_the_padding_of_their_axis() {
        let mut options = ChainOptions::default();
        (options.range_doppler.range_padding, options.range_doppler.doppler_padding) = (1, 4);
        (options.cfar.guard_cells, options.cfar.training_cells) = ([3, 1], [5, 2]);
        let transform = RangeDoppler::new(&waveform_awr1642(), 4, &options.range_doppler).unwrap();
        let padded = cfar_options(&options, &transform);
        assert_eq!((padded.guard_cells, padded.training_cells), ([3, 4], [5, 8]));
    }
}
