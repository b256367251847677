//! Scenes of targets that stand apart.

use crate::error::EvaluateError;
use boresight_core::{Array, Complex64, Direction, Random};
use boresight_simulate::{Scene, SnapshotOptions, SnapshotSimulator, Target};
use ndarray::Array3;
use std::f64::consts::FRAC_PI_3;

/// Half width of the sector of targets, rad (60 deg).
const WITHIN_RAD: f64 = FRAC_PI_3;
/// Distance of targets that disturb each other little, in beams between their first zeros.
pub(crate) const BEAMS_APART: f64 = 2.0;
/// Draws of a target that comes too near another; the last one is taken, where beams fill the sector.
const DRAWS: usize = 100;

/// Half the width of the main beam between its first zeros, sine: that of a line as long as the array.
pub(crate) fn half_beam(array: &Array) -> f64 {
    2.0 / array.aperture().max(1.0)
}

/// What is drawn.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Drawn<'a> {
    /// The array.
    pub array: &'a Array,
    /// Seed.
    pub seed: u64,
    /// What tells the scenes from other ones of the seed: those of one group are the same targets in the same noise.
    pub group: u64,
    /// Signal-to-noise ratio of a target of 0 dB, dB.
    pub snr_db: f64,
    /// Snapshots of each scene.
    pub snapshots: usize,
    /// Least distance of two targets, in beams between their first zeros.
    pub beams_apart: f64,
    /// Power of each target, dB.
    pub powers_db: &'a [f64],
    /// Their distance, m; none for plane waves.
    pub range_m: Option<f64>,
}

impl Drawn<'_> {
    /// Scenes `first` to `first + trials - 1`, scenes x elements x snapshots, each with its targets.
    ///
    /// # Errors
    /// Those of the simulation.
    pub fn scenes(
        &self,
        first: u64,
        trials: u64,
    ) -> Result<(Array3<Complex64>, Vec<Vec<Target>>), EvaluateError> {
        let mut scenes = Array3::zeros((trials as usize, self.array.len(), self.snapshots));
        let mut truths = vec![];
        for (trial, mut scene) in (first..).zip(scenes.outer_iter_mut()) {
            let mut random = Random::new(self.seed, (self.group << 40) + trial);
            let options = SnapshotOptions {
                scene: Scene::Given(self.targets(&mut random)),
                snr_db: self.snr_db,
                snapshots: self.snapshots,
                seed: random.bits(),
                ..SnapshotOptions::default()
            };
            let (y, truth) = SnapshotSimulator::new(self.array, &options)?.scene(0)?;
            scene.assign(&y);
            truths.push(truth);
        }
        Ok((scenes, truths))
    }

    fn targets(&self, random: &mut Random) -> Vec<Target> {
        let least = 2.0 * self.beams_apart * half_beam(self.array);
        let mut azimuths_rad: Vec<f64> = vec![];
        for _ in self.powers_db {
            let mut azimuth_rad = random.uniform(-WITHIN_RAD, WITHIN_RAD);
            for _ in 1..DRAWS {
                let sine = azimuth_rad.sin();
                if azimuths_rad.iter().all(|other| (other.sin() - sine).abs() >= least) {
                    break;
                }
                azimuth_rad = random.uniform(-WITHIN_RAD, WITHIN_RAD);
            }
            azimuths_rad.push(azimuth_rad);
        }
        let target = |(azimuth_rad, &power_db)| Target {
            direction: Direction::azimuth(azimuth_rad).into(),
            power_db,
            range_m: self.range_m,
            ..Target::default()
        };
        azimuths_rad.into_iter().zip(self.powers_db).map(target).collect()
    }
}
