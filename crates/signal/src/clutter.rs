//! Removal of static clutter.

use boresight_core::Complex32;
use ndarray::{ArrayViewMut4, Axis};

/// Takes the mean over the loops off every sample of a frame of loops x transmitters x receivers x
/// samples: what does not move between chirps vanishes, and so does a target at rest.
/// [`crate::range_doppler::RangeDopplerOptions::static_clutter_removal`] does the same on the way.
pub fn remove_static_clutter(mut frame: ArrayViewMut4<Complex32>) {
    if let Some(mean) = frame.mean_axis(Axis(0)) {
        frame -= &mean;
    }
}

/// Takes the mean off the pulses of one cell.
pub(crate) fn subtract_mean(pulses: &mut [Complex32]) {
    let mean = pulses.iter().sum::<Complex32>() / pulses.len().max(1) as f32;
    pulses.iter_mut().for_each(|pulse| *pulse -= mean);
}
