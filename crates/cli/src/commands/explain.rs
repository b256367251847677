//! Why a cell is a detection, or is none.

use crate::arguments::EstimateArguments;
use crate::commands::frame::frame_within;
use crate::error::CliError;
use crate::run::Run;
use boresight_options::decibels::finite_db;
use boresight_pipeline::{CellExplanation, Chain, FrameSource};
use serde_json::json;

/// What `estimate --explain` prints of the cell `bins`.
pub fn explain<S: FrameSource>(
    arguments: &EstimateArguments,
    bins: &[usize],
    chain: &mut Chain,
    source: &S,
) -> Result<String, CliError>
where
    CliError: From<S::Error>,
{
    let &[range_bin, doppler_bin] = bins else {
        return Err(CliError::Option {
            option: "--explain",
            expected: "a range bin and a Doppler bin with a comma between".into(),
            given: format!("{} numbers", bins.len()),
        });
    };
    let frames = match arguments.frame {
        Some(frame) => {
            let frame = frame_within(frame, source.frames())?;
            frame..frame + 1
        }
        None => 0..source.frames(),
    };
    let run = Run::start("frames")?;
    let told = chain
        .explain(source, frames, [range_bin, doppler_bin], &mut |progress| run.report(progress))?;
    run.finish();
    let range_m = chain.range_m()[told.range_bin];
    let rate_mps = chain.rate_mps()[told.doppler_bin];
    if arguments.output.json {
        return Ok(format!("{:#}\n", as_json(&told)));
    }
    Ok(format!(
        "cell {range_bin}, {doppler_bin} ({range_m:.3} m, {rate_mps:.2} m/s): {:.1} dBFS, threshold {:.1} dBFS\n{}\n",
        finite_db(told.power),
        finite_db(told.threshold),
        told.message
    ))
}

fn as_json(told: &CellExplanation) -> serde_json::Value {
    json!({
        "rangeBin": told.range_bin,
        "dopplerBin": told.doppler_bin,
        "verdict": told.verdict,
        "message": told.message,
        "powerDb": finite_db(told.power),
        "noiseDb": finite_db(told.noise_power),
        "thresholdDb": finite_db(told.threshold),
        "trainingCells": told.training_cells,
        "excisedCells": told.excised_cells,
        "peakRangeBin": told.peak_range_bin,
        "peakDopplerBin": told.peak_doppler_bin,
        "profileThresholdDb": told.profile_threshold.iter().copied().map(finite_db).collect::<Vec<_>>(),
    })
}
