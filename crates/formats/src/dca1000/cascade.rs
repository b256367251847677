//! Recordings of Texas Instruments' cascade of four chips (MMWCAS-RF-EVM on MMWCAS-DSP-EVM): files
//! `master_0000_data.bin`, `slave1_0000_data.bin` to `slave3_0000_data.bin`, and an index `..._idx.bin` beside each.
//! A long recording goes on in files `0001`, `0002` and so on.
//!
//! An index has a header of 24 bytes (four 32-bit words, the last being the number of frames; the data's bytes as a
//! 64-bit number) and 48 bytes a frame (the frame's bytes at 28, its time at 32, its place in the data at 40).

use super::layout::{CHIPS, Layout};
use crate::error::FormatError;
use crate::mmwave_cfg::RadarConfig;
use boresight_core::Remark;
use std::collections::BTreeMap;

/// The chips in the order of their receivers' numbers.
pub const CHIP_NAMES: [&str; CHIPS] = ["master", "slave1", "slave2", "slave3"];

const HEADER_BYTES: usize = 24;
const ENTRY_BYTES: usize = 48;

/// A recording as one capture.
#[derive(Debug, Clone, PartialEq)]
pub struct Joined {
    /// Frame after frame, of each frame the chips' in the order of [`CHIP_NAMES`].
    pub bytes: Vec<u8>,
    /// What was left out or does not fit.
    pub remarks: Vec<Remark>,
}

/// A part of a file's name: its number in the recording, its chip, and whether it is an index.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
struct Name {
    number: u32,
    chip: usize,
    index: bool,
}

impl Name {
    fn of(path: &str) -> Option<Self> {
        let name = path.rsplit(['/', '\\']).next()?.to_ascii_lowercase();
        let mut words = name.strip_suffix(".bin")?.split('_');
        let (chip, number, kind) = (words.next()?, words.next()?, words.next()?);
        let index = match kind {
            "data" => false,
            "idx" => true,
            _ => return None,
        };
        let digits = number.len() <= 9 && number.bytes().all(|byte| byte.is_ascii_digit());
        let number = number.parse().ok().filter(|_| digits && words.next().is_none())?;
        Some(Self { number, chip: CHIP_NAMES.iter().position(|known| *known == chip)?, index })
    }
}

/// Whether a file is one of a cascade's, by its name.
pub fn is_part(path: &str) -> bool {
    Name::of(path).is_some()
}

fn error(
    what: impl Into<String>,
    expected: impl Into<String>,
    given: impl Into<String>,
) -> FormatError {
    FormatError::Parts { what: what.into(), expected: expected.into(), given: given.into() }
}

/// Puts the files of a recording, with their names, together to the bytes of a capture.
///
/// # Errors
/// [`FormatError::Parts`] for a file of another name, one that is there twice, a chip that is missing, files of unequal
/// lengths, and a configuration that is not of a cascade; [`FormatError::Binary`] for an index that is cut or says
/// something else than its length.
pub fn join(files: &[(&str, &[u8])], config: &RadarConfig) -> Result<Joined, FormatError> {
    if config.adc.layout != Layout::Cascade {
        let given = "one of a single chip";
        return Err(error("the configuration", "one of a cascade (channelCfg 65535 ... 1)", given));
    }
    let mut parts = BTreeMap::new();
    for &(path, bytes) in files {
        let name = Name::of(path).ok_or_else(|| {
            error(
                "a file of the cascade",
                "a name as slave1_0000_data.bin or master_0000_idx.bin",
                path,
            )
        })?;
        if parts.insert(name, bytes).is_some() {
            return Err(error("a file of the cascade", "each chip once in a recording", path));
        }
    }
    let mut numbers: Vec<u32> = parts.keys().map(|name| name.number).collect();
    numbers.dedup();
    let chip_bytes = usize::try_from(config.frame_bytes() / CHIPS as u64).unwrap_or(usize::MAX);
    let mut joined = Joined { bytes: vec![], remarks: vec![] };
    if numbers.is_empty() {
        return Err(error("files of the cascade", "four, one of each chip", "none"));
    }
    for number in numbers {
        joined.add(number, &parts, chip_bytes.max(1))?;
    }
    Ok(joined)
}

/// The data of each chip ([`CHIP_NAMES`]) out of the bytes of a capture: the inverse of [`join`].
///
/// # Errors
/// [`FormatError::Layout`] for a configuration of a single chip.
pub fn split(bytes: &[u8], config: &RadarConfig) -> Result<[Vec<u8>; CHIPS], FormatError> {
    if config.adc.layout != Layout::Cascade {
        return Err(FormatError::Layout {
            what: "layout",
            expected: "a cascade".into(),
            given: "one chip".into(),
        });
    }
    let each = usize::try_from(config.frame_bytes() / CHIPS as u64).unwrap_or(usize::MAX).max(1);
    let mut files = [const { vec![] }; CHIPS];
    for (k, part) in bytes.chunks_exact(each).enumerate() {
        files[k % CHIPS].extend_from_slice(part);
    }
    Ok(files)
}

impl Joined {
    fn add(
        &mut self,
        number: u32,
        parts: &BTreeMap<Name, &[u8]>,
        chip_bytes: usize,
    ) -> Result<(), FormatError> {
        let file = |chip, index| {
            let kind = if index { "idx" } else { "data" };
            let bytes = parts.get(&Name { number, chip, index }).copied();
            (format!("{}_{number:04}_{kind}.bin", CHIP_NAMES[chip]), bytes)
        };
        let mut chips = [[].as_slice(); CHIPS];
        for (chip, slot) in chips.iter_mut().enumerate() {
            let (name, bytes) = file(chip, false);
            let all = "the data of the master and three slaves";
            *slot = bytes.ok_or_else(|| error("the cascade", all, format!("no {name}")))?;
        }
        let lengths = chips.map(<[u8]>::len);
        if lengths.iter().any(|&length| length != lengths[0]) {
            let given =
                CHIP_NAMES.iter().zip(lengths).map(|(name, bytes)| format!("{name} {bytes}"));
            let given = given.collect::<Vec<_>>().join(", ");
            return Err(error("bytes of the chips' files", "equal numbers", given));
        }
        let frames = lengths[0] / chip_bytes;
        let trailing = lengths[0] % chip_bytes;
        if trailing > 0 {
            let message = format!(
                "{trailing} bytes follow the last whole frame of each chip in files {number:04}: left out"
            );
            self.remarks.push(Remark::new("trailing-bytes", message));
        }
        self.bytes.reserve(lengths[0].saturating_mul(CHIPS));
        for frame in 0..frames {
            for chip in chips {
                self.bytes.extend_from_slice(&chip[frame * chip_bytes..(frame + 1) * chip_bytes]);
            }
        }
        let mut times: Vec<Vec<u64>> = vec![];
        for chip in 0..CHIPS {
            let (name, bytes) = file(chip, true);
            if let Some(bytes) = bytes {
                let index = Index::parse(&name, bytes)?;
                self.check(&name, &index, lengths[0], chip_bytes);
                times.push(index.times);
            }
        }
        self.check_times(number, &times);
        Ok(())
    }

    /// Compares an index with its data.
    fn check(&mut self, name: &str, index: &Index, data_bytes: usize, chip_bytes: usize) {
        let other = index.frame_bytes.iter().filter(|&&bytes| bytes as usize != chip_bytes).count();
        let mut odd = vec![];
        if index.data_bytes != data_bytes as u64 {
            odd.push(format!(
                "tells {} bytes of data, and {data_bytes} are there",
                index.data_bytes
            ));
        }
        if index.frame_bytes.len() != data_bytes / chip_bytes {
            let frames = data_bytes / chip_bytes;
            odd.push(format!("tells {} frames, and {frames} are there", index.frame_bytes.len()));
        }
        if other > 0 {
            odd.push(format!("has {other} frames of another size than {chip_bytes} bytes"));
        }
        if !odd.is_empty() {
            let message = format!("{name} {}", odd.join("; "));
            self.remarks.push(Remark::new("cascade-index", message));
        }
    }

    /// Chips that lost frames are out of step from there on, by an interval of frames or more.
    fn check_times(&mut self, number: u32, times: &[Vec<u64>]) {
        let Some((first, others)) = times.split_first() else { return };
        let span = |times: &[u64]| times.last()?.checked_sub(*times.first()?);
        let steps = first.len().saturating_sub(1).max(1) as u64;
        let half_interval = span(first).unwrap_or_default() / steps / 2;
        let differs = |frame: usize| {
            others.iter().any(|other| {
                let since = |times: &[u64]| times.get(frame)?.checked_sub(*times.first()?);
                match (since(first), since(other)) {
                    (Some(a), Some(b)) => a.abs_diff(b) > half_interval,
                    (None, None) => false,
                    _ => true,
                }
            })
        };
        let most = times.iter().map(Vec::len).max().unwrap_or_default();
        let count = (0..most).filter(|&frame| differs(frame)).count();
        if count > 0 {
            let message = format!(
                "{count} of {most} frames of files {number:04} have other times in the chips' indices: chips may \
                 have lost frames, and frames then mix different moments"
            );
            self.remarks.push(Remark::new("cascade-out-of-step", message));
        }
    }
}

/// What an index says.
struct Index {
    data_bytes: u64,
    frame_bytes: Vec<u32>,
    times: Vec<u64>,
}

impl Index {
    fn parse(name: &str, bytes: &[u8]) -> Result<Self, FormatError> {
        let wrong = |what: &str, expected: String, given: String| FormatError::Binary {
            format: "cascade index",
            offset: 12,
            what: format!("{what} of {name}"),
            expected,
            given,
        };
        let (header, entries) = bytes.split_at_checked(HEADER_BYTES).ok_or_else(|| {
            wrong("length", format!("at least {HEADER_BYTES} bytes"), bytes.len().to_string())
        })?;
        let frames = word(header, 12);
        let (each, rest) = entries.as_chunks::<ENTRY_BYTES>();
        if frames as usize != each.len() || !rest.is_empty() {
            let there = format!("{} for {} bytes", each.len(), bytes.len());
            return Err(wrong("number of frames", there, frames.to_string()));
        }
        Ok(Self {
            data_bytes: long(header, 16),
            frame_bytes: each.iter().map(|entry| word(entry, 28)).collect(),
            times: each.iter().map(|entry| long(entry, 32)).collect(),
        })
    }
}

fn word(bytes: &[u8], at: usize) -> u32 {
    bytes.get(at..at + 4).and_then(|four| four.try_into().ok()).map_or(0, u32::from_le_bytes)
}

fn long(bytes: &[u8], at: usize) -> u64 {
    bytes.get(at..at + 8).and_then(|eight| eight.try_into().ok()).map_or(0, u64::from_le_bytes)
}
