//! Arrays of HDF5 and MATLAB: each has as many numbers as its shape says.

#![no_main]

use boresight_formats::hdf5::{list, read};
use libfuzzer_sys::fuzz_target;

fuzz_target!(|bytes: &[u8]| {
    for entry in list(bytes.to_vec()).unwrap_or_default() {
        if let Ok(array) = read(bytes.to_vec(), Some(&entry.name)) {
            assert_eq!(array.shape, entry.shape);
            assert_eq!(array.to_complex64().len(), array.shape.iter().product::<usize>());
        }
    }
});
