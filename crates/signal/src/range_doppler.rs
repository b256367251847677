//! Range and Doppler transform of a frame.

use crate::cfar::BinNoise;
use crate::clutter::subtract_mean;
use crate::doppler_division::Bands;
use crate::error::SignalError;
use crate::power::accumulate_power;
use crate::range::{RowTransform, range_axis_m};
use crate::real_range::RealRangeTransform;
use crate::window::Window;
use boresight_core::limits::check_bytes;
use boresight_core::{Complex32, Complex64, InputError, Sampling, Waveform};
use boresight_math::error::check_range;
use boresight_options::Described;
use ndarray::{Array1, Array2, Array3, ArrayView2, ArrayView4, Axis};
use serde::{Deserialize, Serialize};

/// Memory of a value: itself, and what it was made of.
const VALUE_BYTES: usize = 16;

/// Edge of the square tiles in which the transposition between the transforms runs.
const TILE: usize = 16;

/// How a frame is transformed.
#[derive(Debug, Clone, Copy, PartialEq, Described, Serialize, Deserialize)]
#[serde(default)]
pub struct RangeDopplerOptions {
    /// Window over the samples of a chirp: lower sidelobes in range for a wider main lobe.
    pub range_window: Window,
    /// Window over the loops of a frame: lower sidelobes in rate for a wider main lobe.
    pub doppler_window: Window,
    /// Range bins as a multiple of the samples, a power of two: finer bins, the same resolution.
    #[option(default = 1, range = 1..=64)]
    pub range_padding: usize,
    /// Doppler bins as a multiple of the loops, a power of two: finer bins, the same resolution.
    #[option(default = 1, range = 1..=64)]
    pub doppler_padding: usize,
    /// Take the mean over the loops off, which removes what does not move.
    pub static_clutter_removal: bool,
}

/// A frame in range and Doppler.
#[derive(Debug, Clone, PartialEq)]
pub struct RangeDopplerMap {
    /// Channels x range x Doppler, in memory in this order, channel `tx * receivers + rx`. Rates
    /// ascend with the Doppler bin. The phase between transmitters is as measured; see
    /// [`crate::tdm`]. In binary-phase multiplexing the first number is that of the chirp in the
    /// loop, from which [`crate::binary_phase`] makes transmitters.
    pub cube: Array3<Complex32>,
    /// Mean power over the channels, range x Doppler. A cell that holds a target has the power of
    /// one raw sample of it.
    pub power: Array2<f32>,
}

impl RangeDopplerMap {
    /// The channels of one cell, in `f64` for angle estimation.
    ///
    /// # Errors
    /// [`InputError::OutOfRange`] for a cell outside the map.
    pub fn snapshot(
        &self,
        range_bin: usize,
        doppler_bin: usize,
    ) -> Result<Array1<Complex64>, SignalError> {
        let (_, ranges, dopplers) = self.cube.dim();
        for (what, bin, bins) in
            [("range bin", range_bin, ranges), ("Doppler bin", doppler_bin, dopplers)]
        {
            if bin >= bins {
                return Err(SignalError::Argument(InputError::OutOfRange {
                    what: what.into(),
                    expected: format!("less than {bins}"),
                    given: bin as f64,
                }));
            }
        }
        let cell = self.cube.slice(ndarray::s![.., range_bin, doppler_bin]);
        Ok(cell.mapv(|z| Complex64::new(z.re.into(), z.im.into())))
    }
}

/// The range transform of either kind of samples.
enum RangeTransform {
    Complex(RowTransform),
    Real(RealRangeTransform),
}

impl RangeTransform {
    fn new(waveform: &Waveform, options: &RangeDopplerOptions) -> Result<Self, SignalError> {
        let (window, padding) = (options.range_window, options.range_padding);
        Ok(match waveform.sampling {
            Sampling::Complex => {
                Self::Complex(RowTransform::new(window, waveform.samples, padding)?)
            }
            Sampling::Real => {
                Self::Real(RealRangeTransform::new(window, waveform.samples, padding)?)
            }
        })
    }

    fn bins(&self) -> usize {
        match self {
            Self::Complex(transform) => transform.bins(),
            Self::Real(transform) => transform.bins(),
        }
    }

    fn noise_bandwidth_bins(&self) -> f64 {
        match self {
            Self::Complex(transform) => transform.noise_bandwidth_bins,
            Self::Real(transform) => transform.noise_bandwidth_bins,
        }
    }

    fn noise(&self) -> BinNoise {
        match self {
            Self::Complex(transform) => transform.noise,
            Self::Real(transform) => transform.noise,
        }
    }

    /// Range bins of the chirps, into rows of [`RangeTransform::bins`].
    fn transform(
        &mut self,
        chirps: ArrayView2<Complex32>,
        rows: &mut [Complex32],
    ) -> Result<(), SignalError> {
        let each = self.bins();
        match self {
            Self::Complex(transform) => {
                for (chirp, row) in chirps.outer_iter().zip(rows.chunks_exact_mut(each)) {
                    weigh(chirp, &transform.weights, row);
                }
                transform.transform(rows);
            }
            Self::Real(transform) => {
                for (chirp, row) in chirps.outer_iter().zip(rows.chunks_exact_mut(each)) {
                    transform.transform(chirp, row)?;
                }
            }
        }
        Ok(())
    }
}

/// A plan for the range and Doppler transform of frames of one shape. It keeps its windows, FFTs
/// and scratch space, so that [`RangeDoppler::process`] allocates nothing.
pub struct RangeDoppler {
    waveform: Waveform,
    receivers: usize,
    static_clutter_removal: bool,
    range: RangeTransform,
    doppler: RowTransform,
    /// What tells transmitters apart in Doppler division.
    bands: Option<Bands>,
    /// Range bins of all loops of one channel.
    chirps: Vec<Complex32>,
    range_m: Vec<f64>,
    rate_mps: Vec<f64>,
}

impl RangeDoppler {
    /// Plans for frames of `waveform.loops` x [`Waveform::chirps_per_loop`] x `receivers` x
    /// `waveform.samples`.
    ///
    /// # Errors
    /// [`InputError::OutOfRange`] for a waveform, a window or a padding out of range,
    /// [`InputError::TooLarge`] above the limits of the thread ([`boresight_core::limits`]).
    pub fn new(
        waveform: &Waveform,
        receivers: usize,
        options: &RangeDopplerOptions,
    ) -> Result<Self, SignalError> {
        waveform.check()?;
        check_range("receivers", receivers as f64, 1.0, 1024.0)?;
        let sizes = [
            waveform.samples,
            options.range_padding,
            waveform.loops,
            options.doppler_padding,
            waveform.transmitters,
            receivers,
        ];
        check_bytes("the range-Doppler cube", &sizes, VALUE_BYTES)?;
        let range = RangeTransform::new(waveform, options)?;
        let mut doppler =
            RowTransform::new(options.doppler_window, waveform.loops, options.doppler_padding)?;
        let bins = doppler.bins();
        if bins.is_multiple_of(2) {
            // Alternating signs move zero Doppler to bin `bins / 2`, without a pass over the data.
            doppler.weights.iter_mut().skip(1).step_by(2).for_each(|w| *w = -*w);
        }
        let rate_mps = (0..bins).map(|k| rate_of_bin_mps(waveform, bins, k as f64)).collect();
        Ok(Self {
            waveform: *waveform,
            receivers,
            static_clutter_removal: options.static_clutter_removal,
            chirps: vec![Complex32::default(); waveform.loops * range.bins()],
            range_m: range_axis_m(waveform, range.bins()),
            rate_mps,
            bands: Bands::of(waveform, &doppler.weights),
            range,
            doppler,
        })
    }

    /// Range of each bin, m.
    pub fn range_m(&self) -> &[f64] {
        &self.range_m
    }

    /// Range rate of each Doppler bin, m/s, ascending, receding positive.
    pub fn rate_mps(&self) -> &[f64] {
        &self.rate_mps
    }

    /// The waveform.
    pub fn waveform(&self) -> &Waveform {
        &self.waveform
    }

    /// Number of virtual channels.
    pub fn channels(&self) -> usize {
        self.waveform.transmitters * self.receivers
    }

    /// Noise power of one raw sample over that of one cell: the gain in SNR of a target in the
    /// middle of a cell, over that of one transmitter in one raw sample. With real samples it is half of what as many
    /// complex ones give. In binary phase it is larger by the number of transmitters, which all send in each chirp; in
    /// Doppler division so are the loops in the same time.
    pub fn processing_gain(&self) -> f64 {
        let bandwidth = match self.waveform.sampling {
            Sampling::Complex => self.range.noise_bandwidth_bins(),
            Sampling::Real => 2.0 * self.range.noise_bandwidth_bins(),
        };
        let samples = self.waveform.samples as f64 / bandwidth;
        let chirps = (self.waveform.loops * self.waveform.sent_per_loop()) as f64;
        samples * chirps / self.doppler.noise_bandwidth_bins
    }

    /// How noise in neighbouring bins is correlated, along range and Doppler: what [`crate::CfarOptions::noise`] takes.
    pub fn bin_noise(&self) -> [Option<BinNoise>; 2] {
        [Some(self.range.noise()), Some(self.doppler.noise)]
    }

    /// Space for a result of [`RangeDoppler::process`], to be used again and again.
    pub fn output(&self) -> RangeDopplerMap {
        let (ranges, dopplers) = (self.range.bins(), self.doppler.bins());
        RangeDopplerMap {
            cube: Array3::zeros((self.channels(), ranges, dopplers)),
            power: Array2::zeros((ranges, dopplers)),
        }
    }

    /// Transforms a frame of loops x chirps of a loop x receivers x samples.
    ///
    /// # Errors
    /// [`InputError::Shape`] if the frame or the output has another shape than planned;
    /// [`InputError::OutOfRange`] for real samples with an imaginary part.
    pub fn process(
        &mut self,
        frame: ArrayView4<Complex32>,
        output: &mut RangeDopplerMap,
    ) -> Result<(), SignalError> {
        let Waveform { loops, transmitters, samples, .. } = self.waveform;
        let chirps = self.waveform.chirps_per_loop();
        check_shape("frame", frame.shape(), &[loops, chirps, self.receivers, samples])?;
        let (ranges, dopplers) = (self.range.bins(), self.doppler.bins());
        check_shape("output cube", output.cube.shape(), &[self.channels(), ranges, dopplers])?;
        check_shape("output power map", output.power.shape(), &[ranges, dopplers])?;
        output.power.fill(0.0);
        for chirp in 0..chirps {
            for rx in 0..self.receivers {
                let channel = frame.index_axis(Axis(1), chirp);
                let channel = channel.index_axis(Axis(1), rx);
                self.range.transform(channel, &mut self.chirps)?;
                // Chirps that all transmitters share are those of each.
                let planes = if self.bands.is_some() { 0..transmitters } else { chirp..chirp + 1 };
                for plane in planes {
                    self.pulses(plane, plane * self.receivers + rx, output)?;
                }
            }
        }
        let share = 1.0 / (self.channels() * self.waveform.sent_per_loop()) as f32;
        output.power.mapv_inplace(|p| p * share);
        Ok(())
    }

    /// The Doppler transform of the range bins at hand into one channel of the output.
    fn pulses(
        &mut self,
        transmitter: usize,
        channel: usize,
        output: &mut RangeDopplerMap,
    ) -> Result<(), SignalError> {
        let loops = self.waveform.loops;
        let (ranges, dopplers) = (self.range.bins(), self.doppler.bins());
        let mut plane = output.cube.index_axis_mut(Axis(0), channel);
        let Some(plane) = plane.as_slice_mut() else {
            return Err(not_contiguous("output cube"));
        };
        let Some(power) = output.power.as_slice_mut() else {
            return Err(not_contiguous("output power map"));
        };
        transpose(&self.chirps, loops, plane, ranges);
        for row in plane.chunks_exact_mut(dopplers) {
            let (pulses, padding) = row.split_at_mut(loops);
            match &self.bands {
                Some(bands) => {
                    if self.static_clutter_removal {
                        bands.subtract_static(pulses);
                    }
                    bands.weigh(transmitter, pulses);
                }
                None => {
                    if self.static_clutter_removal {
                        subtract_mean(pulses);
                    }
                    for (pulse, &weight) in pulses.iter_mut().zip(&self.doppler.weights) {
                        *pulse *= weight;
                    }
                }
            }
            padding.fill(Complex32::default());
        }
        self.doppler.transform(plane);
        if !dopplers.is_multiple_of(2) {
            for row in plane.chunks_exact_mut(dopplers) {
                row.rotate_right(dopplers / 2);
            }
        }
        accumulate_power(plane, power);
        Ok(())
    }

    /// Power in each range bin over all Doppler: the sum of a row of the power map, less what
    /// window and padding count double, so that a target keeps the power of one raw sample.
    ///
    /// # Errors
    /// [`InputError::Shape`] if the map has another shape than planned.
    pub fn range_profile(&self, map: &RangeDopplerMap) -> Result<Vec<f64>, SignalError> {
        let (ranges, dopplers) = (self.range.bins(), self.doppler.bins());
        check_shape("power map", map.power.shape(), &[ranges, dopplers])?;
        let padding = (dopplers / self.waveform.loops) as f64;
        // In Doppler division a target is in the row of each transmitter once for each.
        let times = if self.bands.is_some() { self.waveform.transmitters } else { 1 };
        let share = 1.0 / (padding * self.doppler.noise_bandwidth_bins * times as f64);
        let total = |row: ndarray::ArrayView1<f32>| row.iter().map(|&p| f64::from(p)).sum::<f64>();
        Ok(map.power.outer_iter().map(|row| share * total(row)).collect())
    }
}

/// Range rate of a Doppler bin that need not be whole, m/s, with zero at bin `bins / 2`.
pub fn rate_of_bin_mps(waveform: &Waveform, bins: usize, bin: f64) -> f64 {
    let doppler_hz = (bin - (bins / 2) as f64) / (bins as f64 * waveform.loop_interval_s());
    doppler_hz * waveform.wavelength_m() / 2.0
}

/// Writes the weighted chirp to the head of `row` and zeros after it.
fn weigh(chirp: ndarray::ArrayView1<Complex32>, weights: &[f32], row: &mut [Complex32]) {
    let (head, padding) = row.split_at_mut(weights.len());
    match chirp.as_slice() {
        Some(chirp) => {
            for ((out, x), &w) in head.iter_mut().zip(chirp).zip(weights) {
                *out = x * w;
            }
        }
        None => {
            for ((out, x), &w) in head.iter_mut().zip(chirp).zip(weights) {
                *out = x * w;
            }
        }
    }
    padding.fill(Complex32::default());
}

/// Loops x ranges to ranges x Doppler bins, of which the first `loops` of each row are written.
fn transpose(chirps: &[Complex32], loops: usize, plane: &mut [Complex32], ranges: usize) {
    let dopplers = plane.len() / ranges;
    for first_loop in (0..loops).step_by(TILE) {
        let last_loop = (first_loop + TILE).min(loops);
        for first_range in (0..ranges).step_by(TILE) {
            for range in first_range..(first_range + TILE).min(ranges) {
                let row = &mut plane[range * dopplers + first_loop..range * dopplers + last_loop];
                for (out, l) in row.iter_mut().zip(first_loop..last_loop) {
                    *out = chirps[l * ranges + range];
                }
            }
        }
    }
}

fn check_shape(what: &str, given: &[usize], expected: &[usize]) -> Result<(), SignalError> {
    if given == expected {
        return Ok(());
    }
    Err(SignalError::Argument(InputError::Shape {
        what: what.into(),
        expected: format!("{expected:?}"),
        given: given.to_vec(),
    }))
}

fn not_contiguous(what: &str) -> SignalError {
    SignalError::Argument(InputError::Shape {
        what: what.into(),
        expected: "values in C order without gaps".into(),
        given: vec![],
    })
}
