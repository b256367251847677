//! The records of a fleet, each log's once.

use crate::error::FleetError;
use crate::fleet::LogCounts;
use crate::job::Job;
use crate::pattern::natural_order;
use crate::record::{RadarResult, Record};
use crate::schema::{self, SCHEMA};
use crate::store;
use std::collections::{HashMap, HashSet};
use std::path::{Path, PathBuf};

/// Records as merging reads them, and what was left out.
#[derive(Debug, Default)]
pub struct Gathered {
    /// The records, of each log one, in no order.
    pub records: Vec<Record<RadarResult>>,
    /// What became of the logs.
    pub counts: LogCounts,
    /// Records beyond the first of a log. This and the next depend on how the records came to be, which results do not.
    pub repeated: u64,
    /// Lines that are damaged or unfinished.
    pub damaged: u64,
}

/// Reads the records in files and folders. Of several records of a log, one that was done counts before one that failed, and one of a later release before
/// one of an earlier release. With a plan, records of
/// logs that are not in it are left out.
///
/// # Errors
/// [`FleetError::Conflict`] where two records of a log differ, [`FleetError::Incomplete`] where a log of the plan has none, unless `partial`;
/// [`FleetError::Record`] and those of the files.
pub fn gather(
    sources: &[PathBuf],
    plan: Option<&[Job]>,
    partial: bool,
) -> Result<Gathered, FleetError> {
    let planned: Option<HashMap<&str, &Job>> =
        plan.map(|jobs| jobs.iter().map(|job| (&*job.key, job)).collect());
    let mut places: HashMap<String, usize> = HashMap::new();
    let mut result = Gathered::default();
    let mut foreign: HashSet<String> = HashSet::new();
    for path in store::files(sources)? {
        result.damaged += store::each_line(&path, |line, text| {
            let mut record = read(&path, line, text)?;
            if let Some(planned) = &planned {
                let Some(job) = planned.get(&*record.key) else {
                    foreign.insert(record.key);
                    return Ok(());
                };
                // What the plan calls it counts, whichever copy was run.
                rename(&mut record, job);
            }
            match places.get(&record.key) {
                None => {
                    places.insert(record.key.clone(), result.records.len());
                    result.records.push(record);
                }
                Some(&at) => {
                    result.repeated += 1;
                    choose(&mut result.records[at], record)?;
                }
            }
            Ok(())
        })?;
    }
    let counts = &mut result.counts;
    counts.foreign = foreign.len() as u64;
    counts.failed = result.records.iter().filter(|record| record.done.is_none()).count() as u64;
    counts.done = result.records.len() as u64 - counts.failed;
    counts.planned = planned.as_ref().map_or(result.records.len(), HashMap::len) as u64;
    counts.missing = counts.planned - result.records.len() as u64;
    if counts.missing > 0 && !partial {
        let missing = plan.into_iter().flatten().filter(|job| !places.contains_key(&job.key));
        let first = missing.map(|job| &job.path).min().cloned().unwrap_or_default();
        let (missing, planned) = (counts.missing, counts.planned);
        return Err(FleetError::Incomplete { missing, planned, first });
    }
    Ok(result)
}

fn read(path: &Path, line: u64, text: &[u8]) -> Result<Record<RadarResult>, FleetError> {
    let wrong = |error: String| FleetError::Record { path: path.to_owned(), line, error };
    let record: Record<RadarResult> = serde_json::from_slice(text).map_err(|error| {
        schema::newer(text).map_or_else(
            || wrong(error.to_string()),
            |found| FleetError::Newer { path: path.to_owned(), line, found },
        )
    })?;
    if record.schema > SCHEMA {
        return Err(FleetError::Newer { path: path.to_owned(), line, found: record.schema });
    }
    match (&record.done, &record.failed) {
        (Some(_), Some(_)) => return Err(wrong("done and failed in one record".into())),
        (None, None) => return Err(wrong(store::NEITHER.into())),
        _ => {}
    }
    let mut radars = record.done.iter().flat_map(|done| &done.radars);
    let odd = radars.find(|radar| {
        !radar.result.angle_deg.is_finite()
            || radar.result.sigma_deg.is_some_and(|sigma| sigma.is_nan() || sigma < 0.0)
            || radar.equations.is_some_and(|equations| !equations.is_sound())
    });
    match odd {
        Some(radar) => Err(wrong(format!("radar {} has numbers that no drive has", radar.sensor))),
        None => Ok(record),
    }
}

fn rename(record: &mut Record<RadarResult>, job: &Job) {
    record.vehicle.clone_from(&job.vehicle);
    record.drive.clone_from(&job.drive);
    record.path.clone_from(&job.path);
    record.time_s = job.time_s;
}

/// Keeps of two records of one log the one that says more, whichever came first.
fn choose(kept: &mut Record<RadarResult>, other: Record<RadarResult>) -> Result<(), FleetError> {
    if kept.vehicle != other.vehicle {
        return Err(FleetError::Conflict {
            path: other.path,
            what: "the log is another vehicle's too",
            expected: format!("vehicle {}", kept.vehicle.clone().min(other.vehicle.clone())),
            given: format!("vehicle {}", kept.vehicle.clone().max(other.vehicle)),
        });
    }
    match (&kept.done, &other.done) {
        (Some(_), None) => return Ok(()),
        (None, Some(_)) => {
            *kept = other;
            return Ok(());
        }
        // Another release may come to another angle.
        (Some(_), Some(_)) if kept.version != other.version => {
            if natural_order(&kept.version, &other.version).is_lt() {
                *kept = other;
            }
            return Ok(());
        }
        (Some(one), Some(another)) if one != another => {
            return Err(FleetError::Conflict {
                path: other.path,
                what: "the same log and settings came to different angles",
                expected: "one result".into(),
                given: "two".into(),
            });
        }
        _ => {}
    }
    let order = |r: &Record<RadarResult>| {
        (r.path.clone(), r.drive.clone(), r.time_s.map(f64::to_bits), r.failed.clone())
    };
    if order(&other) < order(kept) {
        *kept = other;
    }
    Ok(())
}
