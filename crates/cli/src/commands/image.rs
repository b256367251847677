//! `boresight image`.

use super::capture::{Samples, board_array};
use super::frame::frame_within;
use crate::arguments::{ImageArguments, ImageCaptureArguments, ImageCommand, ImageStreetArguments};
use crate::array;
use crate::destination::Destination;
use crate::error::CliError;
use crate::files::{self, Files};
use crate::network;
use crate::output::remark;
use crate::picture::{self, Truth};
use crate::run::Run;
use crate::street::{CHAIN, ImageFigures, Maker, StreetFrames};
use boresight_aoa::Method;
use boresight_core::drive::Mounting;
use boresight_formats::json;
use boresight_image::{BirdsEyeView, Grid, Outside, PointMeasure, ViewGrid, birds_eye_view};
use boresight_math::decibels::power_to_db;
use boresight_options::Named;
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
    let shared = &arguments.shared;
    let chain = arguments.chain.then_some(CHAIN);
    let names: Vec<&str> = shared.method.iter().map(String::as_str).chain(chain).collect();
    let pictures = pictures(shared, &names, files)?;
    let grid = ViewGrid::of(&arguments.grid.options)?;
    let asked = |name: &str| {
        arguments.radars.is_empty() || arguments.radars.iter().any(|radar| radar == name)
    };
    let radars: Vec<usize> =
        (0..STREET_RADARS.len()).filter(|&index| asked(STREET_RADARS[index])).collect();
    let street = Street::new(arguments.street.options)?;
    let frames = StreetFrames::new(street, &radars)?;
    let cells: Vec<usize> = frames.frames.iter().map(|frame| frame.cells.cells.len()).collect();
    let targets = frames.targets_m();
    let truth = match arguments.truth {
        true => Truth::of(frames.street(), &targets),
        false => Truth::default(),
    };
    let content = content(shared, chain.is_some())?;
    let mut text = format!(
        "{:<22}{:<9}{:>11}{:>16}{:>13}{:>13}{:>11}{:>11}{:>8}{:>8}{:>8}\n",
        "method",
        "from",
        "outside_db",
        "peak_outside_db",
        "lit_outside",
        "lit_targets",
        "behind_db",
        "behind_m2",
        "points",
        "false",
        "behind"
    );
    let mut rows = vec![];
    for (name, picture) in names.into_iter().zip(pictures) {
        let angles;
        let model;
        let maker = if chain == Some(name) {
            Maker::Chain
        } else {
            angles = Angles { content, ..Angles::of(Method::from_name(name)?) };
            model = network::model_for(angles.method, &shared.model, files)?;
            Maker::Cells { angles: &angles, model: model.as_ref().map(|(model, _)| model) }
        };
        let image = frames.image(&maker, grid)?;
        remark(image.warnings.iter().map(|warning| format!("{name}: {warning}")));
        let figures = frames.figures(&image)?;
        let ImageFigures { sidelobes, behind_walls, points } = &figures;
        let from = maker.content().name();
        text += &format!(
            "{name:<22}{from:<9}{:>11.1}{:>16.1}{:>12.2}%{:>12.1}%{:>11.1}{:>11.1}",
            sidelobes.outside_db(),
            sidelobes.peak_outside_db(),
            100.0 * sidelobes.lit_outside,
            100.0 * sidelobes.lit_targets,
            power_to_db(behind_walls.share),
            behind_walls.lit_m2,
        );
        let count = |of: fn(&PointMeasure) -> usize| match points {
            Some(points) => format!("{:>8}", of(points)),
            None => format!("{:>8}", "-"),
        };
        text += &count(|points| points.points);
        text += &count(|points| points.false_points);
        text += &count(|points| points.hidden_points);
        text += "\n";
        let further = json!({
            "method": name,
            "from": from,
            "offMap": json::result(&image.outside),
            "behindWalls": json::result(behind_walls),
            "points": points.as_ref().map(json::result),
        });
        rows.push(json::beside(sidelobes, further));
        keep(picture, &image.view, &truth, files)?;
    }
    remark([format!("cells of each radar: {cells:?}; targets in view of any: {}", targets.len())]);
    Ok(if shared.json { format!("{:#}\n", Value::Array(rows)) } else { text })
}

fn capture(arguments: &ImageCaptureArguments, files: &Files) -> Result<String, CliError> {
    let shared = &arguments.shared;
    let config = Some(&*arguments.config);
    let samples = Samples::read(&arguments.file, config, None, &arguments.reading.options, files)?;
    let (source, config) = (samples.frames()?, &samples.config);
    let array = board_array(arguments.array.as_deref(), config, files)?;
    let array = array::calibrated_board(array, arguments.calibration.as_deref(), config, files)?;
    let waveform = config.waveform;
    let names: Vec<&str> = shared.method.iter().map(String::as_str).collect();
    let pictures = pictures(shared, &names, files)?;
    let content = content(shared, false)?;
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
    for (name, picture) in names.into_iter().zip(pictures) {
        let map_grid = Grid::of(&map_grid(&waveform))?;
        let angles = Angles { content, ..Angles::of(Method::from_name(name)?) };
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
        keep(picture, &view, &Truth::default(), files)?;
    }
    Ok(if shared.json { format!("{:#}\n", Value::Array(rows)) } else { text })
}

/// What images are made of: what was asked for, or the same of all.
fn content(shared: &ImageArguments, with_chain: bool) -> Result<Content, CliError> {
    if let Some(from) = shared.from.as_deref() {
        return Ok(Content::from_name("--from", from)?);
    }
    let methods = shared.method.iter().map(|name| Method::from_name(name));
    let methods: Vec<Method> = methods.collect::<Result<_, _>>()?;
    Ok(if with_chain { Content::Targets } else { Content::of_all(&methods) })
}

/// Where the picture of each method goes, if one is asked for.
fn pictures(
    shared: &ImageArguments,
    names: &[&str],
    files: &Files,
) -> Result<Vec<Option<Destination>>, CliError> {
    let several = names.len() > 1;
    let picture = |name: &&str| {
        let path = shared.out.as_deref();
        let path = path.map(|path| if several { named(path, name) } else { path.into() });
        path.map(|path| files.destination(&path)).transpose()
    };
    names.iter().map(picture).collect()
}

/// Writes the picture, if one is asked for.
fn keep(
    picture: Option<Destination>,
    view: &BirdsEyeView,
    truth: &Truth,
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
