//! How a calibration does on data that it was not made from.

use crate::cells::Cell;
use crate::error::ArrayCalibrationError;
use crate::fit::{Fit, Fitted};
use crate::options::CalibrationOptions;
use crate::plane_wave::{Cosines, PlaneWaves};
use crate::result::{CalibrationCheck, CheckFigures, CheckedCell};
use crate::self_calibration::{calibrate, share_db};
use boresight_core::{Array, ArrayCalibration, Complex64, Direction};
use ndarray::Array2;

/// Points of a beam's pattern a beam width.
const OVERSAMPLING: f64 = 16.0;

/// Most points of a pattern.
const MOST_POINTS: f64 = 4096.0;

/// Most cells that are left out in turn.
const MOST_FOLDS: usize = 16;

/// Checks a calibration on cells seen by all channels of an array.
///
/// # Errors
/// A calibration of another array; cells of other channels; no cells.
pub fn check(
    array: &Array,
    calibration: &ArrayCalibration,
    cells: &[Cell],
    frames: usize,
) -> Result<CalibrationCheck, ArrayCalibrationError> {
    if cells.is_empty() {
        return Err(ArrayCalibrationError::NoCells {
            expected: "cells to check by".into(),
            given: 0,
        });
    }
    let plan = array.whole()?;
    let calibrated = plan.calibrated(calibration)?;
    let corrected =
        cells.iter().map(|cell| corrected(&calibrated, cell)).collect::<Result<Vec<_>, _>>()?;
    let before = figures(&plan, cells.iter())?;
    let after = figures(&calibrated, corrected.iter())?;
    let checked =
        cells.iter().zip(&before).zip(&after).map(|((cell, before), after)| CheckedCell {
            range_m: cell.range_m,
            range_bin: cell.range_bin,
            doppler_bin: cell.doppler_bin,
            azimuth_before_rad: before.0.azimuth_rad,
            azimuth_rad: after.0.azimuth_rad,
            elevation_rad: after.0.elevation_rad,
            before: before.1,
            after: after.1,
        });
    Ok(CalibrationCheck {
        frames,
        before: together(before.iter().map(|one| &one.1)),
        after: together(after.iter().map(|one| &one.1)),
        cells: checked.collect(),
    })
}

/// Each of the cells of a calibration under one from the others: what it does on targets that it has not seen. Nothing for
/// fewer than three cells, or where the others do not make a calibration; the first 16 are left out in turn.
///
/// # Errors
/// Those of the eigenvalues.
pub fn leave_one_out(
    array: &Array,
    cells: &[Cell],
    options: &CalibrationOptions,
) -> Result<Option<CheckFigures>, ArrayCalibrationError> {
    if cells.len() < 3 {
        return Ok(None);
    }
    let plan = array.whole()?;
    let mut all = vec![];
    for index in 0..cells.len().min(MOST_FOLDS) {
        let others: Vec<Cell> = cells
            .iter()
            .enumerate()
            .filter(|(at, _)| *at != index)
            .map(|(_, c)| c.clone())
            .collect();
        let Ok(made) = calibrate(&plan, &others, options) else { continue };
        let calibrated = plan.calibrated(&made.calibration)?;
        let left_out = corrected(&calibrated, &cells[index])?;
        all.extend(figures(&calibrated, std::iter::once(&left_out))?.into_iter().map(|one| one.1));
    }
    Ok((!all.is_empty()).then(|| together(all.iter())))
}

/// The figures of several cells together.
pub(crate) fn together<'a>(cells: impl Iterator<Item = &'a CheckFigures>) -> CheckFigures {
    let mut sums = CheckFigures { sidelobe_db: f64::NEG_INFINITY, ..CheckFigures::default() };
    let mut count = 0.0;
    for cell in cells {
        sums.residual_phase_rad += cell.residual_phase_rad.powi(2);
        sums.residual_gain_db += cell.residual_gain_db.powi(2);
        sums.residual_db += 10_f64.powf(cell.residual_db / 10.0);
        sums.sidelobe_db = sums.sidelobe_db.max(cell.sidelobe_db);
        count += 1.0;
    }
    let count: f64 = if count > 0.0 { count } else { 1.0 };
    CheckFigures {
        residual_phase_rad: (sums.residual_phase_rad / count).sqrt(),
        residual_gain_db: (sums.residual_gain_db / count).sqrt(),
        residual_db: share_db(sums.residual_db / count),
        sidelobe_db: sums.sidelobe_db.max(-300.0),
    }
}

/// A cell once an array's errors are taken off.
pub(crate) fn corrected(array: &Array, cell: &Cell) -> Result<Cell, ArrayCalibrationError> {
    let mut signal = Array2::from_shape_vec((cell.signal.len(), 1), cell.signal.clone())
        .unwrap_or_else(|_| Array2::zeros((cell.signal.len(), 1)));
    array.correct(signal.view_mut())?;
    Ok(Cell { signal: signal.into_iter().collect(), ..cell.clone() })
}

/// Direction and figures of each cell, by the array as it is.
pub(crate) fn figures<'a>(
    array: &Array,
    cells: impl Iterator<Item = &'a Cell>,
) -> Result<Vec<(Direction, CheckFigures)>, ArrayCalibrationError> {
    let cells: Vec<&Cell> = cells.collect();
    let mut fit = Fit::new(array, &cells)?;
    // A check asks where a target is seen, not where it was said to be.
    fit.seen.iter_mut().for_each(|cell| cell.known = None);
    let channels = array.len();
    let mut found = Fitted {
        factors: vec![Complex64::ONE; channels],
        moved: vec![[0.0; 2]; channels],
        directions: vec![],
        amplitudes: vec![],
        residuals: vec![],
    };
    fit.fit_cells(&mut found);
    let each = cells.iter().enumerate().map(|(index, cell)| {
        let u = found.directions[index];
        let response = fit.waves.response(u);
        let ratio: Vec<Complex64> = cell
            .signal
            .iter()
            .zip(&response)
            .map(|(v, a)| v / (a * found.amplitudes[index]))
            .collect();
        let count = channels as f64;
        let square = |of: &dyn Fn(&Complex64) -> f64| {
            (ratio.iter().map(|z| of(z).powi(2)).sum::<f64>() / count).sqrt()
        };
        let mean_db = ratio.iter().map(|z| 20.0 * z.norm().max(1e-5).log10()).sum::<f64>() / count;
        let figures = CheckFigures {
            residual_phase_rad: square(&|z| z.arg()),
            residual_gain_db: square(&|z| 20.0 * z.norm().max(1e-5).log10() - mean_db),
            residual_db: share_db(found.residuals[index]),
            sidelobe_db: sidelobe_db(&fit.waves, &cell.signal, u),
        };
        (fit.waves.direction(u), figures)
    });
    Ok(each.collect())
}

/// The highest point of the conventional beam beyond the first minima beside its peak, over the peak, dB; along each axis of
/// the array through the peak.
fn sidelobe_db(waves: &PlaneWaves, signal: &[Complex64], peak: Cosines) -> f64 {
    let power = |u: Cosines| {
        let response = waves.response(u);
        response.iter().zip(signal).map(|(a, v)| a.conj() * v).sum::<Complex64>().norm_sqr()
    };
    let top = power(peak);
    let mut highest = 0.0_f64;
    for &axis in &waves.axes {
        let other = peak[1 - axis];
        let reach = (1.0 - other * other).max(0.0).sqrt();
        let extent = waves.positions.iter().map(|p| p[axis + 1]).fold(f64::NEG_INFINITY, f64::max)
            - waves.positions.iter().map(|p| p[axis + 1]).fold(f64::INFINITY, f64::min);
        let points =
            (2.0 * reach * OVERSAMPLING * extent.max(1.0)).clamp(16.0, MOST_POINTS) as usize;
        let at = |k: usize| {
            let mut u = peak;
            u[axis] = -reach + 2.0 * reach * k as f64 / points as f64;
            power(u)
        };
        let pattern: Vec<f64> = (0..=points).map(at).collect();
        let middle = ((peak[axis] + reach) / (2.0 * reach).max(1e-12) * points as f64)
            .round()
            .clamp(0.0, points as f64) as usize;
        let mut up = middle;
        while up < points && pattern[up + 1] <= pattern[up] {
            up += 1;
        }
        let mut down = middle;
        while down > 0 && pattern[down - 1] <= pattern[down] {
            down -= 1;
        }
        let beyond = pattern[..down].iter().chain(&pattern[(up + 1).min(points)..]);
        highest = beyond.fold(highest, |high, &value| high.max(value));
    }
    share_db(if top > 0.0 { highest / top } else { 0.0 })
}
