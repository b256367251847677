//! Arrays of HDF5 files: datasets of real and complex numbers by name, as h5py and MATLAB (7.3, `save -v7.3`) write them.
//!
//! Complex numbers are compounds of `r` and `i` (h5py) or `real` and `imag` (MATLAB). MATLAB keeps an array in the order of its
//! first index, and HDF5 has its axes backwards: they are turned round again, so that `A(i, j)` of MATLAB is `[i - 1, j - 1]` here.
//! MATLAB drops axes of length 1 at the end, and gives a vector two axes.

mod arrays;
pub(crate) mod guard;
mod matlab;
pub(crate) mod number;

pub use arrays::{ArrayEntry, list, read};

/// Whether a file's name is that of a file read here.
pub fn is_array_file(name: &str) -> bool {
    let name = name.to_ascii_lowercase();
    [".mat", ".h5", ".hdf5"].iter().any(|ending| name.ends_with(ending))
}

#[cfg(test)]
mod tests;
