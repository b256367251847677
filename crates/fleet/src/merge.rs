//! From the records of a fleet to what they come to.

use crate::error::FleetError;
use crate::fleet::{FailureCount, Fleet, FleetRadar, Vehicle};
use crate::gather::Gathered;
use crate::options::FleetOptions;
use crate::outlying::{Outlying, VehicleAngle};
use crate::pattern::natural_order;
use crate::record::{RadarResult, Record};
use crate::{parallel, vehicle};
use boresight_mounting::wrap;
use boresight_options::{Naming, check};
use std::collections::{BTreeMap, HashMap};

/// What the records come to: the same whatever their order, over so many threads.
///
/// # Errors
/// Those of the options' check and of [`boresight_mounting::merge_drives`].
pub fn merge(
    gathered: Gathered,
    options: &FleetOptions,
    threads: usize,
) -> Result<Fleet, FleetError> {
    check(options, Naming::Rust)?;
    let Gathered { records, counts, .. } = gathered;
    let failures = failures(&records);
    let mut by_vehicle: HashMap<String, Vec<Record<RadarResult>>> = HashMap::new();
    for record in records.into_iter().filter(|record| record.done.is_some()) {
        by_vehicle.entry(record.vehicle.clone()).or_default().push(record);
    }
    let groups: Vec<(String, Vec<Record<RadarResult>>)> = by_vehicle.into_iter().collect();
    let mut vehicles: Vec<Vehicle> = Vec::with_capacity(groups.len());
    parallel::each(
        &groups,
        threads,
        |(name, records)| vehicle::vehicle(name, records, options),
        |vehicle| {
            vehicles.push(vehicle?);
            Ok::<(), FleetError>(())
        },
    )?;
    drop(groups);
    vehicles.sort_by(|a, b| natural_order(&a.name, &b.name));
    let radars = radars(&mut vehicles);
    Ok(Fleet { logs: counts, failures, vehicles, radars })
}

fn failures(records: &[Record<RadarResult>]) -> Vec<FailureCount> {
    let mut counts: BTreeMap<&str, FailureCount> = BTreeMap::new();
    for record in records {
        let Some(failed) = &record.failed else { continue };
        let entry = counts.entry(&failed.code).or_default();
        if entry.count == 0 || record.path < entry.path {
            entry.code.clone_from(&failed.code);
            entry.message.clone_from(&failed.message);
            entry.path.clone_from(&record.path);
        }
        entry.count += 1;
    }
    let mut all: Vec<FailureCount> = counts.into_values().collect();
    all.sort_by(|a, b| b.count.cmp(&a.count).then_with(|| a.code.cmp(&b.code)));
    all
}

/// Holds the vehicles' angles off nominal against each other, radar by radar, and marks those that are unlike the others.
fn radars(vehicles: &mut [Vehicle]) -> Vec<FleetRadar> {
    let mut numbers: Vec<u8> =
        vehicles.iter().flat_map(|v| v.radars.iter().map(|radar| radar.sensor)).collect();
    numbers.sort_unstable();
    numbers.dedup();
    let mut all = vec![];
    for sensor in numbers {
        let places: Vec<(usize, usize)> = vehicles
            .iter()
            .enumerate()
            .filter_map(|(v, vehicle)| {
                let r = vehicle.radars.iter().position(|radar| radar.sensor == sensor)?;
                Some((v, r))
            })
            .collect();
        // Where not all state what they should be, angles themselves are compared.
        let nominal = places.iter().all(|&(v, r)| vehicles[v].radars[r].nominal_rad.is_some());
        let angles: Vec<VehicleAngle> = places
            .iter()
            .map(|&(v, r)| {
                let radar = &vehicles[v].radars[r];
                let off = if nominal { radar.nominal_rad.unwrap_or(0.0) } else { 0.0 };
                VehicleAngle { angle_rad: wrap(radar.angle_rad - off), sigma_rad: radar.sigma_rad }
            })
            .collect();
        let found = Outlying::of(&angles);
        let mut names = vec![];
        for (&(v, r), told) in places.iter().zip(&found.vehicles) {
            if told.outlying {
                names.push(vehicles[v].name.clone());
                vehicles[v].radars[r].outlying = Some(told.deviations);
            }
        }
        all.push(FleetRadar {
            sensor,
            vehicles: angles
                .iter()
                .filter(|of| of.angle_rad.is_finite() && of.sigma_rad.is_finite())
                .count() as u64,
            centre_rad: found.centre_rad,
            spread_rad: found.spread_rad,
            threshold: found.threshold,
            outlying: names,
        });
    }
    all
}
