//! The whole flow of the paper's Figure 4 on the same scenes: detection along range, regions, the counting network,
//! and the network for the number it gave.

use super::REGION;
use super::answers::Answers;
use super::end_to_end::EndToEnd;
use super::plan::Plan;
use super::tally::{DoaRecord, Tally};
use crate::entrants::Network;
use crate::error::EvaluateError;
use boresight_aoa::{Counted, Data, EstimatorOptions, SourceCount};
use boresight_neural::REGION_FIELD_OF_VIEW_RAD;
use boresight_pipeline::RegionChain;
use boresight_pipeline::regions::RegionFinder;
use boresight_validate::experiment::Tell;
use ndarray::Axis;

impl Plan {
    /// Trials of one condition from end to end; tells of each its number, truth and answers.
    pub(super) fn run_end_to_end(
        &self,
        flow: &EndToEnd,
        index: usize,
        first: u64,
        trials: u64,
        mut tell: Option<Tell>,
    ) -> Result<DoaRecord, EvaluateError> {
        let count = self.conditions[index].targets.count();
        let receivers = self.array.rx().len();
        let mut finder = RegionFinder::new(&self.waveform, receivers, &self.array, &flow.regions)?;
        let counting: Vec<_> =
            self.networks_that(true).map(Network::model).collect::<Result<_, _>>()?;
        let mut chains: Vec<Option<RegionChain>> = vec![];
        for network in self.networks_that(false).filter(|_| count > 0) {
            let model = network.model()?;
            let suits = model.card().and_then(|card| card.targets).is_none_or(|of| of == count);
            let of = |sources| {
                let options = EstimatorOptions {
                    sources: SourceCount::Known(sources),
                    field_of_view_rad: REGION_FIELD_OF_VIEW_RAD,
                    refine: flow.regions.refine,
                    ..EstimatorOptions::default()
                };
                model.estimator(&self.array, &options)
            };
            let chain = || {
                let counter = flow.counting.model()?.counter()?;
                let counted = Counted::new(counter, [of(1)?, of(2)?])?;
                let options = &flow.regions;
                Ok::<_, EvaluateError>(RegionChain::new(
                    &self.waveform,
                    receivers,
                    options,
                    counted,
                )?)
            };
            chains.push(suits.then(chain).transpose()?);
        }
        let mut record = DoaRecord {
            condition: index,
            trials: trials as u32,
            close: 0,
            counted: vec![[0; 4]; counting.len()],
            methods: chains.iter().map(|chain| chain.as_ref().map(|_| Tally::default())).collect(),
        };
        for trial in first..first + trials {
            let (frame, truth_deg, close) = self.frame(index, trial)?;
            record.close += u32::from(close);
            let frame = frame.index_axis(Axis(0), 0);
            let mut answers = Answers::default();
            let found = if counting.is_empty() { vec![] } else { finder.find(frame)?.regions };
            for (model, counts) in counting.iter().zip(&mut record.counted) {
                let mut all = 0;
                for region in &found {
                    let covariance = region.covariance(flow.regions.count_loading);
                    let (matrix, snapshots) = (covariance.view(), REGION[0] * REGION[1]);
                    all += model.count(Data::Covariance { matrix, snapshots })?.sources;
                }
                counts[all.min(3)] += 1;
                answers.counted.push(all);
            }
            for (chain, tally) in chains.iter_mut().zip(&mut record.methods) {
                let (Some(chain), Some(tally)) = (chain, tally) else {
                    answers.azimuths_rad.push(None);
                    continue;
                };
                let regions = chain.process(frame)?.regions;
                let targets = regions.iter().flat_map(|region| &region.targets);
                let mut found: Vec<f64> =
                    targets.map(|target| flow.offset_rad(target.azimuth_rad)).collect();
                found.sort_by(f64::total_cmp);
                let found = (found.len() == count).then_some(found);
                if let Some(found) = &found {
                    tally.count(&truth_deg, found, close);
                }
                answers.azimuths_rad.push(found);
            }
            if let Some(tell) = tell.as_deref_mut() {
                self.tell(index, trial, &truth_deg, &answers, tell);
            }
        }
        Ok(record)
    }
}
