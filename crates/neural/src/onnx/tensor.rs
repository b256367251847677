//! Constants of a graph: as many numbers as their shape says, none of them NaN.

use super::malformed;
use crate::error::NeuralError;
use tract_onnx::pb::TensorProto;
use tract_onnx::pb::tensor_proto::{DataLocation, DataType};

/// Most numbers in one tensor, stored or intermediate.
pub(super) const MAX_NUMBERS: usize = 1 << 26;

/// Number of entries of a shape, if it is one and not too large.
pub(super) fn numbers(dims: impl IntoIterator<Item = i64>) -> Option<usize> {
    dims.into_iter().try_fold(1usize, |product, dim| {
        let product = product.checked_mul(usize::try_from(dim).ok()?)?;
        (product <= MAX_NUMBERS).then_some(product)
    })
}

/// Checks a tensor's type, shape and numbers.
pub(super) fn check(tensor: &TensorProto, name: &str) -> Result<(), NeuralError> {
    let what = || format!("tensor {name:?}");
    if tensor.data_location == Some(DataLocation::External as i32)
        || !tensor.external_data.is_empty()
    {
        return Err(malformed(what(), "its numbers in the file itself", "a reference to a file"));
    }
    let Some(count) = numbers(tensor.dims.iter().copied()) else {
        let expected = format!("a shape of at most {MAX_NUMBERS} numbers");
        return Err(malformed(what(), expected, format!("{:?}", tensor.dims)));
    };
    let typed = || {
        let data_type = DataType::try_from(tensor.data_type).ok()?;
        Some(match data_type {
            DataType::Float => (4, tensor.float_data.len()),
            DataType::Double => (8, tensor.double_data.len()),
            DataType::Int64 => (8, tensor.int64_data.len()),
            DataType::Int32 => (4, tensor.int32_data.len()),
            DataType::Float16 | DataType::Int16 | DataType::Uint16 => (2, tensor.int32_data.len()),
            DataType::Bool | DataType::Int8 | DataType::Uint8 => (1, tensor.int32_data.len()),
            _ => return None,
        })
    };
    let Some((bytes, listed)) = typed() else {
        let given = format!("type {}", tensor.data_type);
        return Err(malformed(what(), "floating-point numbers, integers or booleans", given));
    };
    let raw = tensor.raw_data.len();
    let fits = if raw > 0 { raw == count * bytes } else { listed == count };
    if !fits {
        let given = if raw > 0 { format!("{raw} bytes") } else { format!("{listed} numbers") };
        return Err(malformed(what(), format!("{count} numbers of {bytes} bytes"), given));
    }
    match nan(tensor) {
        true => Err(NeuralError::NotFinite { what: what(), given: f32::NAN }),
        false => Ok(()),
    }
}

/// Whether a number of a tensor is NaN. Infinities have their use, as masks.
fn nan(tensor: &TensorProto) -> bool {
    let words = |size: usize| tensor.raw_data.chunks_exact(size);
    let half = |bits: u16| bits & 0x7fff > 0x7c00;
    match DataType::try_from(tensor.data_type) {
        Ok(DataType::Float) => {
            let raw = |w: &[u8]| w.try_into().is_ok_and(|w| f32::from_le_bytes(w).is_nan());
            tensor.float_data.iter().any(|x| x.is_nan()) || words(4).any(raw)
        }
        Ok(DataType::Double) => {
            let raw = |w: &[u8]| w.try_into().is_ok_and(|w| f64::from_le_bytes(w).is_nan());
            tensor.double_data.iter().any(|x| x.is_nan()) || words(8).any(raw)
        }
        Ok(DataType::Float16) => {
            let raw = |w: &[u8]| w.try_into().is_ok_and(|w| half(u16::from_le_bytes(w)));
            tensor.int32_data.iter().any(|&x| half(x as u16)) || words(2).any(raw)
        }
        _ => false,
    }
}

/// The integers of a tensor that has been checked.
pub(super) fn integers(tensor: &TensorProto) -> Vec<i64> {
    let words = |size: usize| tensor.raw_data.chunks_exact(size);
    match DataType::try_from(tensor.data_type) {
        Ok(DataType::Int64) if tensor.raw_data.is_empty() => tensor.int64_data.clone(),
        Ok(DataType::Int32) if tensor.raw_data.is_empty() => {
            tensor.int32_data.iter().map(|&x| x.into()).collect()
        }
        Ok(DataType::Int64) => {
            words(8).filter_map(|w| w.try_into().ok().map(i64::from_le_bytes)).collect()
        }
        Ok(DataType::Int32) => words(4)
            .filter_map(|w| w.try_into().ok().map(|w| i32::from_le_bytes(w).into()))
            .collect(),
        _ => Vec::new(),
    }
}
