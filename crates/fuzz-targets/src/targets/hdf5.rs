//! Arrays of HDF5 and MATLAB, whole files or changes of bundled ones: each has as many numbers as its shape says.

use crate::hdf5_files::{ARRAYS, file_of};
use boresight_formats::hdf5::{list, read};

/// Checks one input.
pub fn check(bytes: &[u8]) {
    let file = file_of(bytes, &ARRAYS);
    for entry in list(file.clone()).unwrap_or_default() {
        if let Ok(array) = read(file.clone(), Some(&entry.name)) {
            assert_eq!(array.shape, entry.shape);
            assert_eq!(array.to_complex64().len(), array.shape.iter().product::<usize>());
        }
    }
}
