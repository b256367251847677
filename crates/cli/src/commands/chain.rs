//! From arguments to the chain, and from its results to a table.

use crate::arguments::EstimateArguments;
use crate::commands::explain::explain;
use crate::commands::frame::frame_within;
use crate::error::CliError;
use crate::output::{Column, Table, remark};
use crate::run::Run;
use boresight_math::decibels::power_to_db;
use boresight_pipeline::{Chain, ChainOptions, Detection, FrameResult, FrameSource};

/// Options of the chain, on all processor cores.
pub fn chain_options(arguments: &EstimateArguments) -> ChainOptions {
    ChainOptions {
        angle: arguments.angle.flags.options,
        threads: std::thread::available_parallelism().map_or(1, usize::from),
        ..arguments.chain.options
    }
}

/// Runs the chain over the frames asked for and returns what is printed.
pub fn detections<S: FrameSource>(
    arguments: &EstimateArguments,
    chain: &mut Chain,
    source: &S,
) -> Result<String, CliError>
where
    CliError: From<S::Error>,
{
    if let Some(bins) = &arguments.explain {
        return explain(arguments, bins, chain, source);
    }
    let frames = source.frames();
    let single = chain.options().angle.method.requirements().max_snapshots == Some(1);
    let run = Run::start("frames")?;
    let mut results = vec![];
    let report = &mut |progress| run.report(progress);
    match arguments.frame {
        Some(frame) => {
            let frame = frame_within(frame, frames)?;
            chain.each(source, frame..frame + 1, |r| results.push(r), report)?;
        }
        None if arguments.each || (single && !arguments.all) => {
            chain.each(source, 0..frames, |result| results.push(without_maps(result)), report)?;
        }
        None => results.push(chain.combine(source, 0..frames, report)?),
    }
    run.finish();
    remark(remarks(&results));
    table(results.iter().flat_map(|result| &result.detections)).render(&arguments.output)
}

/// A result without its map, of which there may be many.
fn without_maps(mut result: FrameResult) -> FrameResult {
    result.range_doppler_db = ndarray::Array2::zeros((0, 0));
    result
}

fn remarks(results: &[FrameResult]) -> Vec<String> {
    let sum = |count: fn(&FrameResult) -> usize| results.iter().map(count).sum::<usize>();
    let mut lines = vec![format!(
        "frames: {}; cells over the threshold: {}, of which grouped under a stronger neighbour: {}",
        sum(|r| r.frames),
        sum(|r| r.counts.cells_over_threshold),
        sum(|r| r.counts.grouped),
    )];
    for (count, what) in [
        (sum(|r| r.counts.other_bands), "echoes in other Doppler bands"),
        (sum(|r| r.counts.outside_usable_range), "outside the usable range"),
        (sum(|r| r.counts.outside_region), "outside the limits"),
        (sum(|r| r.counts.beyond_limit), "beyond the most to report"),
        (sum(|r| r.counts.clipped_samples), "samples clipped by the converter"),
    ] {
        if count > 0 {
            lines.push(format!("{what}: {count}"));
        }
    }
    let mut seen: Vec<&str> = vec![];
    for warning in results.iter().flat_map(|result| &result.warnings) {
        if !seen.contains(&warning.code) {
            seen.push(warning.code);
            lines.push(warning.message.clone());
        }
    }
    lines
}

/// The table of detections, as [`boresight_formats::tables::write_detections`] names its columns.
fn table<'a>(detections: impl Iterator<Item = &'a Detection>) -> Table {
    let column = |json, csv, digits| Column { json, csv, digits };
    Table {
        columns: vec![
            column("frame", "frame", 0),
            column("rangeM", "range_m", 3),
            column("rateMps", "rate_mps", 2),
            column("azimuthDeg", "azimuth_deg", 2),
            column("elevationDeg", "elevation_deg", 2),
            column("powerDb", "power_db", 1),
            column("snrDb", "snr_db", 1),
            column("rangeBin", "range_bin", 0),
            column("dopplerBin", "doppler_bin", 0),
            column("xM", "x_m", 3),
            column("yM", "y_m", 3),
            column("zM", "z_m", 3),
            column("dopplerFold", "doppler_fold", 0),
            column("foldProbability", "fold_probability", 3),
        ],
        rows: detections
            .map(|d| {
                vec![
                    d.frame as f64,
                    d.range_m,
                    d.rate_mps,
                    d.azimuth_rad.to_degrees(),
                    d.elevation_rad.to_degrees(),
                    power_to_db(d.power),
                    power_to_db(d.snr),
                    d.range_bin as f64,
                    d.doppler_bin as f64,
                    d.x_m,
                    d.y_m,
                    d.z_m,
                    d.doppler_fold.into(),
                    d.fold_probability.unwrap_or(f64::NAN),
                ]
            })
            .collect(),
        empty: "no detections",
    }
}
