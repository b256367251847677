//! What a board detected itself.

use super::frame::frame_within;
use crate::arguments::EstimateArguments;
use crate::error::CliError;
use crate::files::{Files, radar_config};
use crate::output::{Column, Table, remark};
use boresight_formats::{BoardLog, RadarConfig};
use std::path::Path;

/// Packets out of messages of a recording, as [`run`] takes them.
pub fn recorded(
    arguments: &EstimateArguments,
    path: &Path,
    files: &Files,
) -> Result<String, CliError> {
    let failed = |error| CliError::File { action: "read", path: path.into(), error };
    run(arguments, files, |config| {
        let file = files.open(path)?;
        Ok(BoardLog::of_mcap(file, None, config).map_err(failed)??)
    })
}

/// The board's detections of each packet; `--frame` counts packets from 0.
pub fn run(
    arguments: &EstimateArguments,
    files: &Files,
    read: impl FnOnce(Option<&RadarConfig>) -> Result<BoardLog, CliError>,
) -> Result<String, CliError> {
    let config = match &arguments.radar.config {
        Some(path) => Some(radar_config(path, files)?),
        None => None,
    };
    let log = read(config.as_ref())?;
    remark(
        std::iter::once(format!("packets: {}", log.frames.len()))
            .chain(log.counts.remarks.iter().map(|remark| remark.message.clone())),
    );
    let frames = match arguments.frame {
        Some(frame) => {
            let frame = frame_within(frame, log.frames.len())?;
            &log.frames[frame..=frame]
        }
        None => &log.frames[..],
    };
    let rows = frames
        .iter()
        .flat_map(|frame| {
            frame.objects.iter().map(|object| {
                vec![
                    f64::from(frame.frame_number),
                    object.range_m,
                    object.rate_mps.unwrap_or(f64::NAN),
                    object.azimuth_rad.to_degrees(),
                    object.elevation_rad.to_degrees(),
                    object.peak.unwrap_or(f64::NAN),
                    object.snr_db.unwrap_or(f64::NAN),
                    object.x_m,
                    object.y_m,
                    object.z_m,
                ]
            })
        })
        .collect();
    let column = |json, csv, digits| Column { json, csv, digits };
    let table = Table {
        columns: vec![
            column("frame", "frame", 0),
            column("rangeM", "range_m", 3),
            column("rateMps", "rate_mps", 2),
            column("azimuthDeg", "azimuth_deg", 2),
            column("elevationDeg", "elevation_deg", 2),
            column("peak", "peak", 0),
            column("snrDb", "snr_db", 1),
            column("xM", "x_m", 3),
            column("yM", "y_m", 3),
            column("zM", "z_m", 3),
        ],
        rows,
        empty: "the board detected nothing",
    };
    table.render(&arguments.output)
}
