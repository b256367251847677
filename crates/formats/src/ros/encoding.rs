//! Numbers, texts and lengths as messages encode them.

use std::borrow::Cow;

/// What a message is that cannot be decoded: what is wrong with it.
pub type Malformed = &'static str;

/// A type of numbers.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[expect(missing_docs, reason = "they are Rust's")]
pub enum NumberKind {
    Bool,
    I8,
    U8,
    I16,
    U16,
    I32,
    U32,
    I64,
    U64,
    F32,
    F64,
}

impl NumberKind {
    /// By the name it has in definitions.
    pub fn of_name(name: &str) -> Option<Self> {
        Some(match name {
            "bool" => Self::Bool,
            "int8" => Self::I8,
            "uint8" | "byte" | "char" => Self::U8,
            "int16" => Self::I16,
            "uint16" => Self::U16,
            "int32" => Self::I32,
            "uint32" => Self::U32,
            "int64" => Self::I64,
            "uint64" => Self::U64,
            "float32" => Self::F32,
            "float64" => Self::F64,
            _ => return None,
        })
    }

    /// Its bytes.
    pub fn size(self) -> usize {
        match self {
            Self::Bool | Self::I8 | Self::U8 => 1,
            Self::I16 | Self::U16 => 2,
            Self::I32 | Self::U32 | Self::F32 => 4,
            Self::I64 | Self::U64 | Self::F64 => 8,
        }
    }

    /// The number at the front of bytes, to 53 bits; `None` where they are too few.
    pub fn read(self, bytes: &[u8], is_big_endian: bool) -> Option<f64> {
        let mut own = [0; 8];
        let size = self.size();
        let held = own.get_mut(..size)?;
        held.copy_from_slice(bytes.get(..size)?);
        if is_big_endian {
            held.reverse();
        }
        let whole = u64::from_le_bytes(own);
        Some(match self {
            Self::Bool | Self::U8 | Self::U16 | Self::U32 | Self::U64 => whole as f64,
            Self::I8 => f64::from(whole as i8),
            Self::I16 => f64::from(whole as i16),
            Self::I32 => f64::from(whole as i32),
            Self::I64 => whole as i64 as f64,
            Self::F32 => f64::from(f32::from_bits(whole as u32)),
            Self::F64 => f64::from_bits(whole),
        })
    }
}

/// How messages are encoded.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Encoding {
    /// The Common Data Representation of DDS, as ROS 2 has it.
    Cdr,
    /// That of ROS 1.
    Ros1,
}

impl Encoding {
    /// By the names of a channel's encoding and of its schema's.
    pub fn of_names(message: &str, schema: &str) -> Option<Self> {
        match (message, schema) {
            ("cdr", "ros2msg") => Some(Self::Cdr),
            ("ros1", "ros1msg") => Some(Self::Ros1),
            _ => None,
        }
    }
}

/// A message while it is decoded.
pub(super) struct Reader<'a> {
    bytes: &'a [u8],
    at: usize,
    pub is_big_endian: bool,
    /// Numbers lie at multiples of their size, up to this.
    alignment: usize,
    pub encoding: Encoding,
}

impl<'a> Reader<'a> {
    pub fn new(message: &'a [u8], encoding: Encoding) -> Result<Self, Malformed> {
        let plain = Self { bytes: message, at: 0, is_big_endian: false, alignment: 1, encoding };
        if encoding == Encoding::Ros1 {
            return Ok(plain);
        }
        // Two bytes for the representation, two for options.
        let [0, kind, _, _, bytes @ ..] = message else {
            return Err("its first bytes are none of CDR");
        };
        let (is_big_endian, alignment) = match kind {
            0 => (true, 8),
            1 => (false, 8),
            6 => (true, 4),
            7 => (false, 4),
            _ => return Err("it is in a representation other than plain CDR"),
        };
        Ok(Self { bytes, is_big_endian, alignment, ..plain })
    }

    pub fn left(&self) -> usize {
        self.bytes.len() - self.at
    }

    fn take(&mut self, count: usize) -> Result<&'a [u8], Malformed> {
        let rest = self.bytes.get(self.at..).unwrap_or_default();
        let (taken, _) = rest.split_at_checked(count).ok_or("it ends early")?;
        self.at += count;
        Ok(taken)
    }

    fn align(&mut self, size: usize) -> Result<(), Malformed> {
        let to = size.min(self.alignment);
        self.take(self.at.next_multiple_of(to) - self.at).map(|_| ())
    }

    pub fn number(&mut self, kind: NumberKind) -> Result<f64, Malformed> {
        self.align(kind.size())?;
        let bytes = self.take(kind.size())?;
        kind.read(bytes, self.is_big_endian).ok_or("it ends early")
    }

    /// A number of values or bytes, of which each takes at least one byte.
    pub fn length(&mut self) -> Result<usize, Malformed> {
        let length = self.number(NumberKind::U32)? as usize;
        if length > self.left() { Err("it states more values than it holds") } else { Ok(length) }
    }

    /// The bytes of numbers of a kind.
    pub fn numbers(&mut self, kind: NumberKind, count: usize) -> Result<&'a [u8], Malformed> {
        if count == 0 {
            return Ok(&[]);
        }
        self.align(kind.size())?;
        self.take(count.checked_mul(kind.size()).ok_or("it states more values than it holds")?)
    }

    pub fn text(&mut self) -> Result<Cow<'a, str>, Malformed> {
        let length = self.length()?;
        let bytes = self.take(length)?;
        let text = match self.encoding {
            Encoding::Cdr => bytes.strip_suffix(&[0]).unwrap_or(bytes),
            Encoding::Ros1 => bytes,
        };
        Ok(String::from_utf8_lossy(text))
    }

    /// Passes over wide text, of which vendors have two encodings, so that nothing can follow it.
    pub fn wide_text(&mut self) -> Result<Cow<'a, str>, Malformed> {
        Err("it holds wide text, whose encoding is not defined")
    }
}
