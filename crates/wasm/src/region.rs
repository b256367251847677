//! Regions of interest: the range bins around the strongest target, as networks take them.

use crate::carry;
use crate::complex::Cube;
use crate::error::Fallible;
use crate::read::Read;
use boresight_core::{Complex32, Complex64};
use boresight_options::shaped::ComplexArray;
use boresight_options::{Described, columns};
pub use boresight_signal::region::RegionOptions;
use boresight_signal::region::{
    covariance_features, crop_region, range_spectrum, region_channels, region_covariance,
    strongest_range,
};
use boresight_signal::{SignalError, Window};
use ndarray::{ArrayView4, Axis};
use serde::Serialize;
use wasm_bindgen::JsValue;
use wasm_bindgen::prelude::wasm_bindgen;

/// The range bins around the strongest of a frame.
#[derive(Described, Serialize)]
pub struct RegionOfInterest {
    /// The strongest range bin.
    range_bin: usize,
    /// Bins x elements x chirps, with the power of raw samples: no window.
    region: ComplexArray,
    /// Covariance of the region, elements x elements.
    covariance: ComplexArray,
    /// The strongest bin alone, elements x chirps.
    snapshots: ComplexArray,
    /// What the 3D-CNN takes of it: magnitude, real and imaginary part of each number of the region.
    #[serde(serialize_with = "columns::serialize")]
    channels: Vec<f32>,
    /// What networks on the covariance take of it (the paper's equation 8).
    #[serde(serialize_with = "columns::serialize")]
    features: Vec<f32>,
}

impl RegionOfInterest {
    /// The region of interest of a frame: loops x transmitters x receivers x samples.
    ///
    /// # Errors
    /// As [`range_spectrum`] and [`crop_region`].
    pub fn of(frame: ArrayView4<Complex32>, options: RegionOptions) -> Result<Self, SignalError> {
        let RegionOptions { bins, chirps } = options;
        let spectrum = range_spectrum(frame, Window::Rectangular)?;
        let range_bin = strongest_range(spectrum.view());
        let region = crop_region(spectrum.view(), range_bin, bins, chirps)?;
        let covariance = region_covariance(region.view());
        let double = region.mapv(|z| Complex64::new(z.re.into(), z.im.into()));
        let middle = double.index_axis(Axis(0), bins / 2).to_owned();
        Ok(Self {
            range_bin,
            region: ComplexArray::from(&double),
            snapshots: ComplexArray::from(&middle),
            channels: region_channels(region.view()).into_iter().collect(),
            features: covariance_features(covariance.view()),
            covariance: ComplexArray::from(&covariance),
        })
    }
}

/// The region of interest of a cube of one frame.
#[wasm_bindgen(js_name = strongestRegion)]
pub fn strongest_region(cube: &JsValue, options: &JsValue) -> Fallible<JsValue> {
    let cube = Cube::read(cube, "cube")?;
    let options = carry::read_optional(options)?;
    Ok(carry::write(&RegionOfInterest::of(cube.one_frame()?, options)?))
}
