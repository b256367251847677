//! What finds targets in snapshots: methods and networks as they are named, plain and refined.

use super::cell::TARGETS_WITHIN_RAD;
use super::plain_iaa::PlainIaa;
use super::score::{Threshold, WITHIN_RAD};
use crate::entrants::{Entrants, Network, REFINED};
use crate::error::EvaluateError;
use boresight_aoa::options::Thresholding;
use boresight_aoa::{
    AoaError, BatchEstimate, Estimator, EstimatorOptions, Method, Source, SourceCount,
};
use boresight_core::{Array, Complex64, Direction};
use boresight_neural::Kind;
use boresight_options::Named;
use ndarray::ArrayView3;
use std::sync::{Mutex, PoisonError};

/// Half width of the sector that all methods search, rad: to where predictions are right, since a spectrum's maximum at
/// the edge of its grid is no peak.
const FIELD_OF_VIEW_RAD: f64 = TARGETS_WITHIN_RAD + WITHIN_RAD;
/// Most predictions of a snapshot, and of networks, which say of each how sure they are.
const MOST: usize = 64;
const MOST_OF_NETWORKS: usize = 512;
/// Threshold of IAA where it has one, below the strongest power: twice the range of the targets, and a little.
const THRESHOLD_DB: f64 = 30.0;

/// What finds targets in a snapshot.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Finder {
    /// With the thresholding of IAA.
    Method(Method, Thresholding),
    /// IAA on a grid of so many points a degree, see [`PlainIaa`].
    PlainIaa(u8),
    Network(Network),
}

/// Names of [`Finder::PlainIaa`], and grid points a degree.
const PLAIN_IAA: [(&str, u8); 2] = [("plain-iaa", 1), ("plain-iaa-half-degree", 2)];

impl Finder {
    pub(super) fn name(&self) -> String {
        match self {
            Self::Method(method, Thresholding::None) => method.name().into(),
            Self::Method(method, thresholding) => {
                format!("{}+{}", method.name(), thresholding.name())
            }
            Self::PlainIaa(wanted) => PLAIN_IAA
                .into_iter()
                .find(|(_, per_degree)| per_degree == wanted)
                .map_or("plain-iaa", |(name, _)| name)
                .into(),
            Self::Network(network) => network.name.clone(),
        }
    }

    /// What its predictions are swept over.
    pub(super) fn threshold(&self) -> Threshold {
        match self {
            Self::Network(network) if network.kind != Kind::UnrolledIaa => Threshold::Confidence,
            _ => Threshold::Power,
        }
    }

    /// Whether it is more than a name.
    pub(crate) fn can_run(&self) -> bool {
        !matches!(self, Self::Network(Network { model: None, .. }))
    }

    /// Directions that count where there is no sweep: of a network those it is sure enough of.
    pub(crate) fn sure(&self, sources: &[Source]) -> Vec<Direction> {
        self.sure_sources(sources).map(|s| *s.direction).collect()
    }

    /// The sources of these directions.
    pub(crate) fn sure_sources<'a>(
        &self,
        sources: &'a [Source],
    ) -> impl Iterator<Item = &'a Source> + use<'a> {
        let least = match self {
            Self::Network(network) => network.confidence(),
            Self::Method(..) | Self::PlainIaa(_) => 0.0,
        };
        sources.iter().filter(move |s| s.confidence.is_none_or(|of| of >= least))
    }

    /// For `targets` targets, or as many as the method can find. A network says what it finds by itself.
    pub(super) fn estimator(
        &self,
        array: &Array,
        targets: usize,
    ) -> Result<Estimator, EvaluateError> {
        match self.with_options(array, angle_options(targets)) {
            Err(EvaluateError::Angle(AoaError::TooManySources { most, .. })) => {
                self.with_options(array, angle_options(most))
            }
            result => result,
        }
    }

    /// With options, of which networks do without a number of sources and without thresholds.
    pub(crate) fn with_options(
        &self,
        array: &Array,
        options: EstimatorOptions,
    ) -> Result<Estimator, EvaluateError> {
        Ok(match self {
            Self::Network(network) => {
                let sources = EstimatorOptions::default().sources;
                let options = EstimatorOptions {
                    sources,
                    confidence: Some(0.0),
                    max_peaks: MOST_OF_NETWORKS,
                    ..options
                };
                network.model()?.estimator(array, &options)?
            }
            Self::PlainIaa(per_degree) => {
                let plan = Box::new(PlainIaa::new(array, *per_degree));
                Estimator::with_plan(Method::Iaa, array, plan, &options)?
            }
            Self::Method(method, thresholding) => {
                let mut options = options;
                options.iaa.thresholding = *thresholding;
                options.iaa.threshold_db = THRESHOLD_DB;
                Estimator::new(*method, array, &options)?
            }
        })
    }
}

/// What is compared: a finder, and whether its directions are refined on the snapshot.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Candidate {
    pub(crate) finder: Finder,
    pub(crate) refined: bool,
}

impl Candidate {
    /// Methods as they are named, each network plain and refined.
    pub(crate) fn all(entrants: &Entrants) -> Result<Vec<Self>, EvaluateError> {
        let mut all = vec![];
        for name in &entrants.methods {
            let candidate = Self::method(name)?;
            if !all.contains(&candidate) {
                all.push(candidate);
            }
        }
        for network in &entrants.networks {
            let finder = Finder::Network(network.clone());
            all.extend([false, true].map(|refined| Self { finder: finder.clone(), refined }));
        }
        Ok(all)
    }

    /// A method as it is named: `iaa`, `iaa+hard`, `nomp+refined`, `iaa+soft+refined`.
    fn method(name: &str) -> Result<Self, EvaluateError> {
        let plain = name.strip_suffix(REFINED);
        let refined = plain.is_some();
        let name = plain.unwrap_or(name);
        let plain_iaa = PLAIN_IAA.into_iter().find(|(known, _)| *known == name);
        let finder = match (plain_iaa, name.split_once('+')) {
            (Some((_, per_degree)), _) => Finder::PlainIaa(per_degree),
            (_, Some((of, how))) if of == Method::Iaa.name() => {
                Finder::Method(Method::Iaa, Thresholding::from_name("thresholding", how)?)
            }
            _ => Finder::Method(Method::from_name(name)?, Thresholding::None),
        };
        Ok(Self { finder, refined })
    }

    pub(crate) fn name(&self) -> String {
        format!("{}{}", self.finder.name(), if self.refined { REFINED } else { "" })
    }

    /// What it is swept over.
    pub(super) fn threshold(&self) -> Threshold {
        if self.refined { Threshold::Power } else { self.finder.threshold() }
    }
}

/// All predictions, so that their power can be swept.
pub(super) fn angle_options(targets: usize) -> EstimatorOptions {
    EstimatorOptions {
        grid_points: 2048,
        field_of_view_rad: FIELD_OF_VIEW_RAD,
        dynamic_range_db: 40.0,
        max_peaks: MOST,
        sources: SourceCount::Known(targets),
        ..EstimatorOptions::default()
    }
}

/// Networks that no thread works with at the moment, by name: they take long to prepare and are for any number of
/// targets.
#[derive(Default)]
pub(crate) struct Idle(Mutex<Vec<(String, Estimator)>>);

impl Idle {
    /// What an idle estimator of the finder, or a new one, finds in snapshots, with spectra where they are asked for.
    pub(crate) fn estimate(
        &self,
        finder: &Finder,
        new: impl FnOnce() -> Result<Estimator, EvaluateError>,
        scenes: ArrayView3<Complex64>,
        spectra: bool,
    ) -> Result<BatchEstimate, EvaluateError> {
        let mut estimator = self.take(finder).map_or_else(new, Ok)?;
        let batch = estimator.estimate_batch(scenes, spectra)?;
        if let Finder::Network(network) = finder {
            let mut idle = self.0.lock().unwrap_or_else(PoisonError::into_inner);
            idle.push((network.name.clone(), estimator));
        }
        Ok(batch)
    }

    fn take(&self, finder: &Finder) -> Option<Estimator> {
        let Finder::Network(network) = finder else { return None };
        let mut idle = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        let at = idle.iter().position(|(name, _)| *name == network.name)?;
        Some(idle.swap_remove(at).1)
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use boresight_aoa::Data;
    use boresight_core::presets::preset;
    use boresight_simulate::snapshots::{
        Fluctuation, Scene, SnapshotOptions, SnapshotSimulator, Target,
    };

    /// Azimuths that a method finds of one target at the end of the sector, deg.
    fn found(name: &str, array: &Array, azimuth_rad: f64, trial: u64) -> Vec<f64> {
        let direction = Direction::azimuth(azimuth_rad);
        let target = Target { direction: direction.into(), ..Target::default() };
        let options = SnapshotOptions {
            scene: Scene::Given(vec![target]),
            snr_db: 30.0,
            snapshots: 1,
            fluctuation: Fluctuation::RandomPhase,
            seed: 1,
            ..SnapshotOptions::default()
        };
        let (y, _) = SnapshotSimulator::new(array, &options).unwrap().scene(trial).unwrap();
        let finder = Candidate::method(name).unwrap().finder;
        let estimate = finder.estimator(array, 1).unwrap().estimate(Data::Snapshots(y.view()));
        let sources = estimate.unwrap().sources;
        sources.iter().map(|source| source.direction.azimuth_rad.to_degrees()).collect()
    }

    #[test]
    fn every_method_finds_targets_where_their_sector_ends() {
        let array = preset("ula16").unwrap();
        for name in super::super::default_methods(&array) {
            for end in [-TARGETS_WITHIN_RAD, TARGETS_WITHIN_RAD] {
                for trial in 0..20 {
                    let found = found(&name, &array, end, trial);
                    let near = found.iter().any(|f| (f - end.to_degrees()).abs() <= 0.5);
                    assert!(near, "{name}: {found:?}");
                }
            }
        }
    }
}
