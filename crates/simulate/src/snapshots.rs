//! Snapshots of an array: `y(t) = sum_m alpha_m a(theta_m) s_m(t) + n(t)` (equations 4 to 6 of the
//! AAETR paper, Zhu, Chen and Yang 2024), bit for bit the same natively and in wasm.
//!
//! `a` is the far field's [`steering_vector`], or, of a target with a range, the response to a spherical wave. That
//! does not follow from the positions of virtual elements: to second order in their size, a transmitter at `t` and a
//! receiver at `r` add `(|t|^2 + |r|^2) / 2 R` to the path, less the squares along the line of sight. Two pairs with
//! one `t + r` answer differently. So paths run from each element's transmitter over the target to its receiver
//! ([`Array::channels`]). An array that was given by positions alone has one transmitter at the origin and its
//! receivers there.

use crate::cost::sum_operations;
use crate::error::SimulateError;
use crate::paths::{Paths, moved};
use boresight_core::array::Position;
use boresight_core::limits::{check_bytes, check_operations};
use boresight_core::steering::steering_vector;
use boresight_core::{Array, Complex64, Direction, Imperfections, InputError, Random};
use boresight_math::decibels::{db_to_amplitude, db_to_power};
use boresight_math::error::check_range;
use boresight_math::phasor::cis;
use boresight_options::shaped::interleaved;
use boresight_options::{Described, Flat, columns};
use ndarray::{Array1, Array2, Array3, ArrayViewMut2, Axis};
use serde::{Deserialize, Serialize, Serializer};
use std::f64::consts::FRAC_PI_2;

/// Most snapshots of a scene.
const MAX_SNAPSHOTS: f64 = 67_108_864.0;

/// Most targets of a scene.
pub const MAX_TARGETS: usize = 1024;

/// Something that reflects.
#[derive(Debug, Clone, Copy, PartialEq, Default, Described, Serialize, Deserialize)]
#[option(name = "TrueTarget")]
#[serde(default)]
pub struct Target {
    /// Where it is.
    pub direction: Flat<Direction>,
    /// Its power at one element, `20 log10` of its amplitude.
    #[option(range = -300..=300)]
    pub power_db: f64,
    /// Phase of its amplitude in the first snapshot; drawn uniformly if absent. Complex normal
    /// amplitudes have none.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub phase_rad: Option<f64>,
    /// Distance from the array's origin: its wave is spherical, with the paths of each transmitter and receiver, and
    /// equally strong at all elements. Without it the wave is plane.
    #[option(range = 0.001..=1_000_000_000)]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub range_m: Option<f64>,
}

/// Rule by which scenes are drawn: every quantity uniform.
#[derive(Debug, Clone, Copy, PartialEq, Described, Serialize, Deserialize)]
#[serde(default)]
pub struct SceneSampling {
    /// Fewest and most targets.
    #[option(default = [0, 16])]
    pub count: [usize; 2],
    /// Azimuths lie within plus and minus this.
    #[option(default = 60.0_f64.to_radians(), range = 0.0..=90.0)]
    pub field_of_view_rad: f64,
    /// Elevations lie within plus and minus this; 0 keeps targets in the horizontal plane.
    #[option(default = 0.0, range = 0.0..=90.0)]
    pub elevation_field_of_view_rad: f64,
    /// Lowest and highest power.
    #[option(default = [-13.0, 0.0])]
    pub power_db: [f64; 2],
}

/// Where the targets of a scene come from.
#[derive(Debug, Clone, PartialEq)]
pub enum Scene {
    /// The same targets in every scene.
    Given(Vec<Target>),
    /// New targets for every scene.
    Sampled(SceneSampling),
}

/// How amplitudes change from snapshot to snapshot.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Described, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Fluctuation {
    /// Constant magnitude, a new phase for each target and snapshot: uncorrelated targets of
    /// exactly the given powers.
    #[default]
    RandomPhase,
    /// A new complex normal amplitude of the given mean power for each target and snapshot: the
    /// stochastic model of the bounds.
    ComplexNormal,
    /// Constant magnitude, a new phase for each snapshot that all targets share: fully correlated
    /// targets.
    Coherent,
}

/// What to simulate.
#[derive(Debug, Clone, PartialEq, Described, Serialize, Deserialize)]
#[serde(default)]
pub struct SnapshotOptions {
    /// The targets.
    #[serde(skip)]
    #[option(default = Scene::Given(vec![]))]
    pub scene: Scene,
    /// Power of a 0 dB target at one element over noise power at one element: noise power is
    /// `10^(-snr_db / 10)`.
    #[option(default = 20.0, range = -300..=300)]
    pub snr_db: f64,
    /// Snapshots a scene.
    #[option(default = 1, range = 1..)]
    pub snapshots: usize,
    /// How amplitudes change between them.
    pub fluctuation: Fluctuation,
    /// Wavelength, which says how long a half wavelength of the positions is; of use for targets with a range.
    #[option(default = 0.0039, range = 1e-6..=1000)]
    pub wavelength_m: f64,
    /// What is wrong with the array.
    #[serde(skip)]
    pub imperfections: Option<Imperfections>,
    /// Seed; the same one gives the same numbers on every machine. Scene `i` draws from stream `i` of
    /// it, whatever else is simulated.
    #[option(required)]
    pub seed: u64,
}

/// Snapshots of several scenes.
#[derive(Debug, Clone, PartialEq, Described, Serialize)]
#[option(name = "SnapshotResult")]
pub struct Snapshots {
    /// Scenes x elements x snapshots.
    #[option(described_as = Flat<SnapshotValues>)]
    #[serde(serialize_with = "with_shape")]
    pub values: Array3<Complex64>,
    /// Targets of each scene, with their phase in the first snapshot where they have one.
    pub truth: Vec<Vec<Target>>,
}

/// Interleaved values with their shape.
#[derive(Described, Serialize)]
struct SnapshotValues {
    /// Scenes x elements x snapshots: real and imaginary parts, one after the other.
    #[serde(serialize_with = "columns::serialize")]
    data: Vec<f64>,
    /// Lengths of the axes.
    #[option(typescript = "[scenes: number, elements: number, snapshots: number]")]
    shape: [usize; 3],
}

fn with_shape<S: Serializer>(all: &Array3<Complex64>, serializer: S) -> Result<S::Ok, S::Error> {
    Flat(SnapshotValues { data: interleaved(all), shape: all.dim().into() }).serialize(serializer)
}

/// A simulator for one array and one set of options.
#[derive(Debug, Clone)]
pub struct SnapshotSimulator {
    /// The array with its elements where they really are.
    array: Array,
    paths: Paths,
    options: SnapshotOptions,
}

impl SnapshotSimulator {
    /// Checks array and options.
    ///
    /// # Errors
    /// [`InputError::OutOfRange`] for a number out of range, [`InputError::Shape`] or
    /// [`InputError::NotFinite`] for imperfections that do not fit the array.
    pub fn new(array: &Array, options: &SnapshotOptions) -> Result<Self, SimulateError> {
        check_range("snr_db", options.snr_db, -300.0, 300.0)?;
        check_range("snapshots", options.snapshots as f64, 1.0, MAX_SNAPSHOTS)?;
        check_range("wavelength_m", options.wavelength_m, 1e-6, 1e3)?;
        match &options.scene {
            Scene::Given(targets) => {
                check_range("targets", targets.len() as f64, 0.0, MAX_TARGETS as f64)?;
                for target in targets {
                    target.direction.0.check()?;
                    check_range("power_db", target.power_db, -300.0, 300.0)?;
                    check_range("phase_rad", target.phase_rad.unwrap_or(0.0), -1e6, 1e6)?;
                    check_range("range_m", target.range_m.unwrap_or(1.0), 1e-3, 1e9)?;
                }
            }
            Scene::Sampled(sampling) => check_sampling(sampling)?,
        }
        let imperfections = options.imperfections.as_ref();
        imperfections.map_or(Ok(()), |i| i.check(array.len()))?;
        let paths = Paths::of(options.wavelength_m, array, imperfections);
        let mut array = array.clone();
        if let Some(imperfections) = imperfections {
            let places = array.positions().iter().zip(&imperfections.displacement);
            let places: Vec<Position> = places.map(|(p, error)| moved(*p, *error)).collect();
            array = Array::new(&places)?;
        }
        Ok(Self { array, paths, options: options.clone() })
    }

    /// Snapshots (elements x snapshots) and targets of scene `index`.
    ///
    /// # Errors
    /// [`InputError::TooLarge`] above the limits of the thread ([`boresight_core::limits`]).
    pub fn scene(&self, index: u64) -> Result<(Array2<Complex64>, Vec<Target>), SimulateError> {
        self.check_cost(1)?;
        let shape = [self.array.len(), self.options.snapshots];
        let mut values = Array2::zeros(shape);
        let truth = self.fill(index, values.view_mut());
        Ok((values, truth))
    }

    /// Scenes `first` to `first + count - 1`.
    ///
    /// # Errors
    /// [`InputError::TooLarge`] above the limits of the thread ([`boresight_core::limits`]).
    pub fn scenes(&self, first: u64, count: usize) -> Result<Snapshots, SimulateError> {
        let shape = [count, self.array.len(), self.options.snapshots];
        self.check_cost(count)?;
        let mut values = Array3::zeros(shape);
        let truth = values
            .axis_iter_mut(Axis(0))
            .zip(0..)
            .map(|(scene, i)| self.fill(first.wrapping_add(i), scene))
            .collect();
        Ok(Snapshots { values, truth })
    }

    fn check_cost(&self, scenes: usize) -> Result<(), InputError> {
        let shape = [scenes, self.array.len(), self.options.snapshots];
        let values = check_bytes("the snapshots", &shape, size_of::<Complex64>())? as f64;
        let targets = match &self.options.scene {
            Scene::Given(targets) => targets.len(),
            Scene::Sampled(sampling) => sampling.count[1],
        };
        check_operations("the snapshots", values * sum_operations(targets))
    }

    fn fill(&self, index: u64, mut values: ArrayViewMut2<Complex64>) -> Vec<Target> {
        let mut random = Random::new(self.options.seed, index);
        let mut targets = self.targets(&mut random);
        let responses: Vec<Array1<Complex64>> =
            targets.iter().map(|target| self.response(target)).collect();
        let powers: Vec<f64> = targets.iter().map(|t| db_to_power(t.power_db)).collect();
        let magnitudes: Vec<f64> = targets.iter().map(|t| db_to_amplitude(t.power_db)).collect();
        let noise_power = db_to_power(-self.options.snr_db);
        let mut amplitudes = vec![Complex64::ZERO; targets.len()];
        for (t, mut snapshot) in values.axis_iter_mut(Axis(1)).enumerate() {
            let common = if t > 0 && self.options.fluctuation == Fluctuation::Coherent {
                random.phase()
            } else {
                0.0
            };
            for (m, amplitude) in amplitudes.iter_mut().enumerate() {
                let first = targets[m].phase_rad.unwrap_or(0.0);
                *amplitude = match self.options.fluctuation {
                    Fluctuation::ComplexNormal => random.complex_normal(powers[m]),
                    Fluctuation::RandomPhase if t > 0 => cis(random.phase()) * magnitudes[m],
                    _ => cis(first + common) * magnitudes[m],
                };
            }
            for (k, value) in snapshot.iter_mut().enumerate() {
                let mut sum = Complex64::ZERO;
                for (response, amplitude) in responses.iter().zip(&amplitudes) {
                    sum += response[k] * amplitude;
                }
                *value = sum + random.complex_normal(noise_power);
            }
        }
        if self.options.fluctuation == Fluctuation::ComplexNormal {
            targets.iter_mut().for_each(|target| target.phase_rad = None);
        }
        targets
    }

    /// The targets of a scene, each with a phase.
    fn targets(&self, random: &mut Random) -> Vec<Target> {
        match &self.options.scene {
            Scene::Given(targets) => targets
                .iter()
                .map(|t| Target {
                    phase_rad: Some(t.phase_rad.unwrap_or_else(|| random.phase())),
                    ..*t
                })
                .collect(),
            Scene::Sampled(s) => {
                let count = random.integer(s.count[0] as u64, s.count[1] as u64);
                let symmetric = |random: &mut Random, half: f64| random.uniform(-half, half);
                (0..count)
                    .map(|_| Target {
                        direction: Direction {
                            azimuth_rad: symmetric(random, s.field_of_view_rad),
                            elevation_rad: symmetric(random, s.elevation_field_of_view_rad),
                        }
                        .into(),
                        power_db: random.uniform(s.power_db[0], s.power_db[1]),
                        phase_rad: Some(random.phase()),
                        range_m: None,
                    })
                    .collect()
            }
        }
    }

    fn response(&self, target: &Target) -> Array1<Complex64> {
        let mut response = match target.range_m {
            None => steering_vector(&self.array, *target.direction),
            Some(range_m) => self.paths.response(range_m, &target.direction.unit()),
        };
        if let Some(imperfections) = &self.options.imperfections {
            imperfections.apply(&mut response);
        }
        response
    }
}

fn check_sampling(sampling: &SceneSampling) -> Result<(), InputError> {
    let [fewest, most] = sampling.count;
    check_range("most targets", most as f64, 0.0, MAX_TARGETS as f64)?;
    check_range("fewest targets", fewest as f64, 0.0, most as f64)?;
    check_range("field_of_view_rad", sampling.field_of_view_rad, 0.0, FRAC_PI_2)?;
    let elevation = sampling.elevation_field_of_view_rad;
    check_range("elevation_field_of_view_rad", elevation, 0.0, FRAC_PI_2)?;
    let [lowest, highest] = sampling.power_db;
    check_range("highest power_db", highest, -300.0, 300.0)?;
    check_range("lowest power_db", lowest, -300.0, highest)
}
