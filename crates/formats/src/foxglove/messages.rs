//! Messages of Foxglove's schemas, with their names and units: SI and radians, fields as they are called there.

use boresight_options::{Described, Kind, Special};
use serde::{Serialize, Serializer};

/// A name of Foxglove's for a number.
macro_rules! numbered {
    ($(#[$of_all:meta])* $name:ident {
        $(#[$of_first:meta])* $first:ident = $first_number:literal $first_title:literal,
        $($(#[$of_one:meta])* $one:ident = $number:literal $title:literal,)*
    }) => {
        $(#[$of_all])*
        #[derive(Debug, Clone, Copy, PartialEq, Eq)]
        pub enum $name {
            $(#[$of_first])*
            $first = $first_number,
            $($(#[$of_one])* $one = $number,)*
        }

        impl Serialize for $name {
            fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
                serializer.serialize_u8(*self as u8)
            }
        }

        impl Described for $name {
            const KIND: Kind = Kind::Special(&Special {
                expected: "a number that names something",
                typescript: "number",
                schema: concat!(
                    "{\"oneOf\":[{\"title\":\"", $first_title, "\",\"const\":", $first_number, "}",
                    $(",{\"title\":\"", $title, "\",\"const\":", $number, "}",)*
                    "]}"
                ),
                flag: "",
            });
        }
    };
}

numbered! {
    /// How a number of a point is stored.
    NumericType {
        /// One byte from 0.
        Uint8 = 1 "UINT8",
        /// Single precision.
        Float32 = 7 "FLOAT32",
    }
}

numbered! {
    /// How grave a message is.
    LogLevel {
        /// To know.
        Info = 2 "INFO",
        /// To look after.
        Warning = 3 "WARNING",
        /// Something failed.
        Error = 4 "ERROR",
    }
}

numbered! {
    /// How points make lines.
    LineType {
        /// Each with the next.
        Strip = 0 "LINE_STRIP",
        /// Each with the next, and the last with the first.
        Loop = 1 "LINE_LOOP",
        /// Two a line.
        List = 2 "LINE_LIST",
    }
}

/// A time of the log.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Described, Serialize)]
pub struct Time {
    /// Whole seconds.
    pub sec: u32,
    /// Nanoseconds beyond them.
    pub nsec: u32,
}

/// A place or a way in space, m.
#[derive(Debug, Clone, Copy, PartialEq, Default, Described, Serialize)]
pub struct Vector3 {
    /// Ahead.
    pub x: f64,
    /// To the left.
    pub y: f64,
    /// Up.
    pub z: f64,
}

/// A rotation.
#[derive(Debug, Clone, Copy, PartialEq, Described, Serialize)]
pub struct Quaternion {
    /// About x.
    pub x: f64,
    /// About y.
    pub y: f64,
    /// About z.
    pub z: f64,
    /// The real part.
    pub w: f64,
}

impl Quaternion {
    /// A turn to the left, rad.
    #[must_use]
    pub fn yaw(yaw_rad: f64) -> Self {
        let (sin, cos) = (0.5 * yaw_rad).sin_cos();
        Self { x: 0.0, y: 0.0, z: sin, w: cos }
    }
}

/// Where something is, and how it is turned.
#[derive(Debug, Clone, Copy, PartialEq, Described, Serialize)]
#[option(name = "SpacePose")]
pub struct Pose {
    /// Where.
    pub position: Vector3,
    /// How.
    pub orientation: Quaternion,
}

impl Pose {
    /// That of a frame in itself.
    pub const OWN: Self = Self {
        position: Vector3 { x: 0.0, y: 0.0, z: 0.0 },
        orientation: Quaternion { x: 0.0, y: 0.0, z: 0.0, w: 1.0 },
    };

    /// At a place of the frame, not turned.
    #[must_use]
    pub fn at(x: f64, y: f64, z: f64) -> Self {
        Self { position: Vector3 { x, y, z }, ..Self::OWN }
    }
}

/// A number that each point has.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Described, Serialize)]
pub struct PackedElementField {
    /// What it is.
    pub name: &'static str,
    /// Bytes before it.
    pub offset: u32,
    /// How it is stored.
    #[serde(rename = "type")]
    pub of: NumericType,
}

/// Bytes, in base64.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Base64(pub Vec<u8>);

impl Serialize for Base64 {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_str(&data_encoding::BASE64.encode_display(&self.0))
    }
}

impl Described for Base64 {
    const KIND: Kind = Kind::Special(&Special {
        expected: "bytes in base64",
        typescript: "string",
        schema: "{\"type\":\"string\",\"contentEncoding\":\"base64\"}",
        flag: "",
    });
}

/// Points with numbers of each.
#[derive(Debug, Clone, PartialEq, Described, Serialize)]
pub struct PointCloud {
    /// When they were measured.
    pub timestamp: Time,
    /// The frame they are in.
    pub frame_id: String,
    /// Where their origin is in that frame.
    pub pose: Pose,
    /// Bytes of a point.
    pub point_stride: u32,
    /// Numbers of a point.
    pub fields: Vec<PackedElementField>,
    /// Points, one after the other, little-endian.
    pub data: Base64,
}

/// Where a frame is in another one.
#[derive(Debug, Clone, PartialEq, Described, Serialize)]
pub struct FrameTransform {
    /// Since when.
    pub timestamp: Time,
    /// The other one.
    pub parent_frame_id: String,
    /// The frame.
    pub child_frame_id: String,
    /// Where its origin is.
    pub translation: Vector3,
    /// How it is turned.
    pub rotation: Quaternion,
}

/// A line of a log.
#[derive(Debug, Clone, PartialEq, Described, Serialize)]
pub struct Log {
    /// When.
    pub timestamp: Time,
    /// How grave.
    pub level: LogLevel,
    /// What to know.
    pub message: String,
    /// Of what.
    pub name: String,
    /// Source, which is not told.
    pub file: String,
    /// Its line, which is not told.
    pub line: u32,
}

/// A colour, each part from 0 to 1.
#[derive(Debug, Clone, Copy, PartialEq, Described, Serialize)]
pub struct Color {
    /// Red.
    pub r: f64,
    /// Green.
    pub g: f64,
    /// Blue.
    pub b: f64,
    /// How little shines through.
    pub a: f64,
}

/// A block.
#[derive(Debug, Clone, Copy, PartialEq, Described, Serialize)]
pub struct CubePrimitive {
    /// Its middle.
    pub pose: Pose,
    /// Its lengths, m.
    pub size: Vector3,
    /// Its colour.
    pub color: Color,
}

/// Lines.
#[derive(Debug, Clone, PartialEq, Described, Serialize)]
pub struct LinePrimitive {
    /// How points make lines.
    #[serde(rename = "type")]
    pub of: LineType,
    /// Where their origin is.
    pub pose: Pose,
    /// Pixels where they do not scale, m otherwise.
    pub thickness: f64,
    /// Whether they are as thick from afar.
    pub scale_invariant: bool,
    /// The points.
    pub points: Vec<Vector3>,
    /// Colour of all.
    pub color: Color,
    /// Colours of points; none.
    pub colors: Vec<Color>,
    /// Order of points; as they come.
    pub indices: Vec<u32>,
}

/// Something to see.
#[derive(Debug, Clone, PartialEq, Described, Serialize)]
pub struct SceneEntity {
    /// When it was there.
    pub timestamp: Time,
    /// The frame it is in.
    pub frame_id: String,
    /// What it replaces of the same topic.
    pub id: String,
    /// How long it is shown; zero for always.
    pub lifetime: Time,
    /// Whether it moves with its frame.
    pub frame_locked: bool,
    /// Blocks.
    pub cubes: Vec<CubePrimitive>,
    /// Lines.
    pub lines: Vec<LinePrimitive>,
}

/// What changes of what is to be seen.
#[derive(Debug, Clone, PartialEq, Described, Serialize)]
pub struct SceneUpdate {
    /// What is new or replaced.
    pub entities: Vec<SceneEntity>,
}
