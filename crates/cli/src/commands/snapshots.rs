//! Snapshots of an array.

use super::frame::frame_within;
use crate::arguments::EstimateArguments;
use crate::error::CliError;
use crate::files::Files;
use crate::output::{Column, Table, remark};
use crate::{array, network};
use boresight_aoa::{Data, Method};
use boresight_core::{Complex64, InputError};
use boresight_formats::NpyArray;
use boresight_math::decibels::power_to_db;
use boresight_pipeline::AngleOptions;
use ndarray::{Array3, Axis};

/// Scenes x elements x snapshots; a vector is one snapshot, a matrix elements x snapshots.
pub fn scenes(file: &NpyArray) -> Result<Array3<Complex64>, CliError> {
    let shape = match file.shape[..] {
        [elements] => [1, elements, 1],
        [elements, snapshots] => [1, elements, snapshots],
        [scenes, elements, snapshots] => [scenes, elements, snapshots],
        _ => [0; 3],
    };
    Array3::from_shape_vec(shape, file.to_complex64()).map_err(|_| {
        InputError::Shape {
            what: "snapshots".into(),
            expected: "1 to 3 axes".into(),
            given: file.shape.clone(),
        }
        .into()
    })
}

/// Angles in each scene.
pub fn run(
    arguments: &EstimateArguments,
    scenes: &Array3<Complex64>,
    files: &Files,
) -> Result<String, CliError> {
    let name = arguments.radar.array.as_ref().ok_or_else(|| CliError::Option {
        option: "--array",
        expected: "the array that took the snapshots".into(),
        given: "nothing".into(),
    })?;
    let AngleOptions { method, options } = arguments.angle.flags.options;
    let model = &arguments.angle.model;
    let array = array::array(name, files)?;
    let array = array::calibrated(array, arguments.radar.calibration.as_deref(), files)?;
    let mut estimator = network::estimator(method, &array, &options, model, files)?;
    let count = scenes.len_of(Axis(0));
    let chosen = match arguments.frame {
        Some(frame) => {
            let frame = frame_within(frame, count)?;
            frame..frame + 1
        }
        None => 0..count,
    };
    let mut rows = vec![];
    let mut notes: Vec<String> = vec![];
    for scene in chosen {
        let mut snapshots = scenes.index_axis(Axis(0), scene).to_owned();
        array.correct(snapshots.view_mut())?;
        let estimate = estimator.estimate(Data::Snapshots(snapshots.view()))?;
        for warning in &estimate.warnings {
            let note = warning.to_string();
            if !notes.contains(&note) && notes.len() < 20 {
                notes.push(note);
            }
        }
        rows.extend(estimate.sources.iter().map(|source| {
            vec![
                scene as f64,
                source.direction.azimuth_rad.to_degrees(),
                source.direction.elevation_rad.to_degrees(),
                power_to_db(source.power),
                source.confidence.unwrap_or(f64::NAN),
                source.deviation.map_or(f64::NAN, |of| of.azimuth_rad.to_degrees()),
                source.deviation.map_or(f64::NAN, |of| of.power_db),
            ]
        }));
    }
    remark(notes);
    let column = |json, csv, digits| Column { json, csv, digits };
    let mut columns = vec![
        column("scene", "scene", 0),
        column("azimuthDeg", "azimuth_deg", 3),
        column("elevationDeg", "elevation_deg", 3),
        column("powerDb", "power_db", 2),
    ];
    if Method::NETWORKS.contains(&method) {
        columns.push(column("confidence", "confidence", 3));
    }
    if rows.iter().any(|row: &Vec<f64>| row.last().is_some_and(|last| last.is_finite())) {
        columns.push(column("azimuthDeviationDeg", "azimuth_deviation_deg", 3));
        columns.push(column("powerDeviationDb", "power_deviation_db", 2));
    }
    rows.iter_mut().for_each(|row| row.truncate(columns.len()));
    let table = Table { columns, rows, empty: "no sources" };
    table.render(&arguments.output)
}
