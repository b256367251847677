//! A calibration as bytes, to continue elsewhere or later.
//!
//! `BSCA`, a version (one byte), options and state by postcard, and the CRC-32 of all before it, little endian.
//!
//! Every release reads the snapshots of all earlier versions from [`FIRST_VERSION`] on. Postcard writes fields without names or lengths, so
//! that any change of `CalibrationOptions`, `State`, `Intake` or a type within them is a new version: copy the types of the version before
//! to read it, convert them here, and write fixtures of the new version (`tests/snapshot_versions.rs`).

use super::{Recursive, State};
use crate::error::MountingError;
use crate::intake::Intake;
use crate::network::MotionNetwork;
use crate::options::CalibrationOptions;
use std::sync::Arc;

const MAGIC: &[u8; 4] = b"BSCA";
/// Version written.
const VERSION: u8 = 4;
/// First version that can be read. It has options and state as version 4, and no counts of what was rejected.
const FIRST_VERSION: u8 = 3;
const CHECKSUM: usize = 4;

impl Recursive {
    /// The calibration as bytes: some kilobytes, whatever the drive's length. [`Recursive::restore`] makes of them one that goes on
    /// to the last digit as this one does.
    pub fn snapshot(&self) -> Vec<u8> {
        let mut bytes = MAGIC.to_vec();
        bytes.push(VERSION);
        // Numbers, options and sequences of them are written to memory, which cannot fail.
        let mut bytes = postcard::to_extend(&(&self.options, &self.state, &self.intake), bytes)
            .unwrap_or_default();
        bytes.extend(crc32fast::hash(&bytes).to_le_bytes());
        bytes
    }

    /// The calibration that a snapshot is of.
    ///
    /// # Errors
    /// As [`Recursive::restore_with_network`]; one with a network is refused.
    pub fn restore(snapshot: &[u8]) -> Result<Self, MountingError> {
        Self::restore_with_network(snapshot, None)
    }

    /// The same of one with a network, which is no part of it.
    ///
    /// # Errors
    /// Those of [`Recursive::with_network`];
    /// [`MountingError::MalformedSnapshot`] for other bytes and a snapshot that was damaged;
    /// [`MountingError::UnsupportedSnapshot`] for one of a later or unknown version; those of [`CalibrationOptions::validate`].
    pub fn restore_with_network(
        snapshot: &[u8],
        network: Option<&Arc<MotionNetwork>>,
    ) -> Result<Self, MountingError> {
        let malformed = |expected: &str, given: String| MountingError::MalformedSnapshot {
            expected: expected.into(),
            given,
        };
        let Some((body, checksum)) = snapshot
            .split_last_chunk::<CHECKSUM>()
            .filter(|(body, _)| body.starts_with(MAGIC) && body.len() > MAGIC.len())
        else {
            let given = format!("{} bytes that begin otherwise", snapshot.len());
            return Err(malformed("a calibration's snapshot, which begins with BSCA", given));
        };
        let version = body[MAGIC.len()];
        if !(FIRST_VERSION..=VERSION).contains(&version) {
            return Err(MountingError::UnsupportedSnapshot {
                first: FIRST_VERSION,
                last: VERSION,
                given: version,
            });
        }
        if crc32fast::hash(body) != u32::from_le_bytes(*checksum) {
            return Err(malformed("bytes as they were written", "a wrong checksum".into()));
        }
        let content = &body[MAGIC.len() + 1..];
        let read: postcard::Result<(CalibrationOptions, State, Intake)> = match version {
            FIRST_VERSION => postcard::from_bytes(content)
                .map(|(options, state)| (options, state, Intake::default())),
            _ => postcard::from_bytes(content),
        };
        let (options, state, intake) =
            read.map_err(|error| malformed("options and state", error.to_string()))?;
        options.validate()?;
        if !state.is_sound() {
            return Err(malformed(
                "a state that holds together",
                "numbers that no calibration has".into(),
            ));
        }
        let network = Self::network_of(&options, network)?;
        Ok(Self::with_state(&options, network, state, intake))
    }
}

impl State {
    /// Whether lengths and numbers are such as the code relies on.
    fn is_sound(&self) -> bool {
        self.vote.as_ref().is_none_or(super::Vote::is_sound)
            && self.before.is_sound()
            && self.now.is_sound()
            && self.recent.is_sound()
            && self.block.is_sound()
            && self.time_s.is_none_or(f64::is_finite)
            && self.noise_scale > 0.0
            && self.noise_scale.is_finite()
            && self.scatter.scatter.excess > 0.0
            && self.scatter.scatter.correlated >= 0.0
            && self.scatter.blocks >= 0.0
    }
}
