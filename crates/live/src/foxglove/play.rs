//! A drive played and calibrated, scan after scan.

use super::results::ResultTopics;
use crate::error::LiveError;
use boresight_core::Remark;
use boresight_core::drive::{DriveLog, Scan};
use boresight_formats::foxglove::{Channel, Message};
use boresight_mounting::network::MotionNetwork;
use boresight_mounting::{CalibrationOptions, Car, Frames};
use std::sync::Arc;

/// What is calibrated, and how.
#[derive(Debug, Clone)]
pub struct Setup {
    /// The radars by number, with their options.
    pub radars: Vec<(u8, CalibrationOptions)>,
    /// Whether they are calibrated together.
    pub joint: bool,
    /// The network, where options ask for a motion that needs one.
    pub network: Option<Arc<MotionNetwork>>,
}

impl Setup {
    /// A calibration without frames.
    ///
    /// # Errors
    /// Those of [`Car::together`] and [`Car::apart`].
    pub fn car(&self) -> Result<Car, LiveError> {
        Ok(if self.joint {
            Car::together(self.radars.clone())?
        } else {
            Car::apart(self.radars.clone(), self.network.as_ref())?
        })
    }

    /// The frames of its radars. The gap over which motion is interpolated is that of the first: one option is given for all.
    fn frames<'a>(&self, log: &'a DriveLog) -> Frames<'a> {
        let wanted = |id| self.radars.iter().any(|(sensor, _)| *sensor == id);
        let max_gap_s = self.radars.first().map_or(0.0, |(_, options)| options.max_gap_s);
        Frames::of(log, wanted, max_gap_s)
    }
}

/// Plays a drive: each step tells one scan, and what the calibration makes of it.
pub struct Play<'a> {
    log: &'a DriveLog,
    setup: Setup,
    remarks: &'a [Remark],
    topics: ResultTopics<'a>,
    car: Car,
    scans: Vec<&'a Scan>,
    frames: Frames<'a>,
    done: usize,
    has_ended: bool,
}

impl<'a> Play<'a> {
    /// Of a log with remarks on it, from its start.
    ///
    /// # Errors
    /// Those of [`Setup::car`] and [`ResultTopics::new`].
    pub fn new(log: &'a DriveLog, remarks: &'a [Remark], setup: Setup) -> Result<Self, LiveError> {
        let car = setup.car()?;
        let topics = ResultTopics::new(log, &car)?;
        let wanted = |id| car.radars().iter().any(|(sensor, _)| *sensor == id);
        let scans = log.scans.iter().filter(|scan| wanted(scan.sensor)).collect();
        let frames = setup.frames(log);
        Ok(Self { log, setup, remarks, topics, car, scans, frames, done: 0, has_ended: false })
    }

    /// The channels.
    #[must_use]
    pub fn channels(&self) -> &[Channel] {
        self.topics.channels()
    }

    /// First and last time of the drive, ns.
    #[must_use]
    pub fn span_ns(&self) -> [u64; 2] {
        self.topics.span_ns()
    }

    /// Scans played, and all of them.
    #[must_use]
    pub fn progress(&self) -> [usize; 2] {
        [self.done, self.scans.len()]
    }

    /// Goes back to the start, with a calibration that knows nothing, and tells what is true from there.
    ///
    /// # Errors
    /// Those of [`Setup::car`].
    pub fn begin(&mut self, out: &mut Vec<Message>) -> Result<(), LiveError> {
        self.car = self.setup.car()?;
        self.frames = self.setup.frames(self.log);
        (self.done, self.has_ended) = (0, false);
        self.topics.begin(self.remarks, out);
        Ok(())
    }

    /// Tells the next scan; after the last one each radar's angle from all of them. Returns whether there was anything left to
    /// tell.
    ///
    /// # Errors
    /// Those of [`Car::add`].
    pub fn step(&mut self, out: &mut Vec<Message>) -> Result<bool, LiveError> {
        let Some((sensor, frame)) = self.frames.next() else { return self.end(out) };
        let scan = self.scans[self.done];
        self.done += 1;
        let outcome = self.car.add(sensor, frame)?;
        self.topics.step(scan, outcome, &self.car, out)?;
        Ok(true)
    }

    fn end(&mut self, out: &mut Vec<Message>) -> Result<bool, LiveError> {
        if std::mem::replace(&mut self.has_ended, true) {
            return Ok(false);
        }
        self.topics.end(&self.car, out)?;
        Ok(true)
    }
}
