//! The messages of a drive and of its calibration, in order of time.

use boresight_core::drive::{DriveLog, Mounting, Scan};
use boresight_core::{InputError, Remark as DriveRemark};
use boresight_formats::foxglove::messages::{LogLevel, SceneUpdate, Time};
use boresight_formats::foxglove::typed::{encode, encode_own, known, own};
use boresight_formats::foxglove::{Channel, DriveTopics, Message, scene, topic};
use boresight_mounting::{
    Alignment, AngleEstimate, CalibrationOptions, Car, FrameOutcome, MountingError, Remark,
};
use boresight_options::{Described, Flat};
use serde::Serialize;

/// Angles are told no more often, s of the drive.
const STEP_S: f64 = 0.2;
/// Where an angle takes time in proportion to all frames before, it is told after such a share of the drive so far.
const STEP_SHARE: f64 = 0.02;
/// Fields of frames that stand elsewhere: weights are numbers of points.
const NOT_IN_FRAMES: [&str; 1] = ["weights"];

/// The mounting angle of a radar, as far as it is known at a time.
#[derive(Debug, Clone, PartialEq, Described, Serialize)]
pub struct MountingAngle<'a> {
    /// Time of the last frame in it.
    pub timestamp: Time,
    /// Number of the radar.
    pub sensor: u8,
    /// Whether the radars of the car were calibrated together.
    pub joint: bool,
    /// The angle it should be mounted at, where that is known.
    pub nominal_rad: Option<f64>,
    /// The angle less the nominal one, within half a turn.
    pub drift_rad: Option<f64>,
    /// The angle, and what it rests on.
    pub estimate: Flat<&'a AngleEstimate>,
}

/// What became of a frame.
#[derive(Debug, Clone, PartialEq, Described, Serialize)]
pub struct Frame {
    /// Time of the scan.
    pub timestamp: Time,
    /// Number of the radar.
    pub sensor: u8,
    /// What the method made of it.
    pub outcome: Flat<FrameOutcome>,
}

/// What was told of a radar, and where.
#[derive(Debug, Clone)]
struct Radar {
    sensor: u8,
    options: CalibrationOptions,
    /// Places of its channels.
    angle: usize,
    frame: usize,
    moving: usize,
    /// Times of the first scan, the last one and the last angle, s.
    first_s: Option<f64>,
    last_s: Option<f64>,
    told_s: Option<f64>,
    alignment: Option<Alignment>,
    converged: bool,
    remarks: Vec<Remark>,
}

impl Radar {
    fn forget(&mut self) {
        (self.first_s, self.last_s, self.told_s) = (None, None, None);
        (self.alignment, self.converged) = (None, false);
        self.remarks.clear();
    }
}

/// Makes messages of a drive and its calibration. Scans are handed in with what became of them.
#[derive(Debug, Clone)]
pub struct ResultTopics<'a> {
    drive: DriveTopics<'a>,
    radars: Vec<Radar>,
    joint: bool,
    at_hand: bool,
}

impl<'a> ResultTopics<'a> {
    /// Of a log and the radars of a calibration.
    ///
    /// # Errors
    /// Those of [`DriveTopics::new`].
    pub fn new(log: &'a DriveLog, car: &Car) -> Result<Self, InputError> {
        let radars = car.radars();
        let mut drive = DriveTopics::new(log, |id| radars.iter().any(|(sensor, _)| *sensor == id))?;
        let radars = radars
            .iter()
            .map(|&(sensor, options)| {
                let mut add = |channel| drive.add_channel(channel);
                let of = |what| topic(sensor, what);
                Radar {
                    sensor,
                    options,
                    angle: add(own::<MountingAngle>(
                        of("mounting"),
                        "boresight.MountingAngle",
                        &[],
                    )
                    .lasting()),
                    frame: add(own::<Frame>(of("frame"), "boresight.Frame", &NOT_IN_FRAMES)),
                    moving: add(known::<SceneUpdate>(of("moving"), "foxglove.SceneUpdate")),
                    first_s: None,
                    last_s: None,
                    told_s: None,
                    alignment: None,
                    converged: false,
                    remarks: vec![],
                }
            })
            .collect();
        Ok(Self { drive, radars, joint: car.is_joint(), at_hand: car.is_at_hand() })
    }

    /// The channels.
    #[must_use]
    pub fn channels(&self) -> &[Channel] {
        self.drive.channels()
    }

    /// First and last time of the drive, ns.
    #[must_use]
    pub fn span_ns(&self) -> [u64; 2] {
        self.drive.span_ns()
    }

    /// Begins anew: what is true from the start of the drive, with a line for each remark on it.
    pub fn begin(&mut self, remarks: &[DriveRemark], out: &mut Vec<Message>) {
        self.radars.iter_mut().for_each(Radar::forget);
        self.drive.begin(remarks, out);
    }

    /// What the car did until a scan, the scan, what became of it, and now and then the angle.
    ///
    /// # Errors
    /// [`InputError::OutOfRange`] for a radar that is none of the calibration.
    pub fn step(
        &mut self,
        scan: &Scan,
        outcome: FrameOutcome,
        car: &Car,
        out: &mut Vec<Message>,
    ) -> Result<(), MountingError> {
        self.scan(scan, outcome, out);
        if self.is_angle_due(scan.sensor, scan.time_s) {
            self.angle(scan.sensor, scan.time_s, &car.estimate(scan.sensor)?, out);
        }
        Ok(())
    }

    /// The angles from all scans, and what the car did after the last one.
    ///
    /// # Errors
    /// As [`Self::step`].
    pub fn end(&mut self, car: &Car, out: &mut Vec<Message>) -> Result<(), MountingError> {
        let last = self.radars.iter().filter_map(|radar| radar.last_s).reduce(f64::max);
        for sensor in self.radars.iter().map(|radar| radar.sensor).collect::<Vec<_>>() {
            if let Some(last_s) = last {
                self.angle(sensor, last_s, &car.estimate(sensor)?, out);
            }
        }
        self.drive.finish(out);
        Ok(())
    }

    fn scan(&mut self, scan: &Scan, outcome: FrameOutcome, out: &mut Vec<Message>) {
        self.drive.scan(scan, Some(&outcome.weights), out);
        let Some(radar) = self.radars.iter_mut().find(|radar| radar.sensor == scan.sensor) else {
            return;
        };
        radar.first_s.get_or_insert(scan.time_s);
        radar.last_s = Some(scan.time_s);
        let time_ns = self.drive.clock().nanoseconds(scan.time_s);
        let velocity_mps = outcome.motion.map(|motion| motion.velocity_mps);
        let moving = scene::moving(scan, time_ns, &outcome.weights, velocity_mps);
        out.push(Message { channel: radar.moving, time_ns, data: encode(&moving) });
        let frame = Frame {
            timestamp: Time::from(time_ns),
            sensor: scan.sensor,
            outcome: FrameOutcome { weights: vec![], ..outcome }.into(),
        };
        let data = encode_own(&frame, &NOT_IN_FRAMES);
        out.push(Message { channel: radar.frame, time_ns, data });
    }

    /// Whether a radar's angle is to be told again.
    fn is_angle_due(&self, sensor: u8, time_s: f64) -> bool {
        let Some(radar) = self.radars.iter().find(|radar| radar.sensor == sensor) else {
            return false;
        };
        let Some(told_s) = radar.told_s else { return true };
        let so_far_s = time_s - radar.first_s.unwrap_or(time_s);
        let step_s = if self.at_hand { STEP_S } else { STEP_S.max(STEP_SHARE * so_far_s) };
        time_s - told_s >= step_s
    }

    /// A radar's angle at a time, where that puts the radar, and a line for each thing that is new of it.
    fn angle(&mut self, sensor: u8, time_s: f64, estimate: &AngleEstimate, out: &mut Vec<Message>) {
        let Some(radar) = self.radars.iter_mut().find(|radar| radar.sensor == sensor) else {
            return;
        };
        let time_ns = self.drive.clock().nanoseconds(time_s);
        let CalibrationOptions { x_m, y_m, nominal_rad, .. } = radar.options;
        let angle = MountingAngle {
            timestamp: Time::from(time_ns),
            sensor,
            joint: self.joint,
            nominal_rad,
            drift_rad: estimate.drift_rad(&radar.options),
            estimate: estimate.into(),
        };
        out.push(Message { channel: radar.angle, time_ns, data: encode_own(&angle, &[]) });
        let mounting = Mounting { x_m, y_m, yaw_rad: estimate.angle_rad };
        self.drive.mounting(sensor, &mounting, time_ns, out);
        radar.told_s = Some(time_s);
        for (level, message) in news(radar, estimate) {
            self.drive.line(time_ns, level, format!("radar {sensor}"), message, out);
        }
    }
}

/// What of an estimate was not told yet: a verdict when it changes, a remark when it first comes.
fn news(radar: &mut Radar, estimate: &AngleEstimate) -> Vec<(LogLevel, String)> {
    let [angle, sigma] = [estimate.angle_rad, estimate.sigma_rad].map(f64::to_degrees);
    let mut lines = vec![];
    if estimate.alignment != radar.alignment {
        let drift = estimate.drift_rad(&radar.options).unwrap_or_default().to_degrees();
        let off = format!("{drift:+.3} +- {sigma:.3} deg off its nominal angle");
        match estimate.alignment {
            Some(Alignment::Aligned) => lines.push((LogLevel::Info, format!("aligned, {off}"))),
            Some(Alignment::Misaligned) => {
                lines.push((LogLevel::Warning, format!("misaligned, {off}")));
            }
            // So it begins; later it is news.
            Some(Alignment::Undecided) if radar.alignment.is_some() => {
                lines.push((LogLevel::Info, format!("no longer decided, {off}")));
            }
            _ => {}
        }
        radar.alignment = estimate.alignment;
    }
    if estimate.converged != radar.converged {
        let settled = if estimate.converged { "settled" } else { "no longer settled" };
        lines.push((LogLevel::Info, format!("{settled} at {angle:+.3} +- {sigma:.3} deg")));
        radar.converged = estimate.converged;
    }
    for remark in &estimate.remarks {
        if !radar.remarks.contains(remark) {
            radar.remarks.push(*remark);
            lines.push((LogLevel::Warning, remark.to_string()));
        }
    }
    lines
}
