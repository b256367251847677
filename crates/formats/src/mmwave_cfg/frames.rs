//! Frames and sub-frames, and how their transmitters share the chirps.

use super::line::Line;
use crate::error::FormatError;

/// Sub-frames of an advanced frame, at most.
pub(super) const MOST_SUB_FRAMES: i64 = 4;

/// What `frameCfg` or `subFrameCfg` says, with the line it stood on.
#[derive(Debug, Clone, Copy)]
pub(super) struct Frame {
    pub line: usize,
    pub command: &'static str,
    pub first: usize,
    pub last: usize,
    pub loops: usize,
    pub interval_s: f64,
    /// Profile of all its chirps, whatever they say themselves, if the frame forces one.
    pub forced_profile: Option<usize>,
}

impl Frame {
    /// `frameCfg`, and the number of frames.
    pub fn plain(line: &Line<'_>) -> Result<(Self, usize), FormatError> {
        line.count(7, 8)?;
        let first = line.index(0, "first chirp", 511)?;
        let last = line.integer(1, "last chirp", first as i64, 511)?.unsigned_abs() as usize;
        let loops = line.integer(2, "loops", 1, 65_535)?.unsigned_abs() as usize;
        let frames = line.index(3, "frames", 65_535)?;
        // SDK 4 puts the number of ADC samples before the period.
        let at = line.arguments.len() - 3;
        let interval_s = line.number(at, "frame period (ms)", 1e-3, 1e6)? * 1e-3;
        let (number, command) = (line.number, "frameCfg");
        let frame =
            Self { line: number, command, first, last, loops, interval_s, forced_profile: None };
        Ok((frame, frames))
    }

    /// `subFrameCfg`, and its number.
    pub fn part(line: &Line<'_>) -> Result<(usize, Self), FormatError> {
        line.count(10, 10)?;
        let number = line.index(0, "sub-frame", MOST_SUB_FRAMES - 1)?;
        let forced = line.index(1, "forced profile", 3)?;
        let first = line.index(2, "first chirp", 511)?;
        let chirps = line.integer(3, "chirps", 1, 512 - first as i64)?.unsigned_abs() as usize;
        let loops = line.integer(4, "loops", 1, 65_535)?.unsigned_abs() as usize;
        for (index, what) in [(7, "bursts"), (8, "loops of bursts")] {
            let count = line.integer(index, what, 1, 65_535)?;
            if count != 1 {
                return Err(line.error(what, "1 (loops alone)", count.to_string()));
            }
        }
        let interval_s = line.number(9, "sub-frame period (ms)", 1e-3, 1e6)? * 1e-3;
        let frame = Self {
            line: line.number,
            command: "subFrameCfg",
            first,
            last: first + chirps - 1,
            loops,
            interval_s,
            forced_profile: Some(forced),
        };
        Ok((number, frame))
    }

    /// The line it stood on, for errors.
    pub fn at(&self) -> Line<'static> {
        Line { number: self.line, command: self.command, arguments: vec![] }
    }
}

/// What `advFrameCfg` says.
#[derive(Debug, Clone, Copy)]
pub(super) struct Advanced {
    pub line: usize,
    pub sub_frames: usize,
    pub forces_profile: bool,
    pub frames: usize,
}

impl Advanced {
    pub fn of(line: &Line<'_>) -> Result<Self, FormatError> {
        line.count(5, 5)?;
        let sub_frames = line.integer(0, "sub-frames", 1, MOST_SUB_FRAMES)?.unsigned_abs();
        let forces_profile = line.index(1, "profile forced", 1)? == 1;
        let frames = line.index(2, "frames", 65_535)?;
        Ok(Self { line: line.number, sub_frames: sub_frames as usize, forces_profile, frames })
    }

    /// The sub-frames in order of transmission, each with the interval of whole frames.
    pub fn parts(&self, given: &[(usize, Frame)]) -> Result<Vec<Frame>, FormatError> {
        let at = Line { number: self.line, command: "advFrameCfg", arguments: vec![] };
        if let Some((number, part)) = given.iter().find(|(number, _)| *number >= self.sub_frames) {
            let expected = format!("below {}, as advFrameCfg says", self.sub_frames);
            return Err(part.at().error("sub-frame", expected, number.to_string()));
        }
        let mut parts = (0..self.sub_frames)
            .map(|number| {
                let known = given.iter().rev().find(|(other, _)| *other == number);
                let mut part = known.map(|(_, part)| *part).ok_or_else(|| {
                    let expected = format!("a subFrameCfg line for sub-frame {number}");
                    at.error("sub-frames", expected, "none")
                })?;
                part.forced_profile = part.forced_profile.filter(|_| self.forces_profile);
                Ok(part)
            })
            .collect::<Result<Vec<Frame>, FormatError>>()?;
        let interval_s = parts.iter().map(|part| part.interval_s).sum();
        parts.iter_mut().for_each(|part| part.interval_s = interval_s);
        Ok(parts)
    }
}

/// What `bpmCfg` says of a sub-frame, or of all: the chirps in phase and inverted, where enabled.
#[derive(Debug, Clone, Copy)]
pub(super) struct BinaryPhase {
    pub line: usize,
    /// None is all.
    pub sub_frame: Option<usize>,
    pub chirps: Option<[usize; 2]>,
}

impl BinaryPhase {
    pub fn of(line: &Line<'_>) -> Result<Self, FormatError> {
        let sub_frame = line.integer(0, "sub-frame", -1, MOST_SUB_FRAMES - 1)?;
        let enabled = line.index(1, "enabled", 1)? == 1;
        let chirps = if enabled {
            line.count(4, 4)?;
            Some([line.index(2, "chirp in phase", 511)?, line.index(3, "inverted chirp", 511)?])
        } else {
            None
        };
        Ok(Self { line: line.number, sub_frame: usize::try_from(sub_frame).ok(), chirps })
    }
}
