//! Simulated boards whose errors are known: what calibration finds of them, and where angles are then.

#![allow(clippy::unwrap_used, clippy::print_stdout)]

use boresight_aoa::bounds::{BoundRequest, BoundTarget, target_bound};
use boresight_aoa::{Data, Estimator, EstimatorOptions, Method, SourceCount};
use boresight_array_calibration::{
    CalibrationModel, CalibrationOptions, CalibrationResult, Cell, CellUse, SteeringTable,
    calibrate, check, leave_one_out,
};
use boresight_core::imperfections::ImperfectionSpread;
use boresight_core::presets::preset;
use boresight_core::{
    Array, ArrayCalibration, Complex64, Diagnose, Direction, Imperfections, NotIdentifiable, Random,
};
use boresight_simulate::snapshots::{Scene, SnapshotOptions, SnapshotSimulator, Target};
use ndarray::Array2;

const SNR_DB: f64 = 20.0;

/// A board with errors, and the directions of what it sees.
struct Board {
    plan: Array,
    errors: Imperfections,
}

impl Board {
    fn new(name: &str, spread: ImperfectionSpread, seed: u64) -> Self {
        let plan = preset(name).unwrap();
        let errors = Imperfections::random(&plan, spread, seed).unwrap();
        Self { plan, errors }
    }

    /// A snapshot of targets, noise 20 dB below a target of 0 dB at one element.
    fn seen(&self, targets: &[(Direction, f64)], seed: u64) -> Array2<Complex64> {
        let target = |&(direction, power_db): &(Direction, f64)| Target {
            direction: direction.into(),
            power_db,
            ..Target::default()
        };
        self.scene(targets.iter().map(target).collect(), seed)
    }

    /// Error of a target's azimuth over the bound of the plan.
    fn error(&self, array: &Array, direction: Direction, seed: u64) -> f64 {
        let mut seen = self.seen(&[(direction, 0.0)], seed);
        array.correct(seen.view_mut()).unwrap();
        let target = BoundTarget { direction: direction.into(), snr_db: SNR_DB, phase_rad: 0.0 };
        let bound = target_bound(&self.plan, &[target], &BoundRequest::default()).unwrap();
        (azimuth(array, &seen) - direction.azimuth_rad) / bound.azimuth_rad[0]
    }

    /// The same of two, in ascending order.
    fn errors_of_two(&self, array: &Array, targets: &[BoundTarget; 2], seed: u64) -> Vec<f64> {
        let target = |t: &BoundTarget| Target {
            direction: t.direction,
            phase_rad: Some(t.phase_rad),
            ..Target::default()
        };
        let mut seen = self.scene(targets.iter().map(target).collect(), seed);
        array.correct(seen.view_mut()).unwrap();
        let bound = target_bound(&self.plan, targets, &BoundRequest::default()).unwrap();
        azimuths(array, &seen, 2)
            .iter()
            .zip(targets)
            .zip(&bound.azimuth_rad)
            .map(|((found, target), bound)| (found - target.direction.azimuth_rad) / bound)
            .collect()
    }

    fn scene(&self, targets: Vec<Target>, seed: u64) -> Array2<Complex64> {
        let options = SnapshotOptions {
            scene: Scene::Given(targets),
            snr_db: SNR_DB,
            imperfections: Some(self.errors.clone()),
            seed,
            ..SnapshotOptions::default()
        };
        SnapshotSimulator::new(&self.plan, &options).unwrap().scene(0).unwrap().0
    }

    fn cell(&self, direction: Direction, seed: u64) -> Cell {
        Cell::of(self.seen(&[(direction, 0.0)], seed).view(), 0.01).unwrap()
    }

    fn cells(&self, count: usize, seed: u64) -> Vec<Cell> {
        let directions = directions(count, seed);
        directions
            .into_iter()
            .enumerate()
            .map(|(k, direction)| self.cell(direction, 1000 * seed + k as u64))
            .collect()
    }

    /// Errors of phase (rad) and gain (dB) that a calibration leaves, without what these data do not determine.
    fn left(&self, calibration: &ArrayCalibration, with_turn: bool) -> (Vec<f64>, Vec<f64>) {
        let phase = self
            .errors
            .phase_rad
            .iter()
            .zip(&calibration.channels)
            .map(|(truth, found)| truth - found.phase_rad)
            .collect();
        let gain = self
            .errors
            .gain_db
            .iter()
            .zip(&calibration.channels)
            .map(|(truth, found)| truth - found.gain_db)
            .collect();
        let along = |axis: usize| self.plan.positions().iter().map(|p| p[axis]).collect();
        let ones = vec![1.0; self.plan.len()];
        let columns: Vec<Vec<f64>> =
            if with_turn { vec![ones.clone(), along(1), along(2)] } else { vec![ones.clone()] };
        (without(phase, &columns), without(gain, &[ones]))
    }
}

/// Azimuths within 50 deg.
fn directions(count: usize, seed: u64) -> Vec<Direction> {
    let mut random = Random::new(seed, 7);
    let azimuth = |_| Direction::azimuth(random.uniform(-50.0, 50.0).to_radians());
    (0..count).map(azimuth).collect()
}

/// What is left of values once a least-squares sum of columns is taken off.
fn without(values: Vec<f64>, columns: &[Vec<f64>]) -> Vec<f64> {
    let mut basis: Vec<Vec<f64>> = vec![];
    let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(x, y)| x * y).sum::<f64>();
    let mut left = values;
    for column in columns {
        let mut rest = column.clone();
        for known in &basis {
            let along = dot(known, &rest);
            rest.iter_mut().zip(known).for_each(|(x, y)| *x -= along * y);
        }
        let length = dot(&rest, &rest).sqrt();
        if length > 1e-9 {
            rest.iter_mut().for_each(|x| *x /= length);
            let along = dot(&rest, &left);
            left.iter_mut().zip(&rest).for_each(|(x, y)| *x -= along * y);
            basis.push(rest);
        }
    }
    left
}

fn rms(values: &[f64]) -> f64 {
    (values.iter().map(|v| v * v).sum::<f64>() / values.len() as f64).sqrt()
}

fn spread() -> ImperfectionSpread {
    ImperfectionSpread { gain_db: 1.0, phase_rad: 10_f64.to_radians(), ..Default::default() }
}

fn found(board: &Board, cells: &[Cell]) -> CalibrationResult {
    calibrate(&board.plan, cells, &CalibrationOptions::default()).unwrap()
}

#[test]
fn twenty_strong_cells_leave_less_than_2_deg_and_a_fifth_of_a_decibel() {
    let (mut phases, mut gains, mut expected) = (vec![], vec![], vec![]);
    for seed in 0..40 {
        let board = Board::new("awr1642", spread(), seed);
        let result = found(&board, &board.cells(20, seed));
        assert_eq!(result.calibration.cells, 20);
        assert!(result.calibration.not_identifiable.contains(&NotIdentifiable::Direction));
        let (phase, gain) = board.left(&result.calibration, true);
        phases.extend(phase);
        gains.extend(gain);
        expected.extend(result.calibration.channels.iter().map(|c| c.phase_std_rad.unwrap()));
    }
    let (phase, gain) = (rms(&phases).to_degrees(), rms(&gains));
    let said = rms(&expected).to_degrees();
    println!("phase {phase:.3} deg (said {said:.3}), gain {gain:.3} dB");
    assert!(phase < 2.0 && gain < 0.2, "{phase} deg, {gain} dB");
    // Noise of 20 cells: 4.05 / sqrt(20) deg, of which the constant and the turn take a quarter of the power; 320 numbers
    // have it to 4 %.
    assert!((phase / (0.906 * 0.75_f64.sqrt()) - 1.0).abs() < 0.15, "{phase}");
    // The larger of two estimates of 20 cells is too large rather than too small.
    assert!((0.95..1.4).contains(&(said / phase)), "{said} of {phase}");
}

#[test]
fn angles_are_as_good_as_those_of_a_board_without_errors() {
    let (mut after, mut before, mut by_itself) = (vec![], vec![], vec![]);
    for seed in 0..20 {
        let mut board = Board::new("awr1642", spread(), seed);
        // Twenty reflectors at known angles, and the same cells without.
        let known: Vec<Cell> = directions(20, seed)
            .into_iter()
            .enumerate()
            .map(|(k, at)| board.cell(at, 1000 * seed + k as u64).at(at))
            .collect();
        let known = board.plan.calibrated(&found(&board, &known).calibration).unwrap();
        let cases: Vec<(Direction, u64)> = directions(50, 500 + seed)
            .into_iter()
            .enumerate()
            .map(|(k, direction)| (direction, 90_000 + 100 * seed + k as u64))
            .collect();
        for &(direction, draw) in &cases {
            before.push(board.error(&board.plan, direction, draw));
            after.push(board.error(&known, direction, draw));
        }
        // Without a known angle the turn of the errors cannot be told; it is taken off the board.
        let along: Vec<f64> = board.plan.positions().iter().map(|p| p[1]).collect();
        board.errors.phase_rad =
            without(board.errors.phase_rad.clone(), &[vec![1.0; along.len()], along]);
        let own = found(&board, &board.cells(20, seed)).calibration;
        let own = board.plan.calibrated(&own).unwrap();
        by_itself.extend(cases.iter().map(|&(at, draw)| board.error(&own, at, draw)));
    }
    let [after, before, by_itself] = [after, before, by_itself].map(|errors| rms(&errors));
    println!("rms over the bound: known {after:.3}, before {before:.3}, self {by_itself:.3}");
    // 1,000 angles have their rms to 2.2 %; 20 cells add a twentieth of the noise's power, 2.5 % of its rms.
    assert!(after < 1.2 && by_itself < 1.2, "{after} {by_itself}");
    assert!(before > 1.5, "{before}");
}

#[test]
fn two_targets_are_where_they_are_once_a_board_has_calibrated_itself() {
    let (mut after, mut before) = (vec![], vec![]);
    let mut random = Random::new(4, 0);
    for seed in 0..10 {
        let mut board = Board::new("awr1642", spread(), seed);
        let along: Vec<f64> = board.plan.positions().iter().map(|p| p[1]).collect();
        board.errors.phase_rad =
            without(board.errors.phase_rad.clone(), &[vec![1.0; along.len()], along]);
        let own = found(&board, &board.cells(20, seed)).calibration;
        let own = board.plan.calibrated(&own).unwrap();
        for draw in 0..20 {
            let first = random.uniform(-40.0, 10.0);
            let target = |azimuth_deg: f64, phase_rad: f64| BoundTarget {
                direction: Direction::azimuth(azimuth_deg.to_radians()).into(),
                snr_db: SNR_DB,
                phase_rad,
            };
            let targets = [
                target(first, random.uniform(0.0, std::f64::consts::TAU)),
                target(
                    first + random.uniform(25.0, 35.0),
                    random.uniform(0.0, std::f64::consts::TAU),
                ),
            ];
            before.extend(board.errors_of_two(&board.plan, &targets, 100 * seed + draw));
            after.extend(board.errors_of_two(&own, &targets, 100 * seed + draw));
        }
    }
    let [after, before] = [after, before].map(|errors| rms(&errors));
    println!("rms over the bound of two targets: after {after:.3}, before {before:.3}");
    assert!(after < 1.2 && before > 1.5, "{after} {before}");
}

/// The azimuth of the one target by maximum likelihood.
fn azimuth(array: &Array, seen: &Array2<Complex64>) -> f64 {
    azimuths(array, seen, 1)[0]
}

/// Azimuths by maximum likelihood, ascending.
fn azimuths(array: &Array, seen: &Array2<Complex64>, targets: usize) -> Vec<f64> {
    let options =
        EstimatorOptions { sources: SourceCount::Known(targets), ..EstimatorOptions::default() };
    let mut estimator = Estimator::new(Method::MaximumLikelihood, array, &options).unwrap();
    let estimate = estimator.estimate(Data::Snapshots(seen.view())).unwrap();
    let mut found: Vec<f64> = estimate.sources.iter().map(|s| s.direction.azimuth_rad).collect();
    found.sort_by(f64::total_cmp);
    found
}

#[test]
fn a_reflector_at_a_known_angle_tells_the_turn() {
    let mut errors = vec![];
    for seed in 0..20 {
        let board = Board::new("awr1642", spread(), seed);
        let at = Direction::azimuth(0.2);
        let cells: Vec<Cell> =
            (0..20).map(|k| board.cell(at, 7000 * (seed + 1) + k).at(at)).collect();
        let result = found(&board, &cells);
        assert!(!result.calibration.not_identifiable.contains(&NotIdentifiable::Direction));
        errors.extend(board.left(&result.calibration, false).0);
    }
    let phase = rms(&errors).to_degrees();
    println!("phase {phase:.3} deg");
    assert!((phase / (0.906 * (7.0_f64 / 8.0).sqrt()) - 1.0).abs() < 0.2, "{phase}");
}

#[test]
fn large_errors_are_found_from_any_start() {
    // Every second receiver the other way round, as on boards with antennas in the package.
    for seed in 0..10 {
        let mut board = Board::new("awr1642", spread(), seed);
        for phase in board.errors.phase_rad.iter_mut().skip(1).step_by(2) {
            *phase += std::f64::consts::PI;
        }
        let result = found(&board, &board.cells(20, seed));
        assert_eq!(result.calibration.cells_left_out, 0);
        let calibrated = board.plan.calibrated(&result.calibration).unwrap();
        let mut one = board.seen(&[(Direction::azimuth(0.3), 0.0)], 5);
        calibrated.correct(one.view_mut()).unwrap();
        let corrected = Cell::of(one.view(), 0.01).unwrap();
        let neutral = ArrayCalibration::neutral(&board.plan);
        let figures = check(&board.plan, &neutral, &[corrected], 1).unwrap();
        assert!(figures.after.residual_phase_rad.to_degrees() < 8.0, "{figures:?}");
    }
}

#[test]
fn cells_of_two_targets_are_left_out_and_counted() {
    let board = Board::new("awr1642", spread(), 3);
    let mut cells = board.cells(12, 3);
    for k in 0..5 {
        let two = [(Direction::azimuth(-0.5), 0.0), (Direction::azimuth(0.1 * f64::from(k)), -3.0)];
        cells.push(Cell::of(board.seen(&two, 800 + k as u64).view(), 0.01).unwrap());
    }
    cells.push(Cell::of((board.seen(&[(Direction::azimuth(0.0), 0.0)], 1)).view(), 1.0).unwrap());
    let result = found(&board, &cells);
    let count = |state| result.cells.iter().filter(|cell| cell.state == state).count();
    assert_eq!(
        (count(CellUse::Used), count(CellUse::DoesNotFit), count(CellUse::Weak)),
        (12, 5, 1)
    );
    let (phase, gain) = board.left(&result.calibration, true);
    assert!(rms(&phase).to_degrees() < 2.0 && rms(&gain) < 0.3);
    assert!(
        result.warnings.iter().any(|w| w.message.contains("5 that one plane wave does not fit"))
    );
    let none = calibrate(
        &board.plan,
        &cells[12..17],
        &CalibrationOptions { max_residual_db: -60.0, ..CalibrationOptions::default() },
    );
    assert_eq!(none.unwrap_err().code(), "no-calibration-cells");
}

#[test]
fn displacements_are_found_from_known_angles_and_left_alone_where_they_cannot_be() {
    let wide = ImperfectionSpread { position: 0.05, ..spread() };
    let options =
        CalibrationOptions { model: CalibrationModel::Positions, ..CalibrationOptions::default() };
    let mut errors = vec![];
    let mut said = vec![];
    for seed in 0..10 {
        let board = Board::new("awr1642", wide, seed);
        let cells: Vec<Cell> = directions(40, seed)
            .into_iter()
            .enumerate()
            .map(|(k, at)| board.cell(at, 3000 * (seed + 1) + k as u64).at(at))
            .collect();
        let result = calibrate(&board.plan, &cells, &options).unwrap();
        let moved: Vec<f64> = board
            .errors
            .displacement
            .iter()
            .zip(&result.calibration.channels)
            .map(|(truth, found)| truth[1] - found.displacement.unwrap()[1])
            .collect();
        errors.extend(without(moved, &[vec![1.0; 8]]));
        said.extend(result.calibration.channels.iter().map(|c| c.displacement_std.unwrap()[1]));
    }
    let (error, said) = (rms(&errors), rms(&said));
    println!("displacement {error:.4} of 0.05 half wavelengths, said {said:.4}");
    assert!(error < 0.012 && (0.8..1.6).contains(&(said / error)), "{error} {said}");
    // All at one angle: a displacement is a phase.
    let board = Board::new("awr1642", wide, 1);
    let at = Direction::azimuth(0.1);
    let same: Vec<Cell> = (0..5).map(|k| board.cell(at, k).at(at)).collect();
    let result = calibrate(&board.plan, &same, &options).unwrap();
    assert!(result.calibration.not_identifiable.contains(&NotIdentifiable::Displacement));
    assert!(result.calibration.channels.iter().all(|c| c.displacement.is_none()));
}

#[test]
fn coupling_is_found_from_a_table_of_steering_vectors() {
    let coupled = ImperfectionSpread { coupling_db: Some(-20.0), ..spread() };
    let board = Board::new("awr1642", coupled, 5);
    let azimuths: Vec<f64> = (-25..=25).map(|k| (2.4 * f64::from(k)).to_radians()).collect();
    let response = |&azimuth: &f64| {
        board.errors.steering_vector(&board.plan, Direction::azimuth(azimuth)).unwrap().to_vec()
    };
    let table = SteeringTable {
        responses: azimuths.iter().map(response).collect(),
        azimuth_rad: azimuths,
        elevation_rad: vec![],
    };
    let result = table.calibrate(&board.plan).unwrap();
    let left = result.calibration.residual_db.unwrap();
    println!("residual {left:.1} dB");
    assert!(left < -50.0, "{left}");
    // A direction that is not in the table.
    let calibrated = board.plan.calibrated(&result.calibration).unwrap();
    let mut seen = board
        .errors
        .steering_vector(&board.plan, Direction::azimuth(0.123))
        .unwrap()
        .insert_axis(ndarray::Axis(1));
    calibrated.correct(seen.view_mut()).unwrap();
    assert!((azimuth(&calibrated, &seen) - 0.123).abs() < 1e-3);
    let short = SteeringTable { azimuth_rad: vec![0.0], ..table };
    assert_eq!(short.calibrate(&board.plan).unwrap_err().code(), "shape");
}

#[test]
fn cells_left_out_in_turn_are_as_good_as_those_used() {
    let board = Board::new("awr1642", spread(), 9);
    let cells = board.cells(10, 9);
    let result = found(&board, &cells);
    let before = check(&board.plan, &result.calibration, &cells, 1).unwrap().before;
    let out = leave_one_out(&board.plan, &cells, &CalibrationOptions::default()).unwrap().unwrap();
    // Noise of 20 dB is 4 deg; nine cells add a ninth of its power.
    assert!(out.residual_phase_rad < 0.6 * before.residual_phase_rad, "{out:?} of {before:?}");
    assert!(out.residual_phase_rad.to_degrees() < 4.8, "{out:?}");
}
