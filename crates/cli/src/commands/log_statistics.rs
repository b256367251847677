//! `boresight log --statistics`: what the radars of a log are like.

use crate::error::CliError;
use boresight_core::drive::DriveLog;
use boresight_formats::json;
use boresight_mounting::CalibrationOptions;
use boresight_mounting::statistics::{SensorStatistics, log_statistics};

/// A row of the table: its name with its unit, its digits after the point, and its number.
type Row = (&'static str, usize, fn(&SensorStatistics) -> f64);

const ROWS: [Row; 26] = [
    ("scans", 0, |s| s.counts.scans as f64),
    ("cycle, ms", 2, |s| 1e3 * s.counts.cycle_s),
    ("  jitter, ms", 2, |s| 1e3 * s.counts.cycle_jitter_s),
    ("  lost, %", 2, |s| 100.0 * s.counts.lost_share),
    ("detections a scan, mean", 1, |s| s.counts.mean_count),
    ("  5 %", 0, |s| s.counts.count_range[0]),
    ("  95 %", 0, |s| s.counts.count_range[1]),
    ("  most", 0, |s| s.counts.most),
    ("azimuth, least, deg", 1, |s| s.counts.azimuth_span_rad[0].to_degrees()),
    ("  greatest, deg", 1, |s| s.counts.azimuth_span_rad[1].to_degrees()),
    ("labelled moving, %", 2, |s| 100.0 * s.counts.moving_share),
    ("static and over 1 m/s off, %", 2, |s| 100.0 * s.noise.outlier_share),
    ("static and 0.3 to 1 m/s off, %", 2, |s| 100.0 * s.noise.soft_outlier_share),
    ("range rate sigma, m/s", 3, |s| s.noise.range_rate_sigma_mps),
    ("azimuth sigma at 0, deg", 3, |s| s.noise.azimuth_sigma_rad[0].to_degrees()),
    ("  at 30, deg", 3, |s| s.noise.azimuth_sigma_rad[1].to_degrees()),
    ("  at 50, deg", 3, |s| s.noise.azimuth_sigma_rad[2].to_degrees()),
    ("  at 65, deg", 3, |s| s.noise.azimuth_sigma_rad[3].to_degrees()),
    ("angle of a scan less nominal, deg", 3, |s| s.angles.offset_rad.to_degrees()),
    ("  scatter, deg", 3, |s| s.angles.scatter_rad.to_degrees()),
    ("  by equation 3, deg", 3, |s| s.angles.formal_rad.to_degrees()),
    ("  scatter over equation 3", 2, |s| s.angles.scatter_over_formal),
    ("  autocorrelation after 1 s", 2, |s| s.angles.autocorrelation),
    ("slip gradient, rad/(m/s^2)", 4, |s| s.angles.slip_gradient_rad),
    ("delay of range rates, ms", 0, |s| 1e3 * s.angles.delay_s),
    ("speed of log over radar's", 4, |s| s.speed_ratio),
];

/// The statistics as a table of text, a column a radar, or as JSON.
pub fn run(log: &DriveLog, as_json: bool) -> Result<String, CliError> {
    let all = log_statistics(log, CalibrationOptions::default().max_gap_s)?;
    if as_json {
        return Ok(format!("{:#}\n", json::result(&all)));
    }
    let mut text = format!("{:<34}", "sensor");
    for one in &all {
        text += &format!("{:>9}", one.sensor);
    }
    text += "\n";
    for (name, digits, number) in ROWS {
        text += &format!("{name:<34}");
        for one in &all {
            let number = number(one);
            let shown =
                if number.is_finite() { format!("{number:.digits$}") } else { "-".to_owned() };
            text += &format!("{shown:>9}");
        }
        text += "\n";
    }
    for one in &all {
        for untold in &one.untold {
            text += &format!("sensor {}: no {}: {}\n", one.sensor, untold.row, untold.why);
        }
    }
    Ok(text)
}
