//! Options of the estimators out of JavaScript.

use crate::error::Fallible;
use crate::read::{Fields, Read, choice, wrong_type};
use boresight_aoa::options::{
    EspritForm, IaaForm, IaaOptions, IaaPrecision, NompOptions, Thresholding,
};
use boresight_aoa::{Method, Options, SourceCount};
use boresight_core::error::check_range;
use wasm_bindgen::JsValue;

impl Read for Method {
    const EXPECTED: &'static str = "the name of a method";

    fn read(value: &JsValue, path: &str) -> Fallible<Self> {
        let known: Vec<_> = Self::ALL
            .iter()
            .chain(&Self::NETWORKS)
            .map(|method| (method.name(), *method))
            .collect();
        choice(value, path, &known)
    }
}

impl Read for SourceCount {
    const EXPECTED: &'static str = "a number, 'aic' or 'mdl'";

    fn read(value: &JsValue, path: &str) -> Fallible<Self> {
        if value.as_f64().is_some() {
            return Ok(Self::Known(usize::read(value, path)?));
        }
        if value.as_string().is_none() {
            return Err(wrong_type(path, Self::EXPECTED, value));
        }
        choice(value, path, &[("aic", Self::Aic), ("mdl", Self::Mdl)])
    }
}

/// Reads what is shared by all estimators; the caller has read `method` and `array`.
pub fn read_options(fields: &mut Fields) -> Fallible<Options> {
    let mut options = Options::default();
    fields.update("sources", &mut options.sources)?;
    update_half_width(fields, "fieldOfViewDeg", &mut options.field_of_view_rad)?;
    update_half_width(fields, "elevationFieldOfViewDeg", &mut options.elevation_field_of_view_rad)?;
    fields.update("gridPoints", &mut options.grid_points)?;
    fields.update("elevationPoints", &mut options.elevation_points)?;
    fields.update("forwardBackward", &mut options.forward_backward)?;
    options.smoothing = fields.optional("smoothing")?;
    fields.update("loading", &mut options.loading)?;
    fields.update("dynamicRangeDb", &mut options.dynamic_range_db)?;
    fields.update("maxPeaks", &mut options.max_peaks)?;
    let forms = [
        ("least-squares", EspritForm::LeastSquares),
        ("total-least-squares", EspritForm::TotalLeastSquares),
    ];
    fields.update_choice("esprit", &forms, &mut options.esprit)?;
    if let Some(fields) = fields.object("iaa")? {
        read_iaa(fields, &mut options.iaa)?;
    }
    if let Some(fields) = fields.object("nomp")? {
        read_nomp(fields, &mut options.nomp)?;
    }
    fields.update("refine", &mut options.refine)?;
    fields.update("maxIterations", &mut options.max_iterations)?;
    fields.update("tolerance", &mut options.tolerance)?;
    options.confidence = fields.optional("confidence")?;
    // Networks are found by what calls this; a method that lacks its own says so.
    fields.raw("network")?;
    Ok(options)
}

fn read_iaa(mut fields: Fields, iaa: &mut IaaOptions) -> Fallible<()> {
    fields.update("iterations", &mut iaa.iterations)?;
    let kinds =
        [("none", Thresholding::None), ("hard", Thresholding::Hard), ("soft", Thresholding::Soft)];
    fields.update_choice("thresholding", &kinds, &mut iaa.thresholding)?;
    fields.update("thresholdDb", &mut iaa.threshold_db)?;
    fields.update("regularisation", &mut iaa.regularisation)?;
    let forms = [("auto", IaaForm::Auto), ("fast", IaaForm::Fast), ("dense", IaaForm::Dense)];
    fields.update_choice("form", &forms, &mut iaa.form)?;
    let precisions = [("auto", IaaPrecision::Auto), ("double", IaaPrecision::Double)];
    fields.update_choice("precision", &precisions, &mut iaa.precision)?;
    fields.finish()
}

fn read_nomp(mut fields: Fields, nomp: &mut NompOptions) -> Fallible<()> {
    fields.update("falseAlarm", &mut nomp.false_alarm)?;
    nomp.noise_power = fields.optional("noisePower")?;
    fields.update("oversampling", &mut nomp.oversampling)?;
    fields.update("singleRefinements", &mut nomp.single_refinements)?;
    fields.update("cyclicRefinements", &mut nomp.cyclic_refinements)?;
    fields.update("maxSources", &mut nomp.max_sources)?;
    fields.finish()
}

/// Half width of a field of view, given in degrees.
fn update_half_width(fields: &mut Fields, name: &'static str, rad: &mut f64) -> Fallible<()> {
    if let Some(degrees) = fields.optional::<f64>(name)? {
        check_range(&fields.path_of(name), degrees, 0.1, 90.0)?;
        *rad = degrees.to_radians();
    }
    Ok(())
}
