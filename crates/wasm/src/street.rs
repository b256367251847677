//! The simulated street.

use crate::error::Fallible;
use crate::image::mounting_record;
use crate::read::{Fields, choice};
use crate::waveform::waveform_record;
use crate::write::{Record, complex32, float64, list};
use boresight_simulate::VisibleTarget;
use boresight_simulate::street::{STREET_RADARS, Street, StreetOutline, StreetRadar, StreetTarget};
use wasm_bindgen::JsValue;
use wasm_bindgen::prelude::wasm_bindgen;

/// A street around a car with four radars.
#[wasm_bindgen(js_name = streetScene)]
pub fn street_scene(options: &JsValue) -> Fallible<JsValue> {
    let mut fields = Fields::of_optional(options)?;
    let street = Street::new(fields.spread()?)?;
    fields.finish()?;
    Ok(Record::new()
        .with("egoSpeedMps", street.options().ego_speed_mps)
        .with("radars", list(street.radars.iter().map(radar_record)))
        .with("targets", list(street.targets.iter().map(target_record)))
        .with("outlines", list(street.outlines.iter().map(outline_record)))
        .into())
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
    let shape = list(cube.shape().iter().copied());
    let (values, _) = cube.into_raw_vec_and_offset();
    let cube = Record::new().with("data", complex32(&values)).with("shape", shape);
    Ok(Record::new()
        .with("cube", cube)
        .with("radar", radar_record(&street.radars[radar]))
        .with("targets", list(targets.iter().map(visible_record)))
        .into())
}

fn radar_record(radar: &StreetRadar) -> Record {
    Record::new()
        .with("name", radar.name)
        .with("mounting", mounting_record(&radar.mounting))
        .with("array", radar.array)
        .with("waveform", waveform_record(&radar.waveform))
        .with("fieldOfViewDeg", radar.field_of_view_rad.to_degrees())
}

fn target_record(target: &StreetTarget) -> Record {
    Record::new()
        .with("xM", target.x_m)
        .with("yM", target.y_m)
        .with("vxMps", target.velocity_mps[0])
        .with("vyMps", target.velocity_mps[1])
        .with("rcsDbsm", target.rcs_dbsm)
        .with("kind", target.kind.name())
        .with("outline", target.outline)
}

fn outline_record(outline: &StreetOutline) -> Record {
    let axis = |k: usize| float64(&outline.corners_m.iter().map(|c| c[k]).collect::<Vec<_>>());
    Record::new().with("kind", outline.kind.name()).with("xM", axis(0)).with("yM", axis(1))
}

fn visible_record(visible: &VisibleTarget) -> Record {
    Record::new()
        .with("target", visible.target)
        .with("rangeM", visible.echo.range_m)
        .with("rateMps", visible.echo.rate_mps)
        .with("azimuthDeg", visible.echo.direction.azimuth_rad.to_degrees())
        .with("powerDb", visible.echo.power_db)
}
