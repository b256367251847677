//! Folds of the range rate in the chain.

use crate::error::PipelineError;
use boresight_core::{Array, Complex64, Waveform};
use boresight_signal::FoldTest;
use ndarray::ArrayView2;

/// Probability from which a fold other than that of the bin is taken.
const CERTAIN: f64 = 0.99;

/// The test of folds where there are several.
pub(crate) struct Folds {
    test: FoldTest,
    noise_share: f64,
}

impl Folds {
    /// None where folds are not asked for, or phases cannot tell any. The test takes all channels
    /// of the cube where their places are known, whichever of them the array keeps: elements that
    /// share a place tell folds best.
    pub fn new(
        waveform: &Waveform,
        array: &Array,
        channels: &[usize],
        most_folds: usize,
    ) -> Result<Option<Self>, PipelineError> {
        let Waveform { transmitters, multiplexing, .. } = *waveform;
        let all = array.tx().len() * array.rx().len();
        let correction = array.correction();
        let test = |array: &Array, channels: &[usize]| {
            FoldTest::new(array, channels, transmitters, multiplexing, most_folds, correction)
        };
        if most_folds == 0 || multiplexing.chirps_per_loop(transmitters) < 2 {
            return Ok(None);
        }
        let test = if array.len() < all {
            let whole = array.whole()?;
            test(&whole, &(0..all).collect::<Vec<_>>())?
        } else {
            test(array, channels)?
        };
        Ok(Some(Self { test, noise_share: waveform.sent_per_loop() as f64 }))
    }

    /// Folds that are told apart.
    pub fn told(&self) -> usize {
        self.test.hypotheses()
    }

    /// Whether a fold of this probability is certain enough.
    pub fn is_certain(&self, probability: f64) -> bool {
        probability >= CERTAIN
    }

    /// The fold of a cell and its probability; that of its bin where none is certain.
    pub fn decide(
        &self,
        raw: ArrayView2<'_, Complex64>,
        doppler_bin: f64,
        dopplers: usize,
        noise_power: f64,
    ) -> Result<(i32, f64), PipelineError> {
        let noise_power = noise_power * self.noise_share;
        let found = self.test.decide(raw, doppler_bin, dopplers, noise_power)?;
        if self.is_certain(found.probability) {
            return Ok((found.fold, found.probability));
        }
        Ok((0, found.probability))
    }
}
