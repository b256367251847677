//! The nesting of a file's protobuf messages, looked through without reading them.

use super::malformed;
use crate::error::NeuralError;

/// Most messages in a file; each takes up to 300 bytes of memory for 2 of the file.
const MAX_MESSAGES: usize = 1 << 18;

/// Deepest nesting.
const MAX_DEPTH: usize = 16;

/// Wire types of protobuf.
const VARINT: u64 = 0;
const EIGHT_BYTES: u64 = 1;
const LENGTH: u64 = 2;
const FOUR_BYTES: u64 = 5;

/// Messages of which a small file can hold many.
#[derive(Clone, Copy)]
enum Message {
    Model,
    Graph,
    Node,
    Attribute,
    Leaf,
}

impl Message {
    fn child(self, field: u64) -> Self {
        match (self, field) {
            (Self::Model, 7) | (Self::Attribute, 6 | 11) => Self::Graph,
            (Self::Graph, 1) => Self::Node,
            (Self::Node, 5) => Self::Attribute,
            _ => Self::Leaf,
        }
    }
}

/// Checks that the bytes are a model's fields, whole, and not too many.
pub(super) fn check(bytes: &[u8]) -> Result<(), NeuralError> {
    let not_onnx = |given: &str| NeuralError::NotOnnx { given: given.into() };
    if bytes.is_empty() {
        return Err(not_onnx("there are no bytes"));
    }
    let first = Fields { bytes, at: 0 }.next();
    // Fields of ModelProto, numbers first.
    let known = |field: &Field| match field.wire {
        VARINT => matches!(field.number, 1 | 5),
        LENGTH => matches!(field.number, 2 | 3 | 4 | 6 | 7 | 8 | 14 | 20 | 25),
        _ => false,
    };
    match first {
        Some(Ok(field)) if known(&field) => {}
        Some(Err(Fault::Overrun(_))) if bytes[0] == 0x08 => {}
        _ => return Err(not_onnx("it does not begin with a field of a model")),
    }
    let mut messages = 0;
    walk(bytes, Message::Model, 0, &mut messages).map_err(|fault| match fault {
        Fault::Overrun(missing) => {
            NeuralError::Truncated { expected: bytes.len() + missing, given: bytes.len() }
        }
        Fault::Malformed => malformed("protobuf fields", "well-formed ones", "others"),
        Fault::TooMany => malformed(
            "number or depth of messages",
            format!("at most {MAX_MESSAGES}, {MAX_DEPTH} deep"),
            "more",
        ),
    })
}

fn walk(bytes: &[u8], message: Message, depth: usize, messages: &mut usize) -> Result<(), Fault> {
    if depth > MAX_DEPTH {
        return Err(Fault::TooMany);
    }
    for field in (Fields { bytes, at: 0 }) {
        let field = match field {
            // Only the whole file can be cut short.
            Err(Fault::Overrun(_)) if depth > 0 => return Err(Fault::Malformed),
            other => other?,
        };
        if field.wire == LENGTH {
            *messages += 1;
            if *messages > MAX_MESSAGES {
                return Err(Fault::TooMany);
            }
            let child = message.child(field.number);
            if !matches!(child, Message::Leaf) {
                walk(field.content, child, depth + 1, messages)?;
            }
        }
    }
    Ok(())
}

struct Field<'a> {
    number: u64,
    wire: u64,
    content: &'a [u8],
}

enum Fault {
    /// This many bytes are missing.
    Overrun(usize),
    Malformed,
    TooMany,
}

/// Fields of one message.
struct Fields<'a> {
    bytes: &'a [u8],
    at: usize,
}

impl<'a> Fields<'a> {
    fn varint(&mut self) -> Result<u64, Fault> {
        let mut value = 0u64;
        for shift in (0..64).step_by(7) {
            let byte = *self.bytes.get(self.at).ok_or(Fault::Overrun(1))?;
            self.at += 1;
            value |= u64::from(byte & 0x7f) << shift;
            if byte < 0x80 {
                return Ok(value);
            }
        }
        Err(Fault::Malformed)
    }

    fn take(&mut self, count: u64) -> Result<&'a [u8], Fault> {
        let left = self.bytes.len() - self.at;
        let count = usize::try_from(count).map_err(|_| Fault::Malformed)?;
        if count > left {
            return Err(Fault::Overrun(count - left));
        }
        self.at += count;
        Ok(&self.bytes[self.at - count..self.at])
    }

    fn field(&mut self) -> Result<Field<'a>, Fault> {
        let key = self.varint()?;
        let (number, wire) = (key >> 3, key & 7);
        let content = match wire {
            VARINT => {
                self.varint()?;
                &[]
            }
            EIGHT_BYTES => self.take(8)?,
            LENGTH => {
                let length = self.varint()?;
                self.take(length)?
            }
            FOUR_BYTES => self.take(4)?,
            _ => return Err(Fault::Malformed),
        };
        if number == 0 {
            return Err(Fault::Malformed);
        }
        Ok(Field { number, wire, content })
    }
}

impl<'a> Iterator for Fields<'a> {
    type Item = Result<Field<'a>, Fault>;

    fn next(&mut self) -> Option<Self::Item> {
        if self.at >= self.bytes.len() {
            return None;
        }
        let field = self.field();
        if field.is_err() {
            self.at = self.bytes.len();
        }
        Some(field)
    }
}
