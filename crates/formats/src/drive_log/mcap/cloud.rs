//! Point clouds: `sensor_msgs/PointCloud2`, and `foxglove.PointCloud` as JSON.

use super::quantity::Layout;
use crate::ros::Definitions;
use crate::ros::{NumberKind, Value};
use serde::Deserialize;

/// Most fields that a point has.
const MAX_FIELDS: usize = 1024;

/// The points of a cloud, as they lie in its bytes.
pub(super) struct Cloud<'a> {
    /// Names of the fields, by which [`Layout`] knows them.
    pub layout: Layout,
    fields: Vec<(usize, NumberKind)>,
    is_big_endian: bool,
    width: usize,
    point_step: usize,
    row_step: usize,
    rows: usize,
    data: &'a [u8],
}

impl Cloud<'_> {
    /// The points, each as its numbers by the places of the fields.
    pub fn points(&self) -> impl Iterator<Item = impl Fn(usize) -> Option<f64>> {
        (0..self.rows).flat_map(move |row| {
            (0..self.width).map(move |column| {
                let start = row * self.row_step + column * self.point_step;
                move |place: usize| {
                    let (offset, kind) = self.fields.get(place)?;
                    let own = self.data.get(start..start + self.point_step)?;
                    kind.read(own.get(*offset..)?, self.is_big_endian)
                }
            })
        })
    }

    /// The number of points; nothing where they are not in the data.
    fn checked(self) -> Option<Self> {
        let row = self.width.checked_mul(self.point_step)?;
        if self.rows == 0 || self.width == 0 {
            return Some(Self { rows: 0, ..self });
        }
        let needed = self.row_step.checked_mul(self.rows - 1)?.checked_add(row)?;
        let is_right = self.point_step > 0
            && (self.rows == 1 || self.row_step >= row)
            && needed <= self.data.len();
        is_right.then_some(self)
    }
}

/// Where the parts of a `PointCloud2` stand in its message.
pub(super) struct CloudPaths {
    height: Vec<usize>,
    width: Vec<usize>,
    fields: Vec<usize>,
    name: Vec<usize>,
    offset: Vec<usize>,
    datatype: Vec<usize>,
    is_bigendian: Vec<usize>,
    point_step: Vec<usize>,
    row_step: Vec<usize>,
    data: Vec<usize>,
}

impl CloudPaths {
    /// Of a message that has them.
    pub fn of(definitions: &Definitions) -> Option<Self> {
        use crate::ros::{Field, Kind, Many};
        let path = |name: &str| definitions.path(0, name);
        let fields = path("fields")?;
        let root = definitions.root();
        let Field { kind: Kind::Struct(field), many: Many::Sequence, .. } =
            root.fields.get(*fields.first()?)?
        else {
            return None;
        };
        let of_field = |name: &str| definitions.path(*field, name);
        Some(Self {
            name: of_field("name")?,
            offset: of_field("offset")?,
            datatype: of_field("datatype")?,
            height: path("height")?,
            width: path("width")?,
            fields,
            is_bigendian: path("is_bigendian")?,
            point_step: path("point_step")?,
            row_step: path("row_step")?,
            data: path("data")?,
        })
    }

    /// The cloud of a message; nothing where its points are not in its data.
    pub fn read<'a>(&self, message: &Value<'a>) -> Option<Cloud<'a>> {
        let whole = |path: &[usize]| message.number(path).map(|number| number as usize);
        let given = message.list(&self.fields).get(..).filter(|all| all.len() <= MAX_FIELDS)?;
        let fields = given.iter().map(|field| {
            let kind = point_field(field.number(&self.datatype)? as u8)?;
            Some((field.number(&self.offset)? as usize, kind))
        });
        let names = given.iter().map(|field| field.text(&self.name).unwrap_or_default());
        Cloud {
            layout: Layout::of_names(names),
            // One of an unknown type has no numbers; the others keep their places.
            fields: fields.map(|field| field.unwrap_or((usize::MAX, NumberKind::U8))).collect(),
            is_big_endian: message.number(&self.is_bigendian)? != 0.0,
            width: whole(&self.width)?,
            rows: whole(&self.height)?,
            point_step: whole(&self.point_step)?,
            row_step: whole(&self.row_step)?,
            data: message.bytes(&self.data)?,
        }
        .checked()
    }
}

/// The type of a `sensor_msgs/PointField`.
fn point_field(number: u8) -> Option<NumberKind> {
    use NumberKind::{F32, F64, I8, I16, I32, U8, U16, U32};
    [I8, U8, I16, U16, I32, U32, F32, F64].get(usize::from(number).checked_sub(1)?).copied()
}

/// The type of a field of Foxglove's.
fn packed_field(number: u8) -> Option<NumberKind> {
    use NumberKind::{F32, F64, I8, I16, I32, U8, U16, U32};
    [U8, I8, U16, I16, U32, I32, F32, F64].get(usize::from(number).checked_sub(1)?).copied()
}

/// `foxglove.PointCloud` as JSON.
#[derive(Deserialize)]
pub(super) struct JsonCloud {
    timestamp: Option<JsonTime>,
    #[serde(default)]
    pub frame_id: String,
    point_stride: usize,
    fields: Vec<JsonField>,
    data: String,
}

#[derive(Deserialize)]
struct JsonTime {
    sec: i64,
    nsec: i64,
}

#[derive(Deserialize)]
struct JsonField {
    name: String,
    offset: usize,
    #[serde(rename = "type")]
    kind: u8,
}

impl JsonCloud {
    pub fn read(message: &[u8]) -> Option<Self> {
        serde_json::from_slice(message).ok()
    }

    /// Its time, ns.
    pub fn time_ns(&self) -> Option<i64> {
        let JsonTime { sec, nsec } = self.timestamp.as_ref()?;
        sec.checked_mul(1_000_000_000)?.checked_add(*nsec)
    }

    /// The bytes of its points.
    pub fn data(&self) -> Option<Vec<u8>> {
        from_base64(&self.data)
    }

    /// Its points, in the bytes of [`Self::data`].
    pub fn cloud<'a>(&self, data: &'a [u8]) -> Option<Cloud<'a>> {
        let given = self.fields.get(..).filter(|all| all.len() <= MAX_FIELDS)?;
        let fields = given.iter().map(|field| {
            packed_field(field.kind)
                .map_or((usize::MAX, NumberKind::U8), |kind| (field.offset, kind))
        });
        Cloud {
            layout: Layout::of_names(given.iter().map(|field| &*field.name)),
            fields: fields.collect(),
            is_big_endian: false,
            width: data.len().checked_div(self.point_stride)?,
            rows: 1,
            point_step: self.point_stride,
            row_step: 0,
            data,
        }
        .checked()
    }
}

/// Bytes of base64, with or without padding at the end.
fn from_base64(text: &str) -> Option<Vec<u8>> {
    let digits = text.trim_end_matches('=').as_bytes();
    let mut bytes = Vec::with_capacity(digits.len() / 4 * 3 + 3);
    for group in digits.chunks(4) {
        let mut bits = 0_u32;
        for &digit in group {
            let value = match digit {
                b'A'..=b'Z' => digit - b'A',
                b'a'..=b'z' => digit - b'a' + 26,
                b'0'..=b'9' => digit - b'0' + 52,
                b'+' => 62,
                b'/' => 63,
                _ => return None,
            };
            bits = bits << 6 | u32::from(value);
        }
        let missing = 4 - group.len();
        let [_, whole @ ..] = (bits << (6 * missing)).to_be_bytes();
        bytes.extend_from_slice(whole.get(..3_usize.checked_sub(missing)?)?);
    }
    Some(bytes)
}

#[cfg(test)]
mod tests {
    use super::from_base64;

    #[test]
    fn base64_as_rfc_4648_has_it() {
        for (text, bytes) in
            [("", ""), ("Zg==", "f"), ("Zm8=", "fo"), ("Zm9v", "foo"), ("Zm9vYmFy", "foobar")]
        {
            assert_eq!(from_base64(text).unwrap(), bytes.as_bytes());
        }
        assert_eq!(from_base64("+/8=").unwrap(), [0xfb, 0xff]);
        assert!(from_base64("Z").is_none_or(|bytes| bytes.is_empty()));
        assert!(from_base64("Zm9?").is_none());
    }
}
