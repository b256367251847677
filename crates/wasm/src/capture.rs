//! Recorded and simulated frames through the chain.

use crate::bytes::Bytes;
use crate::calibrated::ArrayChoice;
use crate::carry;
use crate::chain::{read_angle, read_chain, read_cube_chain};
use crate::complex::Cube;
use crate::config::{ConfigRecord, read_config};
use crate::error::{BindingError, Fallible};
use crate::estimate::shape_error;
use crate::read::{Fields, Read};
use crate::report::reporter;
use boresight_core::{Array, Complex64, Geometry, Remark, Waveform};
use boresight_formats::dca1000::Evidence;
use boresight_formats::{self as formats, RadarConfig, Settled};
use boresight_math::error::check_range;
use boresight_options::Described;
use boresight_options::shaped::ComplexArray;
use boresight_pipeline::{Chain, ChainOptions, CubeFrames, Frame, FrameCells, FrameSource};
use js_sys::Function;
use ndarray::{Array2, ArrayView5, Axis};
use serde::Serialize;
use std::ops::{ControlFlow, Range};
use wasm_bindgen::JsValue;
use wasm_bindgen::prelude::wasm_bindgen;

/// How a chain is planned for frames of a waveform and a number of receivers, seen by an array.
pub type Planner<'a> = &'a dyn Fn(&Waveform, usize, &Array, &ChainOptions) -> Fallible<Chain>;

/// The chain with estimators that need no network.
fn classical(
    waveform: &Waveform,
    receivers: usize,
    array: &Array,
    options: &ChainOptions,
) -> Fallible<Chain> {
    Ok(Chain::new(waveform, receivers, array, options)?)
}

/// A raw capture with its configuration. The chain planned last is kept.
#[wasm_bindgen]
pub struct Capture {
    bytes: Vec<u8>,
    config: RadarConfig,
    evidence: Evidence,
    remarks: Vec<Remark>,
    array: Option<Array>,
    frames: usize,
    chain: Option<Chain>,
}

/// What is known of a capture before any processing.
#[derive(Described, Serialize)]
pub struct CaptureInfo<'a> {
    /// Its configuration.
    pub config: ConfigRecord<'a>,
    /// Whole frames.
    pub frames: usize,
    /// Bytes after the last whole frame.
    pub trailing_bytes: usize,
    /// Virtual array of the configured channels; null for a platform that is not known.
    pub array: Option<Geometry>,
    /// Power above the noise at positive beat frequencies over that at negative ones, as samples are read; null for real
    /// samples, and for chirps that are too short or silent.
    pub beat_asymmetry_db: Option<f64>,
    /// Whether the samples tell that I and Q are the other way round than they are read; null where they tell nothing.
    pub iq_swapped: Option<bool>,
    /// What is odd about its size, its lanes, and the order of I and Q.
    pub warnings: &'a [Remark],
}

/// The frames of a capture.
pub struct Recording<'a>(formats::Capture<'a>);

impl FrameSource for Recording<'_> {
    type Error = BindingError;

    fn frames(&self) -> usize {
        self.0.frames()
    }

    fn frame(&self, index: usize) -> Fallible<Frame> {
        let raw = self.0.frame(index)?;
        Ok(Frame { samples: raw.samples, clipped: raw.clipped })
    }
}

#[wasm_bindgen]
impl Capture {
    /// Lays the configuration over the bytes.
    #[wasm_bindgen(constructor)]
    pub fn new(bytes: &JsValue, config: &JsValue) -> Fallible<Self> {
        let (config, reading) = read_config(config, "configuration")?;
        let bytes = Bytes::read(bytes, "capture")?.0;
        let Settled { config, evidence, remarks } = Settled::new(&bytes, &config, &reading)?;
        let frames = formats::Capture::new(&bytes, &config)?.frames();
        let array = config.array();
        Ok(Self { bytes, config, evidence, remarks, array, frames, chain: None })
    }

    /// What is known before any processing.
    pub fn info(&self) -> Fallible<JsValue> {
        let layout = formats::Capture::new(&self.bytes, &self.config)?;
        Ok(carry::write(&CaptureInfo {
            config: ConfigRecord::from(&self.config),
            frames: layout.frames(),
            trailing_bytes: layout.trailing_bytes(),
            array: self.array.as_ref().map(Geometry::from),
            beat_asymmetry_db: self.evidence.sides.map(|sides| sides.asymmetry_db),
            iq_swapped: self.evidence.sides.and_then(|sides| sides.swapped),
            warnings: &self.remarks,
        }))
    }

    /// Detections of one frame.
    #[wasm_bindgen(js_name = processFrame)]
    pub fn process_frame(&mut self, frame: &JsValue, options: &JsValue) -> Fallible<JsValue> {
        let frame = self.read_frame(frame)?;
        Ok(self.process_frames_by(&classical, frame..frame + 1, options)?.get(0))
    }

    /// Detections of several frames together. `report`, a function or `undefined`, is called with
    /// the steps done and in all, and stops the run by returning `false`.
    #[wasm_bindgen(js_name = combineFrames)]
    pub fn combine_frames(
        &mut self,
        options: &JsValue,
        report: Option<Function>,
    ) -> Fallible<JsValue> {
        self.combine_frames_by(&classical, options, report)
    }

    /// Snapshots of one cell, elements x frames; of all frames if `frame` is `undefined`.
    #[wasm_bindgen(js_name = cellSnapshots)]
    pub fn cell_snapshots(&mut self, cell: &JsValue, options: &JsValue) -> Fallible<JsValue> {
        let mut fields = Fields::of_optional(options)?;
        let (array, options) = read_chain(&mut fields)?;
        fields.finish()?;
        let (_, snapshots) = self.snapshots(cell, array, &options)?;
        Ok(carry::write(&ComplexArray::from(&snapshots)))
    }

    /// Why one cell is a detection or none.
    #[wasm_bindgen(js_name = explainCell)]
    pub fn explain_cell(&mut self, cell: &JsValue, options: &JsValue) -> Fallible<JsValue> {
        let mut fields = Fields::of_optional(options)?;
        let (array, options) = read_chain(&mut fields)?;
        fields.finish()?;
        let (bins, frames) = self.read_cell(cell)?;
        let (chain, recording) = self.planned(&classical, array, &options)?;
        let go_on = &mut |_| ControlFlow::Continue(());
        Ok(carry::write(&chain.explain(&recording, frames, bins, go_on)?))
    }

    /// Angles and spectrum of one cell by any method.
    #[wasm_bindgen(js_name = cellSpectrum)]
    pub fn cell_spectrum(
        &mut self,
        cell: &JsValue,
        angle: &JsValue,
        options: &JsValue,
    ) -> Fallible<JsValue> {
        let angle = read_angle(Fields::of_optional(angle)?)?;
        let mut fields = Fields::of_optional(options)?;
        let (array, options) = read_chain(&mut fields)?;
        fields.finish()?;
        let (chain, snapshots) = self.snapshots(cell, array, &options)?;
        let estimate = chain.cell_spectrum(snapshots.view(), angle.method, &angle.options)?;
        Ok(carry::write(&estimate))
    }
}

impl Capture {
    /// Number of frames.
    pub fn frames(&self) -> usize {
        self.frames
    }

    /// Detections of each frame of a range, by chains planned elsewhere: always by the same planner
    /// for one capture.
    pub fn process_frames_by(
        &mut self,
        planner: Planner,
        frames: Range<usize>,
        options: &JsValue,
    ) -> Fallible<js_sys::Array> {
        let mut fields = Fields::of_optional(options)?;
        let (array, options) = read_chain(&mut fields)?;
        fields.finish()?;
        let (chain, recording) = self.planned(planner, array, &options)?;
        let results = js_sys::Array::new();
        let take = |result| {
            results.push(&carry::write(&result));
        };
        chain.each(&recording, frames, take, &mut |_| ControlFlow::Continue(()))?;
        Ok(results)
    }

    /// As [`Capture::combine_frames`], by a chain planned elsewhere.
    pub fn combine_frames_by(
        &mut self,
        planner: Planner,
        options: &JsValue,
        report: Option<Function>,
    ) -> Fallible<JsValue> {
        let mut fields = Fields::of_optional(options)?;
        let first = fields.optional("firstFrame")?.unwrap_or(0);
        let count = fields.optional("frameCount")?;
        let (array, options) = read_chain(&mut fields)?;
        fields.finish()?;
        let frames = self.frame_range(first, count)?;
        let (chain, recording) = self.planned(planner, array, &options)?;
        let mut report = reporter(report);
        Ok(carry::write(&chain.combine(&recording, frames, &mut report)?))
    }

    /// Detected cells of one frame.
    pub(crate) fn cells_of(&mut self, frame: &JsValue, options: &JsValue) -> Fallible<FrameCells> {
        let frame = self.read_frame(frame)?;
        let mut fields = Fields::of_optional(options)?;
        let (array, options) = read_chain(&mut fields)?;
        fields.finish()?;
        let (chain, recording) = self.planned(&classical, array, &options)?;
        let Frame { samples, clipped } = recording.frame(frame)?;
        let mut cells = chain.cells(samples.view())?;
        cells.counts.clipped_samples = clipped;
        Ok(cells)
    }

    /// A frame's number.
    ///
    /// # Errors
    /// For one that is not there.
    pub fn read_frame(&self, frame: &JsValue) -> Fallible<usize> {
        let index = usize::read(frame, "frame")?;
        check_range("frame", index as f64, 0.0, (self.frames - 1) as f64)?;
        Ok(index)
    }

    /// All frames, or the one named.
    ///
    /// # Errors
    /// For one that is not there.
    pub fn read_frames(&self, frame: &JsValue) -> Fallible<Range<usize>> {
        if frame.is_undefined() {
            return Ok(0..self.frames);
        }
        let frame = self.read_frame(frame)?;
        Ok(frame..frame + 1)
    }

    /// `count` frames from `first`, all that are left if absent.
    fn frame_range(&self, first: usize, count: Option<usize>) -> Fallible<Range<usize>> {
        check_range("first_frame", first as f64, 0.0, (self.frames - 1) as f64)?;
        let left = self.frames - first;
        let count = count.unwrap_or(left);
        check_range("frame_count", count as f64, 1.0, left as f64)?;
        Ok(first..first + count)
    }

    /// An array that was asked for, or else that of the platform, calibrated as was asked for, or else by
    /// the configuration.
    ///
    /// # Errors
    /// Where neither array is known; a calibration of another array.
    pub fn array_or(&self, choice: ArrayChoice) -> Fallible<Array> {
        choice.or_board(self.array.as_ref(), &self.config)
    }

    /// Its waveform, its number of receivers, and its frames.
    ///
    /// # Errors
    /// Those of laying the configuration over the bytes, which have not come up so far.
    pub fn recording(&self) -> Fallible<(Waveform, usize, Recording<'_>)> {
        let recording = Recording(formats::Capture::new(&self.bytes, &self.config)?);
        Ok((self.config.waveform, self.config.receivers.len(), recording))
    }

    /// Plans the chain, unless the one planned last will do.
    fn planned(
        &mut self,
        planner: Planner,
        array: ArrayChoice,
        options: &ChainOptions,
    ) -> Fallible<(&mut Chain, Recording<'_>)> {
        let array = self.array_or(array)?;
        let recording = Recording(formats::Capture::new(&self.bytes, &self.config)?);
        let kept = self.chain.take().filter(|c| c.array() == &array && c.options() == options);
        let chain = match kept {
            Some(chain) => chain,
            None => {
                let receivers = self.config.receivers.len();
                planner(&self.config.waveform, receivers, &array, options)?
            }
        };
        Ok((self.chain.insert(chain), recording))
    }

    /// Range bin and Doppler bin of a cell, and its frames.
    fn read_cell(&self, cell: &JsValue) -> Fallible<([usize; 2], Range<usize>)> {
        let mut fields = Fields::new(cell, "cell")?;
        let range_bin = fields.required("rangeBin")?;
        let doppler_bin = fields.required("dopplerBin")?;
        let frames = match fields.raw("frame")? {
            Some(frame) => {
                let frame = self.read_frame(&frame)?;
                frame..frame + 1
            }
            None => 0..self.frames,
        };
        fields.finish()?;
        Ok(([range_bin, doppler_bin], frames))
    }

    fn snapshots(
        &mut self,
        cell: &JsValue,
        array: ArrayChoice,
        options: &ChainOptions,
    ) -> Fallible<(&Chain, Array2<Complex64>)> {
        let ([range_bin, doppler_bin], frames) = self.read_cell(cell)?;
        let (chain, recording) = self.planned(&classical, array, options)?;
        let snapshots = chain.cell_snapshots(&recording, frames, range_bin, doppler_bin)?;
        Ok((chain, snapshots))
    }
}

/// Detections of each frame of a cube: frames x loops x chirps of a loop x receivers x samples.
#[wasm_bindgen(js_name = processCube)]
pub fn process_cube(cube: &JsValue, options: &JsValue) -> Fallible<js_sys::Array> {
    process_cube_by(&classical, cube, options)
}

/// The frames of a cube.
///
/// # Errors
/// For a cube of other than five axes.
pub fn cube_frames(cube: &Cube) -> Fallible<CubeFrames<'_>> {
    let wrong = || {
        let expected = "[frames, loops, chirps of a loop, receivers, samples]";
        shape_error("cube", expected, &cube.shape)
    };
    let [frames, loops, chirps, receivers, samples] = cube.shape[..] else {
        return Err(wrong());
    };
    let shape = (frames, loops, chirps, receivers, samples);
    Ok(CubeFrames(ArrayView5::from_shape(shape, &cube.data).map_err(|_| wrong())?))
}

/// The same by a chain planned elsewhere.
pub fn process_cube_by(
    planner: Planner,
    cube: &JsValue,
    options: &JsValue,
) -> Fallible<js_sys::Array> {
    let cube = Cube::read(cube, "cube")?;
    let source = cube_frames(&cube)?;
    let (waveform, array, options) = read_cube_chain(options)?;
    let mut chain = planner(&waveform, source.0.len_of(Axis(3)), &array, &options)?;
    let results = js_sys::Array::new();
    let take = |result| {
        results.push(&carry::write(&result));
    };
    chain.each(&source, 0..source.frames(), take, &mut |_| ControlFlow::Continue(()))?;
    Ok(results)
}
