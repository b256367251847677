//! Unpacks the records of chunks, in pieces.

use lz4_flex::frame::FrameDecoder as Lz4;
use ruzstd::decoding::{FrameDecoder as Zstd, StreamingDecoder};
use std::io::Read;

/// Bytes unpacked at a time.
const PIECE: usize = 1 << 16;
/// Largest window of zstd's that is held, bytes.
const MAX_WINDOW_BYTES: u64 = 64 << 20;

/// How the records of a chunk are packed.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Compression {
    None,
    Lz4,
    Zstd,
}

impl Compression {
    pub fn of(name: &[u8]) -> Option<Self> {
        match name {
            b"" => Some(Self::None),
            b"lz4" => Some(Self::Lz4),
            b"zstd" => Some(Self::Zstd),
            _ => None,
        }
    }

    /// Hands on the unpacked bytes in pieces until `take` wants no more; whether all could be unpacked.
    pub fn unpack(self, packed: &[u8], mut take: impl FnMut(&[u8]) -> bool) -> bool {
        match self {
            Self::None => {
                take(packed);
                true
            }
            Self::Lz4 => pieces(Lz4::new(packed), &mut take).is_some(),
            Self::Zstd => {
                let mut rest = packed;
                let mut frame = Zstd::new();
                frame.set_max_window_size(MAX_WINDOW_BYTES);
                while !rest.is_empty() {
                    let Ok(decoder) = StreamingDecoder::new_with_decoder(&mut rest, &mut frame)
                    else {
                        return false;
                    };
                    match pieces(decoder, &mut take) {
                        Some(true) => {}
                        Some(false) => return true,
                        None => return false,
                    }
                }
                true
            }
        }
    }
}

/// Whether there was more to come when `take` wanted none; nothing for what cannot be unpacked.
fn pieces(mut from: impl Read, take: &mut impl FnMut(&[u8]) -> bool) -> Option<bool> {
    let mut piece = vec![0; PIECE];
    loop {
        let count = from.read(&mut piece).ok()?;
        if count == 0 {
            return Some(true);
        }
        if !take(piece.get(..count)?) {
            return Some(false);
        }
    }
}
