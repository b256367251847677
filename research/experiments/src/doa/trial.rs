//! Trials of one condition.

use super::REGION;
use super::answers::Answers;
use super::plan::Plan;
use super::region_methods::RegionPlan;
use super::tally::{DoaRecord, FIELD_OF_VIEW_RAD, Tally};
use crate::error::EvaluateError;
use crate::told::{self, Candidate};
use boresight_aoa::order::counting::{CountOptions, count_sources_in};
use boresight_aoa::{Data, Estimator, EstimatorOptions, SourceCount};
use boresight_core::Complex64;
use boresight_math::linalg::hermitian_eigen;
use boresight_neural::Model;
use boresight_signal::region::{crop_region, range_spectrum, region_snapshots, strongest_range};
use boresight_signal::{Window, sample_covariance};
use boresight_validate::experiment::Tell;
use ndarray::{Array2, Array3, Axis};

impl Plan {
    /// Runs trials `first` to `first + trials - 1` of a condition, and tells of each its number, truth and answers.
    ///
    /// # Errors
    /// Those of the simulation and the estimators.
    pub fn run(
        &self,
        index: usize,
        first: u64,
        trials: u64,
        tell: Option<Tell>,
    ) -> Result<DoaRecord, EvaluateError> {
        if let Some(flow) = &self.end_to_end {
            return self.run_end_to_end(flow, index, first, trials, tell);
        }
        let count = self.conditions[index].targets.count();
        let candidates: &[Candidate] = if count > 0 { &self.candidates[count - 1] } else { &[] };
        let mut estimators: Vec<(Estimator, bool)> = vec![];
        for candidate in candidates {
            estimators.push((candidate.estimator(&self.array)?, candidate.takes_covariance()));
        }
        let mut region_plans: Vec<RegionPlan> = vec![];
        for method in self.region_methods.iter().filter(|_| count > 0) {
            region_plans.push(method.plan(&self.array, self.waveform.samples, count)?);
        }
        let mut counting: Vec<&Model> = vec![];
        for network in self.networks_that(true) {
            counting.push(network.model()?);
        }
        // Where there are no targets none is of use.
        let mut networks: Vec<Option<Estimator>> = vec![];
        for network in self.networks_that(false).filter(|_| count > 0) {
            let model = network.model()?;
            let suits = model.card().and_then(|card| card.targets).is_none_or(|of| of == count);
            let estimator = || model.estimator(&self.array, &known(count));
            networks.push(suits.then(estimator).transpose()?);
        }
        let tallies = networks.iter().map(|network| network.as_ref().map(|_| Tally::default()));
        let mut record = DoaRecord {
            condition: index,
            trials: trials as u32,
            close: 0,
            counted: vec![[0; 4]; self.counters.len() + counting.len()],
            methods: (0..candidates.len() + region_plans.len())
                .map(|_| Some(Tally::default()))
                .chain(tallies)
                .collect(),
        };
        let vectors = REGION[0] * REGION[1];
        let mut cells = Array3::zeros((trials as usize, self.array.len(), vectors));
        let mut regions = vec![];
        let mut truths: Vec<(Vec<f64>, bool)> = vec![];
        for (trial, mut cell) in (first..).zip(cells.outer_iter_mut()) {
            let (frame, truth_deg, close) = self.frame(index, trial)?;
            record.close += u32::from(close);
            let spectrum = range_spectrum(frame.index_axis(Axis(0), 0), Window::Rectangular)?;
            let strongest = strongest_range(spectrum.view());
            let region = crop_region(spectrum.view(), strongest, REGION[0], REGION[1])?;
            cell.assign(&region_snapshots(region.view()));
            regions.push(region);
            truths.push((truth_deg, close));
        }
        let mut answers = vec![Answers::default(); truths.len()];
        let trials = cells.outer_iter().zip(&regions).zip(&truths).zip(&mut answers);
        for (((cell, region), (truth_deg, close)), told) in trials {
            let covariance = sample_covariance(cell);
            let snapshots = root(&covariance)?;
            let data = Data::Covariance { matrix: covariance.view(), snapshots: vectors };
            let mut counts = record.counted.iter_mut();
            for ((_, criterion, reversed), counts) in self.counters.iter().zip(&mut counts) {
                let options = CountOptions {
                    criterion: *criterion,
                    forward_backward: *reversed,
                    ..CountOptions::default()
                };
                let (_, counted) = count_sources_in(data, &options)?;
                counts[counted.sources.min(3)] += 1;
                told.counted.push(counted.sources);
            }
            for (model, counts) in counting.iter().zip(counts) {
                let counted = model.count(data)?.sources;
                counts[counted.min(3)] += 1;
                told.counted.push(counted);
            }
            let mut tallies = record.methods.iter_mut();
            for ((estimator, covariance), tally) in estimators.iter_mut().zip(&mut tallies) {
                let data = if *covariance { data } else { Data::Snapshots(snapshots.view()) };
                let found = told::azimuths(estimator, data, count)?;
                if let (Some(tally), Some(found)) = (tally, &found) {
                    tally.count(truth_deg, found, *close);
                }
                told.azimuths_rad.push(found);
            }
            for (plan, tally) in region_plans.iter_mut().zip(&mut tallies) {
                let found = plan.azimuths(region.view(), &covariance, count)?;
                if let (Some(tally), Some(found)) = (tally, &found) {
                    tally.count(truth_deg, found, *close);
                }
                told.azimuths_rad.push(found);
            }
        }
        let tallies = record.methods.iter_mut().skip(estimators.len() + region_plans.len());
        for (network, tally) in networks.iter_mut().zip(tallies) {
            let (Some(network), Some(tally)) = (network, tally) else {
                answers.iter_mut().for_each(|told| told.azimuths_rad.push(None));
                continue;
            };
            let batch = network.estimate_batch(cells.view(), false)?;
            for (cell, ((truth_deg, close), told)) in truths.iter().zip(&mut answers).enumerate() {
                let found = told::strongest(batch.sources_of(cell), count);
                if let Some(found) = &found {
                    tally.count(truth_deg, found, *close);
                }
                told.azimuths_rad.push(found);
            }
        }
        if let Some(tell) = tell {
            for (trial, ((truth_deg, _), answers)) in (first..).zip(truths.iter().zip(&answers)) {
                self.tell(index, trial, truth_deg, answers, &mut *tell);
            }
        }
        Ok(record)
    }
}

/// A network answers with the most probable directions.
fn known(targets: usize) -> EstimatorOptions {
    let (sources, field_of_view_rad) = (SourceCount::Known(targets), FIELD_OF_VIEW_RAD);
    EstimatorOptions { sources, field_of_view_rad, ..EstimatorOptions::default() }
}

/// As many snapshots as elements with the given covariance.
fn root(covariance: &Array2<Complex64>) -> Result<Array2<Complex64>, EvaluateError> {
    let eigen = hermitian_eigen(covariance.view())?;
    let elements = covariance.nrows() as f64;
    let mut vectors = eigen.vectors;
    for (mut column, value) in vectors.columns_mut().into_iter().zip(&eigen.values) {
        column.mapv_inplace(|z| z * (value.max(0.0) * elements).sqrt());
    }
    Ok(vectors)
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use boresight_core::Random;

    #[test]
    fn the_snapshots_have_the_covariance() {
        let mut random = Random::new(1, 0);
        let y = Array2::from_shape_fn((4, 9), |_| random.complex_normal(1.0));
        let covariance = boresight_signal::sample_covariance(y.view());
        let again = boresight_signal::sample_covariance(root(&covariance).unwrap().view());
        assert!((again - covariance).iter().all(|z| z.norm() < 1e-12));
    }
}
