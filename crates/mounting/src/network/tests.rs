use super::*;
use boresight_core::Detection;
use boresight_formats::NpyArray;
use std::path::{Path, PathBuf};

fn golden(network: &str, name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../tests/golden/motion").join(network).join(name)
}

fn numbers(network: &str, name: &str) -> (Vec<usize>, Vec<f64>) {
    let array = NpyArray::parse(&std::fs::read(golden(network, name)).unwrap()).unwrap();
    let values = array.to_f64().unwrap();
    (array.shape, values)
}

fn weights(network: &str) -> Weights {
    Weights::read(&std::fs::read(golden(network, "weights.bin")).unwrap()).unwrap()
}

fn detection(values: &[f64]) -> Detection {
    Detection {
        azimuth_rad: values[0] as f32,
        range_rate_mps: values[1] as f32,
        range_m: values[2] as f32,
        rcs_dbsm: values[3] as f32,
    }
}

/// Scans of a golden batch, without what pads them.
fn scans(network: &str) -> (Vec<Vec<Detection>>, usize) {
    let (shape, points) = numbers(network, "points.npy");
    let (_, mask) = numbers(network, "mask.npy");
    let most = shape[shape.len() - 2];
    let scans = points
        .chunks_exact(4 * most)
        .zip(mask.chunks_exact(most))
        .map(|(scan, mask)| {
            let rows = scan.chunks_exact(4).zip(mask);
            rows.filter(|(_, there)| **there != 0.0).map(|(row, _)| detection(row)).collect()
        })
        .collect();
    (scans, most)
}

/// That numbers of one kind are the same to 1e-4 of the larger of 1 and the expected one.
fn assert_close(given: f64, expected: f64, what: &str) {
    let off = (given - expected).abs() / expected.abs().max(1.0);
    assert!(off < 1e-4, "{what}: {given}, expected {expected}");
}

#[test]
fn single_frames_are_as_in_pytorch() {
    let network = DeepEgo::new(&weights("deepego")).unwrap();
    let (scans, most) = scans("deepego");
    assert_eq!(scans.len(), 64);
    assert!((0..3).all(|count| scans[count].len() == count));
    let (_, motions) = numbers("deepego", "motion.npy");
    let (_, weights) = numbers("deepego", "weights.npy");
    let (_, moves) = numbers("deepego", "moves.npy");
    for (k, scan) in scans.iter().enumerate() {
        let found = network.motion(scan);
        let expected = &motions[7 * k..7 * (k + 1)];
        let [vx, vy] = found.velocity_mps;
        let [xx, xy, yy] = found.covariance;
        let given = [vx, vy, xx, xy, yy, found.share, f64::from(found.log_factor)];
        for (i, (given, expected)) in given.into_iter().zip(expected).enumerate() {
            assert_close(given, *expected, &format!("frame {k}, number {i}"));
        }
        for (name, found, expected) in
            [("weight", &found.weights, &weights), ("moves", &found.moves, &moves)]
        {
            for (i, value) in found.iter().enumerate() {
                assert_close(
                    (*value).into(),
                    expected[most * k + i],
                    &format!("frame {k}, {name} {i}"),
                );
            }
        }
    }
}

#[test]
fn smoothed_frames_are_as_in_pytorch() {
    let network = DeepEgoPlus::new(&weights("deepego-plus")).unwrap();
    let (scans, _) = scans("deepego-plus");
    let (_, motions) = numbers("deepego-plus", "motion.npy");
    let (_, dt) = numbers("deepego-plus", "dt.npy");
    assert_eq!(scans.len(), 64);
    for (window, scans) in scans.chunks_exact(8).enumerate() {
        let singles: Vec<WeighedMotion> =
            scans.iter().map(|scan| network.single().motion(scan)).collect();
        let mut time_s = 100.0;
        let frames: Vec<WindowFrame> = singles
            .iter()
            .enumerate()
            .map(|(k, motion)| {
                time_s += dt[8 * window + k];
                WindowFrame { time_s, motion }
            })
            .collect();
        for (k, found) in network.smooth(&frames).into_iter().enumerate() {
            let at = 5 * (8 * window + k);
            let given = [found.velocity_mps.to_vec(), found.covariance.to_vec()].concat();
            for (i, (given, expected)) in given.into_iter().zip(&motions[at..at + 5]).enumerate() {
                assert_close(given, *expected, &format!("window {window}, frame {k}, number {i}"));
            }
        }
    }
}

#[test]
fn any_number_of_detections_gives_numbers() {
    let network = DeepEgo::new(&weights("deepego")).unwrap();
    let standing = |k: usize| {
        let azimuth_rad = (k as f32 * 0.7).sin();
        let range_rate_mps = -12.0 * (azimuth_rad + 0.1).cos();
        Detection { azimuth_rad, range_rate_mps, range_m: 20.0, rcs_dbsm: f32::NAN }
    };
    for count in [0, 1, 2, 3, 10_000] {
        let scan: Vec<Detection> = (0..count).map(standing).collect();
        let found = network.motion(&scan);
        assert_eq!(found.weights.len(), count);
        let all = [&found.velocity_mps[..], &found.covariance[..], &[found.share]].concat();
        assert!(all.iter().all(|number| number.is_finite()), "{count}: {found:?}");
        assert!(found.covariance[0] > 0.0 && found.covariance[2] > 0.0);
    }
    // All standing, so the motion is theirs.
    let scan: Vec<Detection> = (0..200).map(standing).collect();
    let found = network.motion(&scan);
    let [x, y] = found.velocity_mps;
    assert!((x - 12.0 * 0.1_f64.cos()).abs() < 0.05 && (y + 12.0 * 0.1_f64.sin()).abs() < 0.05);
    // Copies of one detection tell one component.
    let copies = network.motion(&vec![standing(3); 50]);
    assert!(copies.velocity_mps.iter().all(|v| v.is_finite()));
    assert!(copies.covariance[0].max(copies.covariance[2]) > found.covariance[2]);
}

#[test]
fn the_order_of_detections_changes_nothing() {
    let network = DeepEgo::new(&weights("deepego")).unwrap();
    for scan in scans("deepego").0 {
        let mut other = scan.clone();
        other.reverse();
        let half = other.len() / 2;
        if half > 0 {
            other.swap(0, half);
        }
        let (one, two) = (network.motion(&scan), network.motion(&other));
        for i in 0..2 {
            assert_close(two.velocity_mps[i], one.velocity_mps[i], "velocity");
        }
        assert_close(two.share, one.share, "share");
    }
}

#[test]
fn what_is_not_finite_has_no_part() {
    let network = DeepEgo::new(&weights("deepego")).unwrap();
    let (scans, _) = scans("deepego");
    let scan = &scans[10];
    let clean = network.motion(scan);
    let mut odd = scan.clone();
    let nan = Detection { azimuth_rad: f32::NAN, ..scan[0] };
    odd.insert(1, nan);
    odd.push(Detection { range_rate_mps: f32::INFINITY, ..scan[0] });
    let found = network.motion(&odd);
    assert_eq!((found.velocity_mps, found.covariance), (clean.velocity_mps, clean.covariance));
    assert_eq!((found.weights[1], found.weights[odd.len() - 1]), (0.0, 0.0));
    assert_eq!(found.weights[2..odd.len() - 1], clean.weights[1..]);
    assert!(DeepEgoPlus::new(&weights("deepego-plus")).unwrap().smooth(&[]).is_empty());
}

#[test]
fn damaged_files_are_refused() {
    let bytes = std::fs::read(golden("deepego", "weights.bin")).unwrap();
    assert!(bytes.len() < 150_000);
    let code = |bytes: &[u8]| boresight_core::Diagnose::code(&Weights::read(bytes).unwrap_err());
    assert_eq!(code(&[]), "malformed-weights");
    assert_eq!(code(b"something else altogether"), "malformed-weights");
    for at in [9, 20, bytes.len() / 2, bytes.len() - 1] {
        let mut broken = bytes.clone();
        broken[at] ^= 1;
        assert_eq!(code(&broken), "malformed-weights", "{at}");
    }
    let sealed = |mut body: Vec<u8>| {
        body.extend(crc32fast::hash(&body).to_le_bytes());
        body
    };
    let body = &bytes[..bytes.len() - 4];
    for length in [16, 17, 30, 100, body.len() / 2] {
        assert_eq!(code(&sealed(body[..length].to_vec())), "malformed-weights", "{length}");
    }
    assert_eq!(code(&sealed([body, &[0]].concat())), "malformed-weights");
    let mut endless = body.to_vec();
    let last = endless.len() - 2;
    endless[last..].copy_from_slice(&[0, 0x7c]);
    assert_eq!(code(&sealed(endless)), "weights-not-finite");
    // The weights of another network.
    let plus = DeepEgo::new(&weights("deepego-plus")).unwrap_err();
    assert!(matches!(plus, NetworkError::Unlike { ref tensor, .. } if tensor == "encode.0.weight"));
    assert!(DeepEgoPlus::new(&weights("deepego")).is_err());
}
