use super::*;
use boresight_core::Complex64;
use ndarray::Array2;

#[test]
fn detections_come_back_as_they_were() {
    let rows = vec![
        DetectionRow {
            frame: 3,
            range_m: 2.9485,
            rate_mps: -0.125,
            azimuth_rad: -0.1884,
            elevation_rad: 0.01,
            power_db: -41.25,
            snr_db: 33.0,
            range_bin: 58,
            doppler_bin: 8,
            doppler_fold: -2,
            fold_probability: Some(0.995),
            ..DetectionRow::default()
        }
        .placed(),
        DetectionRow::default(),
    ];
    let text = write_detections(&rows);
    assert!(text.starts_with("frame,range_m,rate_mps,azimuth_deg,"));
    let read = read_detections(text.as_bytes()).unwrap();
    assert_eq!(read.len(), 2);
    // Degrees and back cost at most the last bit or two.
    assert!((read[0].azimuth_rad - rows[0].azimuth_rad).abs() < 1e-15);
    assert!((read[0].z_m - 2.9485 * 0.01_f64.sin()).abs() < 1e-12);
    let x_m = 2.9485 * 0.01_f64.cos() * 0.1884_f64.cos();
    assert!((read[0].x_m - x_m).abs() < 1e-12 && read[0].y_m < -0.5);
    let back =
        |row: DetectionRow| DetectionRow { azimuth_rad: 0.0, elevation_rad: 0.0, ..row }.placed();
    assert_eq!(back(read[0]), back(rows[0]));
    let places: Vec<f64> = text
        .lines()
        .nth(1)
        .and_then(|line| line.rsplitn(4, ',').take(3).map(|word| word.parse().ok()).collect())
        .unwrap();
    assert_eq!(places, [rows[0].z_m, rows[0].y_m, rows[0].x_m]);
}

#[test]
fn columns_may_be_in_any_order_and_some_missing() {
    let rows = read_detections(b"azimuth_deg,note,range_m\r\n90,far,12\r\n").unwrap();
    assert_eq!(rows[0].range_m, 12.0);
    assert!((rows[0].azimuth_rad - std::f64::consts::FRAC_PI_2).abs() < 1e-15);
}

#[test]
fn wrong_tables_name_line_and_column() {
    for (text, line, word) in [
        ("range_m\n1\n", 1, "azimuth_deg"),
        ("range_m,azimuth_deg\n1,2\n3,x\n", 3, "azimuth_deg"),
        ("range_m,azimuth_deg\n1,2\n3\n", 3, "fields"),
        ("range_m,azimuth_deg\n1,inf\n", 2, "finite"),
        ("range_m,azimuth_deg,frame\n1,2,-1\n", 2, "frame"),
        ("", 1, "range_m"),
    ] {
        let error = read_detections(text.as_bytes()).unwrap_err();
        let FormatError::Table { line: at, .. } = error else { panic!("{error}") };
        assert_eq!(at, line, "{text:?}: {error}");
        assert!(error.to_string().contains(word), "{text:?}: {error}");
    }
    let bytes = read_detections(b"range_m,azimuth_deg\n\xff,1\n").unwrap_err();
    assert!(matches!(bytes, FormatError::Table { line: 2, .. }), "{bytes}");
}

#[test]
fn snapshots_come_back_bit_for_bit() {
    let matrix = Array2::from_shape_fn((3, 2), |(k, n)| {
        Complex64::new(0.1 * k as f64 - 1.0 / 3.0, (n as f64).exp())
    });
    let text = write_snapshots(matrix.view());
    assert_eq!(read_snapshots(text.as_bytes()).unwrap(), matrix);
}

#[test]
fn incomplete_snapshots_are_refused() {
    for (text, word) in [
        ("snapshot,element,re,im\n0,0,1,0\n1,1,1,0\n", "2 elements x 2 snapshots"),
        ("snapshot,element,re,im\n0,0,1,0\n0,0,1,0\n", "number of lines"),
        ("snapshot,element,re,im\n0,1,1,0\n0,1,1,0\n", "a second time"),
        ("snapshot,element,re,im\n0,99999999999,1,0\n", "number of lines"),
        ("snapshot,element,re,im\n0,18446744073709551615,1,0\n", "smaller"),
        ("snapshot,element,re,im\n", "number of lines"),
        ("snapshot,element,re\n", "column im"),
    ] {
        let error = read_snapshots(text.as_bytes()).unwrap_err();
        assert!(error.to_string().contains(word), "{text:?}: {error}");
    }
}
