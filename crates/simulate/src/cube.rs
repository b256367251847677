//! FMCW data cubes of a MIMO radar, after equation 9 of the 3D-CNN paper (Sang et
//! al. 2021), bit for bit the same natively and in wasm.
//!
//! A sample at time `t` after the start of its ramp is
//! `alpha exp(j 2 pi (2 R / c) (f_0 + S t))`, with start frequency `f_0`, slope `S` and the range
//! `R` at that very moment. So the beat frequency is positive and grows with range, and the phase
//! `4 pi R / lambda` rises from chirp to chirp for a receding target, whose Doppler is positive.
//!
//! Real samples are the real part of all that, of the noise too: both have half the power.
//!
//! Phases in the far and in the near field are those of `crate::paths`.

use crate::cost::sum_operations;
use crate::error::SimulateError;
use crate::fluctuation::SwerlingModel;
use crate::ground::{Ground, Leg};
use crate::interference::{Interferer, Received};
use crate::paths::{Paths, moved};
use crate::phase_noise::PhaseNoise;
use boresight_core::array::{Channel, MAX_ELEMENTS, Position};
use boresight_core::limits::{check_bytes, check_operations};
use boresight_core::units::SPEED_OF_LIGHT_MPS;
use boresight_core::{
    Array, Complex32, Complex64, Direction, Imperfections, InputError, Random, Sampling, Waveform,
};
use boresight_math::decibels::{db_to_amplitude, db_to_power};
use boresight_math::error::check_range;
use boresight_math::phasor::cis;
use boresight_options::shaped::interleaved;
use boresight_options::{Described, Flat, columns};
use ndarray::{Array1, Array5};
use serde::{Deserialize, Serialize};
use std::f64::consts::{PI, TAU};

/// Most frames.
const MAX_FRAMES: f64 = 134_217_728.0;

/// Streams of the seed from which things are drawn frame by frame, beside phases and noise.
const FLUCTUATIONS: u64 = 1 << 40;
const PHASE_NOISE: u64 = 2 << 40;
/// And of the first interferer; further ones are as far apart.
const INTERFERENCE: u64 = 1 << 50;

/// Operations of a sine and cosine.
const TURN_OPERATIONS: f64 = 40.0;

/// Most interferers.
const MAX_INTERFERERS: f64 = 64.0;

/// Most targets.
pub const MAX_TARGETS: usize = 1024;

/// A point target that moves along the line of sight.
#[derive(Debug, Clone, Copy, PartialEq, Default, Described, Serialize, Deserialize)]
#[option(name = "Echo")]
pub struct CubeTarget {
    /// Distance from the array's origin at the start of the first chirp.
    pub range_m: f64,
    /// Rate at which the range grows.
    #[serde(default)]
    #[option(range = -100_000..=100_000)]
    pub rate_mps: f64,
    /// Where it is.
    #[serde(default)]
    pub direction: Flat<Direction>,
    /// Power of one raw sample at one element.
    #[serde(default)]
    #[option(range = -200..=200)]
    pub power_db: f64,
    /// Phase of its reflection; drawn from the seed if absent.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub phase_rad: Option<f64>,
}

/// A cube as results carry it.
#[derive(Debug, Clone, PartialEq, Described, Serialize)]
#[option(name = "CubeResult")]
pub struct CubeColumns {
    /// Real and imaginary parts, one after the other.
    #[serde(serialize_with = "columns::serialize")]
    pub data: Vec<f32>,
    /// Lengths of the axes.
    #[option(
        typescript = "[frames: number, loops: number, chirps: number, receivers: number, samples: number]"
    )]
    pub shape: [usize; 5],
}

impl From<&Array5<Complex32>> for CubeColumns {
    fn from(cube: &Array5<Complex32>) -> Self {
        Self { data: interleaved(cube), shape: cube.dim().into() }
    }
}

/// Shape of the wavefronts.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Field {
    /// Plane waves.
    #[default]
    Far,
    /// Spherical waves: exact paths from each transmitter and to each receiver.
    Near,
}

/// How to simulate.
#[derive(Debug, Clone, PartialEq, Described, Serialize, Deserialize)]
#[serde(default)]
pub struct CubeOptions {
    /// Power of a 0 dB target over noise power, both of one raw sample.
    #[option(default = 20.0, range = -200..=300)]
    pub snr_db: f64,
    /// Frames.
    #[option(default = 1, range = 1..)]
    pub frames: usize,
    /// Fluctuation of the targets' reflections.
    pub fluctuation: SwerlingModel,
    /// Phase noise of the oscillator in 1 Hz, 1 MHz from the carrier, over the carrier; it falls by 20 dB a decade. None if
    /// absent.
    #[option(range = -200..=-40)]
    pub phase_noise_db: Option<f64>,
    /// A road that reflects; none if absent.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub ground: Option<Ground>,
    /// Other radars that interfere.
    pub interferers: Vec<Interferer>,
    /// Plane or spherical waves.
    #[serde(skip)]
    pub field: Field,
    /// Errors of the virtual elements, transmitter-major, all transmitters x all receivers.
    /// Coupling acts on the response of the virtual array.
    #[serde(skip)]
    pub imperfections: Option<Imperfections>,
    /// Seed; the same one gives the same numbers on every machine. Reflection phases come from stream
    /// 0 of it, the noise of frame `i` from stream `i + 1`.
    #[option(required)]
    pub seed: u64,
}

/// Simulates frames x loops x chirps of a loop x receivers x samples, as the chirps are sent
/// ([`Waveform::chirps_per_loop`]). Transmitters and receivers are those of the array
/// ([`Array::tx`], [`Array::rx`]), whichever of their pairs it keeps. Those that are mounted turned
/// ([`Array::is_inverted`]) send and receive with the opposite sign. Each transmitter sends with
/// the same power whether it sends alone or not.
///
/// # Errors
/// [`InputError::OutOfRange`] for a number out of range, among them a target that is, at any time,
/// not between the radar and the waveform's unambiguous range; [`InputError::Shape`] if waveform
/// and array have different numbers of transmitters or the imperfections another number of
/// elements; [`InputError::TooLarge`] above the limits of the thread ([`boresight_core::limits`]).
pub fn simulate_cube(
    waveform: &Waveform,
    array: &Array,
    targets: &[CubeTarget],
    options: &CubeOptions,
) -> Result<Array5<Complex32>, SimulateError> {
    check(waveform, array, targets, options)?;
    let (tx, rx) = (array.tx().len(), array.rx().len());
    let chirps = waveform.chirps_per_loop();
    let shape = [options.frames, waveform.loops, chirps, rx, waveform.samples];
    let values = check_bytes("the data cube", &shape, size_of::<Complex32>())?;
    let senders = if waveform.multiplexing.is_time_division() { 1 } else { tx };
    let paths = if options.ground.is_some() { 4 } else { 1 };
    let waves = targets.len().saturating_mul(senders * paths);
    let noisy = if options.phase_noise_db.is_some() { waves } else { 0 };
    let turns = (noisy + options.interferers.len()) as f64 * TURN_OPERATIONS;
    check_operations("the data cube", values as f64 * (sum_operations(waves) + turns))?;
    let model = Model::new(waveform, array, options);
    let mut phases = Random::new(options.seed, 0);
    let echoes: Vec<Vec<Echo>> = targets.iter().map(|t| model.echoes(t, &mut phases)).collect();
    let mut interferers = model.interferers(&options.interferers, options.seed);
    let mut phase_noise = options.phase_noise_db.map(|level| PhaseNoise::new(waveform, level));
    let mut factors = vec![1.0; targets.len()];
    let noise_power = db_to_power(-options.snr_db);
    let mut cube = Array5::zeros(shape);
    let mut block = Block::new(rx, waveform.samples);
    for (frame_index, mut frame) in cube.outer_iter_mut().enumerate() {
        let mut random = Random::new(options.seed, frame_index as u64 + 1);
        let mut fluctuations = Random::new(options.seed, FLUCTUATIONS + frame_index as u64);
        let mut oscillator = Random::new(options.seed, PHASE_NOISE + frame_index as u64);
        let mut fluctuate = |factors: &mut [f64]| {
            factors.fill_with(|| options.fluctuation.draw(&mut fluctuations));
        };
        fluctuate(&mut factors);
        for (l, mut loop_chirps) in frame.outer_iter_mut().enumerate() {
            for (c, mut chirp) in loop_chirps.outer_iter_mut().enumerate() {
                let start_s = frame_index as f64 * waveform.frame_interval_s
                    + (l * chirps + c) as f64 * waveform.chirp_interval_s;
                block.re.fill(0.0);
                block.im.fill(0.0);
                if options.fluctuation.is_fast() {
                    fluctuate(&mut factors);
                }
                if let Some(noise) = &mut phase_noise {
                    noise.redraw(&mut oscillator);
                }
                for t in 0..tx {
                    let code = waveform.code(t, l, c);
                    if code == Complex64::ZERO {
                        continue;
                    }
                    for (echoes, factor) in echoes.iter().zip(&factors) {
                        for echo in echoes {
                            let noise = phase_noise.as_ref();
                            model.add(echo, t, code * factor, start_s, noise, &mut block);
                        }
                    }
                }
                for interferer in &mut interferers {
                    model.add_interferer(interferer, start_s, &mut block);
                }
                for ((out, &re), &im) in chirp.iter_mut().zip(&block.re).zip(&block.im) {
                    let noisy = Complex64::new(re, im) + random.complex_normal(noise_power);
                    let im = match waveform.sampling {
                        Sampling::Complex => noisy.im as f32,
                        Sampling::Real => 0.0,
                    };
                    *out = Complex32::new(noisy.re as f32, im);
                }
            }
        }
    }
    Ok(cube)
}

fn check(
    waveform: &Waveform,
    array: &Array,
    targets: &[CubeTarget],
    options: &CubeOptions,
) -> Result<(), InputError> {
    waveform.check()?;
    if waveform.transmitters != array.tx().len() {
        return Err(InputError::Shape {
            what: "transmitters of the array".into(),
            expected: format!("[{}], as in the waveform", waveform.transmitters),
            given: vec![array.tx().len()],
        });
    }
    let elements = array.tx().len() * array.rx().len();
    check_range("virtual elements", elements as f64, 1.0, MAX_ELEMENTS as f64)?;
    if let Some(imperfections) = &options.imperfections {
        imperfections.check(elements)?;
    }
    check_range("snr_db", options.snr_db, -200.0, 300.0)?;
    check_range("frames", options.frames as f64, 1.0, MAX_FRAMES)?;
    check_range("targets", targets.len() as f64, 0.0, MAX_TARGETS as f64)?;
    check_range("interferers", options.interferers.len() as f64, 0.0, MAX_INTERFERERS)?;
    options.interferers.iter().try_for_each(Interferer::check)?;
    check_range("phase_noise_db", options.phase_noise_db.unwrap_or(-100.0), -200.0, -40.0)?;
    if let Some(ground) = &options.ground {
        check_range("radar_height_m", ground.radar_height_m, 0.01, 100.0)?;
        check_range("reflection", ground.reflection, 0.0, 1.0)?;
        if options.field == Field::Near {
            return Err(InputError::Incompatible {
                what: "ground".into(),
                expected: "plane waves".into(),
                given: "with a near field".into(),
            });
        }
    }
    let end_s = options.frames as f64 * waveform.frame_interval_s;
    for target in targets {
        target.direction.0.check()?;
        check_range("rate_mps", target.rate_mps, -1e5, 1e5)?;
        check_range("power_db", target.power_db, -200.0, 200.0)?;
        check_range("phase_rad", target.phase_rad.unwrap_or(0.0), -1e6, 1e6)?;
        let far = waveform.max_range_m();
        check_range("range_m", target.range_m, 1e-3, far)?;
        let last = target.range_m + target.rate_mps * end_s;
        check_range("range_m at the end of the last frame", last, 1e-3, far)?;
    }
    Ok(())
}

/// What all chirps share.
struct Model<'a> {
    waveform: &'a Waveform,
    field: Field,
    ground: Option<Ground>,
    imperfections: Option<&'a Imperfections>,
    paths: Paths,
    /// Virtual elements as they really are, half wavelengths.
    elements: Vec<Position>,
    /// Sign of each virtual element's samples: that of antennas mounted turned.
    signs: Vec<f64>,
    /// Places of transmitter and receiver of each virtual element.
    ends: Vec<[Position; 2]>,
}

/// A target as the cube sees it.
struct Echo {
    /// Half of the path, and of its rate.
    range_m: f64,
    rate_mps: f64,
    unit: [f64; 3],
    /// Factor of each virtual element; in the near field without the phase of its path.
    gains: Vec<Complex64>,
}

/// The samples of a chirp, receivers x samples, and one wave over the samples. Real and imaginary
/// parts apart keep vector units busy.
struct Block {
    re: Vec<f64>,
    im: Vec<f64>,
    wave_re: Vec<f64>,
    wave_im: Vec<f64>,
}

impl Block {
    fn new(receivers: usize, samples: usize) -> Self {
        let zeros = |len| vec![0.0; len];
        let all = receivers * samples;
        Self { re: zeros(all), im: zeros(all), wave_re: zeros(samples), wave_im: zeros(samples) }
    }

    fn set_wave(&mut self, wave: impl Iterator<Item = Complex64>) {
        let parts = self.wave_re.iter_mut().zip(&mut self.wave_im);
        parts.zip(wave).for_each(|((re, im), wave)| (*re, *im) = (wave.re, wave.im));
    }

    /// Adds the wave times `gain` to the samples of receiver `r`.
    fn add_wave(&mut self, r: usize, gain: Complex64) {
        let samples = self.wave_re.len();
        let row = r * samples..(r + 1) * samples;
        let (re, im) = (&mut self.re[row.clone()], &mut self.im[row]);
        let wave = self.wave_re.iter().zip(&self.wave_im);
        for ((re, im), (wave_re, wave_im)) in re.iter_mut().zip(im).zip(wave) {
            *re += wave_re * gain.re - wave_im * gain.im;
            *im += wave_re * gain.im + wave_im * gain.re;
        }
    }
}

impl<'a> Model<'a> {
    fn new(waveform: &'a Waveform, array: &Array, options: &'a CubeOptions) -> Self {
        let imperfections = options.imperfections.as_ref();
        let (mut elements, mut ends, mut signs) = (vec![], vec![], vec![]);
        for (t, tx) in array.tx().iter().enumerate() {
            for (r, rx) in array.rx().iter().enumerate() {
                let inverted = array.is_inverted(Channel { tx: t, rx: r });
                signs.push(if inverted { -1.0 } else { 1.0 });
                let error = imperfections.map_or([0.0; 3], |i| i.displacement[elements.len()]);
                let rx = moved(*rx, error);
                ends.push([*tx, rx]);
                elements.push(moved(*tx, rx));
            }
        }
        let paths = Paths::new(waveform.wavelength_m(), ends.clone());
        let field = options.field;
        let ground = options.ground;
        Self { waveform, field, imperfections, paths, elements, signs, ends, ground }
    }

    /// The echoes of a target: one, or by way of the ground four.
    fn echoes(&self, target: &CubeTarget, phases: &mut Random) -> Vec<Echo> {
        let phase = target.phase_rad.unwrap_or_else(|| phases.phase());
        let direct = Leg::direct(target);
        let mut legs = vec![direct];
        legs.extend(self.ground.and_then(|ground| ground.leg(target)));
        let amplitude = cis(phase) * db_to_amplitude(target.power_db);
        let pairs = legs.iter().flat_map(|&out| legs.iter().map(move |&back| [out, back]));
        pairs.map(|legs| self.echo(legs, amplitude)).collect()
    }

    /// That which goes out by one leg and comes back by another.
    fn echo(&self, [out, back]: [Leg; 2], amplitude: Complex64) -> Echo {
        let amplitude = amplitude * (out.gain * back.gain);
        let (unit, range_m) = (out.direction.unit(), 0.5 * (out.length_m + back.length_m));
        let ideal: Array1<Complex64> = match self.field {
            Field::Far if out == back => {
                self.elements.iter().map(|p| cis(PI * dot(p, &unit))).collect()
            }
            Field::Far => {
                let arriving = back.direction.unit();
                let turn = |[tx, rx]: &[Position; 2]| dot(tx, &unit) + dot(rx, &arriving);
                self.ends.iter().map(|ends| cis(PI * turn(ends))).collect()
            }
            Field::Near => self.paths.response(range_m, &unit),
        };
        let mut gains = ideal.clone();
        if let Some(imperfections) = self.imperfections {
            imperfections.apply(&mut gains);
        }
        if self.field == Field::Near {
            gains.zip_mut_with(&ideal, |gain, ideal| *gain *= ideal.conj());
        }
        let gains = gains.iter().zip(&self.signs).map(|(g, sign)| g * amplitude * sign).collect();
        Echo { range_m, rate_mps: 0.5 * (out.rate_mps + back.rate_mps), unit, gains }
    }

    /// Interferers as the receivers see them.
    fn interferers<'b>(&'b self, all: &'b [Interferer], seed: u64) -> Vec<Received<'b>> {
        let receivers = self.ends.len() / self.waveform.transmitters;
        let received = |(index, of): (usize, &'b Interferer)| {
            let (unit, amplitude) = (of.direction.unit(), db_to_amplitude(of.power_db));
            let first = self.ends[..receivers].iter().zip(&self.signs);
            let gains = first.map(|([_, rx], sign)| cis(PI * dot(rx, &unit)) * amplitude * sign);
            let stream = INTERFERENCE * (index as u64 + 1);
            Received::new(of, self.waveform, gains.collect(), seed, stream)
        };
        all.iter().enumerate().map(received).collect()
    }

    /// Adds what an interferer leaves in the chirp that starts at `start_s`.
    fn add_interferer(&self, interferer: &mut Received<'_>, start_s: f64, block: &mut Block) {
        let Waveform { adc_start_s, sample_rate_hz, .. } = *self.waveform;
        let mut sample = 0.0;
        block.set_wave(std::iter::repeat_with(|| {
            let time_s = adc_start_s + sample / sample_rate_hz;
            sample += 1.0;
            interferer.sample(start_s, time_s)
        }));
        for (r, gain) in interferer.gains.iter().enumerate() {
            block.add_wave(r, *gain);
        }
    }

    /// Adds the echo of what transmitter `tx` sends, times its code, in the chirp that starts at
    /// `start_s` to receivers x samples.
    fn add(
        &self,
        echo: &Echo,
        tx: usize,
        code: Complex64,
        start_s: f64,
        noise: Option<&PhaseNoise>,
        block: &mut Block,
    ) {
        let samples = self.waveform.samples;
        let receivers = block.re.len() / samples;
        let gains = &echo.gains[tx * receivers..(tx + 1) * receivers];
        let first_s = start_s + self.waveform.adc_start_s;
        let last_s = first_s + (samples - 1) as f64 / self.waveform.sample_rate_hz;
        let range_m = |time_s: f64| echo.range_m + echo.rate_mps * time_s;
        if self.field == Field::Far {
            block.set_wave(self.tone(2.0 * range_m(first_s), 2.0 * range_m(last_s)));
            self.add_phase_noise(noise, 2.0 * range_m(first_s), block);
        }
        for (r, gain) in gains.iter().enumerate() {
            if self.field == Field::Near {
                let element = tx * receivers + r;
                let path = |time_s| self.paths.length_m(element, range_m(time_s), &echo.unit);
                block.set_wave(self.tone(path(first_s), path(last_s)));
                self.add_phase_noise(noise, path(first_s), block);
            }
            block.add_wave(r, gain * code);
        }
    }

    /// Turns the wave of a path by the oscillator's phase noise.
    fn add_phase_noise(&self, noise: Option<&PhaseNoise>, path_m: f64, block: &mut Block) {
        let Some(noise) = noise else { return };
        let Waveform { adc_start_s, sample_rate_hz, .. } = *self.waveform;
        let delay_s = path_m / SPEED_OF_LIGHT_MPS;
        let parts = block.wave_re.iter_mut().zip(&mut block.wave_im);
        for (sample, (re, im)) in parts.enumerate() {
            let time_s = adc_start_s + sample as f64 / sample_rate_hz;
            let turned = Complex64::new(*re, *im) * cis(noise.error_rad(time_s, delay_s));
            (*re, *im) = (turned.re, turned.im);
        }
    }

    /// `exp(j 2 pi (d / c) f)` over the samples of a chirp, in which the path `d` and the frequency
    /// `f` change linearly: a phase of second order, by recurrence.
    fn tone(&self, first_m: f64, last_m: f64) -> impl Iterator<Item = Complex64> + use<> {
        let waveform = self.waveform;
        let frequency_hz =
            waveform.start_frequency_hz + waveform.slope_hz_per_s * waveform.adc_start_s;
        let hz_per_sample = waveform.slope_hz_per_s / waveform.sample_rate_hz;
        let delay_s = first_m / SPEED_OF_LIGHT_MPS;
        let per_sample_s = (last_m - first_m) / SPEED_OF_LIGHT_MPS / (waveform.samples - 1) as f64;
        let turns = delay_s * frequency_hz;
        let linear = delay_s * hz_per_sample + per_sample_s * frequency_hz;
        let quadratic = per_sample_s * hz_per_sample;
        let cis_turns = |turns: f64| cis(TAU * (turns - turns.floor()));
        let mut value = cis_turns(turns);
        let mut step = cis_turns(linear + quadratic);
        let growth = cis_turns(2.0 * quadratic);
        std::iter::repeat_with(move || {
            let now = value;
            value *= step;
            step *= growth;
            now
        })
    }
}

fn dot(p: &[f64; 3], q: &[f64; 3]) -> f64 {
    p[0] * q[0] + p[1] * q[1] + p[2] * q[2]
}
