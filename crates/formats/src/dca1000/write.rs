//! The bytes that a capture card would have recorded.

use crate::error::FormatError;
use crate::mmwave_cfg::RadarConfig;
use boresight_core::limits::check_bytes;
use boresight_core::{Complex32, InputError, Sampling};
use ndarray::ArrayView5;

/// Writes frames x loops x transmitters x receivers x samples (full scale 1) as the bytes that [`super::Capture`]
/// reads by the same configuration. Numbers are rounded, and limited to the converter's range. A cascade's are the chips'
/// frames in turn.
///
/// # Errors
/// [`InputError::Shape`] for frames of another shape than configured; those of the layout;
/// [`InputError::TooLarge`] above the limits of the thread ([`boresight_core::limits`]).
pub fn write(
    frames: ArrayView5<'_, Complex32>,
    config: &RadarConfig,
) -> Result<Vec<u8>, FormatError> {
    let waveform = &config.waveform;
    config.check_layout()?;
    let each = [waveform.loops, waveform.transmitters, config.receivers.len(), waveform.samples];
    if frames.shape()[1..] != each {
        return Err(FormatError::Argument(InputError::Shape {
            what: "frames".into(),
            expected: format!("any number of {each:?}"),
            given: frames.shape().to_vec(),
        }));
    }
    let plan = config.plan();
    let words = usize::try_from(plan.words()).unwrap_or(usize::MAX);
    check_bytes("the capture", &[frames.shape()[0], words], size_of::<i16>())?;
    let full_scale = config.adc.full_scale() as f32;
    let number = |x: f32| (x * full_scale).round().clamp(-full_scale, full_scale - 1.0) as i16;
    let mut bytes = Vec::with_capacity(2 * words * frames.shape()[0]);
    let mut numbers = vec![0_i16; words];
    for frame in frames.outer_iter() {
        let samples: Vec<Complex32> = frame.iter().copied().collect();
        plan.each(|place, [first, second]| {
            let z = samples[place];
            let (i, q) = (number(z.re), number(z.im));
            match (plan.sampling, config.adc.q_first) {
                (Sampling::Real, _) => numbers[first] = i,
                (Sampling::Complex, false) => (numbers[first], numbers[second]) = (i, q),
                (Sampling::Complex, true) => (numbers[first], numbers[second]) = (q, i),
            }
        });
        numbers.iter().for_each(|number| bytes.extend_from_slice(&number.to_le_bytes()));
    }
    Ok(bytes)
}
