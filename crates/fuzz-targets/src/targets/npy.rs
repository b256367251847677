//! Arrays: what is accepted holds as many numbers as its shape says, and comes back when written.

use boresight_formats::{NpyArray, npy};

/// Checks one input.
pub fn check(bytes: &[u8]) {
    if let Ok(array) = NpyArray::parse(bytes) {
        let numbers = array.to_complex64();
        assert_eq!(numbers.len(), array.shape.iter().product::<usize>());
        let Ok(written) = npy::write(&array.shape, &numbers) else { panic!("it fits its shape") };
        let Ok(again) = NpyArray::parse(&written) else { panic!("what is written is read") };
        assert_eq!(again.shape, array.shape);
        let bits = |z: &[_]| {
            z.iter()
                .map(|z: &num_complex::Complex64| (z.re.to_bits(), z.im.to_bits()))
                .collect::<Vec<_>>()
        };
        assert_eq!(bits(&again.to_complex64()), bits(&numbers));
    }
}
