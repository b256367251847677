//! `boresight simulate drive`.

use crate::arguments::DriveArguments;
use crate::error::CliError;
use crate::files::{self, Files};
use crate::pairs;
use crate::run::Run;
use crate::terminal::name;
use boresight_core::Progress;
use boresight_core::drive::{Mounting, RADARSCENES_SENSORS};
use boresight_formats::json;
use boresight_formats::radarscenes::{Packing, write};
use boresight_options::Named;
use boresight_simulate::drive::PlacedRadar;
use boresight_simulate::{DriveOptions, SimulatedDrive, simulate_drive_reporting};
use serde_json::{Value, json};
use std::path::Path;

/// The one sequence written.
const SEQUENCE: &str = "sequence_1";

/// Simulates a drive, writes it and says what there is.
pub fn run(arguments: &DriveArguments, out: &Path, files: &Files) -> Result<String, CliError> {
    if arguments.of_dataset.is_given() {
        return Err(CliError::Option {
            option: "--dataset",
            expected: "a folder, with options of sets of data".into(),
            given: "none".into(),
        });
    }
    let options = options(arguments)?;
    let data = out.join("data");
    let folder = data.join(SEQUENCE);
    let truth_path = out.join("truth.json");
    let radar_data = files.destination(&folder.join("radar_data.h5"))?;
    let scenes = files.destination(&folder.join("scenes.json"))?;
    let sensors = files.destination(&data.join("sensors.json"))?;
    let sequences = files.destination(&data.join("sequences.json"))?;
    let truth_file = files.destination(&truth_path)?;
    let run = Run::start("scans")?;
    let drive =
        simulate_drive_reporting(&options, |done, total| run.report(Progress { done, total }))?;
    run.finish();
    files::make_folder(&folder)?;
    let packing = if arguments.packed { Packing::Deflate } else { Packing::Contiguous };
    let beside = files.write_with(radar_data, |file| {
        Ok(write(&drive.log, &drive.tracks, SEQUENCE, packing, file)?)
    })?;
    files.write(scenes, beside.scenes.as_bytes())?;
    files.write(sensors, beside.sensors.as_bytes())?;
    files.write(sequences, beside.sequences.as_bytes())?;
    files.write(truth_file, format!("{:#}\n", truth(&options, &drive)).as_bytes())?;
    let detections: usize = drive.log.scans.iter().map(|scan| scan.detections.len()).sum();
    Ok(format!(
        "{}: {} radars, {} scans, {detections} detections, {:.1} % of them moving\n{}: the truth\n",
        name(&folder),
        drive.log.sensors.len(),
        drive.log.scans.len(),
        100.0 * moving_share(&drive),
        name(&truth_path),
    ))
}

fn moving_share(drive: &SimulatedDrive) -> f64 {
    let (moving, all) = drive
        .moving
        .iter()
        .flatten()
        .fold((0_usize, 0_usize), |(m, n), moving| (m + usize::from(*moving), n + 1));
    moving as f64 / all.max(1) as f64
}

fn options(arguments: &DriveArguments) -> Result<DriveOptions, CliError> {
    let mut options = DriveOptions {
        seed: arguments.seed,
        misalignment_rad: arguments
            .misalignments
            .iter()
            .map(|text| misalignment(text))
            .collect::<Result<_, _>>()?,
        ..arguments.flags.options.clone()
    };
    if !arguments.sensors.is_empty() {
        options.sensors =
            arguments.sensors.iter().map(|text| sensor(text)).collect::<Result<_, _>>()?;
    }
    Ok(options)
}

fn sensor(text: &str) -> Result<(u8, Mounting), CliError> {
    if let Ok(number) = text.trim().parse::<u8>() {
        return RADARSCENES_SENSORS.into_iter().find(|(id, _)| *id == number).ok_or_else(|| {
            CliError::Option {
                option: "--sensor",
                expected: "1 to 4, or id=N,x=M,y=M,yaw=DEG".into(),
                given: number.to_string(),
            }
        });
    }
    let PlacedRadar { id, mounting } = pairs::read("--sensor", text)?;
    Ok((id, *mounting))
}

fn misalignment(text: &str) -> Result<(u8, f64), CliError> {
    text.split_once('=')
        .and_then(|(id, angle)| {
            let angle: f64 = angle.trim().parse().ok()?;
            Some((id.trim().parse().ok()?, angle.to_radians()))
        })
        .ok_or_else(|| CliError::Option {
            option: "--misalign",
            expected: "a radar's number and an angle in deg, such as 2=1.5".into(),
            given: format!("{text:?}"),
        })
}

fn truth(options: &DriveOptions, drive: &SimulatedDrive) -> Value {
    let truth = &drive.truth;
    let sensors: Vec<Value> = truth
        .sensors
        .iter()
        .zip(&drive.log.sensors)
        .zip(&truth.azimuth_bias_rms_rad)
        .map(|(((id, mounting), sensor), rms)| {
            let nominal = sensor.mounting.map(|m| m.yaw_rad.to_degrees());
            let bias = rms.to_degrees();
            json::beside(
                mounting,
                json!({ "id": id, "nominalYawDeg": nominal, "azimuthBiasRmsDeg": bias }),
            )
        })
        .collect();
    json!({
        "scenario": options.scenario.name(),
        "profile": options.profile.name(),
        "seed": options.seed,
        "durationS": options.duration_s,
        "sensors": sensors,
        "yawRate": json::result(&truth.yaw_rate),
        "car": json::result(&truth.car),
        "movingShare": moving_share(drive),
    })
}
