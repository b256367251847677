//! The whole flow of the paper's Figure 4 on the same scenes: detection along range, regions, the counting network,
//! and the network for the number it gave.

use super::REGION;
use super::answers::Answers;
use super::trial::{DoaRecord, Plan, Tally};
use crate::EvaluateError;
use crate::entrants::Network;
use boresight_aoa::{Counted, Data, EstimatorOptions, SourceCount};
use boresight_math::error::check_range;
use boresight_neural::{Kind, REGION_FIELD_OF_VIEW_RAD};
use boresight_pipeline::RegionChain;
use boresight_pipeline::regions::{RegionChainOptions, RegionFinder};
use boresight_validate::experiment::Tell;
use ndarray::Axis;
use serde::{Deserialize, Serialize};

/// How frames become regions, in place of being told the strongest bin and the number of targets.
///
/// A scene is counted as what its regions hold together. Angles are those of a network where the flow counts as many
/// targets as there are; where it does not, the network has not found them.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "camelCase")]
pub struct EndToEnd {
    /// The network that counts for those that estimate angles.
    pub counting: Network,
    /// Targets are put around this azimuth, deg, in place of boresight: their sines lie as far from its sine as those
    /// of whole degrees do from 0. Errors are of these degrees.
    pub centre_deg: f64,
    /// Detection and regions.
    #[serde(with = "in_records")]
    pub regions: RegionChainOptions,
}

/// Serde functions for stored records, in which the region size is named `..size`.
mod in_records {
    use boresight_pipeline::regions::RegionChainOptions;
    use serde::{Deserialize, Deserializer, Serialize, Serializer, de, ser};
    use serde_json::Value;

    const STORED: &str = "..size";
    const OWN: &str = "size";

    pub fn serialize<S: Serializer>(
        options: &RegionChainOptions,
        serializer: S,
    ) -> Result<S::Ok, S::Error> {
        let value = serde_json::to_value(options).map_err(ser::Error::custom)?;
        renamed(value, OWN, STORED).serialize(serializer)
    }

    pub fn deserialize<'de, D: Deserializer<'de>>(
        deserializer: D,
    ) -> Result<RegionChainOptions, D::Error> {
        let value = renamed(Value::deserialize(deserializer)?, STORED, OWN);
        serde_json::from_value(value).map_err(de::Error::custom)
    }

    fn renamed(mut value: Value, from: &str, to: &str) -> Value {
        if let Value::Object(fields) = &mut value
            && let Some(inner) = fields.remove(from)
        {
            fields.insert(to.into(), inner);
        }
        value
    }
}

impl EndToEnd {
    pub(super) fn check(&self) -> Result<(), EvaluateError> {
        // The farthest target still lies before the array.
        check_range("centre_deg", self.centre_deg, -50.0, 50.0)?;
        self.regions.check()?;
        if self.counting.kind != Kind::Counting {
            let given = self.counting.name.clone();
            let (what, expected) = ("counting network".into(), "one that counts".into());
            return Err(boresight_core::InputError::Incompatible { what, expected, given }.into());
        }
        Ok(())
    }

    /// The azimuth of a target at some degrees from the centre, rad.
    pub(super) fn azimuth_rad(&self, offset_deg: f64) -> f64 {
        if self.centre_deg == 0.0 {
            return offset_deg.to_radians();
        }
        (offset_deg.to_radians().sin() + self.centre_deg.to_radians().sin()).asin()
    }

    /// The other way round: degrees from the centre, in radians.
    fn offset_rad(&self, azimuth_rad: f64) -> f64 {
        if self.centre_deg == 0.0 {
            return azimuth_rad;
        }
        (azimuth_rad.sin() - self.centre_deg.to_radians().sin()).clamp(-1.0, 1.0).asin()
    }
}

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

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    #[derive(Debug, PartialEq, Serialize, Deserialize)]
    struct Stored(#[serde(with = "in_records")] RegionChainOptions);

    #[test]
    fn records_name_the_region_size_as_stored_records_do() {
        let mut options = RegionChainOptions::default();
        options.size.bins += 2;
        let stored = Stored(options);
        let value = serde_json::to_value(&stored).unwrap();
        assert_eq!(value["..size"]["bins"], options.size.bins);
        assert!(value.get("size").is_none());
        assert_eq!(serde_json::from_value::<Stored>(value).unwrap(), stored);
    }
}
