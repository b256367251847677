//! Results as JSON, in the names and units that JavaScript has them in, and the way back.

use boresight_options::naming::{is_angle, javascript};
use boresight_options::{Described, Kind, Record};
use serde::Serialize;
use serde::de::{DeserializeOwned, Error};
use serde_json::{Map, Value};

/// A result in the names and units of users; what is not finite becomes null.
pub fn result<T: Serialize + Described>(value: &T) -> Value {
    serde_json::to_value(value).map_or(Value::Null, |value| outside(value, Some(&T::KIND), false))
}

/// The fields of a result with further ones beside them.
pub fn beside(value: &(impl Serialize + Described), further: Value) -> Value {
    match (result(value), further) {
        (Value::Object(mut own), Value::Object(further)) => {
            own.extend(further);
            Value::Object(own)
        }
        (own, _) => own,
    }
}

/// Converts a value to the names and units of users. Without a kind no fields are flattened.
fn outside(value: Value, kind: Option<&Kind>, in_radians: bool) -> Value {
    match value {
        Value::Number(number) if in_radians => {
            number.as_f64().map_or(Value::Null, |radians| radians.to_degrees().into())
        }
        Value::Array(items) => {
            let kind = kind.and_then(Kind::item);
            items.into_iter().map(|item| outside(item, kind, in_radians)).collect()
        }
        Value::Object(fields) => {
            let described = kind.and_then(Kind::record).map_or(&[][..], |record| record.fields);
            let mut renamed = Map::new();
            for (name, value) in fields {
                let field = described.iter().find(|field| field.name == name);
                match outside(value, field.map(|field| &field.kind), is_angle(&name)) {
                    Value::Object(inner) if field.is_some_and(|field| field.flat) => {
                        renamed.extend(inner);
                    }
                    value => {
                        renamed.insert(javascript(&name), value);
                    }
                }
            }
            Value::Object(renamed)
        }
        other => other,
    }
}

/// Reads what [`result`] writes: fields by their names in JavaScript, angles in degrees. Fields that are not known are
/// refused.
///
/// # Errors
/// Those of the text, and of what it holds.
pub fn read<T: DeserializeOwned + Described>(text: &[u8]) -> Result<T, serde_json::Error> {
    let value: Value = serde_json::from_slice(text)?;
    serde_json::from_value(inside(value, &T::KIND, false)?)
}

/// The value in the names and units of Rust.
fn inside(value: Value, kind: &Kind, is_angle: bool) -> Result<Value, serde_json::Error> {
    Ok(match (value, kind) {
        (Value::Number(number), _) if is_angle => {
            number.as_f64().map_or(Value::Null, |degrees| degrees.to_radians().into())
        }
        (value, Kind::Optional(kind)) => inside(value, kind, is_angle)?,
        (Value::Array(items), Kind::List(kind) | Kind::Tuple(kind, _)) => {
            items.into_iter().map(|item| inside(item, kind, is_angle)).collect::<Result<_, _>>()?
        }
        (Value::Array(items), Kind::Numbers(_)) => items
            .into_iter()
            .map(|item| inside(item, &Kind::Number, is_angle))
            .collect::<Result<_, _>>()?,
        (Value::Object(mut fields), Kind::Record(record)) => {
            let known = taken(&mut fields, record)?;
            if let Some(other) = fields.keys().next() {
                let other: String = other.chars().take(40).collect();
                return Err(serde_json::Error::custom(format!("unknown field `{other}`")));
            }
            Value::Object(known)
        }
        (Value::Array(_), Kind::Record(_)) => {
            return Err(serde_json::Error::custom("a list, expected an object of named fields"));
        }
        (value, _) => value,
    })
}

/// Takes a record's fields out of an object.
fn taken(
    from: &mut Map<String, Value>,
    record: &Record,
) -> Result<Map<String, Value>, serde_json::Error> {
    let mut known = Map::new();
    for field in record.fields {
        if let (true, Kind::Record(inner)) = (field.flat, field.kind) {
            known.insert(field.name.into(), Value::Object(taken(from, inner)?));
        } else if let Some(value) = from.remove(&javascript(field.name)) {
            known.insert(field.name.into(), inside(value, &field.kind, is_angle(field.name))?);
        }
    }
    Ok(known)
}

#[cfg(test)]
mod tests {
    use super::*;
    use boresight_core::{ArrayCalibration, Direction, Mounting, NotIdentifiable};
    use boresight_options::Flat;
    use serde_json::json;

    /// What was seen.
    #[derive(Described, Serialize)]
    struct Seen {
        /// Where.
        direction: Flat<Direction>,
        /// How far.
        range_m: f64,
        /// By which radar.
        mounting: Option<Mounting>,
        /// Not finite.
        unknown_rad: f64,
    }

    #[test]
    fn names_units_and_places_are_those_of_javascript() {
        let seen = Seen {
            direction: Direction::azimuth(std::f64::consts::FRAC_PI_2).into(),
            range_m: 4.0,
            mounting: None,
            unknown_rad: f64::INFINITY,
        };
        let written = json!({
            "azimuthDeg": 90.0, "elevationDeg": 0.0, "rangeM": 4.0, "mounting": null, "unknownDeg": null,
            "more": 1
        });
        assert_eq!(beside(&seen, json!({ "more": 1 })), written);
    }

    #[test]
    fn a_calibration_is_read_as_it_was_written() {
        let array = boresight_core::Array::ula(3).unwrap();
        let mut calibration = ArrayCalibration::neutral(&array);
        calibration.channels[1].phase_rad = 0.5;
        calibration.channels[1].displacement = Some([0.0, 0.25, 0.0]);
        calibration.not_identifiable = vec![NotIdentifiable::Direction];
        calibration.coupling = Some(vec![vec![boresight_core::Complex64::ONE; 3]; 3]);
        let text = result(&calibration).to_string();
        assert!(text.contains("phaseDeg") && text.contains("not"), "{text}");
        let back: ArrayCalibration = read(text.as_bytes()).unwrap();
        assert!((back.channels[1].phase_rad - 0.5).abs() < 1e-15);
        let exact = ArrayCalibration { channels: calibration.channels.clone(), ..back };
        assert_eq!(exact, calibration);
    }

    #[test]
    fn hostile_text_is_refused_and_nothing_else_happens() {
        for text in [
            "",
            "[]",
            "{\"tx\":",
            "{\"made\": 1}",
            "{\"channels\": [{\"phase\": 1}]}",
            "{\"tx\": [[0, 0]], \"rx\": [], \"channels\": []}",
            "{\"cells\": -1}",
            "{\"channels\": [{\"gainDb\": \"1\"}]}",
        ] {
            assert!(read::<ArrayCalibration>(text.as_bytes()).is_err(), "{text}");
        }
        let nested = "[".repeat(100_000);
        assert!(read::<ArrayCalibration>(nested.as_bytes()).is_err());
        for text in [
            "{\"tx\": [[0, 0, 0]], \"rx\": [[0, 0, 0]], \"channels\": []}",
            "{\"tx\": [[0, 0, 1e300]], \"rx\": [[0, 0, 0]], \"channels\": [{}]}",
            "{\"tx\": [[0, 0, 0]], \"rx\": [[0, 0, 0]], \"channels\": [{\"gainDb\": 1e300}]}",
            "{\"tx\": [[0, 0, 0]], \"rx\": [[0, 0, 0]], \"channels\": [{}], \"coupling\": [[]]}",
            "{}",
        ] {
            let calibration: ArrayCalibration = read(text.as_bytes()).unwrap();
            assert!(calibration.check().is_err(), "{text}");
        }
    }
}
