//! The simulated street.

use crate::carry;
use crate::error::Fallible;
use crate::read::{Fields, choice};
use boresight_options::Described;
use boresight_simulate::street::{STREET_RADARS, Street, StreetRadar};
use boresight_simulate::{CubeColumns, VisibleTarget};
use serde::Serialize;
use wasm_bindgen::JsValue;
use wasm_bindgen::prelude::wasm_bindgen;

/// A street around a car with five radars.
#[wasm_bindgen(js_name = streetScene)]
pub fn street_scene(options: &JsValue) -> Fallible<JsValue> {
    let mut fields = Fields::of_optional(options)?;
    let street = Street::new(fields.spread()?)?;
    fields.finish()?;
    Ok(carry::write(&street))
}

/// One frame of one radar of the street.
#[derive(Described, Serialize)]
pub struct SimulatedStreet {
    /// Frames (one) x loops x transmitters x receivers x samples.
    cube: CubeColumns,
    /// The radar.
    radar: StreetRadar,
    /// The points in its field of view and in no deep shadow.
    targets: Vec<VisibleTarget>,
}

/// One frame of one of the radars.
#[wasm_bindgen(js_name = simulateStreet)]
pub fn simulate_street(options: &JsValue) -> Fallible<JsValue> {
    let mut fields = Fields::new(options, "")?;
    let radars: Vec<(&str, usize)> =
        STREET_RADARS.iter().enumerate().map(|(index, name)| (*name, index)).collect();
    let name: String = fields.required("radar")?;
    let radar = choice(&JsValue::from(name), "radar", &radars)?;
    let street = Street::new(fields.spread()?)?;
    fields.finish()?;
    let (cube, targets) = street.cube(radar)?;
    Ok(carry::write(&SimulatedStreet {
        cube: CubeColumns::from(&cube),
        radar: street.radars[radar],
        targets,
    }))
}
