//! The table of detections.

use super::{Columns, field, finite, from_csv};
use crate::error::FormatError;
use boresight_core::Direction;
use boresight_options::Described;
use serde::{Deserialize, Serialize};

/// One detection of a table.
#[derive(Debug, Clone, Copy, PartialEq, Default, Described, Serialize, Deserialize)]
pub struct DetectionRow {
    /// Frame, from 0.
    pub frame: usize,
    /// Range.
    pub range_m: f64,
    /// Range rate, positive when receding.
    pub rate_mps: f64,
    /// Azimuth, positive to the left.
    pub azimuth_rad: f64,
    /// Elevation.
    pub elevation_rad: f64,
    /// Place forward of the sensor. Tables have the places that follow from range and angles.
    #[serde(default)]
    pub x_m: f64,
    /// Place to its left.
    #[serde(default)]
    pub y_m: f64,
    /// Place above it.
    #[serde(default)]
    pub z_m: f64,
    /// Power at one element over full scale (1.0).
    pub power_db: f64,
    /// Over the local noise.
    pub snr_db: f64,
    /// Range bin.
    pub range_bin: usize,
    /// Doppler bin.
    pub doppler_bin: usize,
    /// Times twice the waveform's largest rate that the rate is beyond that of its bin.
    #[serde(default)]
    pub doppler_fold: i32,
    /// Probability of the likeliest fold among those tried.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub fold_probability: Option<f64>,
}

impl DetectionRow {
    /// The row with the place that follows from its range and angles.
    #[must_use]
    pub fn placed(self) -> Self {
        let direction = Direction::new(self.azimuth_rad, self.elevation_rad);
        let [x_m, y_m, z_m] = direction.place_m(self.range_m);
        Self { x_m, y_m, z_m, ..self }
    }
}

/// Columns that are read; those of the place follow from range and angles.
const COLUMNS: [&str; 11] = [
    "frame",
    "range_m",
    "rate_mps",
    "azimuth_deg",
    "elevation_deg",
    "power_db",
    "snr_db",
    "range_bin",
    "doppler_bin",
    "doppler_fold",
    "fold_probability",
];

/// The table as text: the columns `frame`, `range_m`, `rate_mps`, `azimuth_deg`, `elevation_deg`,
/// `power_db`, `snr_db`, `range_bin`, `doppler_bin`, `doppler_fold`, `fold_probability` (empty where
/// no other fold was tried), and the place `x_m` (forward), `y_m` (left), `z_m` (up).
pub fn write_detections(rows: &[DetectionRow]) -> String {
    let mut text = COLUMNS.join(",");
    text.push_str(",x_m,y_m,z_m\n");
    for row in rows {
        let numbers = [
            row.range_m,
            row.rate_mps,
            row.azimuth_rad.to_degrees(),
            row.elevation_rad.to_degrees(),
            row.power_db,
            row.snr_db,
        ];
        text.push_str(&row.frame.to_string());
        for number in numbers {
            text.push_str(&format!(",{number}"));
        }
        let DetectionRow { x_m, y_m, z_m, .. } = row.placed();
        let probability = row.fold_probability.map(|p| p.to_string()).unwrap_or_default();
        text.push_str(&format!(
            ",{},{},{},{probability},{x_m},{y_m},{z_m}\n",
            row.range_bin, row.doppler_bin, row.doppler_fold
        ));
    }
    text
}

/// Reads a table as [`write_detections`] makes it. Columns may come in any order, and others
/// beside them, such as those of the place; `range_m` and `azimuth_deg` must be there, missing ones are zero.
///
/// # Errors
/// [`FormatError::Table`] naming line and column.
pub fn read_detections(bytes: &[u8]) -> Result<Vec<DetectionRow>, FormatError> {
    let mut reader = csv::Reader::from_reader(bytes);
    let columns = Columns::read(&mut reader)?;
    columns.need("range_m")?;
    columns.need("azimuth_deg")?;
    let places = COLUMNS.map(|name| columns.find(name));
    let mut rows = vec![];
    for record in reader.records() {
        let record = record.map_err(|error| from_csv(&error))?;
        let number = |k: usize| places[k].map_or(Ok(0.0), |at| finite(&record, at, COLUMNS[k]));
        let index = |k: usize| {
            places[k].map_or(Ok(0), |at| field(&record, at, COLUMNS[k], "an integer of at least 0"))
        };
        let fold = match places[9] {
            Some(at) => field(&record, at, COLUMNS[9], "an integer")?,
            None => 0,
        };
        let told = places[10].filter(|&at| record.get(at).is_some_and(|text| !text.is_empty()));
        let row = DetectionRow {
            frame: index(0)?,
            range_m: number(1)?,
            rate_mps: number(2)?,
            azimuth_rad: number(3)?.to_radians(),
            elevation_rad: number(4)?.to_radians(),
            power_db: number(5)?,
            snr_db: number(6)?,
            range_bin: index(7)?,
            doppler_bin: index(8)?,
            doppler_fold: fold,
            fold_probability: told.map(|at| finite(&record, at, COLUMNS[10])).transpose()?,
            ..DetectionRow::default()
        };
        rows.push(row.placed());
    }
    Ok(rows)
}
