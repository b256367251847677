//! Options of trials from end to end.

use crate::entrants::Network;
use crate::error::EvaluateError;
use boresight_math::error::check_range;
use boresight_neural::Kind;
use boresight_pipeline::regions::RegionChainOptions;
use serde::{Deserialize, Serialize};

/// How frames become regions, in place of being told the strongest bin and the number of targets.
///
/// A scene is counted as what its regions hold together. Angles are those of a network where the flow counts as many
/// targets as there are; where it does not, the network has not found them.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "camelCase")]
pub struct EndToEnd {
    /// The network that counts for those that estimate angles.
    pub counting: Network,
    /// Targets are put around this azimuth, deg, in place of boresight: their sines lie as far from its sine as those
    /// of whole degrees do from 0. Errors are of these degrees.
    pub centre_deg: f64,
    /// Detection and regions.
    #[serde(with = "in_records")]
    pub regions: RegionChainOptions,
}

/// Serde functions for stored records, in which the region size is named `..size`.
mod in_records {
    use boresight_pipeline::regions::RegionChainOptions;
    use serde::{Deserialize, Deserializer, Serialize, Serializer, de, ser};
    use serde_json::Value;

    const STORED: &str = "..size";
    const OWN: &str = "size";

    pub fn serialize<S: Serializer>(
        options: &RegionChainOptions,
        serializer: S,
    ) -> Result<S::Ok, S::Error> {
        let value = serde_json::to_value(options).map_err(ser::Error::custom)?;
        renamed(value, OWN, STORED).serialize(serializer)
    }

    pub fn deserialize<'de, D: Deserializer<'de>>(
        deserializer: D,
    ) -> Result<RegionChainOptions, D::Error> {
        let value = renamed(Value::deserialize(deserializer)?, STORED, OWN);
        serde_json::from_value(value).map_err(de::Error::custom)
    }

    fn renamed(mut value: Value, from: &str, to: &str) -> Value {
        if let Value::Object(fields) = &mut value
            && let Some(inner) = fields.remove(from)
        {
            fields.insert(to.into(), inner);
        }
        value
    }
}

impl EndToEnd {
    pub(super) fn check(&self) -> Result<(), EvaluateError> {
        // The farthest target still lies before the array.
        check_range("centre_deg", self.centre_deg, -50.0, 50.0)?;
        self.regions.check()?;
        if self.counting.kind != Kind::Counting {
            let given = self.counting.name.clone();
            let (what, expected) = ("counting network".into(), "one that counts".into());
            return Err(boresight_core::InputError::Incompatible { what, expected, given }.into());
        }
        Ok(())
    }

    /// The azimuth of a target at some degrees from the centre, rad.
    pub(super) fn azimuth_rad(&self, offset_deg: f64) -> f64 {
        if self.centre_deg == 0.0 {
            return offset_deg.to_radians();
        }
        (offset_deg.to_radians().sin() + self.centre_deg.to_radians().sin()).asin()
    }

    /// The other way round: degrees from the centre, in radians.
    pub(super) fn offset_rad(&self, azimuth_rad: f64) -> f64 {
        if self.centre_deg == 0.0 {
            return azimuth_rad;
        }
        (azimuth_rad.sin() - self.centre_deg.to_radians().sin()).clamp(-1.0, 1.0).asin()
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    #[derive(Debug, PartialEq, Serialize, Deserialize)]
    struct Stored(#[serde(with = "in_records")] RegionChainOptions);

    #[test]
    fn records_name_the_region_size_as_stored_records_do() {
        let mut options = RegionChainOptions::default();
        options.size.bins += 2;
        let stored = Stored(options);
        let value = serde_json::to_value(&stored).unwrap();
        assert_eq!(value["..size"]["bins"], options.size.bins);
        assert!(value.get("size").is_none());
        assert_eq!(serde_json::from_value::<Stored>(value).unwrap(), stored);
    }
}
