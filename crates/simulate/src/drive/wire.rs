//! Radars and misalignments by number, as serde carries them.

use boresight_core::drive::Mounting;
use boresight_options::{Described, Flat, Kind, Special};
use serde::{Deserialize, Serialize};

/// A radar of a simulated drive.
#[derive(Debug, Clone, Copy, PartialEq, Described, Serialize, Deserialize)]
pub struct PlacedRadar {
    /// Its number.
    pub id: u8,
    /// Where it truly sits and which way it looks.
    pub mounting: Flat<Mounting>,
}

/// Radars as a list of [`PlacedRadar`].
pub mod sensors {
    use super::{Mounting, PlacedRadar};
    use serde::{Deserialize, Deserializer, Serialize, Serializer};

    /// Writes them.
    ///
    /// # Errors
    /// Those of the serializer.
    pub fn serialize<S: Serializer>(
        radars: &[(u8, Mounting)],
        serializer: S,
    ) -> Result<S::Ok, S::Error> {
        let placed: Vec<PlacedRadar> = radars
            .iter()
            .map(|&(id, mounting)| PlacedRadar { id, mounting: mounting.into() })
            .collect();
        placed.serialize(serializer)
    }

    /// Reads them.
    ///
    /// # Errors
    /// Those of the deserializer.
    pub fn deserialize<'de, D: Deserializer<'de>>(
        deserializer: D,
    ) -> Result<Vec<(u8, Mounting)>, D::Error> {
        let placed = Vec::<PlacedRadar>::deserialize(deserializer)?;
        Ok(placed.into_iter().map(|radar| (radar.id, *radar.mounting)).collect())
    }
}

/// Angles by the number of a radar.
pub struct Misalignments;

impl Described for Misalignments {
    const KIND: Kind = Kind::Special(&Special {
        expected: "{ [number of a radar]: degrees }",
        typescript: "{ readonly [sensor: number]: number }",
        schema: r#"{ "type": "object", "additionalProperties": { "type": "number", "minimum": -90, "maximum": 90 } }"#,
        flag: "N=DEG",
    });
}

/// Angles as a map from the number of the radar.
pub mod misalignments {
    use serde::de::{Error, MapAccess, Visitor};
    use serde::{Deserializer, Serializer};

    /// Writes them.
    ///
    /// # Errors
    /// Those of the serializer.
    pub fn serialize<S: Serializer>(
        angles: &[(u8, f64)],
        serializer: S,
    ) -> Result<S::Ok, S::Error> {
        serializer.collect_map(angles.iter().map(|(id, angle)| (id.to_string(), angle)))
    }

    /// Reads them.
    ///
    /// # Errors
    /// Those of the deserializer; a key that is no number from 0 to 255.
    pub fn deserialize<'de, D: Deserializer<'de>>(
        deserializer: D,
    ) -> Result<Vec<(u8, f64)>, D::Error> {
        deserializer.deserialize_map(Angles)
    }

    struct Angles;

    impl<'de> Visitor<'de> for Angles {
        type Value = Vec<(u8, f64)>;

        fn expecting(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
            f.write_str("{ [number of a radar]: degrees }")
        }

        fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<Self::Value, A::Error> {
            let mut angles = vec![];
            while let Some(key) = map.next_key::<String>()? {
                let id = key.parse().map_err(|_| {
                    A::Error::invalid_value(serde::de::Unexpected::Str(&key), &self)
                })?;
                angles.push((id, map.next_value()?));
            }
            Ok(angles)
        }
    }
}
