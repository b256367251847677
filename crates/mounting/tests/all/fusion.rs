//! The car's motion from four radars: as exact as it states, held where one radar alone is misled, and kept where one
//! fails. All drives are simulated.

use crate::size::sized;
use boresight_core::drive::Mounting;
use boresight_core::{Detection, Diagnose};
use boresight_mounting::fusion::{Fusion, Mounted};
use boresight_mounting::{FrameInput, Frames};
use boresight_simulate::drive::{
    DriveOptions, DriveProfile, Scenario, SimulatedDrive, simulate_drive,
};

fn drive(
    scenario: Scenario,
    moving_share: Option<f64>,
    duration_s: f64,
    seed: u64,
) -> SimulatedDrive {
    let options = DriveOptions {
        scenario,
        profile: DriveProfile::Radarscenes,
        seed,
        duration_s,
        moving_share,
        ..DriveOptions::default()
    };
    simulate_drive(&options).unwrap()
}

/// Errors of a fusion over a drive.
#[derive(Debug, Default)]
struct Errors {
    speed_rms_mps: f64,
    yaw_rms_degps: f64,
    /// Share of frames whose speed is off by 1 m/s and more.
    misled: f64,
    /// Shares of whitened errors within what holds 68 and 95 % of a normal distribution in two dimensions.
    within: [f64; 2],
    contradicted: Vec<u64>,
}

fn run(drive: &SimulatedDrive, sensors: &[u8], broken: Option<u8>) -> Errors {
    let truth = &drive.truth;
    let mounted = |(sensor, m): &(u8, Mounting)| Mounted {
        sensor: *sensor,
        angle_rad: m.yaw_rad,
        x_m: m.x_m,
        y_m: m.y_m,
    };
    let radars: Vec<Mounted> =
        truth.sensors.iter().map(mounted).filter(|m| sensors.contains(&m.sensor)).collect();
    let mut fusion =
        Fusion::new(&radars, truth.car.slip_gradient_rad, &crate::common::network()).unwrap();
    let (mut squares, mut frames, mut errors) = ([0.0; 2], 0.0, Errors::default());
    for (sensor, frame) in Frames::of(&drive.log, |id| sensors.contains(&id), 0.2) {
        let garbage: Vec<Detection>;
        let mut frame = frame;
        if broken == Some(sensor) {
            // As if the radar were turned by 20 deg.
            garbage = frame
                .detections
                .iter()
                .map(|d| Detection { azimuth_rad: d.azimuth_rad + 0.35, ..*d })
                .collect();
            frame = FrameInput { detections: &garbage, ..frame };
        }
        let found = fusion.add(sensor, frame).unwrap();
        let Some(found) = found else { continue };
        let at_s = frame.time_s - truth.car.delay_s;
        let i = truth.motion.partition_point(|m| m.time_s < at_s).min(truth.motion.len() - 1);
        let true_motion = truth.motion[i];
        let off = [
            found.speed_mps - true_motion.speed_mps,
            found.yaw_rate_radps - true_motion.yaw_rate_radps,
        ];
        let [[a, b], [_, d]] = found.covariance;
        let squared = (d * off[0] * off[0] - 2.0 * b * off[0] * off[1] + a * off[1] * off[1])
            / (a * d - b * b);
        errors.within[0] += f64::from(squared < 2.28);
        errors.within[1] += f64::from(squared < 5.99);
        errors.misled += f64::from(off[0].abs() > 1.0);
        squares = [squares[0] + off[0] * off[0], squares[1] + off[1] * off[1]];
        frames += 1.0;
    }
    errors.speed_rms_mps = (squares[0] / frames).sqrt();
    errors.yaw_rms_degps = (squares[1] / frames).sqrt().to_degrees();
    errors.misled /= frames;
    errors.within = errors.within.map(|count| count / frames);
    errors.contradicted = fusion.counts().map(|(_, counts)| counts.contradicted).collect();
    errors
}

#[test]
fn radars_that_look_aside_hold_those_that_traffic_misleads() {
    for seed in sized(&[3, 4][..], &[3]) {
        let drive = drive(Scenario::DenseTraffic, Some(0.7), 60.0, *seed);
        let [alone, together] = [&[3][..], &[1, 2, 3, 4]].map(|sensors| run(&drive, sensors, None));
        println!("{alone:.3?}\n{together:.3?}");
        assert!(alone.misled > 0.03, "{alone:?}");
        // Of about 3,200 frames.
        assert!(together.misled < 0.001, "{together:?}");
        assert!(together.speed_rms_mps < 0.05 && together.yaw_rms_degps < 0.5, "{together:?}");
        // Of the frames few are independent: errors last seconds, and drives are a minute.
        assert!(together.within[0] > 0.68 && together.within[1] > 0.9, "{together:?}");
    }
}

#[test]
fn more_radars_are_more_exact() {
    let drive = drive(Scenario::City, None, sized(60.0, 30.0), 3);
    let [one, two, four] =
        [&[3][..], &[2, 3], &[1, 2, 3, 4]].map(|sensors| run(&drive, sensors, None));
    println!("{one:.3?}\n{two:.3?}\n{four:.3?}");
    assert!(four.yaw_rms_degps < 0.5 * one.yaw_rms_degps, "{one:?} {four:?}");
    assert!(two.yaw_rms_degps < one.yaw_rms_degps, "{one:?} {two:?}");
}

#[test]
fn a_radar_that_is_turned_is_left_out_and_the_motion_goes_on() {
    let duration_s = sized(60.0, 20.0);
    let drive = drive(Scenario::City, None, duration_s, 4);
    let [whole, broken] = [None, Some(2)].map(|broken| run(&drive, &[1, 2, 3, 4], broken));
    println!("{whole:.3?}\n{broken:.3?}");
    // Of 13.5 scans a second of each radar, most while the car is driven.
    assert!(
        broken.contradicted[1] as f64 > 8.4 * duration_s
            && broken.contradicted[0] + broken.contradicted[2] + broken.contradicted[3] < 10,
        "{broken:?}"
    );
    assert!(
        broken.misled < 0.001 && broken.yaw_rms_degps < 2.0 * whole.yaw_rms_degps,
        "{broken:?}"
    );
}

#[test]
fn what_cannot_be_fused_is_said() {
    let network = crate::common::network();
    let radar = Mounted { sensor: 1, angle_rad: 0.4, x_m: 3.8, y_m: 0.7 };
    let code = |radars: &[Mounted], slip| Fusion::new(radars, slip, &network).unwrap_err().code();
    assert_eq!(code(&[], 0.0), "empty");
    assert_eq!(code(&[radar, radar], 0.0), "out-of-range");
    assert_eq!(code(&[Mounted { x_m: f64::NAN, ..radar }], 0.0), "out-of-range");
    assert_eq!(code(&[radar], f64::INFINITY), "out-of-range");
    let mut fusion = Fusion::new(&[radar], 0.0, &network).unwrap();
    let frame =
        |time_s| FrameInput { time_s, detections: &[], yaw_rate_radps: None, speed_mps: None };
    assert_eq!(fusion.add(1, frame(1.0)).unwrap(), None);
    assert_eq!(fusion.add(2, frame(1.0)).unwrap_err().code(), "out-of-range");
    assert_eq!(fusion.add(1, frame(0.9)).unwrap_err().code(), "time-backwards");
    assert_eq!(fusion.add(1, frame(f64::NAN)).unwrap_err().code(), "not-finite");
    let hostile: Vec<Detection> = [f32::NAN, f32::INFINITY, 0.1, 3e38, -3e38]
        .into_iter()
        .flat_map(|a| {
            [f32::NAN, 0.0, 3e38].map(|rate| Detection {
                azimuth_rad: a,
                range_rate_mps: rate,
                range_m: rate,
                rcs_dbsm: a,
            })
        })
        .collect();
    for i in 0..20 {
        let found = fusion
            .add(1, FrameInput { detections: &hostile, ..frame(1.1 + f64::from(i)) })
            .unwrap();
        if let Some(found) = found {
            assert!(found.speed_mps.is_finite() && found.yaw_rate_radps.is_finite(), "{found:?}");
            assert!(found.covariance[0][0] > 0.0 && found.covariance[1][1] > 0.0, "{found:?}");
        }
    }
    // The frames with wrong times or numbers are not counted.
    assert_eq!(fusion.counts().map(|(_, c)| c.taken + c.untold + c.contradicted).sum::<u64>(), 21);
}
