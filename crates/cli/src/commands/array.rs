//! `boresight array`.

use super::capture::{Radar, board_array};
use super::{capture, cube};
use crate::arguments::{ArrayCommand, CalibrateArrayArguments, ShowCalibrationArguments};
use crate::array;
use crate::error::CliError;
use crate::files::{self, Files, radar_config};
use crate::numbers;
use crate::output::remark;
use crate::run::Run;
use boresight_array_calibration::{
    CalibrationOptions, CalibrationResult, CheckFigures, SteeringTable,
};
use boresight_core::{Array, ArrayCalibration};
use boresight_formats::json;
use boresight_math::decibels::power_to_db;
use boresight_options::Named;
use boresight_pipeline::array_calibration::{CalibrationFrames, calibrate_array};
use boresight_pipeline::{CubeFrames, FrameSource};
use std::ops::Range;
use std::path::Path;

/// Runs the command and returns what it prints.
pub fn run(what: &ArrayCommand, files: &Files) -> Result<String, CliError> {
    match what {
        ArrayCommand::Calibrate(arguments) => calibrate(arguments, files),
        ArrayCommand::Show(arguments) => show(arguments, files),
    }
}

fn calibrate(arguments: &CalibrateArrayArguments, files: &Files) -> Result<String, CliError> {
    let out = arguments.out.as_deref().map(|path| files.destination(path)).transpose()?;
    let result = result(arguments, files)?;
    remark(result.warnings.iter().map(|warning| warning.message.clone()));
    if let Some(out) = out {
        let text = format!("{:#}\n", json::result(&result.calibration));
        files.write(out, text.as_bytes())?;
    }
    if arguments.ti {
        let path = arguments.radar.config.as_deref().ok_or_else(|| CliError::Option {
            option: "--config",
            expected: "the board's .cfg file, for whose channels --ti prints the line".into(),
            given: "nothing".into(),
        })?;
        return line(&result.calibration, path, files);
    }
    if arguments.json {
        return Ok(format!("{:#}\n", json::result(&result)));
    }
    Ok(report(&result))
}

fn result(
    arguments: &CalibrateArrayArguments,
    files: &Files,
) -> Result<CalibrationResult, CliError> {
    let path = &arguments.file;
    match files::ending(path).as_str() {
        ending if ending == "bin" || path.is_dir() => {
            let (samples, radar) = capture::open(&arguments.radar, path, files)?;
            from_frames(arguments, &radar, &samples.frames()?)
        }
        "json" => {
            let table: SteeringTable =
                json::read(&files.read(path)?).map_err(|error| CliError::Json {
                    path: path.into(),
                    expected: "azimuthDeg and responses: directions x channels of [re, im]",
                    error,
                })?;
            Ok(table.calibrate(&named_array(arguments, files)?)?)
        }
        ending if numbers::ENDINGS.contains(&ending) => {
            let file = numbers::read(path, arguments.radar.dataset.as_deref(), files)?;
            let (cube, radar) = cube::open(&arguments.radar, &file, files)?;
            from_frames(arguments, &radar, &CubeFrames(cube.view()))
        }
        other => Err(CliError::Option {
            option: "FILE",
            expected: "a file ending in .bin, .npy, .mat, .h5 or .json".into(),
            given: if other.is_empty() { "no ending".into() } else { format!(".{other}") },
        }),
    }
}

/// The array of a table: by its name, or that of a board's configuration.
fn named_array(arguments: &CalibrateArrayArguments, files: &Files) -> Result<Array, CliError> {
    match (&arguments.radar.array, &arguments.radar.config) {
        (Some(name), _) => array::array(name, files),
        (None, Some(path)) => board_array(None, &radar_config(path, files)?, files),
        (None, None) => Err(CliError::Option {
            option: "--array",
            expected: "the array that the table is of, or --config".into(),
            given: "nothing".into(),
        }),
    }
}

fn from_frames<S: FrameSource>(
    arguments: &CalibrateArrayArguments,
    radar: &Radar,
    source: &S,
) -> Result<CalibrationResult, CliError>
where
    CliError: From<S::Error>,
{
    let count = source.frames();
    let within = |option: &'static str, range: &Range<usize>| {
        if range.end <= count {
            return Ok(range.clone());
        }
        Err(CliError::Option {
            option,
            expected: format!("frames of 0..{count}"),
            given: format!("{}..{}", range.start, range.end),
        })
    };
    let made_from = match &arguments.frames {
        Some(range) => within("--frames", range)?,
        None => CalibrationFrames::halves(count).made_from,
    };
    let checked_on = match &arguments.check_frames {
        Some(range) => within("--check-frames", range)?,
        None => made_from.end..count,
    };
    let options = CalibrationOptions {
        reflectors: arguments.at.clone(),
        ..arguments.options.options.clone()
    };
    let run = Run::start("frames")?;
    let Radar { waveform, receivers, array } = radar;
    let result = calibrate_array(
        (waveform, *receivers, array),
        source,
        &CalibrationFrames { made_from, checked_on },
        &options,
        &mut |at| run.report(at),
    )?;
    run.finish();
    Ok(result)
}

fn show(arguments: &ShowCalibrationArguments, files: &Files) -> Result<String, CliError> {
    let calibration = array::calibration(&arguments.file, files)?;
    match &arguments.ti {
        Some(path) => line(&calibration, path, files),
        None => Ok(channels(&calibration)),
    }
}

/// The line that makes a board apply a calibration.
fn line(calibration: &ArrayCalibration, path: &Path, files: &Files) -> Result<String, CliError> {
    let config = radar_config(path, files)?;
    Ok(format!("{}\n", config.compensation_of(calibration)?))
}

fn report(result: &CalibrationResult) -> String {
    let mut text = channels(&result.calibration);
    text += &format!(
        "\n{:>8}{:>10}{:>12}{:>13}{:>8}  {}\n",
        "range_m", "rate_mps", "azimuth_deg", "residual_db", "snr_db", "state"
    );
    for cell in &result.cells {
        text += &format!(
            "{:>8.2}{:>10.2}{:>12.2}{:>13.1}{:>8.1}  {}\n",
            cell.range_m,
            cell.rate_mps,
            cell.direction.azimuth_rad.to_degrees(),
            power_to_db(cell.residual),
            power_to_db(cell.snr),
            cell.state.name()
        );
    }
    let figures = |name: &str, of: &CheckFigures| {
        format!(
            "{name:<24}{:>10.2}{:>9.2}{:>13.1}{:>13.1}\n",
            of.residual_phase_rad.to_degrees(),
            of.residual_gain_db,
            of.residual_db,
            of.sidelobe_db
        )
    };
    if result.check.is_some() || result.left_out.is_some() {
        text += &format!(
            "\n{:<24}{:>10}{:>9}{:>13}{:>13}\n",
            "check", "phase_deg", "gain_db", "residual_db", "sidelobe_db"
        );
    }
    if let Some(check) = &result.check {
        text += &figures("as planned", &check.before);
        text += &figures("calibrated", &check.after);
    }
    if let Some(left_out) = &result.left_out {
        text += &figures("each by the others", left_out);
    }
    text
}

fn channels(calibration: &ArrayCalibration) -> String {
    let mut text = format!(
        "{:>3}{:>4}{:>11}{:>9}{:>9}{:>8}\n",
        "tx", "rx", "phase_deg", "std_deg", "gain_db", "std_db"
    );
    let receivers = calibration.rx.len().max(1);
    let shown = |number: Option<f64>| number.map_or("-".into(), |number| format!("{number:.2}"));
    for (index, channel) in calibration.channels.iter().enumerate() {
        text += &format!(
            "{:>3}{:>4}{:>11.2}{:>9}{:>9.2}{:>8}",
            index / receivers,
            index % receivers,
            channel.phase_rad.to_degrees(),
            shown(channel.phase_std_rad.map(f64::to_degrees)),
            channel.gain_db,
            shown(channel.gain_std_db)
        );
        if let Some([x, y, z]) = channel.displacement {
            text += &format!("  moved by [{x:.4}, {y:.4}, {z:.4}] half wavelengths");
        }
        text += "\n";
    }
    let names: Vec<&str> = calibration.not_identifiable.iter().map(|what| what.name()).collect();
    text += &format!(
        "method {}; {} cells used, {} left out; {} frames\nnot identifiable: {}\n",
        calibration.method.name(),
        calibration.cells,
        calibration.cells_left_out,
        calibration.frames,
        if names.is_empty() { "nothing".into() } else { names.join(", ") }
    );
    if calibration.coupling.is_some() {
        text += "with coupling between all channels\n";
    }
    if calibration.range_bias_m != 0.0 {
        let std = calibration.range_bias_std_m;
        let std = std.map_or(String::new(), |std| format!(" +- {std:.4}"));
        text += &format!("ranges are {:.4}{std} m too long\n", calibration.range_bias_m);
    }
    if let Some(residual) = calibration.residual_db {
        text += &format!("residual {residual:.1} dB\n");
    }
    text
}
