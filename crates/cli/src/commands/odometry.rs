//! `boresight odometry`: the car's motion from all of its radars.

use super::calibrate::{feed, ids, mounted, read_network};
use super::track::Track;
use crate::arguments::OdometryArguments;
use crate::drive::open_path;
use crate::error::CliError;
use crate::files::Files;
use crate::output::remark;
use crate::run::Run;
use boresight_core::drive::{DriveLog, Sensor};
use boresight_mounting::fusion::{FusedMotion, Fusion, FusionCounts, Mounted};
use boresight_mounting::trajectory::TimedMotion;
use boresight_mounting::{AngleEstimate, CalibrationOptions, Joint, MotionMethod};
use serde_json::json;

/// Lengths of the segments that trajectories are compared over, m.
const SEGMENTS_M: [f64; 3] = [50.0, 100.0, 200.0];

/// What a radar was, and what became of its frames.
struct Radar {
    sensor: u8,
    estimate: AngleEstimate,
    counts: FusionCounts,
}

/// How far the radars' motion is from what the log measured.
#[derive(Default)]
struct Against {
    frames: f64,
    sums: [f64; 2],
    squares: [f64; 2],
    /// Differences within one and two stated deviations.
    within: [[f64; 2]; 2],
}

/// How far one number is from what the log measured.
struct Difference {
    mean: f64,
    rms: f64,
    /// Shares within one and two stated deviations.
    within: [f64; 2],
}

impl Against {
    fn add(&mut self, off: [f64; 2], covariance: [[f64; 2]; 2]) {
        self.frames += 1.0;
        for i in 0..2 {
            let (off, sigma) = (off[i], covariance[i][i].sqrt());
            self.sums[i] += off;
            self.squares[i] += off * off;
            self.within[i][0] += f64::from(off.abs() <= sigma);
            self.within[i][1] += f64::from(off.abs() <= 2.0 * sigma);
        }
    }

    /// Of the speed (0) or the yaw rate (1); none without frames.
    fn of(&self, i: usize) -> Option<Difference> {
        (self.frames > 0.0).then(|| Difference {
            mean: self.sums[i] / self.frames,
            rms: (self.squares[i] / self.frames).sqrt(),
            within: self.within[i].map(|count| count / self.frames),
        })
    }
}

/// The motion, as text or JSON.
pub fn run(arguments: &OdometryArguments, files: &Files) -> Result<String, CliError> {
    let read = open_path(&arguments.log, None, files)?;
    remark(read.report.remarks.iter().map(|remark| remark.message.clone()));
    let log = &read.log;
    let trajectory =
        arguments.trajectory.as_deref().map(|path| files.destination(path)).transpose()?;
    let network = arguments.network.as_deref().map(|path| read_network(path, files)).transpose()?;
    let network = network.unwrap_or_else(boresight_validate::candidates::network);
    let radars = chosen(log, &arguments.sensors)?
        .into_iter()
        .map(|sensor| {
            let options = CalibrationOptions {
                motion: Some(MotionMethod::Deepego),
                ..CalibrationOptions::default()
            };
            Ok((sensor.id, mounted(options, sensor, [false, false])?))
        })
        .collect::<Result<Vec<(u8, CalibrationOptions)>, CliError>>()?;
    let options = radars[0].1;
    let wanted = |id| radars.iter().any(|(sensor, _)| *sensor == id);

    let run = Run::start("frames")?;
    let mut joint = Joint::with_network(&radars, Some(&network))?;
    let look = |progress| run.report(progress);
    feed(log, &options, &look, wanted, |sensor, frame| {
        joint.add(sensor, frame)?;
        Ok(())
    })?;
    let estimates = joint.estimate();
    let car = &estimates[0].1;
    let mounting: Vec<Mounted> = radars
        .iter()
        .zip(&estimates)
        .map(|((sensor, options), (_, estimate))| Mounted {
            sensor: *sensor,
            angle_rad: estimate.angle_rad,
            x_m: options.x_m,
            y_m: options.y_m,
        })
        .collect();
    let mut fusion = Fusion::new(&mounting, car.slip_gradient_rad, &network)?;
    let (mut track, mut against) = (Track::default(), Against::default());
    let mut last: Option<FusedMotion> = None;
    feed(log, &options, &look, wanted, |sensor, frame| {
        let Some(found) = fusion.add(sensor, frame)? else { return Ok(()) };
        let time_s = found.time_s - car.delay_s;
        let (speed, yaw) = (found.speed_mps, found.yaw_rate_radps);
        if let (Some(measured_speed), Some(measured_yaw)) =
            (log.speed_at(time_s, options.max_gap_s), log.yaw_rate_at(time_s, options.max_gap_s))
        {
            against.add([speed - measured_speed, yaw - measured_yaw], found.covariance);
        }
        let velocity_mps = [speed, found.sideways_mps];
        let motion = TimedMotion { time_s, velocity_mps, yaw_rate_radps: Some(yaw) };
        track.push(log, &options, motion);
        last = Some(found);
        Ok(())
    })?;
    run.finish();

    let at_axle = CalibrationOptions { x_m: 0.0, y_m: 0.0, ..options };
    if let Some(trajectory) = trajectory {
        let csv = track.csv(0.0, &at_axle).ok_or_else(|| CliError::Option {
            option: "--trajectory",
            expected: "a drive whose motion is known".into(),
            given: format!("{} frames without one", log.scans.len()),
        })?;
        files.write(trajectory, csv.as_bytes())?;
    }
    let results: Vec<Radar> = estimates
        .into_iter()
        .zip(fusion.counts())
        .map(|((sensor, estimate), (_, counts))| Radar { sensor, estimate, counts })
        .collect();
    let errors: Vec<(f64, Option<f64>)> =
        SEGMENTS_M.map(|length| (length, track.error_m(0.0, &at_axle, length))).into();
    Ok(if arguments.json {
        let frames = |counts: &FusionCounts| json!({ "taken": counts.taken, "untold": counts.untold, "contradicted": counts.contradicted });
        let pair = |i: usize, unit: f64| {
            against.of(i).map(|d| {
                json!({ "mean": d.mean * unit, "rms": d.rms * unit, "within1Sigma": d.within[0], "within2Sigma": d.within[1] })
            })
        };
        let result = json!({
            "radars": results.iter().map(|radar| json!({
                "sensor": radar.sensor,
                "angleDeg": radar.estimate.angle_rad.to_degrees(),
                "sigmaDeg": radar.estimate.sigma_rad.to_degrees(),
                "frames": frames(&radar.counts),
            })).collect::<Vec<_>>(),
            "speedDifferenceMps": pair(0, 1.0),
            "yawRateDifferenceDegps": pair(1, f64::to_degrees(1.0)),
            "trajectoryErrors": errors.iter().map(|(length, error)| json!({ "segmentM": length, "errorM": error })).collect::<Vec<_>>(),
        });
        format!("{result:#}\n")
    } else {
        text(&results, &against, &errors, last)
    })
}

fn chosen<'a>(log: &'a DriveLog, asked: &[u8]) -> Result<Vec<&'a Sensor>, CliError> {
    let known = |id: u8| log.sensors.iter().any(|sensor| sensor.id == id);
    let unknown = asked.iter().find(|id| !known(**id)).map(u8::to_string);
    if log.sensors.is_empty() || unknown.is_some() {
        return Err(CliError::Option {
            option: "--sensors",
            expected: format!("radars of the log: {}", ids(log)),
            given: unknown.unwrap_or_else(|| "a log without radars".into()),
        });
    }
    Ok(log.sensors.iter().filter(|s| asked.is_empty() || asked.contains(&s.id)).collect())
}

fn text(
    radars: &[Radar],
    against: &Against,
    errors: &[(f64, Option<f64>)],
    last: Option<FusedMotion>,
) -> String {
    let mut text = String::new();
    for Radar { sensor, estimate, counts } in radars {
        text += &format!(
            "sensor {sensor}     {:+.3} +- {:.3} deg; frames: {} taken, {} without a motion, {} contradicted by the rest\n",
            estimate.angle_rad.to_degrees(),
            estimate.sigma_rad.to_degrees(),
            counts.taken,
            counts.untold,
            counts.contradicted,
        );
    }
    if let Some(FusedMotion { covariance: [[speed, _], [_, yaw]], .. }) = last {
        text += &format!(
            "deviations   {:.3} m/s, {:.3} deg/s stated at the end\n",
            speed.sqrt(),
            yaw.sqrt().to_degrees()
        );
    }
    let rows = [("speed", "m/s", 1.0), ("yaw rate", "deg/s", f64::to_degrees(1.0))]
        .into_iter()
        .enumerate();
    for (i, (name, unit, scale)) in rows {
        let Some(Difference { mean, rms, within: [one, two] }) = against.of(i) else { continue };
        text += &format!(
            "{name:13}{:+.3} {unit} from the log's on average, {:.3} root mean square, {:.0} and {:.0} % within one and two stated deviations\n",
            mean * scale,
            rms * scale,
            100.0 * one,
            100.0 * two,
        );
    }
    for (length, error) in errors {
        if let Some(error) = error {
            text +=
                &format!("trajectory   {error:.2} m off at the end of {length} m, on average\n");
        }
    }
    text
}
