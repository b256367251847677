//! From cells to a calibration.

use crate::cells::Cell;
use crate::error::ArrayCalibrationError;
use crate::fit::{Fit, Fitted};
use crate::identifiable::{Information, half_wavelengths};
use crate::options::{CalibrationModel, CalibrationOptions};
use crate::plane_wave::PlaneWaves;
use crate::result::{CalibrationResult, CellUse, UsedCell};
use crate::robust::{Weighed, weighed};
use crate::{coupling, positions};
use boresight_core::{
    Array, ArrayCalibration, CalibrationMethod, ChannelCalibration, Complex64, Direction,
    NotIdentifiable, Remark,
};
use boresight_math::decibels::{db_to_power, power_to_db};
use boresight_options::{Naming, check};
use ndarray::Array2;

/// Most channels: what is fitted grows with their square, and its inverse with their cube.
const MOST_CHANNELS: usize = 256;

/// Decibels of gain a unit of its logarithm.
const DB_PER_LOG: f64 = 20.0 / std::f64::consts::LN_10;

/// Calibrates an array from cells seen by all of its channels: `array.whole()`.
///
/// Cells that are weak, that hold several targets, or that no plane wave fits under the errors all share are left out, and
/// said. Standard deviations are the larger of the Cramer-Rao bound of noise and of what the scatter of the cells says.
///
/// # Errors
/// [`ArrayCalibrationError::NoCells`] where none is left; [`ArrayCalibrationError::NotDetermined`] for an array whose
/// elements are all at one point; [`boresight_core::InputError`] for options out of range, cells of other channels, or more
/// than 256 channels.
pub fn calibrate(
    array: &Array,
    cells: &[Cell],
    options: &CalibrationOptions,
) -> Result<CalibrationResult, ArrayCalibrationError> {
    check(options, Naming::Rust)?;
    let plan = array.whole()?;
    boresight_math::error::check_range(
        "number of channels",
        plan.len() as f64,
        2.0,
        MOST_CHANNELS as f64,
    )?;
    let waves = PlaneWaves::new(&plan);
    if waves.axes.is_empty() {
        return Err(ArrayCalibrationError::NotDetermined {
            what: "the phase of each channel",
            expected: "elements at several places along y or z".into(),
            given: "an array whose elements are not".into(),
        });
    }
    let mut states: Vec<CellUse> = cells.iter().map(|cell| fit_for(cell, options)).collect();
    let (fit, weighed) = without_misfits(&plan, cells, &mut states, options)?;
    let calibrated = Calibrated::new(&fit, weighed, options)?;
    Ok(calibrated.result(&plan, cells, &states, &fit, options))
}

/// What a cell is by itself.
fn fit_for(cell: &Cell, options: &CalibrationOptions) -> CellUse {
    if cell.snr < db_to_power(options.min_snr_db) {
        CellUse::Weak
    } else if !cell.is_one_line() {
        CellUse::SeveralTargets
    } else {
        CellUse::Used
    }
}

/// Fits, and leaves out the worst of the cells that do not fit, until all do.
fn without_misfits(
    plan: &Array,
    cells: &[Cell],
    states: &mut [CellUse],
    options: &CalibrationOptions,
) -> Result<(Fit, Weighed), ArrayCalibrationError> {
    let most = db_to_power(options.max_residual_db);
    loop {
        let used: Vec<usize> =
            (0..cells.len()).filter(|&index| states[index] == CellUse::Used).collect();
        if used.is_empty() {
            return Err(ArrayCalibrationError::NoCells {
                expected: format!(
                    "a target of at least {} dB, of which one plane wave leaves at most {} dB",
                    options.min_snr_db, options.max_residual_db
                ),
                given: cells.len(),
            });
        }
        let seen: Vec<&Cell> = used.iter().map(|&index| &cells[index]).collect();
        let fit = Fit::new(plan, &seen)?;
        let found = weighed(&fit);
        let beyond = |at: usize| found.fit.residuals[at] - fit.seen[at].variance - most;
        let worst = (0..used.len()).max_by(|&a, &b| beyond(a).total_cmp(&beyond(b)));
        match worst {
            // A residual that is not a number ranks highest and does not fit either.
            Some(worst) if beyond(worst) > 0.0 || beyond(worst).is_nan() => {
                // Cells at least half as bad as the worst go with it, which bounds the rounds.
                let limit = beyond(worst) * 0.5;
                for (at, &index) in used.iter().enumerate() {
                    if at == worst || beyond(at) > limit {
                        states[index] = CellUse::DoesNotFit;
                    }
                }
            }
            _ => return Ok((fit, found)),
        }
    }
}

/// A fit with what is known of it.
struct Calibrated {
    found: Fitted,
    coupling: Option<Array2<Complex64>>,
    gain_std: Vec<f64>,
    phase_std: Vec<f64>,
    /// Of each channel along y and z, half wavelengths.
    moved_std: Option<Vec<[f64; 2]>>,
    undetermined: Vec<NotIdentifiable>,
    remarks: Vec<Remark>,
}

impl Calibrated {
    fn new(
        fit: &Fit,
        weighed: Weighed,
        options: &CalibrationOptions,
    ) -> Result<Self, ArrayCalibrationError> {
        let Weighed { fit: mut found, weights } = weighed;
        let mut undetermined = vec![NotIdentifiable::CommonGain, NotIdentifiable::CommonPhase];
        let mut remarks = vec![];
        if !fit.any_known() {
            undetermined.push(NotIdentifiable::Direction);
            remarks.push(Remark::new(
                "direction-not-identifiable",
                "no direction is known: a turn of all angles alike cannot be told, and stays with the plan",
            ));
        }
        if fit.seen.len() == 1 {
            remarks.push(Remark::new(
                "one-calibration-cell",
                "one cell alone: what reflections add to it counts as the channels', and no scatter tells",
            ));
        }
        let mut moved = false;
        let mut matrix = None;
        match options.model {
            CalibrationModel::Channels => {}
            CalibrationModel::Positions => {
                match positions::with_positions(fit, &found, &weights)? {
                    Some(better) => (found, moved) = (better, true),
                    None => {
                        undetermined.push(NotIdentifiable::Displacement);
                        remarks.push(Remark::new(
                        "displacement-not-identifiable",
                        "displacements need targets at more angles, further apart; they are left at nought",
                    ));
                    }
                }
            }
            CalibrationModel::Coupling => match coupling::matrix(fit, &found, &weights)? {
                Some((coupling, residuals)) => {
                    found.residuals = residuals;
                    matrix = Some(coupling);
                }
                None => {
                    undetermined.push(NotIdentifiable::Coupling);
                    remarks.push(Remark::new(
                        "coupling-not-identifiable",
                        "coupling needs targets at as many known angles as there are channels; none is assumed",
                    ));
                }
            },
        }
        let channels = found.factors.len();
        // Noise alone, for the bound; the weights of the fit, for the scatter.
        let noise: Vec<f64> = fit.seen.iter().map(|cell| 1.0 / cell.variance.max(1e-12)).collect();
        let larger =
            |of: &dyn Fn(&[f64]) -> Information| -> Result<Vec<f64>, ArrayCalibrationError> {
                let bound = of(&noise).inverse()?.variances();
                let information = of(&weights);
                let scattered = information.scattered(&information.inverse()?);
                Ok(match scattered {
                    Some(scattered) => {
                        bound.iter().zip(scattered).map(|(b, s)| b.max(s).sqrt()).collect()
                    }
                    None => bound.iter().map(|variance| variance.sqrt()).collect(),
                })
            };
        let gain_std = larger(&|weights| Information::of_gains(fit, &found, weights))?;
        let phases = larger(&|weights| Information::of_phases(fit, &found, weights, moved))?;
        let moved_std = moved.then(|| {
            let of = |channel: usize, axis: usize| {
                let block = fit.waves.axes.iter().position(|&known| known == axis);
                block
                    .map_or(0.0, |block| half_wavelengths(phases[(block + 1) * channels + channel]))
            };
            (0..channels).map(|channel| [of(channel, 0), of(channel, 1)]).collect()
        });
        let phase_std = phases[..channels].to_vec();
        Ok(Self { found, coupling: matrix, gain_std, phase_std, moved_std, undetermined, remarks })
    }

    fn result(
        mut self,
        plan: &Array,
        cells: &[Cell],
        states: &[CellUse],
        fit: &Fit,
        options: &CalibrationOptions,
    ) -> CalibrationResult {
        let used: Vec<usize> =
            (0..cells.len()).filter(|&index| states[index] == CellUse::Used).collect();
        let (range_bias, range_bias_std) = self.range_bias(cells, &used, options);
        let left = cells.len() - used.len();
        if left > 0 {
            let count = |state| states.iter().filter(|&&given| given == state).count();
            self.remarks.push(Remark::new(
                "calibration-cells-left-out",
                format!(
                    "{left} of {} cells left out: {} too weak, {} with several targets, {} that one plane wave does not fit",
                    cells.len(),
                    count(CellUse::Weak),
                    count(CellUse::SeveralTargets),
                    count(CellUse::DoesNotFit)
                ),
            ));
        }
        let channels = self.channels();
        let coupling = self.coupling.as_ref().map(|matrix| {
            let size = matrix.nrows();
            (0..size)
                .map(|i| (0..size).map(|k| matrix[[i, k]] / matrix[[k, k]]).collect())
                .collect()
        });
        let (phase, gain) = deviations(fit, &self.found);
        let power = self.found.residuals.iter().sum::<f64>() / used.len().max(1) as f64;
        let calibration = ArrayCalibration {
            tx: plan.tx().to_vec(),
            rx: plan.rx().to_vec(),
            channels,
            coupling,
            range_bias_m: range_bias.unwrap_or_default(),
            range_bias_std_m: range_bias_std,
            method: if fit.any_known() {
                CalibrationMethod::Reflector
            } else {
                CalibrationMethod::SelfCalibration
            },
            not_identifiable: self.undetermined,
            cells: used.len(),
            cells_left_out: left,
            frames: 0,
            residual_db: Some(share_db(power)),
            residual_phase_rad: Some(phase),
            residual_gain_db: Some(gain),
        };
        CalibrationResult {
            cells: self::used(plan, cells, states, fit, &self.found, &used),
            calibration,
            check: None,
            left_out: None,
            warnings: self.remarks,
        }
    }

    fn channels(&self) -> Vec<ChannelCalibration> {
        let diagonal = self.coupling.as_ref().map(|matrix| matrix.diag().to_vec());
        let factors = diagonal.as_ref().unwrap_or(&self.found.factors);
        let any_moved = self.moved_std.as_ref();
        let one = |(k, factor): (usize, &Complex64)| ChannelCalibration {
            gain_db: 20.0 * factor.norm().max(1e-5).log10(),
            phase_rad: factor.arg(),
            gain_std_db: Some(self.gain_std[k] * DB_PER_LOG),
            phase_std_rad: Some(self.phase_std[k]),
            displacement: any_moved.map(|_| [0.0, self.found.moved[k][0], self.found.moved[k][1]]),
            displacement_std: any_moved.map(|std| [0.0, std[k][0], std[k][1]]),
        };
        factors.iter().enumerate().map(one).collect()
    }

    /// What ranges are too long by, with its standard deviation where two reflectors or more tell it.
    fn range_bias(
        &mut self,
        cells: &[Cell],
        used: &[usize],
        options: &CalibrationOptions,
    ) -> (Option<f64>, Option<f64>) {
        let nearest = |range_m: f64| {
            let from = |reflector: &crate::options::Reflector| (range_m - reflector.range_m).abs();
            options.reflectors.iter().min_by(|a, b| from(a).total_cmp(&from(b)))
        };
        let errors: Vec<f64> = used
            .iter()
            .filter(|_| options.range_bias)
            .filter_map(|&index| {
                let range_m = cells[index].range_m;
                nearest(range_m).map(|reflector| range_m - reflector.range_m)
            })
            .collect();
        if errors.is_empty() {
            self.undetermined.push(NotIdentifiable::RangeBias);
            return (None, None);
        }
        let count = errors.len() as f64;
        let mean = errors.iter().sum::<f64>() / count;
        let spread = errors.iter().map(|error| (error - mean).powi(2)).sum::<f64>();
        (Some(mean), (count > 1.0).then(|| (spread / (count - 1.0) / count).sqrt()))
    }
}

/// The cells with where their targets are and what is left of them.
fn used(
    plan: &Array,
    cells: &[Cell],
    states: &[CellUse],
    fit: &Fit,
    found: &Fitted,
    used: &[usize],
) -> Vec<UsedCell> {
    // What those left out would be under the calibration.
    let others: Vec<&Cell> = cells.iter().collect();
    let all = Fit::new(plan, &others).map(|all| {
        let mut under = Fitted { directions: vec![], ..found.clone() };
        all.fit_cells(&mut under);
        under
    });
    cells
        .iter()
        .enumerate()
        .map(|(index, cell)| {
            let at = used.iter().position(|&other| other == index);
            let (u, residual) = match (at, &all) {
                (Some(at), _) => (found.directions[at], found.residuals[at]),
                (None, Ok(all)) => (all.directions[index], all.residuals[index]),
                (None, Err(_)) => ([0.0; 2], 1.0),
            };
            let direction: Direction = cell.direction.unwrap_or_else(|| fit.waves.direction(u));
            UsedCell {
                range_m: cell.range_m,
                rate_mps: cell.rate_mps,
                range_bin: cell.range_bin,
                doppler_bin: cell.doppler_bin,
                snr: cell.snr,
                direction: direction.into(),
                residual,
                state: states[index],
            }
        })
        .collect()
}

/// Root mean squares of phase (rad) and gain (dB) that are left in each channel and cell.
fn deviations(fit: &Fit, found: &Fitted) -> (f64, f64) {
    let (mut phase, mut gain, mut count) = (0.0, 0.0, 0.0);
    for (index, cell) in fit.seen.iter().enumerate() {
        let response = fit.response(found, found.directions[index]);
        for (k, a) in response.iter().enumerate() {
            let ratio = cell.signal[k] / (a * found.factors[k] * found.amplitudes[index]);
            if ratio.norm() > 0.0 && ratio.is_finite() {
                phase += ratio.arg().powi(2);
                gain += (20.0 * ratio.norm().log10()).powi(2);
                count += 1.0;
            }
        }
    }
    let root = |sum: f64| if count > 0.0 { (sum / count).sqrt() } else { 0.0 };
    (root(phase), root(gain))
}

/// Decibels of a share of power, no less than -300.
pub(crate) fn share_db(share: f64) -> f64 {
    power_to_db(share).max(-300.0)
}
