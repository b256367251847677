//! Plans and records with bytes changed: each is read, or refused by a typed error, and what is read comes to something.

use boresight_core::{Diagnose, Random};
use boresight_fleet::gather::gather;
use boresight_fleet::job::{LogFile, Settings};
use boresight_fleet::schema::SCHEMA;
use boresight_fleet::{FleetOptions, Job, Jobs, merge};
use std::path::Path;

const TRIALS: usize = 4000;

/// A record as `fleet run` writes it, of drive `number`.
fn record(number: usize) -> String {
    let equations = r#"{"reference":[0.4,1.0,0.0,0.003,0.04],"information":[40000.0,30.0,-2.0,400.0,10.0,900.0,5.0,20.0,1.0,80000.0,3.0,2.0,90000.0,8.0,700.0],"right":[1.5,0.1,0.02,0.3,0.1],"prior":[0.4,1.0,0.0,0.003,0.04],"priorInformation":[123.0,2500.0,328280.0,145000.0,1111.0],"floorRad":0.0008,"doubtRad":0.0}"#;
    let radar = |sensor: u8| {
        format!(
            r#"{{"sensor":{sensor},"result":{{"angleDeg":24.{number},"sigmaDeg":0.07,"nominalDeg":25.0,"converged":true,"changedS":null,"frames":{{"given":500,"used":400}},"warnings":[{{"code":"not-converged"}}]}},"equations":{equations}}}"#
        )
    };
    format!(
        r#"{{"key":"{number:032}","vehicle":"car","drive":"d{number}","timeS":{}.5,"path":"logs/car/d{number}","done":{{"format":"radarscenes","durationS":60.0,"radars":[{},{}]}}}}"#,
        1_700_000_000 + 86_400 * number,
        radar(1),
        radar(2)
    )
}

fn job() -> String {
    let files = vec![LogFile { name: "a.csv".into(), bytes: 12, sha256: "00".repeat(32) }];
    let settings = Settings { sensor: Some(2), ..Settings::default() };
    let key = Job::key_of(&files, &settings);
    let [path, vehicle, drive] = ["logs/car/d1", "car", "d1"].map(String::from);
    let job =
        Job { key, path, vehicle, drive, time_s: Some(1.7e9), files, settings, schema: SCHEMA };
    serde_json::to_string(&job).unwrap()
}

/// Bytes with some of them replaced, removed, doubled or exchanged for what numbers and texts are made of.
fn changed(text: &str, random: &mut Random) -> Vec<u8> {
    const PIECES: [&[u8]; 12] = [
        b"-",
        b"1e308",
        b"1e-308",
        b"null",
        b"\"",
        b"{",
        b"]",
        b"0",
        b"99999999999999999999",
        b"\\ud800",
        b",",
        b"\xff",
    ];
    let mut bytes = text.as_bytes().to_vec();
    let mut below = |most: usize| random.integer(0, most as u64 - 1) as usize;
    for _ in 0..1 + below(3) {
        let at = below(bytes.len());
        let length = 1 + below(8);
        let end = (at + length).min(bytes.len());
        match below(3) {
            0 => drop(bytes.drain(at..end)),
            1 => {
                let piece = PIECES[below(PIECES.len())];
                drop(bytes.splice(at..(at + 1).min(bytes.len()), piece.iter().copied()));
            }
            _ => {
                let again = bytes[at..end].to_vec();
                drop(bytes.splice(at..at, again));
            }
        }
    }
    bytes
}

#[test]
fn changed_plans_are_read_or_refused() {
    let (whole, mut random) = (job(), Random::new(1, 0));
    let mut read = 0;
    for _ in 0..TRIALS {
        let bytes = changed(&whole, &mut random);
        for job in Jobs::new(&bytes[..], Path::new("jobs.jsonl")) {
            match job {
                Ok(job) => {
                    assert!(job.is_sound());
                    read += 1;
                }
                Err(error) => assert!(["malformed-plan", "edited-plan"].contains(&error.code())),
            }
        }
    }
    // Names and places may be changed, and are a quarter of the line.
    assert!((TRIALS / 40..TRIALS).contains(&read), "{read}");
}

#[test]
fn changed_records_are_read_or_refused_and_what_is_read_comes_to_something() {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("hostile");
    std::fs::create_dir_all(&folder).unwrap();
    let path = folder.join("records.jsonl");
    let mut random = Random::new(2, 0);
    let mut read = 0;
    for _ in 0..TRIALS {
        let mut bytes = changed(&record(1), &mut random);
        bytes.push(b'\n');
        for number in 2..6 {
            bytes.extend(record(number).into_bytes());
            bytes.push(b'\n');
        }
        std::fs::write(&path, &bytes).unwrap();
        match gather(std::slice::from_ref(&path), None, false) {
            Ok(gathered) => {
                read += 1;
                match merge::merge(gathered, &FleetOptions::default(), 1) {
                    Ok(fleet) => {
                        let radars = fleet.vehicles.iter().flat_map(|vehicle| &vehicle.radars);
                        for radar in radars {
                            assert!(radar.sigma_rad >= 0.0, "{radar:?}");
                            assert!(radar.angle_rad.is_finite() || radar.sigma_rad.is_infinite());
                        }
                    }
                    Err(error) => assert_ne!(error.code(), "unknown"),
                }
            }
            Err(error) => {
                assert!(["malformed-record", "conflict"].contains(&error.code()), "{error}")
            }
        }
    }
    assert!((TRIALS / 20..TRIALS).contains(&read), "{read}");
}
