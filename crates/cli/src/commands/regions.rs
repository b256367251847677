//! `boresight regions`.

use super::capture::Radar;
use super::frame::frame_within;
use super::{capture, cube};
use crate::arguments::RegionsArguments;
use crate::error::CliError;
use crate::files::{self, Files};
use crate::network;
use crate::numbers;
use crate::output::{Column, Table, remark};
use crate::run::Run;
use boresight_formats::json;
use boresight_math::decibels::power_to_db;
use boresight_neural::{NeuralError, RegionNetworks};
use boresight_pipeline::regions::RegionFrame;
use boresight_pipeline::{CubeFrames, FrameSource, RegionChain};
use serde_json::Value;

/// Runs the command and returns what it prints.
pub fn run(arguments: &RegionsArguments, files: &Files) -> Result<String, CliError> {
    let path = &arguments.file;
    match files::ending(path).as_str() {
        ending if ending == "bin" || path.is_dir() => {
            let (samples, radar) = capture::open(&arguments.radar, path, files)?;
            print(arguments, &radar, &samples.frames()?, files)
        }
        ending if numbers::ENDINGS.contains(&ending) => {
            let file = numbers::read(path, arguments.radar.dataset.as_deref(), files)?;
            let (cube, radar) = cube::open(&arguments.radar, &file, files)?;
            print(arguments, &radar, &CubeFrames(cube.view()), files)
        }
        other => Err(CliError::Option {
            option: "FILE",
            expected: "a file ending in .bin, .npy, .mat or .h5".into(),
            given: if other.is_empty() { "no ending".into() } else { format!(".{other}") },
        }),
    }
}

fn print<S: FrameSource>(
    arguments: &RegionsArguments,
    radar: &Radar,
    source: &S,
    files: &Files,
) -> Result<String, CliError>
where
    CliError: From<S::Error>,
{
    let count = source.frames();
    let frames = match arguments.frame {
        Some(frame) => {
            let frame = frame_within(frame, count)?;
            frame..frame + 1
        }
        None => 0..count,
    };
    let mut chain = chain(arguments, radar, files)?;
    let run = Run::start("frames")?;
    let mut results: Vec<RegionFrame> = vec![];
    chain.each(source, frames, |result| results.push(result), &mut |at| run.report(at))?;
    run.finish();
    remark(remarks(&results));
    if arguments.output.json {
        let results: Vec<Value> = results.iter().map(json::result).collect();
        return Ok(format!("{:#}\n", Value::Array(results)));
    }
    table(&results).render(&arguments.output)
}

fn chain(
    arguments: &RegionsArguments,
    radar: &Radar,
    files: &Files,
) -> Result<RegionChain, CliError> {
    let options = &arguments.chain.options;
    let RegionsArguments { counting: Some(counting), one: Some(one), two: Some(two), .. } =
        arguments
    else {
        return Ok(RegionChain::joint(&radar.waveform, radar.receivers, &radar.array, options)?);
    };
    let load = |path| network::load(path, None, files);
    let models = [load(counting)?, load(one)?, load(two)?];
    let networks = RegionNetworks { counting: &models[0], one: &models[1], two: &models[2] };
    let counted = networks.counted(&radar.array, options.refine).map_err(|error| {
        let path = match error {
            NeuralError::WrongKind { expected: "counting", .. } => counting,
            NeuralError::WrongKind { expected: "dnn" | "cnn3d", .. }
            | NeuralError::Targets { expected: 2, .. } => two,
            _ => one,
        };
        network::wrong(path, error)
    })?;
    Ok(RegionChain::new(&radar.waveform, radar.receivers, options, counted)?)
}

fn remarks(results: &[RegionFrame]) -> Vec<String> {
    let sum = |count: fn(&RegionFrame) -> usize| results.iter().map(count).sum::<usize>();
    let mut lines = vec![format!(
        "frames: {}; range bins over the threshold: {}, of which grouped under a stronger neighbour: {}; \
         regions: {}",
        results.len(),
        sum(|r| r.counts.cells_over_threshold),
        sum(|r| r.counts.grouped),
        sum(|r| r.regions.len()),
    )];
    for (count, what) in [
        (sum(|r| r.counts.joined), "further peaks within regions"),
        (sum(|r| r.counts.without_target), "regions in which no target was counted"),
        (sum(|r| r.counts.outside_region), "peaks and targets outside the limits"),
        (sum(|r| r.counts.beyond_limit), "regions beyond the most to report"),
        (sum(|r| r.counts.beyond_horizon), "targets beyond 90 deg"),
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

/// One row a target.
fn table(results: &[RegionFrame]) -> Table {
    let column = |json, csv, digits| Column { json, csv, digits };
    let mut rows = vec![];
    for result in results {
        for (number, region) in result.regions.iter().enumerate() {
            rows.extend(region.targets.iter().map(|target| {
                vec![
                    result.frame as f64,
                    number as f64,
                    region.range_bin as f64,
                    region.sources as f64,
                    region.coarse_azimuth_rad.to_degrees(),
                    target.range_m,
                    region.rate_mps,
                    target.azimuth_rad.to_degrees(),
                    target.confidence.unwrap_or(f64::NAN),
                    power_to_db(target.power),
                    power_to_db(region.snr),
                    target.range_deviation_m.unwrap_or(f64::NAN),
                    target.azimuth_deviation_rad.map_or(f64::NAN, f64::to_degrees),
                ]
            }));
        }
    }
    Table {
        columns: vec![
            column("frame", "frame", 0),
            column("region", "region", 0),
            column("rangeBin", "range_bin", 0),
            column("sources", "sources", 0),
            column("coarseAzimuthDeg", "coarse_azimuth_deg", 2),
            column("rangeM", "range_m", 3),
            column("rateMps", "rate_mps", 2),
            column("azimuthDeg", "azimuth_deg", 2),
            column("confidence", "confidence", 3),
            column("powerDb", "power_db", 1),
            column("snrDb", "snr_db", 1),
            column("rangeDeviationM", "range_deviation_m", 3),
            column("azimuthDeviationDeg", "azimuth_deviation_deg", 3),
        ],
        rows,
        empty: "no targets",
    }
}
