//! Parts of an experiment, run anywhere, put together.

use crate::error::EvaluateError;
use crate::{
    aoa, arrays, calibration, doa, hard, images, imperfections, low_snr, near_field, resolution,
    straddling,
};
use boresight_core::InputError;
use boresight_validate::Experiment as _;
use boresight_validate::merge::{Merged, Parts};
use std::path::PathBuf;

/// Puts together the records in `sources`, files of records or folders of them, of whichever experiment.
///
/// # Errors
/// Those of [`Parts::read`] and [`Parts::put_together`]; [`InputError::Unknown`] for records of no experiment.
pub fn merge(sources: &[PathBuf]) -> Result<Merged, EvaluateError> {
    let parts = Parts::read(sources)?;
    match parts.experiment() {
        aoa::AoaExperiment::NAME => parts.put_together::<aoa::AoaExperiment>(),
        arrays::ArraysExperiment::NAME => parts.put_together::<arrays::ArraysExperiment>(),
        calibration::CalibrationExperiment::NAME => {
            parts.put_together::<calibration::CalibrationExperiment>()
        }
        doa::DoaExperiment::NAME => parts.put_together::<doa::DoaExperiment>(),
        hard::HardExperiment::NAME => parts.put_together::<hard::HardExperiment>(),
        images::ImagesExperiment::NAME => parts.put_together::<images::ImagesExperiment>(),
        imperfections::ImperfectionsExperiment::NAME => {
            parts.put_together::<imperfections::ImperfectionsExperiment>()
        }
        low_snr::LowSnrExperiment::NAME => parts.put_together::<low_snr::LowSnrExperiment>(),
        resolution::ResolutionExperiment::NAME => {
            parts.put_together::<resolution::ResolutionExperiment>()
        }
        near_field::NearFieldExperiment::NAME => {
            parts.put_together::<near_field::NearFieldExperiment>()
        }
        straddling::StraddlingExperiment::NAME => {
            parts.put_together::<straddling::StraddlingExperiment>()
        }
        name => Err(InputError::Unknown {
            what: format!("experiment of {}", parts.first().display()),
            expected:
                "aoa, arrays, calibration, doa, hard, images, imperfections, low-snr, near-field, resolution, straddling"
                    .into(),
            given: name.into(),
        }
        .into()),
    }
}
