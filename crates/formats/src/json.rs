//! Results as JSON, in the names and units that JavaScript has them in.

use boresight_core::describe::naming::{is_angle, javascript};
use serde::Serialize;
use serde_json::{Map, Value};

/// A result in the names and units of users; what is not finite becomes null.
pub fn result(value: &impl Serialize) -> Value {
    serde_json::to_value(value).map_or(Value::Null, |value| outside(value, false))
}

/// The fields of a result with further ones beside them.
pub fn beside(value: &impl Serialize, further: Value) -> Value {
    match (result(value), further) {
        (Value::Object(mut own), Value::Object(further)) => {
            own.extend(further);
            Value::Object(own)
        }
        (own, _) => own,
    }
}

fn outside(value: Value, in_radians: bool) -> Value {
    match value {
        Value::Number(number) if in_radians => {
            number.as_f64().map_or(Value::Null, |radians| radians.to_degrees().into())
        }
        Value::Array(items) => items.into_iter().map(|item| outside(item, in_radians)).collect(),
        Value::Object(fields) => {
            let mut renamed = Map::new();
            for (name, value) in fields {
                match outside(value, is_angle(&name)) {
                    // The fields of a field so named stand in its place.
                    Value::Object(inner) if name.starts_with("..") => renamed.extend(inner),
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

#[cfg(test)]
mod tests {
    use super::*;
    use boresight_core::{Direction, Mounting};
    use serde_json::json;

    #[derive(Serialize)]
    struct Seen {
        #[serde(rename = "..direction")]
        direction: Direction,
        range_m: f64,
        mounting: Option<Mounting>,
        unknown_rad: f64,
    }

    #[test]
    fn names_units_and_places_are_those_of_javascript() {
        let seen = Seen {
            direction: Direction::azimuth(std::f64::consts::FRAC_PI_2),
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
}
