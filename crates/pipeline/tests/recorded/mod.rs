//! The recorded capture of an AWR1642 board.

use boresight_core::{Array, Waveform};
use boresight_formats::{Capture, FormatError, RadarConfig};
use boresight_pipeline::{Frame, FrameSource, PipelineError};

const CFG: &[u8] = include_bytes!("../../../../recordings/awr1642/profile.cfg");
const BIN: &[u8] =
    include_bytes!("../../../../recordings/awr1642/xwr16xx_crw_dca_module_2018_1015v2.bin");

pub struct Recording(Capture<'static>);

#[derive(Debug)]
pub enum Failure {
    #[allow(dead_code)] // shown by panics
    Format(FormatError),
    #[allow(dead_code)]
    Pipeline(PipelineError),
}

impl From<PipelineError> for Failure {
    fn from(error: PipelineError) -> Self {
        Self::Pipeline(error)
    }
}

impl FrameSource for Recording {
    type Error = Failure;

    fn frames(&self) -> usize {
        self.0.frames()
    }

    fn frame(&self, index: usize) -> Result<Frame, Failure> {
        let raw = self.0.frame(index).map_err(Failure::Format)?;
        Ok(Frame { samples: raw.samples, clipped: raw.clipped })
    }
}

/// Its waveform, receivers and array.
pub fn board() -> (Waveform, usize, Array) {
    let config = RadarConfig::parse(CFG).unwrap();
    (config.waveform, config.receivers.len(), config.array().unwrap())
}

/// Its frames.
pub fn recording() -> Recording {
    Recording(Capture::new(BIN, &RadarConfig::parse(CFG).unwrap()).unwrap())
}
