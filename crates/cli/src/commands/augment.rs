//! `boresight augment`.

use super::{capture, cube};
use crate::arguments::AugmentArguments;
use crate::error::CliError;
use crate::files::{self, Files, radar_config};
use crate::numbers;
use crate::run::Run;
use crate::terminal::name;
use boresight_core::Progress;
use boresight_core::{Complex32, Waveform};
use boresight_formats::json;
use boresight_formats::npy::{Element, preamble};
use boresight_pipeline::{CubeFrames, FrameSource, PipelineError};
use boresight_signal::{ShiftedFrame, shift_range};
use serde_json::json;

/// Runs the command and returns what it prints.
pub fn run(arguments: &AugmentArguments, files: &Files) -> Result<String, CliError> {
    let config = arguments.config.as_deref();
    match files::ending(&arguments.file).as_str() {
        ending if ending == "bin" || arguments.file.is_dir() => {
            let reading = &arguments.reading.options;
            let samples = capture::Samples::read(&arguments.file, config, None, reading, files)?;
            write(arguments, &samples.config.waveform, &samples.frames()?, files)
        }
        ending if numbers::ENDINGS.contains(&ending) => {
            let waveform = match config {
                Some(path) => radar_config(path, files)?.waveform,
                None => cube::named_waveform(arguments.waveform.as_deref(), files)?,
            };
            let dataset = arguments.dataset.as_deref();
            let cube = cube::read(&numbers::read(&arguments.file, dataset, files)?)?;
            write(arguments, &waveform, &CubeFrames(cube.view()), files)
        }
        other => Err(CliError::Option {
            option: "FILE",
            expected: "a file ending in .bin, .npy, .mat or .h5".into(),
            given: if other.is_empty() { "no ending".into() } else { format!(".{other}") },
        }),
    }
}

/// Writes the new frames one by one, then what they were made from.
fn write<S: FrameSource>(
    arguments: &AugmentArguments,
    waveform: &Waveform,
    source: &S,
    files: &Files,
) -> Result<String, CliError>
where
    CliError: From<S::Error>,
{
    let drawn: Vec<ShiftedFrame> = arguments.flags.options.draw(source.frames())?.collect();
    let data = files.destination(&arguments.out)?;
    let beside = || data.file().map(|_| arguments.out.with_extension("json"));
    let shifts = arguments.shifts.clone().or_else(beside);
    let shifts = shifts.map(|path| files.destination(&path)).transpose()?;
    let mut said = String::new();
    let named = data.named().to_owned();
    let failed = |error| CliError::File { action: "write", path: named.clone(), error };
    let run = Run::start("frames")?;
    files.write_with(data, |out| {
        for (done, shifted) in drawn.iter().enumerate() {
            let mut frame = source.frame(shifted.frame)?.samples;
            shift_range(frame.view_mut(), waveform, shifted.shift_m)?;
            if done == 0 {
                let shape: Vec<usize> =
                    std::iter::once(drawn.len()).chain(frame.shape().iter().copied()).collect();
                out.write_all(&preamble::<Complex32>(&shape)?).map_err(failed)?;
                said = format!("{}: complex numbers of shape {shape:?}\n", name(&named));
            }
            let mut bytes = Vec::with_capacity(frame.len() * 8);
            frame.iter().for_each(|sample| sample.put(&mut bytes));
            out.write_all(&bytes).map_err(failed)?;
            if run.report(Progress { done: done + 1, total: drawn.len() }).is_break() {
                let total = drawn.len();
                return Err(PipelineError::Cancelled { done: done + 1, total }.into());
            }
        }
        Ok(())
    })?;
    run.finish();
    if let Some(destination) = shifts {
        said += &format!("{}: what they were made from\n", name(destination.named()));
        let told = json!({ "waveform": waveform, "frames": json::result(&drawn) });
        files.write(destination, format!("{told:#}\n").as_bytes())?;
    }
    Ok(said)
}
