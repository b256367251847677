//! What `validate` takes.

use crate::experiment::RunArguments;
use clap::Args;
use std::path::PathBuf;

/// Arguments of `validate`.
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  Errors and standard deviations of all methods on the drives in a folder, whole and in pieces of 25 s and 60 s:
    boresight validate drives --pieces 25,60 --out results
  The same on two machines, then put together:
    boresight validate drives --out first --part 1/2
    boresight validate drives --out second --part 2/2
    boresight validate --merge first --merge second --out results")]
pub struct ValidateArguments {
    /// Folder with a folder for each drive, such as a data set of RadarScenes. The mounting angles that the logs state are
    /// taken as true.
    #[arg(value_name = "DIR", required_unless_present = "merge")]
    pub drives: Option<PathBuf>,
    /// Lengths of the pieces that the drives are cut into, s.
    #[arg(long, value_name = "S,...", value_delimiter = ',', default_values_t = [25.0, 60.0, 120.0])]
    pub pieces: Vec<f64>,
    /// Merge the records of all parts of a run: files of records (.jsonl) or folders with such files; repeatable.
    #[arg(long, value_name = "DIR", requires = "out", conflicts_with_all = ["drives", "pieces", "part", "threads"])]
    pub merge: Vec<PathBuf>,
    /// How it runs.
    #[command(flatten)]
    pub run: RunArguments,
}
