//! `boresight image`.

use super::capture::{CaptureFrames, board_array};
use super::frame::frame_within;
use crate::arguments::{ImageArguments, ImageCaptureArguments, ImageCommand, ImageStreetArguments};
use crate::destination::Destination;
use crate::error::CliError;
use crate::files::{self, Files};
use crate::json;
use crate::output::remark;
use crate::run::Run;
use crate::{network, picture};
use boresight_aoa::Method;
use boresight_core::describe::Named;
use boresight_core::drive::Mounting;
use boresight_evaluate::images::StreetFrames;
use boresight_formats::{Capture, RadarConfig};
use boresight_image::{BirdsEyeView, Grid, Outside, ViewGrid, birds_eye_view, sidelobe_measure};
use boresight_pipeline::image::{Angles, Content, chain_options, frame_map, map_grid};
use boresight_pipeline::{Chain, FrameSource};
use boresight_simulate::Street;
use boresight_simulate::street::STREET_RADARS;
use serde_json::{Value, json};
use std::path::{Path, PathBuf};

/// Makes images, writes the pictures and returns what is printed.
pub fn run(what: &ImageCommand, files: &Files) -> Result<String, CliError> {
    match what {
        ImageCommand::Street(arguments) => street(arguments, files),
        ImageCommand::Capture(arguments) => capture(arguments, files),
    }
}

fn street(arguments: &ImageStreetArguments, files: &Files) -> Result<String, CliError> {
    let pictures = pictures(&arguments.shared, files)?;
    let grid = ViewGrid::of(&arguments.grid.options)?;
    let asked = |name: &str| {
        arguments.radars.is_empty() || arguments.radars.iter().any(|radar| radar == name)
    };
    let radars: Vec<usize> =
        (0..STREET_RADARS.len()).filter(|&index| asked(STREET_RADARS[index])).collect();
    let street = Street::new(arguments.street.options)?;
    let frames = StreetFrames::new(street, &radars, &chain_options())?;
    let cells: Vec<usize> = frames.frames.iter().map(|frame| frame.cells.cells.len()).collect();
    let (targets, gate) = (frames.targets_m(), frames.gate()?);
    let truth = if arguments.truth { &targets[..] } else { &[] };
    let shared = &arguments.shared;
    let mut text = format!(
        "{:<22}{:>11}{:>16}{:>13}{:>13}\n",
        "method", "outside_db", "peak_outside_db", "lit_outside", "lit_targets"
    );
    let mut rows = vec![];
    for (name, picture) in shared.method.iter().zip(pictures) {
        let angles = angles(shared, name)?;
        let model = network::model_for(angles.method, &shared.model, files)?;
        let image = frames.image(&angles, model.as_ref().map(|(model, _)| model), grid)?;
        remark(image.warnings.iter().map(|warning| format!("{name}: {warning}")));
        let measure = sidelobe_measure(&image.view, &targets, gate)?;
        let (outside_db, peak_db) = (measure.outside_db(), measure.peak_outside_db());
        text += &format!(
            "{name:<22}{outside_db:>11.1}{peak_db:>16.1}{:>12.2}%{:>12.1}%\n",
            100.0 * measure.lit_outside,
            100.0 * measure.lit_targets
        );
        let further = json!({ "method": name, "offMap": json::result(&image.outside) });
        rows.push(json::beside(&measure, further));
        keep(picture, &image.view, truth, files)?;
    }
    remark([format!("cells of each radar: {cells:?}; targets in view of any: {}", targets.len())]);
    Ok(if shared.json { format!("{:#}\n", Value::Array(rows)) } else { text })
}

fn capture(arguments: &ImageCaptureArguments, files: &Files) -> Result<String, CliError> {
    let shared = &arguments.shared;
    let config = RadarConfig::parse(&files.read(&arguments.config)?)?;
    let bytes = files.read(&arguments.file)?;
    let source = CaptureFrames(Capture::new(&bytes, &config)?);
    let array = board_array(arguments.array.as_deref(), &config, files)?;
    let waveform = config.waveform;
    let pictures = pictures(shared, files)?;
    let mut chain = Chain::new(&waveform, config.receivers.len(), &array, &chain_options())?;
    let cells = match arguments.frame {
        Some(frame) => {
            let frame = source.frame(frame_within(frame, source.frames())?)?;
            chain.cells(frame.samples.view())?
        }
        None => {
            let run = Run::start("frames")?;
            let frames = 0..source.frames();
            let cells = chain.combined_cells(&source, frames, &mut |at| run.report(at))?;
            run.finish();
            cells
        }
    };
    let far_m = 0.9 * waveform.max_range_m();
    let grid = ViewGrid::new([0.0, far_m], [-far_m / 2.0, far_m / 2.0], far_m / 500.0)?;
    let mut text = format!("{:<22}{:>8}{:>12}{:>12}\n", "method", "cells", "off_map", "off_map_db");
    let mut rows = vec![];
    for (name, picture) in shared.method.iter().zip(pictures) {
        let map_grid = Grid::of(&map_grid(&waveform))?;
        let angles = angles(shared, name)?;
        let options = angles.suited(&array);
        let mut estimator =
            network::estimator(angles.method, &array, &options, &shared.model, files)?;
        let made = frame_map(&cells, &mut estimator, angles.content, map_grid)?;
        remark(made.warnings.iter().map(|warning| format!("{name}: {warning}")));
        let here = Mounting { x_m: 0.0, y_m: 0.0, yaw_rad: 0.0 };
        let view = birds_eye_view(&[(&made.map, here)], grid)?;
        let Outside { count, power } = made.map.outside;
        let all = power + f64::from(made.map.power.sum());
        let count_of = cells.cells.len();
        let share_db = 10.0 * (power / all).log10();
        text += &format!("{name:<22}{count_of:>8}{count:>12}{share_db:>12.1}\n");
        let off_map = json::result(&made.map.outside);
        rows.push(json!({ "method": name, "cells": count_of, "offMap": off_map }));
        keep(picture, &view, &[], files)?;
    }
    Ok(if shared.json { format!("{:#}\n", Value::Array(rows)) } else { text })
}

fn angles(shared: &ImageArguments, name: &str) -> Result<Angles, CliError> {
    let mut angles = Angles::of(Method::from_name(name)?);
    if let Some(from) = shared.from.as_deref() {
        angles.content = Content::from_name("--from", from)?;
    }
    Ok(angles)
}

/// Where the picture of each method goes, if one is asked for.
fn pictures(shared: &ImageArguments, files: &Files) -> Result<Vec<Option<Destination>>, CliError> {
    let several = shared.method.len() > 1;
    let picture = |method: &String| {
        let path = shared.out.as_deref();
        let path = path.map(|path| if several { named(path, method) } else { path.into() });
        path.map(|path| files.destination(&path)).transpose()
    };
    shared.method.iter().map(picture).collect()
}

/// Writes the picture, if one is asked for.
fn keep(
    picture: Option<Destination>,
    view: &BirdsEyeView,
    truth: &[[f64; 2]],
    files: &Files,
) -> Result<(), CliError> {
    let Some(destination) = picture else { return Ok(()) };
    let png = picture::png(destination.named(), view, truth)?;
    files.write(destination, &png)
}

/// `street.png` as `street-iaa.png`.
fn named(path: &Path, method: &str) -> PathBuf {
    let mut name = path.file_stem().unwrap_or_default().to_owned();
    name.push(format!("-{method}.{}", files::ending(path)));
    path.with_file_name(name)
}
