//! A batch gives for every cell what an estimate of that cell alone gives.

use crate::support::{azimuths, scene};
use boresight_aoa::Plan;
use boresight_aoa::{
    AoaError, BatchEstimate, Data, Estimate, Estimator, EstimatorOptions, Estimators, Method,
    Source,
};
use boresight_core::presets::preset;
use boresight_core::{Array, Complex64, Diagnose, Direction, Random};
use ndarray::{Array3, ArrayView3, Axis, s};

const CELLS: usize = 11;

/// Cells of none to four sources, the seventh silent.
fn cells(array: &Array, snapshots: usize) -> Array3<Complex64> {
    let mut random = Random::new(5, snapshots as u64);
    let mut y = Array3::zeros((CELLS, array.len(), snapshots));
    for (c, mut cell) in y.outer_iter_mut().enumerate() {
        let at: Vec<f64> =
            (0..c % 5).map(|i| random.uniform(-65.0, -35.0) + 35.0 * i as f64).collect();
        let powers = [1.0, 0.5, 0.8, 0.1];
        cell.assign(&scene(array, &azimuths(&at), &powers, 1e-2, snapshots, &mut random));
    }
    y.slice_mut(s![6, .., ..]).fill(Complex64::ZERO);
    y
}

/// The spectrum in the batch is single precision.
fn assert_same_cells(
    method: Method,
    array: &Array,
    options: &EstimatorOptions,
    y: &Array3<Complex64>,
) {
    let name = method.name();
    let mut warm = Estimator::new(method, array, options).unwrap();
    let mut batch = BatchEstimate::new(method);
    for spectra in [false, true, true] {
        warm.estimate_batch_into(y.view(), spectra, &mut batch).unwrap();
        let mut unresolved = 0;
        let mut warnings = 0;
        for (c, cell) in y.outer_iter().enumerate() {
            let mut fresh = Estimator::new(method, array, options).unwrap();
            let alone = fresh.estimate(Data::Snapshots(cell)).unwrap();
            assert_eq!(batch.sources_of(c), alone.sources, "{name}, cell {c}");
            unresolved += usize::from(!alone.resolved);
            warnings += alone.warnings.len();
            if let Some(spectrum) = alone.spectrum.filter(|_| spectra) {
                let all = batch.spectra.as_ref().unwrap();
                assert_eq!(all.azimuth_rad, spectrum.azimuth_rad);
                assert_eq!(all.elevation_rad, spectrum.elevation_rad);
                assert_eq!(all.kind, spectrum.kind);
                let points = spectrum.values.len();
                let values: Vec<f32> = spectrum.values.iter().map(|&v| v as f32).collect();
                assert_eq!(all.values[c * points..(c + 1) * points], values, "{name}, cell {c}");
                assert_eq!(all.values.len(), CELLS * points);
            }
        }
        assert_eq!(batch.spectra.is_some(), spectra && method.requirements().spectrum, "{name}");
        assert_eq!((batch.cells, batch.unresolved), (CELLS, unresolved), "{name}");
        assert_eq!(batch.warnings.iter().map(|w| w.cells).sum::<usize>(), warnings, "{name}");
        assert!(batch.cell.is_sorted());
        assert_eq!(batch.cell.len(), batch.sources.len());
    }
}

#[test]
fn every_method_gives_the_same_cell_by_cell() {
    let options =
        EstimatorOptions { grid_points: 256, max_iterations: 20, ..EstimatorOptions::default() };
    let uniform = Array::ula(12).unwrap();
    for method in Method::ALL {
        let needs = method.requirements();
        for snapshots in [1, 3, 20] {
            let few = snapshots < needs.min_snapshots;
            if few || needs.max_snapshots.is_some_and(|most| snapshots > most) {
                continue;
            }
            assert_same_cells(method, &uniform, &options, &cells(&uniform, snapshots));
        }
    }
    let planar = preset("awr1843").unwrap();
    let options = EstimatorOptions { elevation_points: 9, grid_points: 64, ..options };
    for method in [Method::Bartlett, Method::Iaa] {
        assert_same_cells(method, &planar, &options, &cells(&planar, 2));
    }
}

#[test]
fn threads_change_nothing() {
    let array = Array::ula(12).unwrap();
    let options = EstimatorOptions { grid_points: 256, ..EstimatorOptions::default() };
    let few = cells(&array, 1);
    let many = ndarray::concatenate(Axis(0), &[few.view(); 5]).unwrap();
    let mut one = Estimator::new(Method::Capon, &array, &options).unwrap();
    for y in [&many, &few] {
        let expected = one.estimate_batch(y.view(), true).unwrap();
        assert!(!expected.warnings.is_empty());
        for threads in [1, 2, 3, 16] {
            let mut all = Estimators::new(Method::Capon, &array, &options, threads).unwrap();
            assert_eq!(all.estimate_batch(y.view(), true).unwrap(), expected, "{threads} threads");
            assert_eq!(all.estimate_batch(y.view(), true).unwrap(), expected, "{threads} threads");
            let refused = all.estimate_batch(y.slice(s![.., ..5, ..]), true);
            assert_eq!(refused.unwrap_err().code(), "shape");
        }
    }
    let refused = Estimators::new(Method::Capon, &array, &options, 0).err().unwrap();
    assert_eq!(refused.code(), "out-of-range");
}

#[test]
fn no_cells_are_an_empty_result() {
    let array = Array::ula(4).unwrap();
    let mut estimator =
        Estimator::new(Method::Bartlett, &array, &EstimatorOptions::default()).unwrap();
    let batch = estimator.estimate_batch(Array3::zeros((0, 4, 1)).view(), true).unwrap();
    assert_eq!(batch, BatchEstimate::new(Method::Bartlett));
    assert_eq!(batch.sources_of(0), &[] as &[Source]);
}

#[test]
fn what_is_malformed_is_refused_whole() {
    let array = Array::ula(4).unwrap();
    let mut estimator =
        Estimator::new(Method::Bartlett, &array, &EstimatorOptions::default()).unwrap();
    for shape in [(2, 5, 1), (2, 4, 0)] {
        let refused = estimator.estimate_batch(Array3::zeros(shape).view(), false).unwrap_err();
        assert_eq!(refused.code(), "shape");
    }
    let mut y = Array3::zeros((3, 4, 2));
    y[[2, 1, 0]] = Complex64::new(f64::NAN, 0.0);
    let refused = estimator.estimate_batch(y.view(), false).unwrap_err();
    assert_eq!(refused.code(), "not-finite");
    assert!(refused.to_string().contains("index 36"), "{refused}");
    y.invert_axis(Axis(1));
    assert!(estimator.estimate_batch(y.slice(s![..2, .., ..]), false).is_ok());
}

/// A plan that looks at four cells at once and finds in each a source of its power.
struct Portions(Vec<usize>);

impl Plan for Portions {
    fn estimate(&mut self, data: Data<'_>) -> Result<Estimate, AoaError> {
        let Data::Snapshots(y) = data else { unreachable!() };
        let mut estimate = Estimate::new(Method::Aaetr);
        let power = y.iter().map(|z| z.norm_sqr()).sum();
        let direction = Direction::azimuth(0.0);
        estimate.sources.push(Source { confidence: Some(0.9), ..Source::new(direction, power) });
        Ok(estimate)
    }

    fn cells_at_once(&self) -> usize {
        4
    }

    fn estimate_cells(
        &mut self,
        cells: ArrayView3<'_, Complex64>,
        out: &mut [Estimate],
    ) -> Result<(), AoaError> {
        self.0.push(cells.dim().0);
        assert_eq!(self.0.last(), Some(&out.len()));
        for (cell, out) in cells.outer_iter().zip(out) {
            *out = self.estimate(Data::Snapshots(cell))?;
        }
        match self.0[..] {
            [.., 4] | [.., 3] => Ok(()),
            _ => Err(AoaError::Network { method: "aaetr", reason: format!("{:?}", self.0) }),
        }
    }
}

#[test]
fn a_plan_made_elsewhere_gets_cells_in_portions() {
    let array = Array::ula(12).unwrap();
    let y = cells(&array, 1);
    let options = EstimatorOptions::default();
    let estimator = || {
        let plan = Box::new(Portions(vec![]));
        Estimator::with_plan(Method::Aaetr, &array, plan, &options).unwrap()
    };
    let mut single = estimator();
    let all = single.estimate_batch(y.view(), false).unwrap();
    for (c, cell) in y.outer_iter().enumerate() {
        assert_eq!(all.sources_of(c), single.estimate(Data::Snapshots(cell)).unwrap().sources);
    }
    let mut threads = Estimators::of(vec![estimator(), estimator()]).unwrap();
    assert_eq!(threads.estimate_batch(y.view(), false).unwrap(), all);
    let refused = single.estimate_batch(y.slice(s![..2, .., ..]), false).unwrap_err();
    assert_eq!(refused.code(), "network-failed");
    assert_eq!(single.estimate_batch(y.view(), false).unwrap(), all);
    let unplanned = Estimator::new(Method::Aaetr, &array, &options).err().unwrap();
    assert_eq!(unplanned.code(), "needs-model");
}
