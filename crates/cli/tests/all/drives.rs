//! Drive logs on the command line.

use crate::common::{boresight, folder, stdout};
use serde_json::Value;
use std::path::{Path, PathBuf};

fn recordings() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../recordings")
}

fn parsed(text: &str) -> Value {
    serde_json::from_str(text).unwrap()
}

#[test]
fn a_drive_log_is_described() {
    let delphi = recordings().join("delphi");
    let text = stdout(&["log", delphi.to_str().unwrap(), "--json"]);
    let log: Value = serde_json::from_str(&text).unwrap();
    assert_eq!(log["format"], "delphi");
    assert_eq!((&log["scans"], &log["motionSamples"]), (&12_003.into(), &5997.into()));
    assert_eq!(log["dropped"]["invalid-marker"], 192);
    let shown = stdout(&["log", delphi.join("front_radar.csv.gz").to_str().unwrap()]);
    assert!(shown.contains("307205 of 307397 rows") && shown.contains("motion      0 samples"));
    let output = boresight(&["log", recordings().join("awr1642/profile.cfg").to_str().unwrap()]);
    assert_eq!(output.status.code(), Some(1));
    assert!(String::from_utf8_lossy(&output.stderr).contains("no-drive-log"));
}

#[test]
fn calibrate_finds_the_angle_of_the_radar_of_a_real_drive() {
    let drive = recordings().join("delphi");
    let drive = drive.to_str().unwrap();
    let text =
        stdout(&["calibrate", drive, "--method", "weighted-mean", "--min-speed", "3", "--json"]);
    let result: Value = serde_json::from_str(&text).unwrap();
    // The set's own extrinsics say -1.96 deg.
    let angle = result["angleDeg"].as_f64().unwrap();
    assert!((angle + 1.96).abs() < 0.3, "{text}");
    assert!(result["frames"]["used"].as_u64().unwrap() > 1000, "{text}");
    let tracked =
        ["calibrate", drive, "--method", "least-squares", "--motion", "tracked", "--json"];
    let result = parsed(&stdout(&tracked));
    assert_eq!(result["motion"], "tracked");
    assert!((result["angleDeg"].as_f64().unwrap() + 1.96).abs() < 0.3, "{result}");
    let refused = boresight(&["calibrate", drive, "--motion", "ransac"]);
    assert!(
        String::from_utf8_lossy(&refused.stderr)
            .contains("tracked or deepego, with the recursive method")
    );
    let by_network =
        ["calibrate", drive, "--method", "least-squares", "--motion", "deepego-plus", "--json"];
    let found = parsed(&stdout(&by_network));
    // Tracked objects are nothing the network was trained on.
    assert!((found["angleDeg"].as_f64().unwrap() + 1.96).abs() < 0.4, "{found}");
    let card = recordings().join("../models/motion/deepego.json");
    let broken = [&by_network[..], &["--network", card.to_str().unwrap()]].concat();
    let refused = boresight(&broken);
    assert!(String::from_utf8_lossy(&refused.stderr).contains("malformed-weights"));
    // With the angle found the trajectory is straighter than with the nominal one.
    let error = |key: &str| result["trajectoryError"][key].as_f64().unwrap();
    assert!(error("estimatedM") < 0.8 * error("nominalM"), "{result}");
    let wrong = boresight(&["calibrate", drive, "--sensor", "9"]);
    assert_eq!(wrong.status.code(), Some(2));
}

#[test]
fn a_simulated_drive_is_written_and_read_back() {
    let folder = folder("drive");
    let out = folder.to_str().unwrap();
    let arguments = [
        "simulate",
        "drive",
        "--seed",
        "1",
        "--duration",
        "10",
        "--misalign",
        "2=1.5",
        "--out",
        out,
    ];
    let said = stdout(&arguments);
    let sequence = folder.join("data/sequence_1");
    let log = parsed(&stdout(&["log", sequence.to_str().unwrap(), "--json"]));
    assert_eq!(log["format"], "radarscenes");
    assert_eq!(log["sensors"].as_array().unwrap().len(), 4);
    assert!(said.contains(&format!("{} detections", log["detections"])), "{said}");
    let read = |name: &str| std::fs::read(folder.join(name)).unwrap();
    let truth: Value = serde_json::from_slice(&read("truth.json")).unwrap();
    let yaw = |key: &str| truth["sensors"][1][key].as_f64().unwrap();
    assert!((yaw("yawDeg") - yaw("nominalYawDeg") - 1.5).abs() < 1e-9);
    // The same seed gives the same bytes, packed the same drive.
    let before = read("data/sequence_1/radar_data.h5");
    stdout(&[&arguments[..], &["--force"]].concat());
    assert_eq!(read("data/sequence_1/radar_data.h5"), before);
    stdout(&[&arguments[..], &["--packed", "--force"]].concat());
    assert!(read("data/sequence_1/radar_data.h5").len() < before.len());
    assert_eq!(parsed(&stdout(&["log", sequence.to_str().unwrap(), "--json"])), log);
}

#[test]
fn a_set_of_data_is_written_and_not_replaced() {
    let folder = folder("dataset");
    let out = folder.to_str().unwrap();
    let arguments = |extra: &[&'static str]| -> Vec<String> {
        let fixed = ["simulate", "drive", "--seed", "4", "--frames", "100", "--dataset", out];
        fixed.iter().chain(extra).map(|text| (*text).to_owned()).collect()
    };
    let run = |extra: &[&'static str]| {
        let arguments = arguments(extra);
        boresight(&arguments.iter().map(String::as_str).collect::<Vec<_>>())
    };
    assert!(run(&["--scenario", "motorway"]).status.success());
    let read = |name: &str| std::fs::read(folder.join(name)).unwrap();
    let card: Value = serde_json::from_slice(&read("dataset.json")).unwrap();
    assert_eq!((&card["frames"], &card["scenario"]), (&104.into(), &"motorway".into()));
    let detections = read("detections.bin");
    assert_eq!(read("frames.bin").len(), 104 * 28);
    assert_eq!(detections.len() as u64, 8 * card["detections"].as_u64().unwrap());

    let said = |extra: &[&'static str]| String::from_utf8_lossy(&run(extra).stderr).into_owned();
    assert!(said(&[]).contains("--force"));
    assert!(said(&["--force", "--duration", "10"]).contains("given:    --duration"));
    let left_out = ["--force", "--scenario", "city", "--scenario-left-out", "city"];
    assert!(said(&left_out).contains("expected: another kind of roads"));
    assert_eq!(read("detections.bin"), detections);
    assert!(run(&["--force", "--scenario", "city"]).status.success());
    assert_ne!(read("detections.bin"), detections);
    let without = boresight(&["simulate", "drive", "--seed", "4", "--frames", "100", "--out", out]);
    assert!(String::from_utf8_lossy(&without.stderr).contains("--dataset"));
}

/// Writes a short drive with radar 2 off by 1.5 deg and gives its folder.
fn simulated(name: &str) -> PathBuf {
    let folder = folder(name);
    let out = folder.to_str().unwrap();
    let misalign = ["--misalign", "2=1.5", "--out", out];
    stdout(&[&["simulate", "drive", "--seed", "1", "--duration", "4"][..], &misalign].concat());
    folder
}

fn log(path: &Path, extra: &[&str]) -> Value {
    parsed(&stdout(&[&["log", path.to_str().unwrap(), "--json"], extra].concat()))
}

#[test]
fn a_sequence_is_found_from_any_of_its_places() {
    let top = simulated("places");
    let sequence = top.join("data/sequence_1");
    let whole = log(&sequence, &[]);
    assert_eq!(whole["mountings"], "sensors-json");
    assert_eq!(whole["sequence"]["name"], "sequence_1");
    let yaw = whole["sensors"][1]["mounting"]["yawDeg"].as_f64().unwrap();
    assert!((yaw - (-0.436_185_662_f64.to_degrees() - 1.5)).abs() < 1e-6, "{yaw}");
    for path in [sequence.join("radar_data.h5"), top.join("data"), top.clone()] {
        assert_eq!(log(&path, &[]), whole, "{}", path.display());
    }
    // As tables it is the same drive, but for the mountings.
    let tables = top.join("tables");
    log(&sequence, &["--export", tables.to_str().unwrap()]);
    let exported = log(&tables, &[]);
    for key in ["scans", "detections", "radarSpan", "motionSamples", "motionSpan", "poses"] {
        assert_eq!(exported[key], whole[key], "{key}");
    }
    // A second sequence, which sequences.json does not name, then does.
    let second = top.join("data/sequence_12");
    std::fs::create_dir(&second).unwrap();
    std::fs::copy(sequence.join("radar_data.h5"), second.join("radar_data.h5")).unwrap();
    assert_eq!(log(&top, &[]), whole);
    let listed = r#"{"sequences": {"sequence_12": {}, "sequence_1": {}, "sequence_3": {}}}"#;
    std::fs::write(top.join("data/sequences.json"), listed).unwrap();
    assert_eq!(log(&top, &["--sequence", "1"]), whole);
    let other = log(&top, &["--sequence", "sequence_12"]);
    assert_eq!((&other["sequence"], &other["scans"]), (&Value::Null, &whole["scans"]));
    let top = top.to_str().unwrap();
    let sequence = sequence.to_str().unwrap();
    for (arguments, words) in [
        (&["log", top][..], "one of sequence_1, sequence_12"),
        (&["log", top, "--sequence", "3"], "one of sequence_1, sequence_12"),
        (&["log", sequence, "--sequence", "1"], "folder of a data set"),
        (&["calibrate", top, "--format", "csv", "--sequence", "1"], "folder of a data set"),
    ] {
        let output = boresight(arguments);
        let errors = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(2), "{arguments:?}: {errors}");
        assert!(errors.contains(words), "{arguments:?}: {errors}");
    }
    // Without sensors.json the car of the data set is taken.
    std::fs::remove_file(Path::new(top).join("data/sensors.json")).unwrap();
    let without = log(Path::new(sequence), &[]);
    assert_eq!(without["mountings"], "format");
    let yaw = without["sensors"][1]["mounting"]["yawDeg"].as_f64().unwrap();
    assert!((yaw + 0.436_185_662_f64.to_degrees()).abs() < 1e-6, "{yaw}");
}

#[test]
fn what_is_no_drive_is_refused_by_log_and_calibrate() {
    let drive = simulated("damaged");
    let folder = folder("no-drive");
    let write = |name: &str, bytes: &[u8]| {
        let path = folder.join(name);
        std::fs::create_dir_all(path.parent().unwrap()).unwrap();
        std::fs::write(&path, bytes).unwrap();
        path.to_str().unwrap().to_owned()
    };
    let whole = std::fs::read(drive.join("data/sequence_1/radar_data.h5")).unwrap();
    let golden = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../tests/golden/radarscenes");
    let golden = |name: &str| golden.join(name).to_str().unwrap().to_owned();
    let pictures = write("pictures/one.jpg", b"jpg");
    write("pictures/two.jpg", b"jpg");
    let pictures = Path::new(&pictures).parent().unwrap().to_str().unwrap().to_owned();
    let empty = folder.join("empty");
    std::fs::create_dir_all(&empty).unwrap();
    let head = "time_s,azimuth_rad,range_rate_mps\n";
    let nowhere = folder.join("nowhere.h5").to_str().unwrap().to_owned();
    for (path, code, words) in [
        (pictures, "no-drive-log", &["radar_data.h5", "range_rate_mps", "one.jpg, two.jpg"][..]),
        (empty.to_str().unwrap().into(), "no-drive-log", &["no files"]),
        (nowhere, "file", &["nowhere.h5"]),
        (
            write("half/radar_data.h5", &whole[..whole.len() / 2]),
            "malformed-hdf5",
            &["unexpected EOF"],
        ),
        (write("short/radar_data.h5", &whole[..40]), "malformed-hdf5", &["whole HDF5 file"]),
        (golden("no_vr.h5"), "malformed-hdf5", &["radar_data.vr"]),
        (golden("no_odometry.h5"), "malformed-hdf5", &["odometry"]),
        (golden("backwards.h5"), "time-backwards", &["row 2"]),
        (write("a.csv", b""), "malformed-table", &["time_s"]),
        (write("b.csv", head.as_bytes()), "malformed-table", &["empty"]),
        (write("c.csv", b"time_s,azimuth_rad\n1,2\n"), "malformed-table", &["range_rate_mps"]),
        (write("d.csv", format!("{head}2,0,1\n1,0,1\n").as_bytes()), "time-backwards", &["line 3"]),
    ] {
        for command in ["log", "calibrate"] {
            let output = boresight(&[command, &path]);
            let errors = String::from_utf8_lossy(&output.stderr);
            assert_eq!(output.status.code(), Some(1), "{command} {path}: {errors}");
            assert!(output.stdout.is_empty());
            assert!(errors.contains(&format!("code:     {code}")), "{command} {path}: {errors}");
            assert!(words.iter().all(|word| errors.contains(word)), "{command} {path}: {errors}");
        }
    }
}

#[test]
fn statistics_of_a_log_are_a_table_or_json_and_say_what_is_lacking() {
    let folder = folder("statistics");
    let out = folder.to_str().unwrap();
    let arguments = [
        "simulate",
        "drive",
        "--profile",
        "radarscenes",
        "--seed",
        "2",
        "--duration",
        "20",
        "--sensor",
        "2",
        "--sensor",
        "3",
        "--slip-gradient",
        "0.3",
        "--out",
        out,
    ];
    stdout(&arguments);
    let truth: Value =
        serde_json::from_slice(&std::fs::read(folder.join("truth.json")).unwrap()).unwrap();
    assert_eq!(truth["profile"], "radarscenes");
    assert!((truth["car"]["slipGradientDeg"].as_f64().unwrap() - 0.3).abs() < 1e-12);
    assert!((0.02..0.1).contains(&truth["car"]["delayS"].as_f64().unwrap()));
    assert!(truth["sensors"][0]["azimuthBiasRmsDeg"].as_f64().unwrap() > 0.01);

    let sequence = folder.join("data/sequence_1");
    let path = sequence.to_str().unwrap();
    let all = parsed(&stdout(&["log", path, "--statistics", "--json"]));
    let all = all.as_array().unwrap();
    assert_eq!([&all[0]["sensor"], &all[1]["sensor"]], [2, 3]);
    let held = parsed(&stdout(&["log", path, "--json"]));
    assert_eq!(all[0]["detections"], held["sensors"][0]["detections"]);
    let span = all[0]["azimuthSpanDeg"].as_array().unwrap();
    assert!(span[0].as_f64().unwrap() < -60.0 && span[1].as_f64().unwrap() <= 70.0);
    let text = stdout(&["log", path, "--statistics"]);
    let mean = all[0]["meanCount"].as_f64().unwrap();
    let line = text.lines().find(|line| line.starts_with("detections a scan, mean")).unwrap();
    assert!(line.contains(&format!("{mean:.1}")), "{line}");

    // Tables hold neither mountings nor labels.
    let tables = folder.join("tables");
    stdout(&["log", path, "--export", tables.to_str().unwrap()]);
    let text = stdout(&["log", tables.to_str().unwrap(), "--statistics"]);
    assert!(text.contains("sensor 2: no moving share: the log has no labels"), "{text}");
    assert!(text.contains("the log does not state where the radar sits"), "{text}");
}

#[test]
fn radars_of_a_simulated_drive_are_chosen() {
    let folder = folder("radars");
    let out = folder.to_str().unwrap();
    let base = ["simulate", "drive", "--seed", "1", "--duration", "2", "--out", out];
    stdout(&[&base[..], &["--sensor", "3", "--sensor", "id=9,x=3.7,y=0,yaw=-30"]].concat());
    let truth: Value =
        serde_json::from_slice(&std::fs::read(folder.join("truth.json")).unwrap()).unwrap();
    let ids: Vec<_> = truth["sensors"].as_array().unwrap().iter().map(|s| &s["id"]).collect();
    assert_eq!(ids, [3, 9]);
    assert!((truth["sensors"][1]["yawDeg"].as_f64().unwrap() + 30.0).abs() < 1e-9);
    for (extra, status, words) in [
        (&["--sensor", "5"][..], 2, "1 to 4"),
        (&["--sensor", "id=1.5,x=1,y=1,yaw=1"], 2, "a whole number for id"),
        (&["--sensor", "id=300,x=1,y=1,yaw=1"], 2, "fit their keys"),
        (&["--sensor", "id=1,x=1"], 2, "y=NUMBER"),
        (&["--misalign", "2"], 2, "2=1.5"),
        (&["--misalign", "7=1"], 1, "numbers of the sensors"),
        (&["--moving-share", "0.9"], 2, "--moving-share is 0.9; expected a number from 0 to 0.8"),
        (&["--scenario", "moon"], 2, "city"),
    ] {
        let output = boresight(&[&base[..], extra, &["--force"]].concat());
        let errors = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(status), "{extra:?}: {errors}");
        assert!(errors.contains(words), "{extra:?}: {errors}");
    }
}

/// Columns of a CSV file with a header line; what is empty is NaN.
fn columns(text: &str) -> (Vec<String>, Vec<Vec<f64>>) {
    let mut lines = text.lines();
    let names: Vec<String> = lines.next().unwrap().split(',').map(str::to_owned).collect();
    let rows = lines
        .map(|line| line.split(',').map(|field| field.parse().unwrap_or(f64::NAN)).collect())
        .collect();
    (names, rows)
}

#[test]
fn all_radars_together_and_the_trajectory_of_one() {
    let folder = folder("joint");
    let out = folder.to_str().unwrap();
    stdout(&[
        "simulate",
        "drive",
        "--seed",
        "3",
        "--duration",
        "60",
        "--misalign",
        "2=1.5",
        "--out",
        out,
    ]);
    let results = parsed(&stdout(&["calibrate", out, "--joint", "--json"]));
    let results = results.as_array().unwrap();
    assert_eq!(results.len(), 4);
    let truth: Value =
        serde_json::from_slice(&std::fs::read(folder.join("truth.json")).unwrap()).unwrap();
    for (result, radar) in results.iter().zip(truth["sensors"].as_array().unwrap()) {
        let number = |key: &str| result[key].as_f64().unwrap();
        // Four of its own standard deviations: once in 16,000.
        let error = number("angleDeg") - radar["yawDeg"].as_f64().unwrap();
        assert!(error.abs() < 4.0 * number("sigmaDeg"), "{result}");
        assert_eq!(
            (&result["scale"], &result["joint"]),
            (&results[0]["scale"], &Value::Bool(true))
        );
    }
    let off = results[1]["angleDeg"].as_f64().unwrap() - results[1]["nominalDeg"].as_f64().unwrap();
    assert!((off - 1.5).abs() < 0.5, "{off}");

    let csv = folder.join("way.csv");
    let path = csv.to_str().unwrap();
    let arguments = ["calibrate", out, "--sensor", "2", "--trajectory", path, "--force"];
    let said = stdout(&[&arguments[..], &["--json"]].concat());
    let error = &parsed(&said)["trajectoryError"];
    let [estimated, nominal] = ["estimatedM", "nominalM"].map(|key| error[key].as_f64().unwrap());
    assert!(3.0 * estimated < nominal, "{error}");
    let (names, rows) = columns(&std::fs::read_to_string(&csv).unwrap());
    let expected = "time_s,x_m,y_m,yaw_deg,logged_x_m,logged_y_m,logged_yaw_deg";
    assert_eq!(names.join(","), expected);
    assert!(rows.len() > 780 && rows.is_sorted_by(|a, b| a[0] < b[0]));
    assert_eq!(rows[0][1..4], rows[0][4..7]);
    // The same way: as long within 2 %, and its end no further off than segments stray.
    let length = |x: usize| -> f64 {
        rows.windows(2).map(|w| (w[1][x] - w[0][x]).hypot(w[1][x + 1] - w[0][x + 1])).sum()
    };
    let ratio = length(1) / length(4);
    assert!((ratio - 1.0).abs() < 0.02, "{ratio}");
    assert!(stdout(&arguments).contains("m by the nominal angle"));
    for (arguments, words) in [
        (&["calibrate", out, "--trajectory", path][..], "1, 2, 3, 4"),
        (&["calibrate", out, "--joint", "--method", "kabsch"], "cannot be used with"),
        (&[&arguments[..], &["--x", "0"]].concat(), "ahead of"),
    ] {
        let output = boresight(arguments);
        let errors = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(2), "{arguments:?}: {errors}");
        assert!(errors.contains(words), "{arguments:?}: {errors}");
    }
}

#[test]
fn a_report_says_the_verdict_and_where_it_comes_from_and_replaces_nothing() {
    let path = folder("calibration-report").join("report.html");
    let report = path.to_str().unwrap();
    let drive = recordings().join("delphi");
    let arguments = ["calibrate", drive.to_str().unwrap(), "--min-speed", "3", "--report", report];
    let text = stdout(&arguments);
    assert!(text.contains("\nnext         "), "{text}");
    let html = std::fs::read_to_string(&path).unwrap();
    let angle = text.lines().find(|line| line.starts_with("angle")).unwrap();
    let angle = angle.trim_start_matches("angle").trim().replace("+-", "\u{b1}");
    assert!(html.contains(&format!("<th>Angle</th><td>{angle}</td>")), "{angle}");
    assert!(html.contains("misaligned") && html.contains("--min-speed 3"));
    let (_, digest) = html.split_once("<th>front_radar.csv.gz</th><td>").unwrap();
    let (_, digest) = digest.split_once("SHA-256 ").unwrap();
    let digits = digest.chars().take_while(char::is_ascii_hexdigit).count();
    assert_eq!(digits, 64);
    let again = boresight(&arguments);
    assert!(!again.status.success());
    assert_eq!(std::fs::read_to_string(&path).unwrap(), html);
}

#[test]
fn the_cars_motion_from_all_radars() {
    let folder = folder("odometry");
    let out = folder.to_str().unwrap();
    let simulate = [
        "simulate",
        "drive",
        "--seed",
        "3",
        "--duration",
        "30",
        "--misalign",
        "2=1.5",
        "--out",
        out,
    ];
    stdout(&simulate);
    let csv = folder.join("way.csv");
    let arguments = ["odometry", out, "--trajectory", csv.to_str().unwrap()];
    let found = parsed(&stdout(&[&arguments[..], &["--json"]].concat()));
    let radars = found["radars"].as_array().unwrap();
    assert_eq!(radars.len(), 4);
    for radar in radars {
        let count = |key: &str| radar["frames"][key].as_u64().unwrap();
        assert!(count("taken") > 20 * (count("untold") + count("contradicted")), "{radar}");
    }
    let rms = |key: &str| found[key]["rms"].as_f64().unwrap();
    // The log's own yaw rate and speed are as exact as that.
    assert!(rms("speedDifferenceMps") < 0.2 && rms("yawRateDifferenceDegps") < 1.5, "{found}");
    let way = std::fs::read_to_string(&csv).unwrap();
    assert!(way.starts_with("time_s,x_m,y_m,yaw_deg"), "{way:.80}");
    assert!(way.lines().count() > 1000);
    let shown = stdout(&["odometry", out, "--sensors", "1,4"]);
    assert!(shown.contains("sensor 4") && !shown.contains("sensor 2"), "{shown}");
    // What is there stays there, and what is asked for has to be.
    assert_eq!(boresight(&arguments).status.code(), Some(1));
    let refused = boresight(&["odometry", out, "--sensors", "1,9"]);
    assert_eq!(refused.status.code(), Some(2));
    assert!(String::from_utf8_lossy(&refused.stderr).contains("1, 2, 3, 4"));
}
