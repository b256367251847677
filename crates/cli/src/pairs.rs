//! Records written as `key=value` pairs: `azimuth=12,power=-3`. A key is what a flag of the field would be called.

use crate::error::CliError;
use crate::flags::fields_of;
use boresight_core::Diagnose;
use boresight_options::{Described, Naming, check};
use serde::de::DeserializeOwned;
use serde_json::{Map, Value};

/// Reads `text`, given for `option`. Every key stands at most once; values are in the units of the command line.
pub fn read<T: Described + DeserializeOwned>(
    option: &'static str,
    text: &str,
) -> Result<T, CliError> {
    let wrong = |expected: String, given: String| CliError::Option { option, expected, given };
    let fields = fields_of::<T>();
    let keys: Vec<String> = fields.iter().map(|field| field.name().0).collect();
    let mut values = Value::Object(Map::new());
    let mut known: Vec<usize> = vec![];
    for pair in text.split(',') {
        let given = || format!("{pair:?} in {text:?}");
        let found = pair.split_once('=').and_then(|(key, value)| {
            let place = keys.iter().position(|own| own == key.trim())?;
            (!known.contains(&place)).then_some((place, value))
        });
        let (place, value) = found.ok_or_else(|| {
            let keys = keys.join(", ");
            wrong(format!("key=number pairs with commas, keys {keys}, each once"), given())
        })?;
        fields[place].put(&mut values, value).ok_or_else(|| {
            wrong(format!("{} for {}", fields[place].field.kind.expected(), keys[place]), given())
        })?;
        known.push(place);
    }
    let lacking =
        (0..fields.len()).find(|place| fields[*place].field.required && !known.contains(place));
    if let Some(place) = lacking {
        return Err(wrong(format!("{}=NUMBER among its pairs", keys[place]), format!("{text:?}")));
    }
    let read: T = serde_json::from_value(values).map_err(|error| {
        wrong(format!("numbers that fit their keys ({error})"), format!("{text:?}"))
    })?;
    check(&read, Naming::CommandLine).map_err(|error| {
        let details = error.details();
        let expected = format!("for {} {}", details.what.trim_start_matches('-'), details.expected);
        wrong(expected, details.given)
    })?;
    Ok(read)
}

#[cfg(test)]
mod tests {
    use super::*;
    use boresight_simulate::{CubeTarget, Target};

    #[test]
    fn keys_are_the_names_of_fields_in_the_units_of_people() {
        let target: CubeTarget = read("--target", "range=5, azimuth=-10,phase=90").unwrap();
        assert_eq!(target.range_m, 5.0);
        assert_eq!(target.direction.azimuth_rad, (-10.0_f64).to_radians());
        assert_eq!(target.phase_rad, Some(90.0_f64.to_radians()));
        assert_eq!((target.rate_mps, target.power_db), (0.0, 0.0));
    }

    #[test]
    fn what_cannot_be_read_is_named() {
        for (text, words) in [
            ("azimuth=5,azimuth=6", "each once"),
            ("azimut=5", "keys azimuth, elevation, power, phase"),
            ("azimuth=five", "expected a number for azimuth"),
            ("azimuth", "key=number pairs"),
            ("azimuth=100", "for azimuth a number from -90 to 90"),
        ] {
            let error = read::<Target>("--target", text).unwrap_err().to_string();
            assert!(error.contains(words), "{error}");
        }
        let error = read::<CubeTarget>("--target", "azimuth=5").unwrap_err().to_string();
        assert!(error.contains("range=NUMBER among its pairs"), "{error}");
    }
}
