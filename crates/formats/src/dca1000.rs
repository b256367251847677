//! Raw samples recorded by Texas Instruments' DCA1000 capture card from two-lane boards
//! (xWR16xx, xWR18xx, xWR68xx): little-endian 16-bit numbers in groups `I0 I1 Q0 Q1` of two
//! samples, the receivers of a chirp one after another.

use crate::error::FormatError;
use crate::mmwave_cfg::RadarConfig;
use boresight_core::Complex32;
use boresight_core::Remark;
use boresight_core::error::check_range;
use ndarray::Array4;
use std::ops::Range;

/// Two complex samples of two 16-bit numbers.
const GROUP_BYTES: usize = 8;

/// A capture laid over its bytes; frames are decoded one at a time.
#[derive(Debug, Clone)]
pub struct Capture<'a> {
    bytes: &'a [u8],
    shape: [usize; 4],
    full_scale: i32,
    q_first: bool,
    frame_bytes: usize,
    /// Where the samples of the sub-frame stand in the bytes of a frame.
    part: Range<usize>,
    remarks: Vec<Remark>,
}

/// One frame of samples.
#[derive(Debug, Clone, PartialEq)]
pub struct RawFrame {
    /// Loops x chirps of a loop x receivers x samples; full scale is 1.
    pub samples: Array4<Complex32>,
    /// Samples whose I or Q stands at either end of the converter's range.
    pub clipped: usize,
}

impl<'a> Capture<'a> {
    /// Lays a configuration over the bytes of a capture.
    ///
    /// # Errors
    /// [`FormatError::NoWholeFrame`] when there is not one whole frame;
    /// [`FormatError::Layout`] for an odd number of samples a chirp and for receivers that
    /// alternate (four-lane boards).
    pub fn new(bytes: &'a [u8], config: &RadarConfig) -> Result<Self, FormatError> {
        let waveform = &config.waveform;
        let shape =
            [waveform.loops, waveform.chirps_per_loop(), config.receivers.len(), waveform.samples];
        if !config.adc.receiver_major {
            return Err(FormatError::Layout {
                what: "channel interleave",
                expected: "1 (receivers one after another, two-lane boards)".into(),
                given: "0 (receivers alternate)".into(),
            });
        }
        if waveform.samples % 2 == 1 {
            return Err(FormatError::Layout {
                what: "samples a chirp",
                expected: "an even number, since they are stored in pairs".into(),
                given: waveform.samples.to_string(),
            });
        }
        let expected = config.frame_bytes();
        let frame_bytes = usize::try_from(expected).unwrap_or(usize::MAX);
        if expected == 0 || bytes.len() < frame_bytes {
            return Err(FormatError::NoWholeFrame {
                expected,
                given: bytes.len() as u64,
                layout: layout_of(config, shape),
            });
        }
        // Not beyond the bytes of a frame, which are there.
        let part = config.sub_frame_bytes();
        let mut capture = Self {
            bytes,
            shape,
            full_scale: config.adc.full_scale(),
            q_first: config.adc.q_first,
            frame_bytes,
            part: part.start as usize..part.end as usize,
            remarks: vec![],
        };
        capture.remark_on_size(config);
        Ok(capture)
    }

    fn remark_on_size(&mut self, config: &RadarConfig) {
        let (frames, trailing) = (self.frames(), self.trailing_bytes());
        if trailing > 0 {
            let message = format!(
                "{trailing} bytes follow the last whole frame: the capture holds {} bytes, \
                 {frames} frames take {}; it was cut short, or recorded with another configuration",
                self.bytes.len(),
                frames * self.frame_bytes
            );
            self.remarks.push(Remark::new("trailing-bytes", message));
        }
        if let Some(expected) = config.frames.filter(|&expected| expected != frames) {
            let message =
                format!("the configuration asks for {expected} frames; {frames} are there");
            self.remarks.push(Remark::new("frame-count", message));
        }
    }

    /// Number of whole frames.
    pub fn frames(&self) -> usize {
        self.bytes.len() / self.frame_bytes
    }

    /// Bytes after the last whole frame.
    pub fn trailing_bytes(&self) -> usize {
        self.bytes.len() % self.frame_bytes
    }

    /// Loops, chirps of a loop, receivers and samples of a frame.
    pub fn shape(&self) -> [usize; 4] {
        self.shape
    }

    /// What is odd about the capture's size.
    pub fn remarks(&self) -> &[Remark] {
        &self.remarks
    }

    /// Decodes frame `index`, counted from 0.
    ///
    /// # Errors
    /// [`boresight_core::CoreError::OutOfRange`] for an index beyond the last whole frame.
    pub fn frame(&self, index: usize) -> Result<RawFrame, FormatError> {
        check_range("frame", index as f64, 0.0, (self.frames() - 1) as f64)?;
        let start = index * self.frame_bytes;
        let bytes = &self.bytes[start + self.part.start..start + self.part.end];
        let scale = 1.0 / self.full_scale as f32;
        let (low, high) = (-self.full_scale, self.full_scale - 1);
        let mut clipped = 0;
        let mut samples = Vec::with_capacity(bytes.len() / 4);
        for group in bytes.chunks_exact(GROUP_BYTES) {
            let word = |k: usize| i32::from(i16::from_le_bytes([group[2 * k], group[2 * k + 1]]));
            for k in 0..2 {
                let (first, second) = (word(k), word(2 + k));
                let (i, q) = if self.q_first { (second, first) } else { (first, second) };
                clipped += usize::from([i, q].iter().any(|&v| v <= low || v >= high));
                samples.push(Complex32::new(i as f32 * scale, q as f32 * scale));
            }
        }
        let [loops, tx, rx, count] = self.shape;
        let samples = Array4::from_shape_vec((loops, tx, rx, count), samples).map_err(|_| {
            FormatError::Layout {
                what: "samples of a frame",
                expected: (loops * tx * rx * count).to_string(),
                given: (bytes.len() / 4).to_string(),
            }
        })?;
        Ok(RawFrame { samples, clipped })
    }
}

/// What a frame is made of, in words.
fn layout_of(config: &RadarConfig, shape: [usize; 4]) -> String {
    let [loops, chirps, receivers, samples] = shape;
    if config.sub_frames.len() > 1 {
        return format!("{} sub-frames", config.sub_frames.len());
    }
    format!(
        "{loops} loops x {chirps} transmitters x {receivers} receivers x {samples} samples x 4 bytes"
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    const CFG: &[u8] = include_bytes!("../../../recordings/awr1642/profile.cfg");
    const BIN: &[u8] =
        include_bytes!("../../../recordings/awr1642/xwr16xx_crw_dca_module_2018_1015v2.bin");

    fn config() -> RadarConfig {
        RadarConfig::parse(CFG).unwrap()
    }

    #[test]
    fn the_recording_holds_eight_frames() {
        let capture = Capture::new(BIN, &config()).unwrap();
        assert_eq!((capture.frames(), capture.trailing_bytes()), (8, 0));
        assert_eq!(capture.shape(), [16, 2, 4, 256]);
        assert_eq!(capture.remarks(), []);
        let frame = capture.frame(7).unwrap();
        assert_eq!(frame.samples.dim(), (16, 2, 4, 256));
        assert_eq!(frame.clipped, 0);
        let error = capture.frame(8).err();
        assert!(matches!(error, Some(FormatError::Argument(_))), "{error:?}");
    }

    #[test]
    fn samples_stand_where_the_layout_says() {
        // Number n of the file is n: loop 1, transmitter 0, receiver 2, sample 5 is in group
        // ((1*2 + 0)*4 + 2)*128 + 2, second of its pair.
        let bytes: Vec<u8> = (0..65_536_u32).flat_map(|n| (n as i16).to_le_bytes()).collect();
        let mut config = config();
        let group = ((2 * 4) + 2) * 128 + 2;
        let z = Capture::new(&bytes, &config).unwrap().frame(0).unwrap().samples[[1, 0, 2, 5]];
        let expected = |n: usize| (4 * group + n) as f32 / 32768.0;
        assert_eq!(z, Complex32::new(expected(1), expected(3)));
        config.adc.q_first = true;
        let z = Capture::new(&bytes, &config).unwrap().frame(0).unwrap().samples[[1, 0, 2, 5]];
        assert_eq!(z, Complex32::new(expected(3), expected(1)));
    }

    #[test]
    fn clipped_samples_are_counted() {
        let mut bytes = BIN[..131_072].to_vec();
        bytes[0..2].copy_from_slice(&i16::MAX.to_le_bytes());
        bytes[4..6].copy_from_slice(&i16::MIN.to_le_bytes());
        bytes[8..10].copy_from_slice(&i16::MIN.to_le_bytes());
        let frame = Capture::new(&bytes, &config()).unwrap().frame(0).unwrap();
        assert_eq!(frame.clipped, 2);
        assert_eq!(frame.samples[[0, 0, 0, 0]], Complex32::new(32767.0 / 32768.0, -1.0));
    }

    #[test]
    fn captures_that_do_not_match_say_by_how_much() {
        let error = Capture::new(&BIN[..131_071], &config()).unwrap_err();
        let FormatError::NoWholeFrame { expected, given, .. } = error else { panic!("{error}") };
        assert_eq!((expected, given), (131_072, 131_071));
        let error = Capture::new(&[], &config()).unwrap_err();
        assert!(matches!(error, FormatError::NoWholeFrame { given: 0, .. }), "{error}");

        let capture = Capture::new(&BIN[..300_000], &config()).unwrap();
        assert_eq!((capture.frames(), capture.trailing_bytes()), (2, 37_856));
        assert_eq!(capture.remarks()[0].code, "trailing-bytes");

        let text = String::from_utf8_lossy(CFG).replace("frameCfg 0 1 16 0", "frameCfg 0 1 16 9");
        let config = RadarConfig::parse(text.as_bytes()).unwrap();
        assert_eq!(Capture::new(BIN, &config).unwrap().remarks()[0].code, "frame-count");
    }

    #[test]
    fn layouts_that_cannot_be_read_are_refused() {
        let mut interleaved = config();
        interleaved.adc.receiver_major = false;
        assert!(matches!(Capture::new(BIN, &interleaved), Err(FormatError::Layout { .. })));
        let mut odd = config();
        odd.waveform.samples = 255;
        assert!(matches!(Capture::new(BIN, &odd), Err(FormatError::Layout { .. })));
    }
}
