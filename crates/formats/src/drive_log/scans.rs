//! Scans from detections in a row, as tables and HDF5 files have them.

use crate::error::FormatError;
use boresight_core::drive::Scan;
use std::collections::BTreeMap;

/// Scans so far: detections of one time and radar are one.
#[derive(Default)]
pub(crate) struct Scans {
    scans: Vec<Scan>,
    /// The latest scan of each radar, by its place.
    latest: BTreeMap<u8, usize>,
}

impl Scans {
    /// The scan of a time and radar, made if it is new; `place` says where the detection stands.
    pub(crate) fn at(
        &mut self,
        time_s: f64,
        sensor: u8,
        place: impl FnOnce() -> String,
    ) -> Result<&mut Scan, FormatError> {
        let previous = self.latest.get(&sensor).map(|&at| (at, self.scans[at].time_s));
        let at = match previous {
            Some((at, previous)) if time_s == previous => at,
            Some((_, previous)) if time_s < previous => {
                return Err(FormatError::TimeBackwards { place: place(), previous, given: time_s });
            }
            _ => {
                self.scans.push(Scan { time_s, sensor, detections: vec![], labels: vec![] });
                self.latest.insert(sensor, self.scans.len() - 1);
                self.scans.len() - 1
            }
        };
        Ok(&mut self.scans[at])
    }

    /// Numbers of the radars, ascending.
    pub(crate) fn sensors(&self) -> impl Iterator<Item = u8> {
        self.latest.keys().copied()
    }

    /// The scans, in the order they began.
    pub(crate) fn into_vec(self) -> Vec<Scan> {
        self.scans
    }
}

/// By time, scans of one time by radar.
pub(crate) fn sort_scans(scans: &mut [Scan]) {
    boresight_math::order::sort_by(scans, |a, b| {
        a.time_s.total_cmp(&b.time_s).then(a.sensor.cmp(&b.sensor))
    });
}
