//! `boresight validate`.

use crate::arguments::ValidateArguments;
use crate::drive;
use crate::error::CliError;
use crate::experiment;
use crate::files::Files;
use boresight_validate::DrivesExperiment;
use boresight_validate::merge::Parts;

/// Runs the methods on all drives, or merges parts of such a run, and returns what is printed.
pub fn run(arguments: &ValidateArguments, files: &Files) -> Result<String, CliError> {
    let run = &arguments.run;
    if let Some(folder) = &arguments.drives {
        let (drives, paths) = drive::drives_in(folder, files)?.into_iter().unzip();
        let pieces_s = arguments.pieces.clone();
        let options = DrivesExperiment { drives, pieces_s, paths, load: Some(drive::load) };
        return experiment::run(&options, run, files);
    }
    arguments.merge.iter().try_for_each(|path| files.check_input(path))?;
    let merged = Parts::read(&arguments.merge)?.put_together::<DrivesExperiment>()?;
    let out = run.out.as_deref().unwrap_or_else(|| std::path::Path::new("."));
    experiment::keep_merged(merged, out, &run.format, files)
}
