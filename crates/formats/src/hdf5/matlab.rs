//! What MATLAB says of its files.

use crate::error::FormatError;
use hdf5_pure::Dataset;

/// Refuses the files of earlier versions, which are no HDF5.
pub(super) fn refuse_earlier(bytes: &[u8]) -> Result<(), FormatError> {
    if bytes.starts_with(b"MATLAB 5.0 MAT-file") {
        let (what, expected) = ("the file", "MATLAB 7.3: save it with '-v7.3'");
        return Err(super::number::wrong(what, expected, "a file of MATLAB 5 to 7"));
    }
    Ok(())
}

/// Whether a dataset is a variable of MATLAB's, so that its axes stand backwards, and whether it holds numbers.
pub(super) fn variable(dataset: &Dataset) -> (bool, bool) {
    let attributes = dataset.attrs().unwrap_or_default();
    let class = attributes.get("MATLAB_class").map(|class| format!("{class:?}"));
    let holds = |word: &str| class.as_ref().is_some_and(|class| class.contains(word));
    let other = ["char", "cell", "struct", "function_handle"].into_iter().any(holds);
    (class.is_some(), !(other || attributes.contains_key("MATLAB_empty")))
}
