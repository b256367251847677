//! Messages made for tests, by the rules of CDR, apart from what reads them.

/// A message that is written.
pub struct Cdr {
    bytes: Vec<u8>,
    is_big_endian: bool,
    /// As ROS 1 writes: without a head, and with nothing between numbers.
    is_plain: bool,
}

impl Cdr {
    pub fn new() -> Self {
        Self { bytes: vec![0, 1, 0, 0], is_big_endian: false, is_plain: false }
    }

    pub fn big_endian() -> Self {
        Self { bytes: vec![0, 0, 0, 0], is_big_endian: true, is_plain: false }
    }

    pub fn ros1() -> Self {
        Self { bytes: vec![], is_big_endian: false, is_plain: true }
    }

    fn put<const N: usize>(mut self, bytes: [u8; N]) -> Self {
        if !self.is_plain {
            while !(self.bytes.len() - 4).is_multiple_of(N) {
                self.bytes.push(0);
            }
        }
        let mut bytes = bytes;
        if self.is_big_endian {
            bytes.reverse();
        }
        self.bytes.extend(bytes);
        self
    }

    pub fn u8(self, number: u8) -> Self {
        self.put([number])
    }

    pub fn u16(self, number: u16) -> Self {
        self.put(number.to_le_bytes())
    }

    pub fn u32(self, number: u32) -> Self {
        self.put(number.to_le_bytes())
    }

    pub fn f32(self, number: f32) -> Self {
        self.put(number.to_le_bytes())
    }

    pub fn f64(self, number: f64) -> Self {
        self.put(number.to_le_bytes())
    }

    pub fn f64s(self, numbers: &[f64]) -> Self {
        numbers.iter().fold(self, |cdr, number| cdr.f64(*number))
    }

    pub fn text(self, text: &str) -> Self {
        let end = usize::from(!self.is_plain);
        let mut cdr = self.u32((text.len() + end) as u32);
        cdr.bytes.extend(text.bytes());
        cdr.bytes.resize(cdr.bytes.len() + end, 0);
        cdr
    }

    pub fn bytes(self, bytes: &[u8]) -> Self {
        let mut cdr = self.u32(bytes.len() as u32);
        cdr.bytes.extend(bytes);
        cdr
    }

    /// `std_msgs/Header` of a time in ns.
    pub fn header(self, time_ns: u64, frame: &str) -> Self {
        let (seconds, nanoseconds) = (time_ns / 1_000_000_000, time_ns % 1_000_000_000);
        let own = if self.is_plain { self.u32(0) } else { self };
        own.u32(seconds as u32).u32(nanoseconds as u32).text(frame)
    }

    pub fn done(self) -> Vec<u8> {
        self.bytes
    }
}

/// What stands before each further type.
pub const LINE: &str =
    "================================================================================\n";

/// A definition and those it holds.
pub fn definition(own: &str, others: &[(&str, &str)]) -> String {
    let others = others.iter().map(|(name, text)| format!("{LINE}MSG: {name}\n{text}\n"));
    format!("{own}\n{}", others.collect::<String>())
}

pub const HEADER: (&str, &str) =
    ("std_msgs/Header", "# When.\nbuiltin_interfaces/Time stamp\nstring frame_id");
pub const TIME: (&str, &str) = ("builtin_interfaces/Time", "int32 sec\nuint32 nanosec");
pub const VECTOR: (&str, &str) = ("geometry_msgs/Vector3", "float64 x\nfloat64 y\nfloat64 z");
pub const QUATERNION: (&str, &str) =
    ("geometry_msgs/Quaternion", "float64 x 0\nfloat64 y 0\nfloat64 z 0\nfloat64 w 1");
