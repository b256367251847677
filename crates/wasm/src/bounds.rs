//! Cramer-Rao bounds.

use crate::carry;
use crate::error::Fallible;
use crate::read::{Angle, Fields, Read};
use boresight_aoa::bounds::{
    Signals, deterministic_bound, single_snapshot, stochastic_bound, uncorrelated,
};
use boresight_core::steering::cis;
use boresight_core::units::{db_to_amplitude, db_to_power};
use boresight_core::{Array, Direction};
use wasm_bindgen::JsValue;
use wasm_bindgen::prelude::wasm_bindgen;

/// A target of a bound, its power over that of the noise.
struct Target {
    direction: Direction,
    snr_db: f64,
    phase_rad: f64,
}

impl Read for Target {
    const EXPECTED: &'static str = "{ azimuthDeg, snrDb }";

    fn read(value: &JsValue, path: &str) -> Fallible<Self> {
        let mut fields = Fields::new(value, path)?;
        let azimuth: Angle = fields.required("azimuthDeg")?;
        let elevation = fields.optional::<Angle>("elevationDeg")?;
        let snr_db = fields.required("snrDb")?;
        boresight_core::error::check_range(&fields.path_of("snrDb"), snr_db, -300.0, 300.0)?;
        let phase_rad = fields.optional::<f64>("phaseDeg")?.unwrap_or(0.0).to_radians();
        fields.finish()?;
        let direction = Direction::new(azimuth.rad, elevation.map_or(0.0, |angle| angle.rad));
        Ok(Self { direction, snr_db, phase_rad })
    }
}

/// Bounds of the angles of uncorrelated targets; of a single snapshot with the given phases.
#[wasm_bindgen(js_name = cramerRaoBound)]
pub fn cramer_rao_bound(options: &JsValue) -> Fallible<JsValue> {
    let mut fields = Fields::new(options, "")?;
    let array: Array = fields.required("array")?;
    let targets: Vec<Target> = fields.required("targets")?;
    let snapshots = fields.required("snapshots")?;
    let mut is_stochastic = false;
    let kinds = [("deterministic", false), ("stochastic", true)];
    fields.update_choice("kind", &kinds, &mut is_stochastic)?;
    fields.finish()?;
    let directions: Vec<Direction> = targets.iter().map(|target| target.direction).collect();
    let covariance = if snapshots == 1 && !is_stochastic {
        let amplitude = |t: &Target| cis(t.phase_rad) * db_to_amplitude(t.snr_db);
        single_snapshot(&targets.iter().map(amplitude).collect::<Vec<_>>())
    } else {
        uncorrelated(&targets.iter().map(|t| db_to_power(t.snr_db)).collect::<Vec<_>>())
    };
    let signals = Signals { covariance: covariance.view(), noise_power: 1.0, snapshots };
    let bound = if is_stochastic {
        stochastic_bound(&array, &directions, &signals)?
    } else {
        deterministic_bound(&array, &directions, &signals)?
    };
    Ok(carry::write(&bound))
}
