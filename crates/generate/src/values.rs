//! Values as users see them.

use boresight_options::naming;
use boresight_options::{Field, Range};
use serde_json::Value;

/// A default in the units that users give: angles in degrees; nothing for none.
pub fn in_user_units(field: &Field, value: &Value) -> Option<Value> {
    match value {
        Value::Null | Value::Object(_) => None,
        Value::Number(number) => {
            let number = number.as_f64()?;
            Some(plain(if naming::is_angle(field.name) {
                naming::in_degrees(number)
            } else {
                number
            }))
        }
        Value::Array(items) => items
            .iter()
            .map(|item| in_user_units(field, item))
            .collect::<Option<_>>()
            .map(Value::Array),
        other => Some(other.clone()),
    }
}

/// A number, whole where it is.
pub fn plain(number: f64) -> Value {
    if number.fract() == 0.0 && number.abs() < 1e15 {
        return Value::from(number as i64);
    }
    Value::from(number)
}

/// A range in words; nothing without limits.
pub fn range(range: Range) -> String {
    let Range { low, high, above_low } = range;
    match (above_low, high == f64::INFINITY) {
        (true, _) => format!("more than {}", plain(low)),
        (false, true) => format!("at least {}", plain(low)),
        (false, false) => format!("{} to {}", plain(low), plain(high)),
    }
}
