//! Digests of simulated numbers, by which every platform can check that it gets the same bits.

use crate::cube::{CubeOptions, CubeTarget, Field, simulate_cube};
use crate::drive::{DriveOptions, DriveProfile, Scenario, simulate_drive};
use crate::error::SimulateError;
use crate::snapshots::{Fluctuation, Scene, SceneSampling, SnapshotOptions, SnapshotSimulator};
use crate::street::{Street, StreetOptions};
use crate::waveforms::waveform_awr1642;
use boresight_core::imperfections::ImperfectionSpread;
use boresight_core::presets::preset;
use boresight_core::{Direction, Imperfections, Waveform};

/// What [`reference_snapshots`] returns on every platform.
pub const REFERENCE_SNAPSHOTS: u64 = 0xe26d_71a2_27fb_8d59;

/// What [`reference_cube`] returns on every platform.
pub const REFERENCE_CUBE: u64 = 0xb0e4_f2ee_454c_6c6e;

/// What [`reference_drive`] returns on every platform.
pub const REFERENCE_DRIVE: u64 = 0x39e9_07b6_0d8a_cd56;

/// What [`reference_radarscenes_drive`] returns on every platform.
pub const REFERENCE_RADARSCENES_DRIVE: u64 = 0xf867_d71c_ba52_2fdb;

/// What [`reference_street`] returns on every platform.
pub const REFERENCE_STREET: u64 = 0x2a7a_5931_4dbd_85fb;

/// FNV-1a over the bytes, low first, of the numbers' bits.
pub fn fnv1a(bits: impl IntoIterator<Item = u64>) -> u64 {
    bits.into_iter().flat_map(u64::to_le_bytes).fold(0xcbf2_9ce4_8422_2325, |hash, byte| {
        (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3)
    })
}

/// Digest of 20 sampled scenes of 3 snapshots of each fluctuation on `lrr48` with imperfections.
///
/// # Errors
/// None, unless the simulator is broken.
pub fn reference_snapshots() -> Result<u64, SimulateError> {
    let array = preset("lrr48")?;
    let spread = ImperfectionSpread {
        gain_db: 0.5,
        phase_rad: 0.1,
        position: 0.05,
        coupling_db: Some(-25.0),
    };
    let mut bits = Vec::new();
    for fluctuation in [Fluctuation::RandomPhase, Fluctuation::ComplexNormal, Fluctuation::Coherent]
    {
        let options = SnapshotOptions {
            scene: Scene::Sampled(SceneSampling::default()),
            snr_db: 20.0,
            snapshots: 3,
            fluctuation,
            imperfections: Some(Imperfections::random(&array, spread, 5)?),
            seed: 2024,
            ..SnapshotOptions::default()
        };
        let snapshots = SnapshotSimulator::new(&array, &options)?.scenes(7, 20)?;
        bits.extend(snapshots.values.iter().flat_map(|z| [z.re.to_bits(), z.im.to_bits()]));
    }
    Ok(fnv1a(bits))
}

/// Digest of two frames of two moving targets, in the far and in the near field.
///
/// # Errors
/// None, unless the simulator is broken.
pub fn reference_cube() -> Result<u64, SimulateError> {
    let array = preset("awr1642")?;
    let waveform = Waveform { loops: 4, samples: 64, ..waveform_awr1642() };
    let target = |range_m, rate_mps, azimuth_rad| CubeTarget {
        range_m,
        rate_mps,
        direction: Direction::new(azimuth_rad, 0.1).into(),
        ..CubeTarget::default()
    };
    let targets = [target(2.5, 1.5, 0.3), target(4.0, -3.0, -0.7)];
    let mut bits = Vec::new();
    for field in [Field::Far, Field::Near] {
        let options =
            CubeOptions { snr_db: 10.0, frames: 2, field, seed: 77, ..CubeOptions::default() };
        let cube = simulate_cube(&waveform, &array, &targets, &options)?;
        bits.extend(cube.iter().flat_map(|z| [z.re, z.im].map(|x| u64::from(x.to_bits()))));
    }
    Ok(fnv1a(bits))
}

/// Digest of half a minute of city traffic with a third of the detections moving.
///
/// # Errors
/// None, unless the simulator is broken.
pub fn reference_drive() -> Result<u64, SimulateError> {
    drive_digest(&DriveOptions {
        scenario: Scenario::City,
        seed: 9,
        duration_s: 30.0,
        moving_share: Some(0.33),
        slip_gradient_rad: Some(-0.002),
        ..DriveOptions::default()
    })
}

/// Digest of ten seconds of a motorway with the errors of `RadarScenes`.
///
/// # Errors
/// None, unless the simulator is broken.
pub fn reference_radarscenes_drive() -> Result<u64, SimulateError> {
    drive_digest(&DriveOptions {
        profile: DriveProfile::Radarscenes,
        scenario: Scenario::Motorway,
        seed: 10,
        car: 3,
        duration_s: 10.0,
        ..DriveOptions::default()
    })
}

/// Digest of a small frame of one radar of a street.
///
/// # Errors
/// None, unless the simulator is broken.
pub fn reference_street() -> Result<u64, SimulateError> {
    let mut street = Street::new(StreetOptions { seed: 3, ..StreetOptions::default() })?;
    street.radars[1].waveform.loops = 2;
    let (cube, targets) = street.cube(1)?;
    let samples = cube.iter().flat_map(|z| [z.re, z.im].map(|x| u64::from(x.to_bits())));
    let rates = targets.iter().map(|target| target.echo.rate_mps.to_bits());
    Ok(fnv1a(samples.chain(rates)))
}

/// Digest of all that a drive's log holds.
///
/// # Errors
/// As [`simulate_drive`].
pub fn drive_digest(options: &DriveOptions) -> Result<u64, SimulateError> {
    let log = simulate_drive(options)?.log;
    let mut bits = Vec::new();
    for scan in &log.scans {
        bits.extend([scan.time_s.to_bits(), u64::from(scan.sensor)]);
        for (d, label) in scan.detections.iter().zip(&scan.labels) {
            let values = [d.azimuth_rad, d.range_rate_mps, d.range_m, d.rcs_dbsm];
            bits.extend(values.map(|x| u64::from(x.to_bits())));
            bits.push(u64::from(*label));
        }
    }
    for m in &log.motion {
        bits.extend([m.yaw_rate_radps, m.speed_mps.unwrap_or(0.0)].map(f64::to_bits));
        bits.extend(m.pose.iter().flat_map(|p| [p.x_m, p.y_m, p.yaw_rad].map(f64::to_bits)));
    }
    Ok(fnv1a(bits))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn snapshots_have_the_bits_they_always_had() {
        assert_eq!(reference_snapshots().unwrap(), REFERENCE_SNAPSHOTS);
    }

    #[test]
    fn cubes_have_the_bits_they_always_had() {
        assert_eq!(reference_cube().unwrap(), REFERENCE_CUBE);
    }

    #[test]
    fn drives_have_the_bits_they_always_had() {
        let digest = reference_drive().unwrap();
        assert_eq!(digest, REFERENCE_DRIVE, "{digest:#x}");
    }

    #[test]
    fn drives_as_radarscenes_have_the_bits_they_always_had() {
        let digest = reference_radarscenes_drive().unwrap();
        assert_eq!(digest, REFERENCE_RADARSCENES_DRIVE, "{digest:#x}");
    }

    #[test]
    fn streets_have_the_bits_they_always_had() {
        let digest = reference_street().unwrap();
        assert_eq!(digest, REFERENCE_STREET, "{digest:#x}");
    }

    /// Test vector of the FNV authors: the empty string, and "a".
    #[test]
    fn fnv1a_is_the_published_one() {
        assert_eq!(fnv1a([]), 0xcbf2_9ce4_8422_2325);
        let byte_a = (0xcbf2_9ce4_8422_2325_u64 ^ 0x61).wrapping_mul(0x0100_0000_01b3);
        assert_eq!(byte_a, 0xaf63_dc4c_8601_ec8c);
    }
}
