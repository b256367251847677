//! `boresight calibrate`: the angle radars are mounted at, from a drive.

use crate::arguments::CalibrateArguments;
use crate::drive::open_path;
use crate::error::CliError;
use crate::output::remark;
use crate::run::Run;
use boresight_calibrate::{
    AngleEstimate, Calibrator, FrameInput, Method, MotionMethod, Options, Remark,
};
use boresight_core::drive::{DriveLog, Sensor};
use boresight_formats::DriveFormat;
use boresight_pipeline::{PipelineError, Progress};
use serde_json::{Value, json};

/// Frames between two looks at progress and Ctrl-C.
const FRAMES_A_REPORT: usize = 64;

/// The angles, as text or JSON.
pub fn run(arguments: &CalibrateArguments) -> Result<String, CliError> {
    let format = arguments.format.as_deref().map(DriveFormat::from_name).transpose()?;
    let read = open_path(&arguments.paths, format, arguments.sequence.as_deref())?;
    remark(read.report.remarks.iter().map(|remark| remark.message.clone()));
    let sensors = chosen(&read.log, arguments.sensor)?;
    let run = Run::start("frames")?;
    let mut estimates = Vec::with_capacity(sensors.len());
    for sensor in sensors {
        let options = options(arguments, sensor)?;
        estimates.push((sensor.id, options, calibrate(&read.log, sensor.id, options, &run)?));
    }
    run.finish();
    Ok(if arguments.json {
        let mut objects: Vec<Value> =
            estimates.iter().map(|(id, o, e)| as_json(*id, o, e)).collect();
        let result = if objects.len() == 1 { objects.remove(0) } else { Value::Array(objects) };
        format!("{result:#}\n")
    } else {
        estimates.iter().map(|(id, o, e)| as_text(*id, o, e)).collect::<Vec<_>>().join("\n")
    })
}

/// The radar asked for, or all.
fn chosen(log: &DriveLog, sensor: Option<u8>) -> Result<Vec<&Sensor>, CliError> {
    let found: Vec<&Sensor> =
        log.sensors.iter().filter(|s| sensor.is_none_or(|id| id == s.id)).collect();
    if found.is_empty() {
        let ids: Vec<String> = log.sensors.iter().map(|s| s.id.to_string()).collect();
        return Err(CliError::Option {
            option: "--sensor",
            expected: format!("a radar of the log: {}", ids.join(", ")),
            given: sensor.map_or("a log without radars".into(), |id| id.to_string()),
        });
    }
    Ok(found)
}

fn options(arguments: &CalibrateArguments, sensor: &Sensor) -> Result<Options, CliError> {
    let x_m = arguments.x.or(sensor.mounting.map(|m| m.x_m)).ok_or_else(|| CliError::Option {
        option: "--x",
        expected: "the radar's distance ahead of the rear axle, m: the log does not state it"
            .into(),
        given: "not given".into(),
    })?;
    Ok(Options {
        method: Method::from_name(&arguments.method)?,
        motion: arguments.motion.as_deref().map(MotionMethod::from_name).transpose()?,
        x_m,
        y_m: arguments.y.or(sensor.mounting.map(|m| m.y_m)).unwrap_or(0.0),
        nominal_rad: arguments
            .nominal
            .map(f64::to_radians)
            .or(sensor.mounting.map(|mounting| mounting.yaw_rad)),
        min_speed_mps: arguments.min_speed,
        ..Options::default()
    })
}

fn calibrate(
    log: &DriveLog,
    sensor: u8,
    options: Options,
    run: &Run,
) -> Result<AngleEstimate, CliError> {
    let mut calibrator = Calibrator::new(options)?;
    let total = log.scans.iter().filter(|scan| scan.sensor == sensor).count();
    for (done, scan) in log.scans.iter().filter(|scan| scan.sensor == sensor).enumerate() {
        if done % FRAMES_A_REPORT == 0 && run.report(Progress { done, total }).is_break() {
            return Err(PipelineError::Cancelled { done, total }.into());
        }
        calibrator.add(FrameInput {
            time_s: scan.time_s,
            detections: &scan.detections,
            yaw_rate_radps: log.yaw_rate_at(scan.time_s, options.max_gap_s),
            speed_mps: log.speed_at(scan.time_s, options.max_gap_s),
        })?;
    }
    Ok(calibrator.estimate())
}

/// A remark's code and what it says.
fn warning(remark: Remark) -> (&'static str, &'static str) {
    match remark {
        Remark::NoFrames => ("no-frames", "no frame could be used; the angle is the nominal one"),
        Remark::AngleUndetermined => {
            ("angle-undetermined", "the drive does not determine the angle to a degree")
        }
        Remark::ScaleUndetermined => {
            ("scale-undetermined", "the drive does not determine the scale of the yaw rate")
        }
        Remark::BiasUndetermined => {
            ("bias-undetermined", "the car never stood: the bias of the yaw rate is taken as 0")
        }
        Remark::FewInliers => ("few-inliers", "fewer than half of the detections were static"),
        Remark::Misaligned => ("misaligned", "the radar is misaligned against its nominal angle"),
        Remark::NotConverged => ("not-converged", "the angle has not settled yet"),
        _ => ("other", "see the documentation"),
    }
}

fn as_json(sensor: u8, options: &Options, e: &AngleEstimate) -> Value {
    let frames = e.frames;
    let warnings: Vec<Value> = e
        .remarks
        .iter()
        .map(|&remark| {
            let (code, message) = warning(remark);
            json!({ "code": code, "message": message })
        })
        .collect();
    // What is not finite becomes null.
    json!({
        "sensor": sensor,
        "method": options.method.name(),
        "motion": options.motion_method().name(),
        "angleDeg": e.angle_rad.to_degrees(),
        "sigmaDeg": e.sigma_rad.to_degrees(),
        "nominalDeg": options.nominal_rad.map(f64::to_degrees),
        "scale": e.scale,
        "scaleSigma": e.scale_sigma,
        "covariance": e.covariance,
        "biasDegps": e.bias_radps.to_degrees(),
        "biasSigmaDegps": e.bias_sigma_radps.to_degrees(),
        "inlierShare": e.inlier_share,
        "frames": {
            "given": frames.given,
            "used": frames.used,
            "standing": frames.standing,
            "slow": frames.slow,
            "turning": frames.turning,
            "sparse": frames.sparse,
            "withoutMotion": frames.without_motion,
        },
        "converged": e.converged,
        "misaligned": e.misaligned,
        "warnings": warnings,
    })
}

fn as_text(sensor: u8, options: &Options, e: &AngleEstimate) -> String {
    let within = |value: String, sigma: f64, digits: usize| {
        if sigma == f64::INFINITY {
            format!("{value}, not determined")
        } else {
            format!("{value} +- {sigma:.digits$}")
        }
    };
    let angle = within(format!("{:.3}", e.angle_rad.to_degrees()), e.sigma_rad.to_degrees(), 3);
    let scale = within(format!("{:.4}", e.scale), e.scale_sigma, 4);
    let bias =
        within(format!("{:.3}", e.bias_radps.to_degrees()), e.bias_sigma_radps.to_degrees(), 3);
    let f = e.frames;
    let mut text = format!(
        "sensor       {sensor}, {}\nangle        {angle} deg\nscale        {scale}\nbias         {bias} deg/s\n\
         inliers      {:.1} %\nframes       {} of {} used; {} standing, {} slow, {} turning, {} sparse, {} \
         without motion\nconverged    {}\n",
        options.method.title(),
        100.0 * e.inlier_share,
        f.used,
        f.given,
        f.standing,
        f.slow,
        f.turning,
        f.sparse,
        f.without_motion,
        if e.converged { "yes" } else { "no" },
    );
    for &remark in &e.remarks {
        text += &format!("warning      {}\n", warning(remark).1);
    }
    text
}
