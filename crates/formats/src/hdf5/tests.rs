use super::*;
use crate::npy::{NpyArray, NpyData};
use boresight_core::{Complex32, Complex64};
use proptest::prelude::*;
use std::path::PathBuf;

/// Files of tests/golden/hdf5/make.py, written by h5py.
fn golden(name: &str) -> Vec<u8> {
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/../../tests/golden/hdf5");
    std::fs::read(PathBuf::from(folder).join(name)).unwrap()
}

/// 1000 i + 100 j + 10 k + l, of indices from 1.
fn index(place: &[usize]) -> f64 {
    place.iter().fold(0.0, |sum, i| 10.0 * sum + (i + 1) as f64)
}

#[test]
fn variables_of_matlab_have_its_axes() {
    let bytes = golden("matlab.mat");
    let entries = list(bytes.clone()).unwrap();
    let listed: Vec<_> =
        entries.iter().map(|e| (e.name.as_str(), &e.shape[..], e.complex)).collect();
    assert_eq!(
        listed,
        [
            ("X", &[3, 2][..], true),
            ("counts", &[1, 3], false),
            ("cube", &[2, 3, 4, 2], false),
            ("single", &[1, 2], true),
            ("board/gain", &[1, 2], false),
        ]
    );
    let x = super::read(bytes.clone(), Some("X")).unwrap();
    let expected: Vec<Complex64> = (0..3)
        .flat_map(|i| (0..2).map(move |j| Complex64::new(index(&[i, j]), index(&[i, j]) + 0.5)))
        .collect();
    assert_eq!(x, NpyArray { shape: vec![3, 2], data: NpyData::Complex64(expected) });
    let cube = super::read(bytes.clone(), Some("/cube")).unwrap();
    let NpyData::Float64(numbers) = cube.data else { panic!() };
    for (n, number) in numbers.iter().enumerate() {
        assert_eq!(*number, index(&[n / 24, n / 8 % 3, n / 2 % 4, n % 2]));
    }
    let single = super::read(bytes.clone(), Some("single")).unwrap();
    let parts = [Complex32::new(11.0, -0.25), Complex32::new(12.0, -0.25)];
    assert_eq!(single.data, NpyData::Complex32(parts.into()));
    assert_eq!(
        super::read(bytes.clone(), Some("counts")).unwrap().data,
        NpyData::Integer(vec![-3, 0, 7])
    );
    let gain = super::read(bytes.clone(), Some("board/gain")).unwrap();
    assert_eq!(gain.to_f64().unwrap(), [1.5, 2.5]);
    for name in [None, Some("name"), Some("nothing"), Some("x")] {
        let error = super::read(bytes.clone(), name).unwrap_err().to_string();
        assert!(error.contains("X [3, 2], counts [1, 3], cube [2, 3, 4, 2]"), "{error}");
    }
}

#[test]
fn arrays_of_h5py_are_as_they_stand() {
    let one = super::read(golden("one.h5"), None).unwrap();
    assert_eq!(one.shape, [3, 2]);
    assert_eq!(one.to_complex32()[3], Complex32::new(22.0, 22.5));
    let several = |name| super::read(golden("several.h5"), Some(name));
    let big = several("big").unwrap();
    assert_eq!(
        big,
        NpyArray {
            shape: vec![3, 2],
            data: NpyData::Float32(vec![11.0, 12.0, 21.0, 22.0, 31.0, 32.0])
        }
    );
    assert_eq!(several("whole").unwrap().data, NpyData::Integer(vec![i64::MAX, 0]));
    assert_eq!(
        several("number").unwrap(),
        NpyArray { shape: vec![], data: NpyData::Float64(vec![4.5]) }
    );
    assert!(several("beyond").unwrap_err().to_string().contains("below 2^63"));
}

#[test]
fn other_files_are_refused_with_what_to_do() {
    let old = [&b"MATLAB 5.0 MAT-file, Platform: GLNXA64"[..], &[0; 200]].concat();
    let error = list(old).unwrap_err().to_string();
    assert!(error.contains("save it with '-v7.3'"), "{error}");
    assert!(list(b"no HDF5".to_vec()).is_err());
    assert!(list(vec![]).is_err());
    let tables =
        concat!(env!("CARGO_MANIFEST_DIR"), "/../../tests/golden/radarscenes/contiguous.h5");
    let none = std::fs::read(tables).unwrap();
    assert!(
        super::read(none, None).unwrap_err().to_string().contains("a dataset of real or complex")
    );
}

#[test]
fn cut_files_are_refused_or_whole() {
    for name in ["matlab.mat", "one.h5"] {
        let whole = golden(name);
        let x = |bytes: Vec<u8>| super::read(bytes, (name == "matlab.mat").then_some("X"));
        let expected = x(whole.clone()).unwrap();
        for length in (0..whole.len()).step_by(97) {
            if let Ok(array) = x(whole[..length].to_vec()) {
                assert_eq!(array, expected, "{length}");
            }
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 64, ..ProptestConfig::default() })]

    #[test]
    fn changed_bytes_never_panic(at in 0..20_000_usize, byte in any::<u8>(), second in 0..20_000_usize) {
        for name in ["matlab.mat", "several.h5"] {
            let mut bytes = golden(name);
            let length = bytes.len();
            bytes[at % length] = byte;
            bytes[second % length] ^= byte;
            if let Ok(entries) = list(bytes.clone()) {
                for entry in entries {
                    let _ = super::read(bytes.clone(), Some(&entry.name));
                }
            }
        }
    }
}
