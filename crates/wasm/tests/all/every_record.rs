//! Every record that functions return comes back whole: each described field is there, under its name in JavaScript,
//! of its type, with its value in its unit, and nothing else is.

use boresight_aoa::bounds::{Signals, deterministic_bound, uncorrelated};
use boresight_aoa::suits::unsuited;
use boresight_aoa::{Data, Estimator, EstimatorOptions, Method};
use boresight_core::drive_columns::DriveColumns;
use boresight_core::presets::preset;
use boresight_core::{Array, Direction, Geometry};
use boresight_formats::{BoardLog, RadarConfig};
use boresight_image::{
    Gate, Grid, RangeAzimuthDoppler, Target, ViewGrid, birds_eye_view, sidelobe_measure,
};
use boresight_mounting::{Calibrator, FrameInput, Method as Calibration};
use boresight_options::{Described, Kind, NumberType, Record, naming};
use boresight_pipeline::regions::{RegionCounts, RegionFrame, RegionTarget, TargetRegion};
use boresight_pipeline::{AngleOptions, Chain, ChainOptions};
use boresight_simulate::street::{Street, StreetOptions};
use boresight_simulate::{
    CubeColumns, CubeOptions, CubeTarget, DriveOptions, Fluctuation, Scene, SceneSampling,
    SnapshotOptions, SnapshotSimulator, Snapshots, simulate_cube, simulate_drive,
};
use boresight_wasm::capture::CaptureInfo;
use boresight_wasm::carry;
use boresight_wasm::config::ConfigRecord;
use boresight_wasm::image::ImageDefaults;
use boresight_wasm::region::{RegionOfInterest, RegionOptions};
use js_sys::{Float32Array, Float64Array, Int8Array, Object, Reflect, Uint8Array, Uint32Array};
use ndarray::{Axis, s};
use serde::Serialize;
use serde_json::Value;
use std::f64::consts::FRAC_PI_3;
use wasm_bindgen::{JsCast, JsValue};
use wasm_bindgen_test::wasm_bindgen_test;

/// Holds what JavaScript is given of a value against what serde_json is.
fn whole<T: Described + Serialize>(value: &T) {
    let there = carry::write(value);
    same(&T::KIND, &serde_json::to_value(value).unwrap(), &there, false, "");
}

fn same(kind: &Kind, here: &Value, there: &JsValue, is_angle: bool, path: &str) {
    match kind {
        Kind::Number | Kind::Whole | Kind::Seed => number(here, there.as_f64(), is_angle, path),
        Kind::Truth => assert_eq!(here.as_bool(), there.as_bool(), "{path}"),
        Kind::Text | Kind::Choice(_) => {
            assert_eq!(here.as_str().map(String::from), there.as_string(), "{path}");
        }
        Kind::Numbers(of) => {
            let there = column(*of, there).unwrap_or_else(|| panic!("{path} is no column"));
            let here = here.as_array().unwrap();
            assert_eq!(here.len(), there.len(), "{path}");
            for (here, there) in here.iter().zip(there) {
                number(here, Some(there), is_angle, path);
            }
        }
        Kind::Record(record) => {
            let count = fields(record, here, there, path);
            assert_eq!(
                count,
                Object::keys(there.unchecked_ref::<Object>()).length(),
                "fields of {path}"
            );
        }
        Kind::Optional(_) if here.is_null() => assert!(there.is_null(), "{path}"),
        Kind::Optional(kind) => same(kind, here, there, is_angle, path),
        Kind::List(kind) | Kind::Tuple(kind, _) => {
            let there: js_sys::Array = there.clone().dyn_into().unwrap();
            let here = here.as_array().unwrap();
            assert_eq!(here.len() as u32, there.length(), "{path}");
            for (index, (here, there)) in here.iter().zip(there.iter()).enumerate() {
                same(kind, here, &there, is_angle, &format!("{path}[{index}]"));
            }
        }
        Kind::Special(_) => assert!(!there.is_undefined(), "{path}"),
    }
}

/// Compares the fields of a record, and counts them.
fn fields(record: &Record, here: &Value, there: &JsValue, path: &str) -> u32 {
    let mut count = 0;
    for field in record.fields {
        if let (true, Kind::Record(inner)) = (field.flat, field.kind) {
            count += fields(inner, &here[field.name], there, path);
            continue;
        }
        let name = naming::javascript(field.name);
        let path = format!("{path}.{name}");
        let value = Reflect::get(there, &name.into()).unwrap();
        let Some(here) = here.get(field.name) else {
            assert!(field.may_be_absent && value.is_undefined(), "{path}");
            continue;
        };
        count += 1;
        same(&field.kind, here, &value, naming::is_angle(field.name), &path);
    }
    count
}

/// JSON has null for what is not finite.
fn number(here: &Value, there: Option<f64>, is_angle: bool, path: &str) {
    let there = there.unwrap_or_else(|| panic!("{path} is no number"));
    let Some(here) = here.as_f64() else { return assert!(!there.is_finite(), "{path}: {there}") };
    let expected = if is_angle { here.to_degrees() } else { here };
    assert!((there - expected).abs() <= 1e-12 * expected.abs(), "{path}: {there}, not {expected}");
}

fn column(of: NumberType, value: &JsValue) -> Option<Vec<f64>> {
    Some(match of {
        NumberType::F64 => value.dyn_ref::<Float64Array>()?.to_vec(),
        NumberType::F32 => widened(value.dyn_ref::<Float32Array>()?.to_vec()),
        NumberType::U32 => widened(value.dyn_ref::<Uint32Array>()?.to_vec()),
        NumberType::U8 => widened(value.dyn_ref::<Uint8Array>()?.to_vec()),
        NumberType::I8 => widened(value.dyn_ref::<Int8Array>()?.to_vec()),
    })
}

fn widened<T: Into<f64>>(numbers: Vec<T>) -> Vec<f64> {
    numbers.into_iter().map(Into::into).collect()
}

fn snapshots(array: &Array, targets: usize) -> Snapshots {
    let sampling = SceneSampling { count: [targets; 2], ..SceneSampling::default() };
    let options = SnapshotOptions {
        scene: Scene::Sampled(sampling),
        snr_db: 20.0,
        snapshots: 4,
        fluctuation: Fluctuation::default(),
        seed: 3,
        ..SnapshotOptions::default()
    };
    SnapshotSimulator::new(array, &options).unwrap().scenes(0, 3).unwrap()
}

#[wasm_bindgen_test]
fn records_of_arrays_and_angles() {
    for name in ["ula8", "awr1843"] {
        let array = preset(name).unwrap();
        whole(&Geometry::from(&array));
        let simulated = snapshots(&array, 2);
        whole(&simulated);
        for method in [Method::Music, Method::Iaa, Method::Nomp] {
            let options = EstimatorOptions::default();
            let mut estimator = Estimator::new(method, &array, &options).unwrap();
            let first = simulated.values.index_axis(Axis(0), 0);
            whole(&estimator.estimate(Data::Snapshots(first)).unwrap());
            if method != Method::Music {
                // One snapshot determines amplitudes.
                let one = simulated.values.slice(s![0, .., ..1]);
                whole(&estimator.estimate(Data::Snapshots(one)).unwrap());
            }
            let batch = estimator.estimate_batch(simulated.values.view(), true).unwrap();
            whole(&batch.columns());
            whole(&method.requirements());
        }
        let directions = [-0.2, 0.1].map(Direction::azimuth);
        let covariance = uncorrelated(&[1.0, 2.0]);
        let signals = Signals { covariance: covariance.view(), noise_power: 1.0, snapshots: 4 };
        whole(&deterministic_bound(&array, &directions, &signals).unwrap());
        whole(&unsuited(Method::Esprit, &array, &EstimatorOptions::default(), 1));
    }
}

/// The confidence of networks is a column of a batch, and of no other.
#[wasm_bindgen_test]
fn a_batch_carries_the_confidence_of_its_sources() {
    let array = preset("ula8").unwrap();
    let mut estimator = Estimator::new(Method::Iaa, &array, &EstimatorOptions::default()).unwrap();
    let mut batch = estimator.estimate_batch(snapshots(&array, 2).values.view(), false).unwrap();
    assert!(batch.columns().confidence.is_none());
    for (index, source) in batch.sources.iter_mut().enumerate() {
        source.confidence = Some(0.5_f64.powi(index as i32));
    }
    let there = Reflect::get(&carry::write(&batch.columns()), &"confidence".into()).unwrap();
    assert_eq!(there.unchecked_into::<Float64Array>().to_vec()[..3], [1.0, 0.5, 0.25]);
    whole(&batch.columns());
}

#[wasm_bindgen_test]
fn records_of_captures_and_images() {
    let config =
        RadarConfig::parse(include_bytes!("../../../../recordings/awr1642/profile.cfg")).unwrap();
    whole(&ConfigRecord::from(&config));
    let array = config.array().unwrap();
    let info = CaptureInfo {
        config: ConfigRecord::from(&config),
        frames: 3,
        trailing_bytes: 5,
        array: Some(Geometry::from(&array)),
        beat_asymmetry_db: Some(20.5),
        iq_swapped: Some(false),
        warnings: &config.remarks,
    };
    whole(&info);
    let waveform = config.waveform;
    whole(&waveform);
    whole(&waveform.summary());
    let target = CubeTarget { range_m: 4.0, rate_mps: 0.5, ..CubeTarget::default() };
    let options = CubeOptions { seed: 2, ..CubeOptions::default() };
    let cube = simulate_cube(&waveform, &array, &[target], &options).unwrap();
    whole(&CubeColumns::from(&cube));
    let mut chain =
        Chain::new(&waveform, config.receivers.len(), &array, &ChainOptions::default()).unwrap();
    let frame = cube.index_axis(Axis(0), 0);
    whole(&chain.process(frame).unwrap());
    whole(&chain.cells(frame).unwrap());
    whole(&RegionOfInterest::of(frame, RegionOptions { bins: 5, chirps: 2 }).unwrap());
    let target = RegionTarget {
        range_m: 4.0,
        azimuth_rad: 0.1,
        power: 0.5,
        confidence: Some(0.75),
        range_deviation_m: Some(0.01),
        azimuth_deviation_rad: Some(0.002),
    };
    whole(&RegionFrame {
        frame: 2,
        range_m: vec![0.5, 1.0],
        range_profile_db: vec![-3.0, -6.0],
        regions: vec![TargetRegion {
            range_bin: 8,
            range_m: 4.0,
            rate_mps: -0.5,
            power: 0.25,
            snr: 100.0,
            peaks: 3,
            coarse_azimuth_rad: 0.2,
            rotated: true,
            sources: 1,
            probability: vec![0.1, 0.8, 0.2],
            targets: vec![target],
        }],
        counts: RegionCounts { joined: 2, ..RegionCounts::default() },
        warnings: vec![],
    });
    whole(&ImageDefaults::of(&waveform, &array, &AngleOptions::default()));
    let grid = Grid::new([0.0, 10.0], 20, FRAC_PI_3, 16).unwrap();
    let mut image = RangeAzimuthDoppler::new(grid, None).unwrap();
    for range_m in [4.0, 40.0] {
        let target =
            Target { range_m, rate_mps: 0.0, azimuth_rad: 0.1, power: 1.0, confidence: 0.5 };
        image.add_target(&target).unwrap();
    }
    let map = image.to_map();
    whole(&map.columns());
    let street = Street::new(StreetOptions::default()).unwrap();
    whole(&street);
    whole(&street.visible(1).unwrap()[0]);
    let view = ViewGrid::new([0.0, 10.0], [-5.0, 5.0], 0.5).unwrap();
    let view = birds_eye_view(&[(&map, street.radars[1].mounting)], view).unwrap();
    whole(&view.columns());
    let gate = Gate::Circle { radius_m: 1.0 };
    whole(&sidelobe_measure(&view, &[[4.0, 0.0]], gate).unwrap());
    let dat = include_bytes!(
        "../../../../recordings/awr1642/xwr16xx_crw_demo_visualizer_2018_1015v2.dat"
    );
    let log = BoardLog::parse(&dat[..40_000], None);
    whole(&log);
    whole(&log.counts);
}

#[wasm_bindgen_test]
fn records_of_drives_and_mounting_angles() {
    let options = DriveOptions { duration_s: 5.0, ..DriveOptions::default() };
    let drive = simulate_drive(&options).unwrap();
    whole(&DriveColumns::from(&drive.log));
    whole(&drive.truth_columns());
    let Some(mounting) = drive.log.sensors[0].mounting else { panic!("a mounting") };
    let options = boresight_mounting::CalibrationOptions {
        method: Calibration::Recursive,
        x_m: mounting.x_m,
        y_m: mounting.y_m,
        ..boresight_mounting::CalibrationOptions::default()
    };
    let mut calibrator = Calibrator::new(options).unwrap();
    for scan in drive.log.scans.iter().filter(|scan| scan.sensor == drive.log.sensors[0].id) {
        let outcome = calibrator.add(FrameInput {
            time_s: scan.time_s,
            detections: &scan.detections,
            yaw_rate_radps: drive.log.yaw_rate_at(scan.time_s, 0.25),
            speed_mps: drive.log.speed_at(scan.time_s, 0.25),
        });
        whole(&outcome.unwrap());
    }
    whole(&calibrator.estimate());
    whole(&calibrator.outlook().unwrap());
}
