//! The chain over several frames.

use crate::chain::{Chain, Found, frame_cells};
use crate::error::PipelineError;
use crate::result::{Detection, FrameCells, FrameResult};
use crate::source::FrameSource;
use boresight_core::Progress;
use boresight_core::{Complex64, InputError, Remark};
use ndarray::{Array2, Array3, Axis};
use std::ops::{ControlFlow, Range};

/// Most snapshots kept for one cell when frames are combined; further frames still count in the
/// power map.
const MAX_SNAPSHOTS: usize = 1024;

/// Called between frames; breaking stops the run.
pub(crate) type Report<'a> = &'a mut dyn FnMut(Progress) -> ControlFlow<()>;

impl Chain {
    /// Processes the frames in `frames` one by one and hands each result to `take`.
    ///
    /// # Errors
    /// As [`Chain::process`] and what the source gives; [`PipelineError::Cancelled`] if `report`
    /// breaks.
    pub fn each<S: FrameSource>(
        &mut self,
        source: &S,
        frames: Range<usize>,
        mut take: impl FnMut(FrameResult),
        report: Report<'_>,
    ) -> Result<(), S::Error> {
        let total = frames.len();
        for (done, index) in frames.enumerate() {
            proceed(report, Progress { done, total })?;
            let frame = source.frame(index)?;
            let mut result = self.process(frame.samples.view())?;
            result.set_clipped(frame.clipped);
            result.frame = index;
            result.detections.iter_mut().for_each(|d| d.frame = index);
            take(result);
        }
        proceed(report, Progress { done: total, total })?;
        Ok(())
    }

    /// Processes the frames in `frames` together: cells are found in the mean of their power maps,
    /// and angles estimated from one snapshot a frame, which methods that need a covariance call
    /// for. Targets have to stay in their range and Doppler cell over the frames.
    ///
    /// Frames are read twice, so that memory does not grow with their number; the report counts
    /// both readings.
    ///
    /// # Errors
    /// As [`Chain::each`]; [`InputError::Empty`] without frames.
    pub fn combine<S: FrameSource>(
        &mut self,
        source: &S,
        frames: Range<usize>,
        report: Report<'_>,
    ) -> Result<FrameResult, S::Error> {
        let count = frames.len();
        let (found, snapshots) = self.find_in_mean(source, frames.clone(), report)?;
        let mut result = self.conclude(found, snapshots.view())?;
        proceed(report, Progress { done: 2 * count, total: 2 * count })?;
        result.frame = frames.start;
        result.frames = count;
        result.detections.iter_mut().for_each(|d| d.frame = frames.start);
        self.remark_on_motion(&mut result);
        Ok(result)
    }

    /// Cells of the frames in `frames` together, as [`Chain::combine`] finds them, without angles.
    ///
    /// # Errors
    /// As [`Chain::combine`].
    pub fn combined_cells<S: FrameSource>(
        &mut self,
        source: &S,
        frames: Range<usize>,
        report: Report<'_>,
    ) -> Result<FrameCells, S::Error> {
        let (found, snapshots) = self.find_in_mean(source, frames, report)?;
        Ok(frame_cells(found, snapshots))
    }

    /// Cells in the mean of the frames' power maps, which is then the map, and their snapshots:
    /// cells x elements x frames.
    fn find_in_mean<S: FrameSource>(
        &mut self,
        source: &S,
        frames: Range<usize>,
        report: Report<'_>,
    ) -> Result<(Found, Array3<Complex64>), S::Error> {
        let clipped = self.average(source, frames.clone(), report)?;
        let mut found = self.detect()?;
        found.counts.clipped_samples = clipped;
        let snapshots = self.snapshots_of(&mut found, source, frames, report)?;
        Ok((found, snapshots))
    }

    /// Makes the mean of the frames' power maps the map, and counts clipped samples: the first half of combining.
    pub(crate) fn average<S: FrameSource>(
        &mut self,
        source: &S,
        frames: Range<usize>,
        report: Report<'_>,
    ) -> Result<usize, S::Error> {
        let count = frames.len();
        if count == 0 {
            let empty =
                InputError::Empty { what: "frames".into(), expected: "at least one".into() };
            return Err(PipelineError::from(empty).into());
        }
        let total = 2 * count;
        let mut mean = Array2::<f64>::zeros(self.map.power.dim());
        let mut clipped = 0;
        for (done, index) in frames.clone().enumerate() {
            proceed(report, Progress { done, total })?;
            clipped += self.load(source, index)?;
            mean.zip_mut_with(&self.map.power, |sum, &p| *sum += f64::from(p));
        }
        let mean = mean.mapv(|sum| (sum / count as f64) as f32);
        self.map.power.assign(&mean);
        Ok(clipped)
    }

    /// Snapshots of cells, cells x elements x frames, whose folds it tells; the map stays the mean that it is. The second
    /// half of combining.
    pub(crate) fn snapshots_of<S: FrameSource>(
        &mut self,
        found: &mut Found,
        source: &S,
        frames: Range<usize>,
        report: Report<'_>,
    ) -> Result<Array3<Complex64>, S::Error> {
        let mean = self.map.power.clone();
        let count = frames.len();
        let used = count.min(MAX_SNAPSHOTS);
        let mut raw = Array3::zeros((found.cells.len(), self.transform.channels(), used));
        for (done, index) in frames.take(used).enumerate() {
            proceed(report, Progress { done: count + done, total: 2 * count })?;
            self.load(source, index)?;
            for (cell, mut rows) in found.cells.iter().zip(raw.outer_iter_mut()) {
                rows.index_axis_mut(Axis(1), done).assign(&self.raw_snapshot(cell)?);
            }
        }
        self.map.power.assign(&mean);
        Ok(self.decoded(found, &raw)?)
    }

    /// A target that leaves its range cell makes several detections, one behind the other.
    fn remark_on_motion(&self, result: &mut FrameResult) {
        let waveform = self.waveform();
        let time_s = (result.frames - 1) as f64 * waveform.frame_interval_s;
        let cell_m = waveform.range_resolution_m();
        let moving = |d: &&Detection| d.rate_mps.abs() * time_s > cell_m;
        let count = result.detections.iter().filter(moving).count();
        if count > 0 {
            let message = format!(
                "{count} detections move through more than one range cell in {time_s:.2} s; \
                 frames by themselves suit them better"
            );
            result.warnings.push(Remark::new("moving-targets", message));
        }
    }

    /// Snapshots (elements x frames) of one cell.
    ///
    /// # Errors
    /// A bin outside the map; what the source gives; [`InputError::OutOfRange`] for more frames
    /// than are kept.
    pub fn cell_snapshots<S: FrameSource>(
        &mut self,
        source: &S,
        frames: Range<usize>,
        range_bin: usize,
        doppler_bin: usize,
    ) -> Result<Array2<Complex64>, S::Error> {
        let most = MAX_SNAPSHOTS as f64;
        boresight_math::error::check_range("number of frames", frames.len() as f64, 1.0, most)
            .map_err(PipelineError::from)?;
        let mut raw = Array2::zeros((self.transform.channels(), frames.len()));
        for (n, index) in frames.enumerate() {
            self.load(source, index)?;
            let snapshot =
                self.map.snapshot(range_bin, doppler_bin).map_err(PipelineError::from)?;
            raw.column_mut(n).assign(&snapshot);
        }
        Ok(self.cell_snapshots_of(raw.view(), doppler_bin)?)
    }

    /// Transforms a frame and tells how many of its samples are clipped.
    fn load<S: FrameSource>(&mut self, source: &S, index: usize) -> Result<usize, S::Error> {
        let frame = source.frame(index)?;
        self.transform.process(frame.samples.view(), &mut self.map).map_err(PipelineError::from)?;
        Ok(frame.clipped)
    }
}

pub(crate) fn proceed(report: Report<'_>, progress: Progress) -> Result<(), PipelineError> {
    match report(progress) {
        ControlFlow::Continue(()) => Ok(()),
        ControlFlow::Break(()) => {
            Err(PipelineError::Cancelled { done: progress.done, total: progress.total })
        }
    }
}
