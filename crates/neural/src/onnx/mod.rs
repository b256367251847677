//! ONNX files: read, and checked before tract sees them.
//!
//! What tract takes on trust from a file (lengths, names, arities) is checked here, so that a bad file gives an error
//! that says what is wrong with it, and never a panic.

mod axes;
mod graph;
mod operators;
mod outline;
mod tensor;

use crate::error::NeuralError;
use boresight_core::InputError;
use tract_onnx::pb::ModelProto;
use tract_onnx::prelude::Framework;

/// Largest file.
pub(crate) const MAX_BYTES: usize = 256 << 20;

/// Reads and checks a model.
///
/// # Errors
/// [`NeuralError`] telling what is wrong with the file.
pub(crate) fn read(bytes: &[u8]) -> Result<ModelProto, NeuralError> {
    if bytes.len() > MAX_BYTES {
        return Err(NeuralError::Argument(InputError::OutOfRange {
            what: "size of the ONNX file, bytes".into(),
            expected: format!("at most {MAX_BYTES}"),
            given: bytes.len() as f64,
        }));
    }
    outline::check(bytes)?;
    let mut reader = bytes;
    let proto = tract_onnx::onnx().proto_model_for_read(&mut reader).map_err(|error| {
        malformed("protobuf messages", "well-formed ones", format!("{:#}", error.root_cause()))
    })?;
    graph::check(&proto)?;
    Ok(proto)
}

fn malformed(
    what: impl Into<String>,
    expected: impl Into<String>,
    given: impl Into<String>,
) -> NeuralError {
    NeuralError::Malformed { what: what.into(), expected: expected.into(), given: given.into() }
}
