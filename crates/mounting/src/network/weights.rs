//! Files of weights, version 1: `research/training/boresight_training/drives/weights_file.py` has the format.

use super::NetworkError;
use std::collections::BTreeMap;

const MAGIC: &[u8; 8] = b"BORESMOT";
const VERSION: u32 = 1;
const CHECKSUM: usize = 4;

/// Tensors by name.
#[derive(Debug, Clone, PartialEq)]
pub struct Weights {
    tensors: BTreeMap<String, Tensor>,
}

#[derive(Debug, Clone, PartialEq)]
struct Tensor {
    shape: Vec<usize>,
    values: Vec<f32>,
}

impl Weights {
    /// Reads a file.
    ///
    /// # Errors
    /// [`NetworkError::Malformed`] for other bytes, another version, and a file that was damaged;
    /// [`NetworkError::NotFinite`] for numbers that are not finite.
    pub fn read(bytes: &[u8]) -> Result<Self, NetworkError> {
        let malformed = |expected: &str, given: String| NetworkError::Malformed {
            expected: expected.into(),
            given,
        };
        let Some((body, checksum)) = bytes
            .split_last_chunk::<CHECKSUM>()
            .filter(|(body, _)| body.starts_with(MAGIC) && body.len() >= MAGIC.len() + 8)
        else {
            let given = format!("{} bytes that begin otherwise", bytes.len());
            return Err(malformed("weights of a motion network", given));
        };
        let (stated, sum) = (u32::from_le_bytes(*checksum), crc32fast::hash(body));
        if stated != sum {
            return Err(malformed(&format!("the check sum {stated:08x}"), format!("{sum:08x}")));
        }
        let mut rest = Rest(&body[MAGIC.len()..]);
        let cut = || malformed("all tensors that are announced", "fewer bytes".into());
        let version = rest.whole().ok_or_else(cut)?;
        if version != VERSION {
            return Err(malformed(&format!("version {VERSION}"), format!("version {version}")));
        }
        let count = rest.whole().ok_or_else(cut)?;
        let mut tensors = BTreeMap::new();
        for _ in 0..count {
            let (name, tensor) = rest.tensor().ok_or_else(cut)?;
            if tensor.values.iter().any(|value| !value.is_finite()) {
                return Err(NetworkError::NotFinite { tensor: name });
            }
            tensors.insert(name, tensor);
        }
        if !rest.0.is_empty() {
            return Err(malformed("no more than the tensors", format!("{} bytes", rest.0.len())));
        }
        Ok(Self { tensors })
    }

    /// Lengths of a tensor's axes; none if it is not there.
    pub(super) fn shape(&self, name: &str) -> Option<&[usize]> {
        self.tensors.get(name).map(|tensor| &tensor.shape[..])
    }

    /// The numbers of a tensor of this shape, row by row.
    pub(super) fn values(&self, name: &str, shape: &[usize]) -> Result<&[f32], NetworkError> {
        match self.tensors.get(name) {
            Some(tensor) if tensor.shape == shape => Ok(&tensor.values),
            other => Err(NetworkError::Unlike {
                tensor: name.into(),
                expected: format!("{shape:?}"),
                given: other.map_or("missing".into(), |tensor| format!("{:?}", tensor.shape)),
            }),
        }
    }
}

/// What is left to read.
struct Rest<'a>(&'a [u8]);

impl<'a> Rest<'a> {
    fn take(&mut self, count: usize) -> Option<&'a [u8]> {
        let (taken, rest) = self.0.split_at_checked(count)?;
        self.0 = rest;
        Some(taken)
    }

    fn byte(&mut self) -> Option<u8> {
        self.take(1).map(|bytes| bytes[0])
    }

    fn whole(&mut self) -> Option<u32> {
        self.take(4)?.try_into().ok().map(u32::from_le_bytes)
    }

    fn tensor(&mut self) -> Option<(String, Tensor)> {
        let length = self.byte()?.into();
        let name = String::from_utf8(self.take(length)?.to_vec()).ok()?;
        let (kind, axes) = (self.byte()?, self.byte()?);
        let shape: Vec<usize> =
            (0..axes).map(|_| self.whole().map(|n| n as usize)).collect::<Option<_>>()?;
        let size = shape.iter().try_fold(1_usize, |size, n| size.checked_mul(*n))?;
        let values = match kind {
            0 => {
                let bytes = self.take(size.checked_mul(4)?)?;
                bytes.as_chunks::<4>().0.iter().map(|b| f32::from_le_bytes(*b)).collect()
            }
            1 => {
                let bytes = self.take(size.checked_mul(2)?)?;
                bytes.as_chunks::<2>().0.iter().map(|b| half(u16::from_le_bytes(*b))).collect()
            }
            _ => return None,
        };
        Some((name, Tensor { shape, values }))
    }
}

/// A number of half precision (IEEE 754 binary16).
fn half(bits: u16) -> f32 {
    let sign = u32::from(bits >> 15) << 31;
    let (exponent, fraction) = (u32::from(bits >> 10) & 31, u32::from(bits) & 1023);
    match exponent {
        // Subnormal: a multiple of 2^-24.
        0 => f32::from_bits(sign | (fraction as f32 / 16_777_216.0).to_bits()),
        31 => f32::from_bits(sign | 0x7f80_0000 | fraction << 13),
        _ => f32::from_bits(sign | (exponent + 112) << 23 | fraction << 13),
    }
}

#[cfg(test)]
mod tests {
    use super::half;

    #[test]
    fn half_precision_is_widened() {
        let known = [
            (0x0000, 0.0),
            (0x3c00, 1.0),
            (0xc000, -2.0),
            (0x3555, 0.333_251_95),
            (0x7bff, 65504.0),
            (0x0001, 5.960_464_5e-8),
            (0x8400, -6.103_515_6e-5),
        ];
        for (bits, value) in known {
            assert_eq!(half(bits), value, "{bits:04x}");
        }
        assert!(half(0x7c00).is_infinite() && half(0x7e00).is_nan());
    }
}
