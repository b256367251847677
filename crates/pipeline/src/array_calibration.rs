//! Calibration of an array from the frames of a capture.

use crate::capture::{Report, proceed};
use crate::chain::Chain;
use crate::error::PipelineError;
use crate::options::ChainOptions;
use crate::result::{DetectedCell, FrameCells};
use crate::source::FrameSource;
use boresight_array_calibration::{
    CalibrationOptions, CalibrationResult, Cell, CellUse, calibrate, check, leave_one_out,
};
use boresight_core::Progress;
use boresight_core::{Array, InputError, Remark, Waveform};
use boresight_math::order::sort_numbers;
use boresight_options::{Naming, check as check_ranges};
use ndarray::Axis;
use std::ops::{ControlFlow, Range};

/// Range resolutions between a reflector and its cell.
const NEAR_RESOLUTIONS: f64 = 2.0;

/// Cells looked through for those near reflectors.
const MOST_CELLS: usize = 4096;

/// Which frames a calibration is made from, and on which it is checked.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct CalibrationFrames {
    /// Frames it is made from.
    pub made_from: Range<usize>,
    /// Frames it is checked on; none if empty.
    pub checked_on: Range<usize>,
}

impl CalibrationFrames {
    /// The first half of `count` frames, and the other for the check; the one frame there is.
    pub fn halves(count: usize) -> Self {
        let half = count.div_ceil(2);
        Self { made_from: 0..half, checked_on: half..count }
    }
}

/// Calibrates an array from frames taken together: from the cells near the reflectors that the options name, or from all
/// strong cells with one target. Targets have to stay in their range and Doppler cell over the frames. What the array knows
/// of its errors already is left aside.
///
/// # Errors
/// [`PipelineError::ArrayCalibration`] where no cell will do; as [`Chain::combine`].
pub fn calibrate_array<S: FrameSource>(
    (waveform, receivers, array): (&Waveform, usize, &Array),
    source: &S,
    frames: &CalibrationFrames,
    options: &CalibrationOptions,
    report: Report<'_>,
) -> Result<CalibrationResult, S::Error> {
    check_ranges(options, Naming::Rust).map_err(PipelineError::from)?;
    let plan = array.whole().map_err(PipelineError::from)?;
    let named = !options.reflectors.is_empty();
    let chain_options = ChainOptions {
        max_detections: if named { MOST_CELLS } else { options.max_cells },
        ..ChainOptions::default()
    };
    let mut chain = Chain::new(waveform, receivers, &plan, &chain_options)?;
    let CalibrationFrames { made_from, checked_on } = frames;
    let total = 2 * (made_from.len() + checked_on.len());
    let mut first = |at: Progress| report(Progress { done: at.done, total });
    let found = chain.combined_cells(source, made_from.clone(), &mut first)?;
    let mut cells = cells(&chain, &found)?;
    if named {
        cells = near_reflectors(cells, waveform, options)?;
    }
    let mut result = calibrate(&plan, &cells, options).map_err(PipelineError::from)?;
    result.calibration.frames = made_from.len();
    if !checked_on.is_empty() {
        let done = 2 * made_from.len();
        let mut second = |at: Progress| report(Progress { done: done + at.done, total });
        let others = chain.combined_cells(source, checked_on.clone(), &mut second)?;
        let others = self::cells(&chain, &others)?;
        let same: Vec<Cell> = others.into_iter().filter(|cell| was_used(cell, &result)).collect();
        if same.is_empty() {
            let text = "no target of the calibration is in its cell in the frames to check on";
            result.warnings.push(Remark::new("nothing-to-check-on", text));
        } else {
            let checked = check(&plan, &result.calibration, &same, checked_on.len());
            result.check = Some(checked.map_err(PipelineError::from)?);
        }
    }
    let used: Vec<Cell> = cells
        .into_iter()
        .zip(&result.cells)
        .filter(|(_, used)| used.state == CellUse::Used)
        .map(|(cell, _)| cell)
        .collect();
    result.left_out = leave_one_out(&plan, &used, options).map_err(PipelineError::from)?;
    proceed(report, Progress { done: total, total })?;
    Ok(result)
}

/// Cells as calibration takes them. Noise is the median of the map: that around a cell may hold other targets.
fn cells(chain: &Chain, found: &FrameCells) -> Result<Vec<Cell>, PipelineError> {
    let mut powers: Vec<f64> = chain.map.power.iter().map(|&power| power.into()).collect();
    sort_numbers(&mut powers);
    let median = powers.get(powers.len() / 2).copied().unwrap_or_default();
    let noise = median.max(f64::MIN_POSITIVE);
    let cell = |(cell, snapshots): (&DetectedCell, _)| -> Result<Cell, PipelineError> {
        let DetectedCell { range_m, rate_mps, range_bin, doppler_bin, .. } = *cell;
        let mut made = Cell::of(snapshots, noise)?;
        (made.range_m, made.rate_mps) = (range_m, rate_mps);
        (made.range_bin, made.doppler_bin) = (range_bin, doppler_bin);
        Ok(made)
    };
    found.cells.iter().zip(found.snapshots.axis_iter(Axis(0))).map(cell).collect()
}

/// The strongest cell near each reflector, at its direction where that is known.
fn near_reflectors(
    cells: Vec<Cell>,
    waveform: &Waveform,
    options: &CalibrationOptions,
) -> Result<Vec<Cell>, PipelineError> {
    let reach = NEAR_RESOLUTIONS * waveform.range_resolution_m();
    let mut near = vec![];
    for reflector in &options.reflectors {
        let distance = |cell: &Cell| (cell.range_m - reflector.range_m).abs();
        let best = cells
            .iter()
            .filter(|cell| distance(cell) <= reach)
            .max_by(|a, b| a.snr.total_cmp(&b.snr))
            .ok_or_else(|| InputError::OutOfRange {
                what: "range_m of a reflector".into(),
                expected: format!("a detected target within {reach:.2} m"),
                given: reflector.range_m,
            })?;
        near.push(match reflector.direction() {
            Some(direction) => best.clone().at(direction),
            None => best.clone(),
        });
    }
    Ok(near)
}

/// Whether a cell is one that a calibration was made from, or beside it.
fn was_used(cell: &Cell, result: &CalibrationResult) -> bool {
    result.cells.iter().any(|used| {
        used.state == CellUse::Used
            && used.range_bin.abs_diff(cell.range_bin) <= 1
            && used.doppler_bin.abs_diff(cell.doppler_bin) <= 1
    })
}

/// Never stops.
pub fn unwatched(_: Progress) -> ControlFlow<()> {
    ControlFlow::Continue(())
}
