//! The mounting angle of a radar, one frame at a time.

use crate::bytes::Bytes;
use crate::carry;
use crate::complex::float_array;
use crate::error::Fallible;
use crate::read::{Fields, Read, items};
use boresight_core::{Detection, InputError};
use boresight_math::error::check_single;
use boresight_mounting::network::MotionNetwork;
use boresight_mounting::{
    self as calibrate, CalibrationOptions, Calibrator, FrameInput, MountingError,
};
use std::sync::Arc;
use wasm_bindgen::JsValue;
use wasm_bindgen::prelude::wasm_bindgen;

/// Options of a calibration, and the network of motion that may come with them as bytes.
pub fn read_options(value: &JsValue) -> Fallible<(CalibrationOptions, Option<Arc<MotionNetwork>>)> {
    let mut fields = Fields::new(value, "")?;
    let network = fields.raw("network")?;
    let options = fields.spread()?;
    fields.finish()?;
    Ok((options, network.map(|bytes| read_network(&bytes, "network")).transpose()?))
}

fn read_network(value: &JsValue, path: &str) -> Fallible<Arc<MotionNetwork>> {
    let bytes = Bytes::read(value, path)?.0;
    Ok(Arc::new(MotionNetwork::read(&bytes).map_err(MountingError::from)?))
}

/// A calibration in progress.
#[wasm_bindgen]
pub struct Calibration {
    inner: Calibrator,
}

#[wasm_bindgen]
impl Calibration {
    /// Checks the options and prepares.
    #[wasm_bindgen(constructor)]
    pub fn new(options: &JsValue) -> Fallible<Self> {
        let (options, network) = read_options(options)?;
        Ok(Self { inner: Calibrator::with_network(options, network.as_ref())? })
    }

    /// Takes the next frame and says what became of it.
    #[wasm_bindgen(js_name = addFrame)]
    pub fn add_frame(&mut self, frame: &JsValue) -> Fallible<JsValue> {
        let frame = Frame::read(frame, "frame")?;
        Ok(carry::write(&self.inner.add(FrameInput {
            time_s: frame.time_s,
            detections: &frame.detections,
            yaw_rate_radps: frame.yaw_rate_radps,
            speed_mps: frame.speed_mps,
        })?))
    }

    /// Starts a session on another clock.
    pub fn restart(&mut self) {
        self.inner.restart();
    }

    /// The angle as far as the frames so far tell.
    pub fn estimate(&self) -> JsValue {
        carry::write(&self.inner.estimate())
    }

    /// What driving on would bring; null for the methods that weigh all frames at once.
    pub fn outlook(&self) -> JsValue {
        self.inner.outlook().map_or(JsValue::NULL, |outlook| carry::write(&outlook))
    }

    /// The calibration as bytes.
    pub fn snapshot(&self) -> Fallible<Vec<u8>> {
        Ok(self.inner.snapshot()?)
    }

    /// The calibration that bytes are of, with its network if it has one.
    pub fn restore(snapshot: &JsValue, network: &JsValue) -> Fallible<Self> {
        let bytes = Bytes::read(snapshot, "snapshot")?.0;
        let given = (!network.is_undefined()).then(|| read_network(network, "network"));
        Ok(Self { inner: Calibrator::restore(&bytes, given.transpose()?.as_ref())? })
    }
}

/// The angle from several drives with one radar, each as the bytes of its calibration.
#[wasm_bindgen(js_name = mergeCalibrations)]
pub fn merge_calibrations(snapshots: &JsValue) -> Fallible<JsValue> {
    let mut drives = vec![];
    for (item, path) in items(snapshots, "snapshots")? {
        drives.push(calibrate::Recursive::restore(&Bytes::read(&item, &path)?.0)?);
    }
    Ok(carry::write(&calibrate::merge(&drives)?))
}

struct Frame {
    time_s: f64,
    detections: Vec<Detection>,
    yaw_rate_radps: Option<f64>,
    speed_mps: Option<f64>,
}

impl Read for Frame {
    const EXPECTED: &'static str = "{ timeS, azimuthDeg, rangeRateMps, yawRateDegps }";

    fn read(value: &JsValue, path: &str) -> Fallible<Self> {
        let mut fields = Fields::new(value, path)?;
        let time_s = fields.required("timeS")?;
        let azimuth = float_array(&mut fields, "azimuthDeg")?.0;
        let rates = column(&mut fields, "rangeRateMps", azimuth.len())?;
        for (name, numbers) in [("azimuthDeg", &azimuth), ("rangeRateMps", &rates)] {
            // As they will be kept: what single precision does not hold is refused too.
            check_single(&|| fields.path_of(name), numbers)?;
        }
        let mut known = |name| match fields.raw(name)? {
            Some(given) if !given.is_null() => column(&mut fields, name, azimuth.len()).map(Some),
            _ => Ok(None),
        };
        let (ranges, rcs) = (known("rangeM")?, known("rcsDbsm")?);
        let YawRate(yaw_rate_radps) = fields.required("yawRateDegps")?;
        let speed_mps = fields.raw("speedMps")?.filter(|speed| !speed.is_null());
        let speed_mps =
            speed_mps.map(|speed| f64::read(&speed, &fields.path_of("speedMps"))).transpose()?;
        // What a frame of a drive has beside.
        for name in ["sensor", "label"] {
            fields.raw(name)?;
        }
        fields.finish()?;
        let detections = Detection::of_columns(&azimuth, &rates, ranges.as_deref(), rcs.as_deref());
        Ok(Self { time_s, detections, yaw_rate_radps, speed_mps })
    }
}

/// A yaw rate in rad/s; `null` where there is none.
struct YawRate(Option<f64>);

impl Read for YawRate {
    const EXPECTED: &'static str = "a number or null";

    fn read(value: &JsValue, path: &str) -> Fallible<Self> {
        if value.is_null() {
            return Ok(Self(None));
        }
        Ok(Self(Some(f64::read(value, path)?.to_radians())))
    }
}

/// Numbers of a field, one for each of `count` detections.
fn column(fields: &mut Fields, name: &'static str, count: usize) -> Fallible<Vec<f64>> {
    let (numbers, _) = float_array(fields, name)?;
    if numbers.len() == count {
        return Ok(numbers);
    }
    let (what, expected) = (fields.path_of(name), format!("[{count}], as azimuthDeg has"));
    Err(InputError::Shape { what, expected, given: vec![numbers.len()] }.into())
}
