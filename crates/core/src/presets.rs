//! Arrays of known radars.

use crate::array::{Array, Position};
use boresight_math::error::{InputError, check_range};
use boresight_math::order::descending;

/// Names [`preset`] knows, beside `ula<N>`.
pub const PRESETS: [&str; 7] =
    ["awr1642", "awr1843", "iwr6843isk", "iwr6843aop", "iwr6843ods", "cascade86", "lrr48"];

/// A named array: one of [`PRESETS`], or `ulaN` for N half-wavelength elements (`ula8`).
///
/// # Errors
/// [`InputError::Unknown`] for any other name; [`InputError::OutOfRange`] or [`InputError::Empty`]
/// for an N that makes no array.
pub fn preset(name: &str) -> Result<Array, InputError> {
    match name {
        "awr1642" => awr1642(),
        "awr1843" | "iwr6843isk" => awr1843(),
        "iwr6843aop" => iwr6843aop(),
        "iwr6843ods" => iwr6843ods(),
        "cascade86" => cascade86(),
        "lrr48" => lrr48(),
        _ => match name.strip_prefix("ula").and_then(|digits| digits.parse().ok()) {
            Some(elements) => Array::ula(elements),
            None => Err(InputError::Unknown {
                what: "array preset".into(),
                expected: format!("{}, ulaN (such as ula8)", PRESETS.join(", ")),
                given: name.into(),
            }),
        },
    }
}

/// Texas Instruments AWR1642BOOST: 2 transmitters and 4 receivers, 8 virtual elements in azimuth.
/// The element index rises toward the board's right, so toward -y.
fn awr1642() -> Result<Array, InputError> {
    Array::mimo(&along_y(&[0.0, -4.0]), &along_y(&[0.0, -1.0, -2.0, -3.0]))
}

/// Texas Instruments AWR1843BOOST: 3 transmitters and 4 receivers, 8 virtual elements in azimuth
/// and 4 elevated by half a wavelength above the middle of them. Transmitters in the order of
/// their numbers on the chip, the second being the elevated one.
///
/// IWR6843ISK and AWR6843ISK have the same layout at 60 GHz: `antGeometry0 0 -1 -2 -3 -2 -3 -4 -5 -4 -5 -6 -7` and
/// `antGeometry1 -1 -1 -1 -1 0 0 0 0 -1 -1 -1 -1` in the configurations of Texas Instruments' 3D People Tracking. Not
/// verified on a 6843 board.
fn awr1843() -> Result<Array, InputError> {
    let tx = [[0.0, 0.0, 0.0], [0.0, -2.0, 1.0], [0.0, -4.0, 0.0]];
    Array::mimo(&tx, &along_y(&[0.0, -1.0, -2.0, -3.0]))
}

/// Texas Instruments IWR6843AOP and AWR6843AOP, antennas on the package: 3 transmitters and 4 receivers, 12 virtual
/// elements in a block of 2 x 2 and one of 4 x 2 below it; two receivers are turned. After
/// `antGeometry0 -1 -1 0 0 -3 -3 -2 -2 -1 -1 0 0`, `antGeometry1 -1 0 -1 0 -3 -2 -3 -2 -3 -2 -3 -2` and
/// `antPhaseRot 1 -1 1 -1 ...` in the configurations of 3D People Tracking. Not verified on a board.
fn iwr6843aop() -> Result<Array, InputError> {
    let tx = [[0.0, 0.0, 0.0], [0.0, -2.0, -2.0], [0.0, 0.0, -2.0]];
    let rx = [[0.0, 0.0, 0.0], [0.0, 0.0, 1.0], [0.0, 1.0, 0.0], [0.0, 1.0, 1.0]];
    Array::mimo(&tx, &rx)?.with_inverted(&[false; 3], &[false, true, false, true])
}

/// Texas Instruments IWR6843ISK-ODS: 3 transmitters and 4 receivers, 12 virtual elements in blocks of 2 x 2 at three
/// corners of a square of 4 x 4; two receivers are turned. After `antGeometry0 0 0 -1 -1 -2 -2 -3 -3 -2 -2 -3 -3`,
/// `antGeometry1 0 -1 -1 0 0 -1 -1 0 -2 -3 -3 -2` and `antPhaseRot 1 -1 -1 1 ...` in the configurations of Overhead 3D
/// People Counting. Not verified on a board.
fn iwr6843ods() -> Result<Array, InputError> {
    let tx = [[0.0, 0.0, 0.0], [0.0, -2.0, 0.0], [0.0, -2.0, -2.0]];
    let rx = [[0.0, 0.0, 0.0], [0.0, 0.0, -1.0], [0.0, -1.0, -1.0], [0.0, -1.0, 0.0]];
    Array::mimo(&tx, &rx)?.with_inverted(&[false; 3], &[false, true, true, false])
}

/// Azimuth array of Texas Instruments' four-chip cascade board: 9 transmitters and 16 receivers in
/// one row, 86 distinct virtual elements without a gap.
fn cascade86() -> Result<Array, InputError> {
    cascade_row(
        &[11, 10, 9, 8, 7, 6, 5, 4, 3],
        &[12, 13, 14, 15, 0, 1, 2, 3, 8, 9, 10, 11, 4, 5, 6, 7],
    )
}

/// Azimuths and elevations of the transmitters of Texas Instruments' four-chip cascade board by their numbers, three a
/// chip: master, slave 1, slave 2, slave 3.
const CASCADE_TX: [[f64; 2]; 12] = [
    [11.0, 6.0],
    [10.0, 4.0],
    [9.0, 1.0],
    [32.0, 0.0],
    [28.0, 0.0],
    [24.0, 0.0],
    [20.0, 0.0],
    [16.0, 0.0],
    [12.0, 0.0],
    [8.0, 0.0],
    [4.0, 0.0],
    [0.0, 0.0],
];

/// Azimuths of its receivers by their numbers, four a chip.
const CASCADE_RX: [f64; 16] =
    [11.0, 12.0, 13.0, 14.0, 50.0, 51.0, 52.0, 53.0, 46.0, 47.0, 48.0, 49.0, 0.0, 1.0, 2.0, 3.0];

/// The elements of Texas Instruments' four-chip cascade board in its row, for transmitters in their order of
/// transmission and receivers in theirs: channels of elevated transmitters are left out, and those at a place that an
/// earlier one has. Of all of the row's transmitters it is `cascade86`.
///
/// # Errors
/// [`InputError::OutOfRange`] for a transmitter above 11 or a receiver above 15; [`InputError::Empty`] where no transmitter
/// is in the row.
pub fn cascade_row(transmitters: &[usize], receivers: &[usize]) -> Result<Array, InputError> {
    let within = |what, numbers: &[usize], most: usize| {
        numbers.iter().try_for_each(|&n| check_range(what, n as f64, 0.0, most as f64))
    };
    within("transmitter", transmitters, CASCADE_TX.len() - 1)?;
    within("receiver", receivers, CASCADE_RX.len() - 1)?;
    let tx: Vec<Position> =
        transmitters.iter().map(|&n| [0.0, -CASCADE_TX[n][0], CASCADE_TX[n][1]]).collect();
    let rx: Vec<Position> = receivers.iter().map(|&n| [0.0, -CASCADE_RX[n], 0.0]).collect();
    let all = Array::mimo(&tx, &rx)?;
    let in_row: Vec<usize> = (0..all.len()).filter(|&k| all.positions()[k][2] == 0.0).collect();
    let array = all.select(&in_row)?.without_duplicates();
    array.select(&descending(array.positions().iter().map(|position| position[1])))
}

/// A sparse long-range array of 6 transmitters and 8 receivers: 48 distinct virtual elements over
/// 92 half wavelengths, peak sidelobe -14.5 dB. The radar of the AAETR paper has as many of each;
/// their positions are unpublished.
fn lrr48() -> Result<Array, InputError> {
    Array::mimo(
        &along_y(&[0.0, 18.0, 30.0, 42.0, 62.0, 78.0]),
        &along_y(&[0.0, 3.0, 4.0, 5.0, 7.0, 8.0, 13.0, 14.0]),
    )
}

fn along_y(ys: &[f64]) -> Vec<Position> {
    ys.iter().map(|&y| [0.0, y, 0.0]).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::array::Extent;

    #[test]
    fn presets_have_the_elements_they_promise() {
        for (name, elements, extent) in [
            ("awr1642", 8, Extent::Azimuth),
            ("awr1843", 12, Extent::Area),
            ("iwr6843isk", 12, Extent::Area),
            ("iwr6843aop", 12, Extent::Area),
            ("iwr6843ods", 12, Extent::Area),
            ("cascade86", 86, Extent::Azimuth),
            ("lrr48", 48, Extent::Azimuth),
            ("ula10", 10, Extent::Azimuth),
        ] {
            let array = preset(name).unwrap();
            assert_eq!((array.len(), array.extent()), (elements, extent), "{name}");
            assert_eq!(array.without_duplicates().len(), elements, "{name}");
        }
        assert!(preset("cascade86").unwrap().is_uniform());
        assert!(preset("awr1642").unwrap().is_uniform());
        assert_eq!(preset("lrr48").unwrap().aperture(), 92.0);
    }

    /// Position of each element along y and z, and its sign, as Texas Instruments' configurations have them for
    /// transmitter 1 with all receivers, then 2 and 3.
    #[test]
    fn boards_with_elevation_stand_as_their_makers_configurations_say() {
        let isk = (
            [0, -1, -2, -3, -2, -3, -4, -5, -4, -5, -6, -7],
            [-1, -1, -1, -1, 0, 0, 0, 0, -1, -1, -1, -1],
            [1; 12],
        );
        let aop = (
            [-1, -1, 0, 0, -3, -3, -2, -2, -1, -1, 0, 0],
            [-1, 0, -1, 0, -3, -2, -3, -2, -3, -2, -3, -2],
            [1, -1, 1, -1, 1, -1, 1, -1, 1, -1, 1, -1],
        );
        let ods = (
            [0, 0, -1, -1, -2, -2, -3, -3, -2, -2, -3, -3],
            [0, -1, -1, 0, 0, -1, -1, 0, -2, -3, -3, -2],
            [1, -1, -1, 1, 1, -1, -1, 1, 1, -1, -1, 1],
        );
        for (name, (y, z, sign)) in
            [("awr1843", isk), ("iwr6843isk", isk), ("iwr6843aop", aop), ("iwr6843ods", ods)]
        {
            let array = preset(name).unwrap();
            for (k, (position, channel)) in
                array.positions().iter().zip(array.channels()).enumerate()
            {
                let apart = [0.0, f64::from(y[k] - y[0]), f64::from(z[k] - z[0])];
                assert_eq!(*position, apart, "{name}, element {k}");
                assert_eq!(array.is_inverted(*channel), sign[k] < 0, "{name}, element {k}");
            }
            assert_eq!(array.unambiguous_elevation_sine(), Some(1.0), "{name}");
        }
    }

    #[test]
    fn rows_a_wavelength_apart_are_ambiguous_beyond_thirty_degrees() {
        let rows = [[0.0; 3], [0.0, 1.0, 0.0], [0.0, 0.0, 2.0], [0.0, 1.0, 2.0]];
        assert_eq!(Array::new(&rows).unwrap().unambiguous_elevation_sine(), Some(0.5));
        assert_eq!(preset("lrr48").unwrap().unambiguous_elevation_sine(), None);
    }

    #[test]
    fn lrr48_has_its_stated_sidelobe() {
        let array = preset("lrr48").unwrap();
        let response = |u: f64| -> f64 {
            let sum: num_complex::Complex64 = array
                .positions()
                .iter()
                .map(|p| num_complex::Complex64::cis(std::f64::consts::PI * p[1] * u))
                .sum();
            20.0 * (sum.norm() / 48.0).log10()
        };
        let first_null = (1..2000).map(|k| f64::from(k) * 1e-5 * 5.0);
        let null =
            first_null.clone().zip(first_null.skip(1)).find(|(a, b)| response(*b) > response(*a));
        let (start, _) = null.unwrap();
        let peak = (0..40_000)
            .map(|k| f64::from(k) / 40_000.0)
            .filter(|u| *u > start)
            .map(response)
            .fold(f64::NEG_INFINITY, f64::max);
        assert!((peak + 14.5).abs() < 0.1, "{peak}");
    }

    #[test]
    fn unknown_names_list_the_known_ones() {
        for name in ["", "ula", "ulax", "awr9999"] {
            let message = preset(name).unwrap_err().to_string();
            assert!(message.contains("lrr48"), "{message}");
        }
        let empty = preset("ula0").unwrap_err();
        assert!(matches!(empty, InputError::Empty { .. }), "{empty}");
    }
}
