//! Mounting angles from many frames at a time, as flat numbers; for the TypeScript around this
//! crate, which checks what goes in.

use crate::calibrate::read_options;
use crate::carry;
use crate::error::{BindingError, Fallible};
use crate::given;
use crate::read::{Fields, items};
use boresight_core::Detection;
use boresight_core::drive::interpolated;
use boresight_mounting::{
    AngleEstimate, CalibrationOptions, Calibrator, FrameInput, Joint, Outlook,
};
use boresight_options::Named;
use boresight_report::{About, Radar, Recorder, Source, page};
use wasm_bindgen::JsValue;
use wasm_bindgen::prelude::wasm_bindgen;

/// A calibration of one radar, or of several together.
#[wasm_bindgen]
pub struct DriveCalibrator {
    inner: Inner,
    motion: MotionSamples,
    detections: Vec<Detection>,
    /// Of the detections of the frames that came last.
    weights: Option<Vec<f32>>,
    /// Of each radar, with what a report needs to know of the drive, where one is wanted.
    options: Vec<CalibrationOptions>,
    recorders: Option<Vec<Recorder>>,
}

/// The car's motion as measured.
struct MotionSamples {
    time_s: Vec<f64>,
    yaw_rate_degps: Vec<f64>,
    speed_mps: Vec<f64>,
    max_gap_s: f64,
}

impl MotionSamples {
    fn yaw_rate_radps(&self, time_s: f64) -> Option<f64> {
        self.at(&self.yaw_rate_degps, time_s).map(f64::to_radians)
    }

    fn speed_mps(&self, time_s: f64) -> Option<f64> {
        self.at(&self.speed_mps, time_s)
    }

    fn at(&self, values: &[f64], time_s: f64) -> Option<f64> {
        interpolated(&self.time_s, values, time_s, self.max_gap_s).filter(|value| value.is_finite())
    }
}

enum Inner {
    One(Box<Calibrator>),
    Joint(Joint),
}

#[wasm_bindgen]
impl DriveCalibrator {
    /// For one radar, of which the options are given, or for several with a list of them, which
    /// are then numbered by their place. A network of motion comes with options, that of the first for all. The car's motion is samples in order of time, without speeds or one each,
    /// interpolated over gaps of at most `max_gap_s`. A report needs `recorded` frames.
    #[wasm_bindgen(constructor)]
    pub fn new(
        options: &JsValue,
        weights: bool,
        recorded: bool,
        time_s: Vec<f64>,
        yaw_rate_degps: Vec<f64>,
        speed_mps: Vec<f64>,
        max_gap_s: f64,
    ) -> Fallible<Self> {
        let mut radars: Vec<(u8, CalibrationOptions)> = vec![];
        let mut network = None;
        let inner = if given::is_array(options) {
            for (place, (item, _)) in (0..=u8::MAX).zip(items(options, "sensors")?) {
                let (options, given) = read_options(&item)?;
                radars.push((place, options));
                network = network.or(given);
            }
            Inner::Joint(Joint::with_network(&radars, network.as_ref())?)
        } else {
            let (options, network) = read_options(options)?;
            radars.push((0, options));
            Inner::One(Box::new(Calibrator::with_network(options, network.as_ref())?))
        };
        let motion = MotionSamples { time_s, yaw_rate_degps, speed_mps, max_gap_s };
        Ok(Self {
            inner,
            motion,
            detections: vec![],
            weights: weights.then(Vec::new),
            recorders: recorded.then(|| vec![Recorder::default(); radars.len()]),
            options: radars.into_iter().map(|(_, options)| options).collect(),
        })
    }

    /// Takes frames in order of time. Detections of frame `i` are those from `ends[i - 1]` to before
    /// `ends[i]`, `radars` places in the list of options. Ranges and cross-sections are one a detection, or none.
    ///
    /// Gives for each frame the time of what is told (s), the place of its verdict, the motion (m/s), the angle it gives
    /// alone and its standard deviation (deg), its weight, and its inliers; NaN where there is none.
    #[wasm_bindgen(js_name = addFrames)]
    pub fn add_frames(
        &mut self,
        radars: &[u8],
        time_s: &[f64],
        ends: &[u32],
        azimuth_deg: &[f64],
        range_rate_mps: &[f32],
        range_m: &[f32],
        rcs_dbsm: &[f32],
    ) -> Fallible<Vec<f64>> {
        if let Some(weights) = &mut self.weights {
            weights.clear();
        }
        let mut rows = Vec::with_capacity(8 * time_s.len());
        let mut start = 0;
        for ((radar, time_s), end) in radars.iter().zip(time_s).zip(ends) {
            let end = (*end as usize).min(azimuth_deg.len()).min(range_rate_mps.len());
            let count = end.saturating_sub(start);
            let known = |column: &[f32], i: usize| column.get(i).copied().unwrap_or(f32::NAN);
            self.detections.clear();
            self.detections.extend((start..end).map(|i| Detection {
                azimuth_rad: azimuth_deg[i].to_radians() as f32,
                range_rate_mps: range_rate_mps[i],
                range_m: known(range_m, i),
                rcs_dbsm: known(rcs_dbsm, i),
            }));
            start = end;
            let frame = FrameInput {
                time_s: *time_s,
                detections: &self.detections,
                yaw_rate_radps: self.motion.yaw_rate_radps(*time_s),
                speed_mps: self.motion.speed_mps(*time_s),
            };
            let outcome = match &mut self.inner {
                Inner::One(calibrator) => calibrator.add(frame)?,
                Inner::Joint(joint) => joint.add(*radar, frame)?,
            };
            let recorders = self.recorders.as_deref_mut().unwrap_or_default();
            if let Some(recorder) = recorders.get_mut(usize::from(*radar))
                && recorder.add(&frame, &outcome)
                && let Some(estimate) = self.inner.estimates().get(usize::from(*radar))
            {
                recorder.look(*time_s, estimate);
            }
            let [vx, vy] = outcome.motion.map_or([f64::NAN; 2], |motion| motion.velocity_mps);
            let degrees = |angle: Option<f64>| angle.map_or(f64::NAN, f64::to_degrees);
            rows.extend([
                outcome.time_s,
                outcome.verdict.place() as f64,
                vx,
                vy,
                degrees(outcome.angle_rad),
                degrees(outcome.angle_sigma_rad),
                outcome.weight,
                outcome.motion.map_or(0.0, |motion| motion.inliers as f64),
            ]);
            if let Some(weights) = &mut self.weights {
                let none = std::iter::repeat(0.0);
                weights.extend(outcome.weights.into_iter().chain(none).take(count));
            }
        }
        Ok(rows)
    }

    /// Weights of the detections of the frames that were taken last, if asked for.
    pub fn weights(&self) -> Vec<f32> {
        self.weights.clone().unwrap_or_default()
    }

    /// Angle and standard deviation of each radar as far as the frames so far tell, deg.
    pub fn angles(&self) -> Vec<f64> {
        let pair = |e: AngleEstimate| [e.angle_rad.to_degrees(), e.sigma_rad.to_degrees()];
        self.inner.estimates().into_iter().flat_map(pair).collect()
    }

    /// The estimate of each radar.
    pub fn estimate(&self) -> js_sys::Array {
        carry::write_all(self.inner.estimates())
    }

    /// What driving on would bring for the radar; null for several, and for the methods that weigh all frames at once.
    pub fn outlook(&self) -> JsValue {
        self.inner.outlook().map_or(JsValue::NULL, |outlook| carry::write(&outlook))
    }

    /// A page of HTML about the calibration of the radars with these numbers, if frames were recorded.
    pub fn report(&self, sensors: &[u8], version: String, about: &JsValue) -> Fallible<String> {
        let (mut fields, mut sources) = (Fields::of_optional(about)?, vec![]);
        if let Some(given) = fields.raw("sources")? {
            for (item, path) in items(&given, "about.sources")? {
                let mut file = Fields::new(&item, &path)?;
                sources.push(Source {
                    name: file.required("name")?,
                    bytes: f64::max(file.required("bytes")?, 0.0) as u64,
                    sha256: file.required("sha256")?,
                });
                file.finish()?;
            }
        }
        let mut text =
            |name| Ok::<_, BindingError>(fields.optional::<String>(name)?.unwrap_or_default());
        let about = About { made: text("made")?, asked: text("asked")?, version, sources };
        fields.finish()?;
        let (estimates, outlook) = (self.inner.estimates(), self.inner.outlook());
        let radars: Vec<Radar> = estimates
            .iter()
            .zip(&self.options)
            .zip(self.recorders.as_deref().unwrap_or_default())
            .zip(sensors)
            .map(|(((estimate, options), recorder), &sensor)| Radar {
                sensor,
                joint: matches!(self.inner, Inner::Joint(_)),
                options,
                estimate,
                outlook: outlook.as_ref(),
                recorder,
            })
            .collect();
        Ok(page(&about, &radars))
    }
}

impl Inner {
    fn estimates(&self) -> Vec<AngleEstimate> {
        match self {
            Self::One(calibrator) => vec![calibrator.estimate()],
            Self::Joint(joint) => joint.estimate().into_iter().map(|(_, e)| e).collect(),
        }
    }

    fn outlook(&self) -> Option<Outlook> {
        match self {
            Self::One(calibrator) => calibrator.outlook(),
            Self::Joint(_) => None,
        }
    }
}
