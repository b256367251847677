//! Options of the chain from frames to detections.

use crate::error::{BindingError, Fallible};
use crate::options::read_options;
use crate::read::{Angle, Fields, Read, choice};
use boresight_aoa::{Method, Options};
use boresight_core::{Array, Waveform};
use boresight_pipeline::ChainOptions;
use boresight_signal::{CfarAxes, CfarKind, CfarOptions, Region, Window};
use wasm_bindgen::JsValue;

/// Reads the options of the chain over a cube, of which nothing else is known.
pub fn read_cube_chain(options: &JsValue) -> Fallible<(Waveform, Array, ChainOptions)> {
    let mut fields = Fields::new(options, "")?;
    let waveform = fields.required("waveform")?;
    let (array, options) = read_chain(&mut fields)?;
    fields.finish()?;
    let array = array.ok_or_else(|| BindingError::Missing {
        what: "array".into(),
        expected: Array::EXPECTED.into(),
    })?;
    Ok((waveform, array, options))
}

/// Reads the options of the chain, and the array where one is named.
pub fn read_chain(fields: &mut Fields) -> Fallible<(Option<Array>, ChainOptions)> {
    let array = fields.optional("array")?;
    let mut options = ChainOptions::default();
    let transform = &mut options.range_doppler;
    fields.update("rangeWindow", &mut transform.range_window)?;
    fields.update("dopplerWindow", &mut transform.doppler_window)?;
    fields.update("rangePadding", &mut transform.range_padding)?;
    fields.update("dopplerPadding", &mut transform.doppler_padding)?;
    fields.update("staticClutterRemoval", &mut transform.static_clutter_removal)?;
    if let Some(fields) = fields.object("cfar")? {
        read_cfar(fields, &mut options.cfar)?;
    }
    fields.update("peakGrouping", &mut options.peak_grouping)?;
    if let Some(fields) = fields.object("region")? {
        read_region(fields, &mut options.region)?;
    }
    if let Some(fields) = fields.object("angle")? {
        (options.method, options.angle) = read_angle(fields, options.method)?;
    }
    fields.update("maxDetections", &mut options.max_detections)?;
    Ok((array, options))
}

/// Reads a method with its options; `method` where none is named.
pub fn read_angle(mut fields: Fields, method: Method) -> Fallible<(Method, Options)> {
    let method = fields.optional("method")?.unwrap_or(method);
    let options = read_options(&mut fields)?;
    fields.finish()?;
    Ok((method, options))
}

fn read_cfar(mut fields: Fields, cfar: &mut CfarOptions) -> Fallible<()> {
    fields.update_choice(
        "kind",
        &[
            ("cell-averaging", CfarKind::CellAveraging),
            ("greatest-of", CfarKind::GreatestOf),
            ("smallest-of", CfarKind::SmallestOf),
            ("ordered-statistic", CfarKind::OrderedStatistic { rank: 0.75 }),
        ],
        &mut cfar.kind,
    )?;
    if let Some(wanted) = fields.optional("rank")?
        && let CfarKind::OrderedStatistic { rank } = &mut cfar.kind
    {
        *rank = wanted;
    }
    let axes =
        [("range", CfarAxes::Range), ("doppler", CfarAxes::Doppler), ("both", CfarAxes::Both)];
    fields.update_choice("axes", &axes, &mut cfar.axes)?;
    fields.update("falseAlarm", &mut cfar.false_alarm)?;
    fields.update("guardCells", &mut cfar.guard)?;
    fields.update("trainingCells", &mut cfar.training)?;
    fields.finish()
}

fn read_region(mut fields: Fields, region: &mut Region) -> Fallible<()> {
    region.range_m = fields.optional("rangeM")?;
    region.rate_mps = fields.optional("rateMps")?;
    let azimuth = fields.optional::<[Angle; 2]>("azimuthDeg")?;
    region.azimuth_rad = azimuth.map(|limits| limits.map(|angle| angle.rad));
    fields.finish()
}

impl Read for Window {
    const EXPECTED: &'static str = "the name of a window";

    fn read(value: &JsValue, path: &str) -> Fallible<Self> {
        let names = Self::NAMES.map(|name| (name, name));
        Ok(Self::named(choice(value, path, &names)?)?)
    }
}
