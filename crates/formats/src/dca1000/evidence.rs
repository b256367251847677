//! What the samples themselves say of the order of I and Q, and of the lanes.
//!
//! The beat frequency of an echo is positive. With I and Q the wrong way round it is negative, so that what is near
//! seems to be far, at the upper end of the band. Of complex samples no more than that tells: at a sample rate `fs` a
//! beat frequency of `0.8 fs` and one of `-0.2 fs` are the same. What is near is stronger, by the fourth power of range,
//! and every board hears its own transmitters at the shortest range of all; so the half of the band that holds most
//! of the power is the lower one.

use super::{Capture, Layout};
use crate::mmwave_cfg::RadarConfig;
use boresight_core::{Complex32, Sampling};
use boresight_math::fft::Transforms;
use boresight_math::phasor::cis;
use std::f64::consts::TAU;

/// Frames looked at, spread over the capture.
const FRAMES: usize = 4;

/// Chirps looked at in all, of all receivers.
const CHIRPS: usize = 256;

/// What the converter adds to all samples, and a window's main lobe around it, is at neither side.
const FIRST_BIN: usize = 2;

/// Power on one side over that on the other from which on the order is told, dB.
const TOLD_DB: f64 = 10.0;

/// Peak over the noise below which nothing is told.
const LEAST_PEAK: f64 = 10.0;

/// By how much more one-sided a spectrum has to be under other lanes, dB.
const OTHER_LANES_DB: f64 = 10.0;

/// How one-sided it has to be then, dB. What is laid out wrong is so by chance up to 9 dB in simulated scenes.
const LEAST_ONE_SIDED_DB: f64 = 12.0;

/// Power of complex samples at positive beat frequencies and at negative ones.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BeatSides {
    /// Power above the noise in the lower half of the band over that in the upper half, which are the negative beat
    /// frequencies, dB.
    pub asymmetry_db: f64,
    /// The strongest bin of either side over the noise, dB.
    pub peak_db: f64,
    /// Whether I and Q are the other way round than they were read; `None` where the samples do not tell.
    pub swapped: Option<bool>,
}

/// What a capture says of its own layout.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Evidence {
    /// Sides of the spectrum; `None` for real samples, and where no chirp can be looked at.
    pub sides: Option<BeatSides>,
    /// Other lanes under which the spectrum is one-sided by so many dB more, if there are such. The numbers of other
    /// lanes put together are no I and Q of one sample, so that their spectrum has both sides alike.
    pub other_lanes: Option<(Layout, f64)>,
}

impl Evidence {
    /// Looks at some chirps of a capture that was laid out by `config`.
    pub fn of(capture: &Capture<'_>, config: &RadarConfig) -> Self {
        if config.waveform.sampling == Sampling::Real {
            return Self { sides: None, other_lanes: None };
        }
        let sides = Spectrum::of(capture).map(|spectrum| spectrum.sides());
        // What tells a side is laid out right.
        let open = sides.is_some_and(|sides| sides.swapped.is_none());
        let other = match config.adc.layout {
            Layout::TwoLane if open => Some(Layout::FourLane),
            Layout::FourLane if open => Some(Layout::TwoLane),
            _ => None,
        };
        let other_lanes = other.and_then(|layout| {
            let mut laid = config.clone();
            laid.adc.layout = layout;
            let there = Spectrum::of(&Capture::new(capture.bytes, &laid).ok()?)?.sides();
            let one_sided_db = there.asymmetry_db.abs();
            let gain_db = one_sided_db - sides?.asymmetry_db.abs();
            let told = there.swapped.is_some() && one_sided_db >= LEAST_ONE_SIDED_DB;
            (told && gain_db >= OTHER_LANES_DB).then_some((layout, gain_db))
        });
        Self { sides, other_lanes }
    }
}

/// Mean power spectrum of chirps.
struct Spectrum {
    power: Vec<f64>,
    chirps: usize,
    /// Middle one of the powers.
    noise: f64,
}

impl Spectrum {
    fn of(capture: &Capture<'_>) -> Option<Self> {
        let [loops, tx, rx, samples] = capture.shape();
        if samples < 16 {
            return None;
        }
        let window: Vec<f32> = (0..samples)
            .map(|n| (0.5 - 0.5 * cis(TAU * n as f64 / samples as f64).re) as f32)
            .collect();
        let fft = f32::plan_forward(samples);
        let mut scratch = vec![Complex32::default(); fft.get_inplace_scratch_len()];
        let mut row = vec![Complex32::default(); samples];
        let mut power = vec![0.0; samples];
        let frames = capture.frames().min(FRAMES);
        let step = (frames * loops * tx * rx).div_ceil(CHIRPS).max(1);
        let (mut chirps, mut passed) = (0, 0);
        for k in 0..frames {
            let frame = capture.frame(k * capture.frames() / frames).ok()?;
            for chirp in frame.samples.rows() {
                passed += 1;
                if passed % step != 0 {
                    continue;
                }
                let mean = chirp.sum() / samples as f32;
                for ((out, sample), &weight) in row.iter_mut().zip(chirp).zip(&window) {
                    *out = (sample - mean) * weight;
                }
                fft.process_with_scratch(&mut row, &mut scratch);
                power.iter_mut().zip(&row).for_each(|(sum, z)| *sum += f64::from(z.norm_sqr()));
                chirps += 1;
            }
        }
        let mut sorted = power.clone();
        boresight_math::order::sort_numbers(&mut sorted);
        let noise = sorted[samples / 2];
        (noise > 0.0).then_some(Self { power, chirps, noise })
    }

    fn sides(&self) -> BeatSides {
        let bins = self.power.len();
        let scatter = 1.0 / (self.chirps as f64).sqrt();
        let threshold = self.noise * (1.0 + 6.0 * scatter);
        let half = FIRST_BIN..bins / 2;
        let side = |bin: &dyn Fn(usize) -> usize| {
            let powers = || half.clone().map(|k| self.power[bin(k)]);
            let above: f64 = powers().map(|power| (power - threshold).max(0.0)).sum();
            (above + threshold, powers().fold(0.0, f64::max))
        };
        let (lower, upper) = (side(&|k| k), side(&|k| bins - k));
        let asymmetry_db = 10.0 * (lower.0 / upper.0).log10();
        let peak = lower.1.max(upper.1) / self.noise;
        // What a few chirps of noise reach by chance is no echo.
        let seen = peak >= LEAST_PEAK.max(1.0 + 20.0 * scatter);
        let told = seen && asymmetry_db.abs() >= TOLD_DB;
        BeatSides {
            asymmetry_db,
            peak_db: 10.0 * peak.log10(),
            swapped: told.then_some(asymmetry_db < 0.0),
        }
    }
}
