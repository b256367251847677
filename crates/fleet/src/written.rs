//! A fleet as a file of JSON, vehicle by vehicle: the whole as one value would take as much memory again as all records.

use crate::fleet::Fleet;
use boresight_formats::json;
use serde_json::Value;
use std::io::{Result, Write};

/// Writes what [`json::result`] makes of a fleet, each vehicle on a line of its own.
///
/// # Errors
/// Those of `out`.
pub fn write(fleet: &Fleet, out: &mut impl Write) -> Result<()> {
    let Fleet { logs, failures, vehicles, radars } = fleet;
    let beside =
        Fleet { logs: *logs, failures: failures.clone(), vehicles: vec![], radars: radars.clone() };
    let Value::Object(fields) = json::result(&beside) else { return Ok(()) };
    for (at, (name, value)) in fields.iter().enumerate() {
        let before = if at == 0 { "{" } else { ",\n" };
        if name != "vehicles" {
            write!(out, "{before}{}:{value}", Value::from(&**name))?;
            continue;
        }
        write!(out, "{before}\"vehicles\":[")?;
        for (at, vehicle) in vehicles.iter().enumerate() {
            let before = if at == 0 { "\n" } else { ",\n" };
            write!(out, "{before}{}", json::result(vehicle))?;
        }
        write!(out, "\n]")?;
    }
    writeln!(out, "}}")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fleet::{FailureCount, Vehicle};

    #[test]
    fn it_is_what_one_value_would_be() {
        let vehicle = |name: &str| Vehicle { name: name.into(), ..Vehicle::default() };
        for vehicles in [vec![], vec![vehicle("a")], vec![vehicle("a"), vehicle("b\"\n")]] {
            let failures = vec![FailureCount { code: "x".into(), ..FailureCount::default() }];
            let fleet = Fleet { vehicles, failures, ..Fleet::default() };
            let mut text = vec![];
            write(&fleet, &mut text).unwrap();
            let read: Value = serde_json::from_slice(&text).unwrap();
            assert_eq!(read, json::result(&fleet));
        }
    }
}
