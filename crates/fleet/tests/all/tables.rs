//! Tables in Parquet, read back.

use boresight_fleet::Fleet;
use boresight_fleet::fleet::{
    AngleSource, CarValues, Drift, Drive, DriveAngle, Knock, Vehicle, VehicleRadar,
};
use boresight_fleet::tables::{drive_columns, radar_columns, write_drives, write_radars};
use boresight_mounting::Alignment;
use parquet::file::reader::{FileReader, SerializedFileReader};
use parquet::record::Field;
use std::collections::BTreeMap;

/// Rows by the names of their columns.
fn read(bytes: Vec<u8>) -> Vec<BTreeMap<String, Field>> {
    let reader = SerializedFileReader::new(bytes::Bytes::from(bytes)).unwrap();
    let rows = reader.get_row_iter(None).unwrap();
    rows.map(|row| row.unwrap().into_columns().into_iter().collect()).collect()
}

fn fleet() -> Fleet {
    let drive = |name: &str, time_s: Option<f64>, at: f64| Drive {
        name: name.into(),
        path: format!("logs/{name}"),
        time_s,
        at,
        duration_s: 60.5,
        own: CarValues {
            scale: Some(0.99),
            scale_sigma: Some(0.002),
            bias_radps: Some(0.01),
            bias_sigma_radps: Some(0.0003),
            slip_gradient_rad: Some(0.004),
            slip_gradient_sigma_rad: Some(0.0005),
            delay_s: Some(0.06),
            delay_sigma_s: Some(0.007),
        },
    };
    let angle = |drive: usize, sigma_rad: f64| DriveAngle {
        drive,
        angle_rad: 0.1 + drive as f64,
        sigma_rad,
        fitted_rad: if drive == 0 { f64::NAN } else { 0.2 },
        converged: drive == 1,
        outlying: drive == 0,
        warnings: vec!["a".into(); drive],
    };
    let knock = Knock { drive: 1, after: 0.0, before: 1.5, step_rad: 0.02, sigma_rad: 0.001 };
    let radar = VehicleRadar {
        sensor: 255,
        nominal_rad: Some(0.5),
        angle_rad: 0.25,
        sigma_rad: f64::INFINITY,
        source: AngleSource::Joint,
        alignment: Some(Alignment::Undecided),
        drives: vec![angle(0, f64::INFINITY), angle(1, 0.003)],
        knocks: vec![Knock::default(), knock],
        drift: Some(Drift { rate_rad: -0.001, sigma_rad: 0.0002 }),
        scatter: 1.5,
        outlying: Some(7.5),
    };
    let quiet = VehicleRadar { sensor: 1, ..VehicleRadar::default() };
    let shared = CarValues {
        scale: Some(1.01),
        scale_sigma: Some(0.012),
        bias_radps: Some(-0.013),
        bias_sigma_radps: Some(0.0014),
        slip_gradient_rad: Some(0.015),
        slip_gradient_sigma_rad: Some(0.0016),
        delay_s: Some(0.05),
        delay_sigma_s: Some(f64::INFINITY),
    };
    Fleet {
        vehicles: vec![Vehicle {
            name: "Wägelchen \u{1f697} \"7\"\n".into(),
            drives: vec![drive("d1", Some(1.777_629_6e9), 0.0), drive("d2", None, 1.5)],
            timed: true,
            radars: vec![quiet, radar],
            shared: Some(shared),
        }],
        ..Fleet::default()
    }
}

#[test]
fn every_value_comes_back() {
    let mut bytes = vec![];
    write_drives(&fleet(), &mut bytes).unwrap();
    let rows = read(bytes);
    assert_eq!(rows.len(), 2);
    let names: Vec<&str> = drive_columns().iter().map(|column| column.name).collect();
    assert!(rows.iter().all(|row| row.len() == names.len()));
    let degrees = |radians: f64| Field::Double(radians.to_degrees());
    for (name, first, second) in [
        ("vehicle", Field::Str("Wägelchen \u{1f697} \"7\"\n".into()), None),
        ("drive", Field::Str("d1".into()), Some(Field::Str("d2".into()))),
        ("path", Field::Str("logs/d1".into()), Some(Field::Str("logs/d2".into()))),
        ("time", Field::TimestampMillis(1_777_629_600_000), Some(Field::Null)),
        ("at", Field::Double(0.0), Some(Field::Double(1.5))),
        ("duration_s", Field::Double(60.5), None),
        ("sensor", Field::Long(255), None),
        ("angle_deg", degrees(0.1), Some(degrees(1.1))),
        ("sigma_deg", Field::Null, Some(degrees(0.003))),
        ("fitted_deg", Field::Null, Some(degrees(0.2))),
        ("converged", Field::Bool(false), Some(Field::Bool(true))),
        ("outlying", Field::Bool(true), Some(Field::Bool(false))),
        ("warnings", Field::Str(String::new()), Some(Field::Str("a".into()))),
        ("scale", Field::Double(0.99), None),
        ("scale_sigma", Field::Double(0.002), None),
        ("bias_degps", degrees(0.01), None),
        ("bias_sigma_degps", degrees(0.0003), None),
        ("slip_gradient_deg", degrees(0.004), None),
        ("slip_gradient_sigma_deg", degrees(0.0005), None),
        ("delay_s", Field::Double(0.06), None),
        ("delay_sigma_s", Field::Double(0.007), None),
    ] {
        assert!(names.contains(&name));
        assert_eq!(rows[0][name], first, "{name}");
        assert_eq!(rows[1][name], second.unwrap_or(first), "{name}");
    }

    let mut bytes = vec![];
    write_radars(&fleet(), &mut bytes).unwrap();
    let rows = read(bytes);
    assert_eq!(rows.len(), 2);
    for (name, quiet, told) in [
        ("vehicle", Field::Str("Wägelchen \u{1f697} \"7\"\n".into()), None),
        ("sensor", Field::Long(1), Some(Field::Long(255))),
        ("drives", Field::Long(0), Some(Field::Long(2))),
        ("nominal_deg", Field::Null, Some(degrees(0.5))),
        ("angle_deg", Field::Double(0.0), Some(degrees(0.25))),
        ("sigma_deg", Field::Double(0.0), Some(Field::Null)),
        ("source", Field::Str("history".into()), Some(Field::Str("joint".into()))),
        ("alignment", Field::Null, Some(Field::Str("undecided".into()))),
        ("knocks", Field::Long(0), Some(Field::Long(2))),
        ("last_knock_at", Field::Null, Some(Field::Double(1.5))),
        ("last_step_deg", Field::Null, Some(degrees(0.02))),
        ("last_step_sigma_deg", Field::Null, Some(degrees(0.001))),
        ("drift_deg", Field::Null, Some(degrees(-0.001))),
        ("drift_sigma_deg", Field::Null, Some(degrees(0.0002))),
        ("timed", Field::Bool(true), None),
        ("scatter", Field::Double(0.0), Some(Field::Double(1.5))),
        ("outlying", Field::Null, Some(Field::Double(7.5))),
        ("scale", Field::Double(1.01), None),
        ("scale_sigma", Field::Double(0.012), None),
        ("bias_degps", degrees(-0.013), None),
        ("bias_sigma_degps", degrees(0.0014), None),
        ("slip_gradient_deg", degrees(0.015), None),
        ("slip_gradient_sigma_deg", degrees(0.0016), None),
        ("delay_s", Field::Double(0.05), None),
        ("delay_sigma_s", Field::Null, None),
    ] {
        assert_eq!(rows[0][name], quiet, "{name}");
        assert_eq!(rows[1][name], told.unwrap_or(quiet), "{name}");
    }
    assert_eq!(rows[0].len(), radar_columns().len());
}

#[test]
fn a_drive_without_a_radar_and_numbers_that_are_none_are_rows_with_nulls() {
    let drive = |name: &str, number: f64| Drive {
        name: name.into(),
        time_s: Some(number),
        at: number,
        duration_s: number,
        ..Drive::default()
    };
    let drives = [("a", f64::NAN), ("b", -0.5), ("c", f64::INFINITY), ("d", 1e300)];
    let angle = DriveAngle { drive: 1, ..DriveAngle::default() };
    let none = DriveAngle { drive: 9, ..DriveAngle::default() };
    let radar = VehicleRadar {
        sensor: 4,
        drives: vec![angle, none],
        scatter: f64::NAN,
        outlying: Some(f64::INFINITY),
        knocks: vec![Knock { before: f64::NAN, ..Knock::default() }],
        ..VehicleRadar::default()
    };
    let vehicle = Vehicle {
        drives: drives.map(|(name, number)| drive(name, number)).into(),
        radars: vec![radar],
        ..Vehicle::default()
    };
    let fleet = Fleet { vehicles: vec![vehicle], ..Fleet::default() };
    let mut bytes = vec![];
    write_drives(&fleet, &mut bytes).unwrap();
    let rows = read(bytes);
    let column = |name: &str| rows.iter().map(|row| row[name].clone()).collect::<Vec<_>>();
    // That of the radar first, then those without; each drive once.
    let names = ["b", "a", "c", "d"].map(|name| Field::Str(name.into()));
    assert_eq!(column("drive"), names);
    for name in ["sensor", "angle_deg", "converged", "outlying", "warnings"] {
        assert!(rows[0][name] != Field::Null, "{name}");
        assert!(rows[1..].iter().all(|row| row[name] == Field::Null), "{name}");
    }
    let null = Field::Null;
    assert_eq!(column("time"), [Field::TimestampMillis(-500), null.clone(), null.clone(), null]);
    let null = Field::Null;
    for name in ["at", "duration_s"] {
        let numbers = [Field::Double(-0.5), null.clone(), null.clone(), Field::Double(1e300)];
        assert_eq!(column(name), numbers, "{name}");
    }
    let mut bytes = vec![];
    write_radars(&fleet, &mut bytes).unwrap();
    for name in ["scatter", "outlying", "last_knock_at"] {
        assert_eq!(read(bytes.clone())[0][name], Field::Null, "{name}");
    }
}

#[test]
fn a_table_of_nothing_and_one_of_many_groups_are_tables() {
    let mut bytes = vec![];
    write_drives(&Fleet::default(), &mut bytes).unwrap();
    assert!(read(bytes).is_empty());
    // More rows than are held at once, in order.
    let radars = |count: usize| {
        let radar = |at: usize| VehicleRadar { scatter: at as f64, ..VehicleRadar::default() };
        let vehicle = Vehicle { radars: (0..count).map(radar).collect(), ..Vehicle::default() };
        Fleet { vehicles: vec![vehicle], ..Fleet::default() }
    };
    let (mut bytes, mut again) = (vec![], vec![]);
    write_radars(&radars(140_000), &mut bytes).unwrap();
    write_radars(&radars(140_000), &mut again).unwrap();
    assert_eq!(bytes, again);
    let rows = read(bytes);
    assert_eq!(rows.len(), 140_000);
    for (at, row) in rows.iter().enumerate() {
        assert_eq!(row["scatter"], Field::Double(at as f64));
    }
}
