//! Takes the commands one by one and makes a [`RadarConfig`] of them.

use super::antennas::{AntennaLines, preset_of};
use super::compensation::Compensation;
use super::frames::{Advanced, BinaryPhase, Frame};
use super::line::{Line, clipped};
use super::sequence::{Chirps, sequence};
use super::{AdcFormat, RadarConfig, SubFrame, platform_layout};
use crate::dca1000::layout::{CASCADE_RECEIVERS, Layout};
use crate::error::FormatError;
use boresight_core::Remark;
use boresight_core::{InputError, Sampling, Waveform, presets};

/// Settings of the board and its own processing: they leave the raw samples as they are.
const WITHOUT_EFFECT: [&str; 30] = [
    "sensorStart",
    "sensorStop",
    "flushCfg",
    "lowPower",
    "guiMonitor",
    "cfarCfg",
    "peakGrouping",
    "multiObjBeamForming",
    "clutterRemoval",
    "calibDcRangeSig",
    "extendedMaxVelocity",
    "nearFieldCfg",
    "measureRangeBiasAndRxChanPhase",
    "CQRxSatMonitor",
    "CQSigImgMonitor",
    "analogMonitor",
    "aoaFovCfg",
    "cfarFovCfg",
    "calibData",
    "configDataPort",
    "queryDemoStatus",
    "version",
    "rangeBias",
    "quit",
    "exit",
    "idlePowerDown",
    "trackingCfg",
    "staticBoundaryBox",
    "boundaryBox",
    "sensorPosition",
];

/// Most remarks kept; further ones are counted.
const MOST_REMARKS: usize = 50;

/// What `profileCfg` says.
#[derive(Clone, Copy)]
struct Profile {
    start_frequency_hz: f64,
    idle_s: f64,
    adc_start_s: f64,
    ramp_s: f64,
    slope_hz_per_s: f64,
    samples: usize,
    sample_rate_hz: f64,
}

/// What `adcbufCfg` says, with the line it stood on.
#[derive(Clone, Copy)]
struct Buffer {
    line: usize,
    real: bool,
    q_first: bool,
    receiver_major: bool,
}

/// State while reading.
#[derive(Default)]
pub(super) struct Commands {
    platform: Option<String>,
    sdk_version: Option<String>,
    masks: Option<(u32, u32)>,
    cascaded: bool,
    adc: Option<(u32, usize)>,
    buffer: Option<Buffer>,
    profiles: Vec<(usize, Profile)>,
    chirps: Vec<Chirps>,
    frame: Option<(Frame, usize)>,
    antennas: AntennaLines,
    advanced: Option<Advanced>,
    sub_frames: Vec<(usize, Frame)>,
    /// Whether `dfeDataOutputMode` asks for an advanced frame.
    mode: Option<bool>,
    coding: Vec<BinaryPhase>,
    /// The sub-frame a comment chooses.
    chosen: Option<usize>,
    compensation: Option<Compensation>,
    compensation_line: usize,
    remarks: Vec<Remark>,
    further_remarks: usize,
}

impl Commands {
    /// Looks for what the visualizer writes in comments.
    pub fn comment(&mut self, comment: &str) {
        let value = |key: &str| {
            let rest = comment.trim().strip_prefix(key)?.trim();
            Some(clipped(rest.split_whitespace().next()?))
        };
        if let Some(platform) = value("Platform:") {
            self.platform = Some(platform);
        } else if let Some(version) = value("Created for SDK ver:") {
            self.sdk_version = Some(version);
        } else if let Some(number) = value("Sub-frame:") {
            self.chosen = number.parse().ok();
        }
    }

    /// Takes one command.
    pub fn take(&mut self, line: &Line<'_>) -> Result<(), FormatError> {
        match line.command {
            "dfeDataOutputMode" => {
                let mode = line.integer(0, "mode", 1, 3)?;
                if mode == 2 {
                    let expected = "1 (frames of chirps) or 3 (advanced frames)";
                    return Err(line.error("mode", expected, mode.to_string()));
                }
                self.mode = Some(mode == 3);
            }
            "channelCfg" => self.channels(line)?,
            "adcCfg" => {
                let bits = [12, 14, 16][line.index(0, "number of bits", 2)?];
                let format = line.index(1, "output format", 2)?;
                self.adc = Some((bits, format));
            }
            "adcbufCfg" | "adcbufcfg" => self.buffer(line)?,
            "profileCfg" => self.profile(line)?,
            "chirpCfg" => self.chirp(line)?,
            "frameCfg" => self.frame = Some(Frame::plain(line)?),
            "advFrameCfg" => self.advanced = Some(Advanced::of(line)?),
            "subFrameCfg" => {
                let (number, part) = Frame::part(line)?;
                self.sub_frames.retain(|(known, _)| *known != number);
                self.sub_frames.push((number, part));
            }
            "bpmCfg" => {
                let coding = BinaryPhase::of(line)?;
                self.coding.retain(|known| known.sub_frame != coding.sub_frame);
                self.coding.push(coding);
            }
            "lvdsStreamCfg" => {
                for (index, what) in [(1, "header"), (3, "software session")] {
                    if line.index(index, what, 1)? == 1 {
                        return Err(line.error(what, "0 (samples alone in the capture)", "1"));
                    }
                }
            }
            "antGeometry0" | "antGeometry1" | "antPhaseRot" => self.antennas.take(line)?,
            "compRangeBiasAndRxChanPhase" => self.compensation(line),
            "contModeCfg" => {
                return Err(line.error("frame mode", "frameCfg or advFrameCfg", line.command));
            }
            name if WITHOUT_EFFECT.contains(&name) => {}
            name => {
                let text = format!("line {}: {} is not known; ignored", line.number, clipped(name));
                self.remark("unknown-command", text);
            }
        }
        Ok(())
    }

    fn remark(&mut self, code: &'static str, message: String) {
        if self.remarks.len() < MOST_REMARKS {
            self.remarks.push(Remark::new(code, message));
        } else {
            self.further_remarks += 1;
        }
    }

    fn channels(&mut self, line: &Line<'_>) -> Result<(), FormatError> {
        line.count(3, 3)?;
        let mask =
            |index, what| line.integer(index, what, 1, 0xffff).map(|m| m.unsigned_abs() as u32);
        self.masks = Some((mask(0, "receiver mask")?, mask(1, "transmitter mask")?));
        self.cascaded = match line.integer(2, "cascading", 0, 2)? {
            0 => false,
            1 => true,
            _ => {
                let expected =
                    "0 (one chip), or 1 with the receivers and transmitters of all chips";
                return Err(line.error("cascading", expected, "2 (a slave by itself)"));
            }
        };
        let (rx, tx) = self.masks.unwrap_or_default();
        if self.cascaded && rx != 0xffff {
            let expected = "65535 (all 16 of the cascade, 4 a chip)";
            return Err(line.error("receiver mask", expected, rx.to_string()));
        }
        if self.cascaded && tx > 0xfff {
            let expected = "at most 4095 (12 of the cascade, 3 a chip)";
            return Err(line.error("transmitter mask", expected, tx.to_string()));
        }
        Ok(())
    }

    fn buffer(&mut self, line: &Line<'_>) -> Result<(), FormatError> {
        line.count(4, 5)?;
        // SDK 1 has no sub-frame number in front.
        let at = line.arguments.len() - 4;
        let real = line.index(at, "output format", 1)? == 1;
        let q_first = line.index(at + 1, "sample swap", 1)? == 1;
        let receiver_major = line.index(at + 2, "channel interleave", 1)? == 1;
        self.buffer = Some(Buffer { line: line.number, real, q_first, receiver_major });
        Ok(())
    }

    fn profile(&mut self, line: &Line<'_>) -> Result<(), FormatError> {
        line.count(14, 14)?;
        let id = line.index(0, "profile", 3)?;
        let profile = Profile {
            start_frequency_hz: line.number(1, "start frequency (GHz)", 1.0, 300.0)? * 1e9,
            idle_s: line.number(2, "idle time (us)", 0.0, 1e5)? * 1e-6,
            adc_start_s: line.number(3, "ADC start time (us)", 0.0, 1e5)? * 1e-6,
            ramp_s: line.number(4, "ramp end time (us)", 0.0, 1e5)? * 1e-6,
            slope_hz_per_s: line.number(7, "slope (MHz/us)", 1e-3, 1e3)? * 1e12,
            samples: line.index(9, "samples", 65_536)?,
            sample_rate_hz: line.number(10, "sample rate (ksps)", 1.0, 1e6)? * 1e3,
        };
        if profile.samples < 2 {
            return Err(line.error("samples", "at least 2", profile.samples.to_string()));
        }
        let end_s = profile.adc_start_s + profile.samples as f64 / profile.sample_rate_hz;
        if end_s > profile.ramp_s * (1.0 + 1e-9) {
            return Err(line.error(
                "time of the last sample",
                format!("at most the ramp end time, {:.3} us", profile.ramp_s * 1e6),
                format!("{:.3} us", end_s * 1e6),
            ));
        }
        self.profiles.retain(|(known, _)| *known != id);
        self.profiles.push((id, profile));
        Ok(())
    }

    fn chirp(&mut self, line: &Line<'_>) -> Result<(), FormatError> {
        line.count(8, 8)?;
        let first = line.index(0, "first chirp", 511)?;
        let last = line.integer(1, "last chirp", first as i64, 511)?.unsigned_abs() as usize;
        let profile = line.index(2, "profile", 3)?;
        let variations = ["start frequency", "slope", "idle time", "ADC start time"];
        for (k, what) in variations.into_iter().enumerate() {
            let value = line.number(3 + k, what, -1e12, 1e12)?;
            if value != 0.0 {
                let what = format!("variation of the {what}");
                return Err(line.error(what, "0 (all chirps alike)", value.to_string()));
            }
        }
        let tx_mask = line.integer(7, "transmitter mask", 1, 0xffff)?.unsigned_abs() as u32;
        self.chirps.push(Chirps { line: line.number, first, last, profile, tx_mask });
        Ok(())
    }

    /// Coefficients other than unity are applied where the channels of a capture are.
    fn compensation(&mut self, line: &Line<'_>) {
        let found = Compensation::of(line);
        match &found {
            None => self.remark(
                "compensation-not-applied",
                format!(
                    "line {}: range bias and channel phases cannot be read; not applied",
                    line.number
                ),
            ),
            Some(_) => self.compensation_line = line.number,
        }
        self.compensation = found;
    }

    /// Puts the parts together and checks them against each other.
    pub fn finish(mut self) -> Result<RadarConfig, FormatError> {
        let missing = |command, purpose| FormatError::MissingCommand { command, purpose };
        let (rx_mask, tx_mask) =
            self.masks.ok_or(missing("channelCfg", "receivers and transmitters"))?;
        if self.profiles.is_empty() {
            return Err(missing("profileCfg", "the ramp and its samples"));
        }
        if self.chirps.is_empty() {
            return Err(missing("chirpCfg", "the transmitter of each chirp"));
        }
        let (frames, count) = self.frames()?;
        let sub_frames = frames
            .iter()
            .enumerate()
            .map(|(number, frame)| self.sub_frame(number, frame, tx_mask))
            .collect::<Result<Vec<SubFrame>, FormatError>>()?;
        let chosen = self.chosen.unwrap_or(0);
        let Some(SubFrame { waveform, transmitters }) = sub_frames.get(chosen).cloned() else {
            let (what, last) = ("sub-frame", sub_frames.len() - 1);
            let (expected, given) = (format!("from 0 to {last}"), chosen as f64);
            return Err(InputError::OutOfRange { what: what.into(), expected, given }.into());
        };
        let (bits, format) = self.adc.unwrap_or_else(|| {
            self.remark("assumed", "no adcCfg line: 16 bits, complex assumed".into());
            (16, 1)
        });
        if format == 2 {
            let text = "complex 2x sampling: negative beat frequencies hold the image band";
            self.remark("complex-2x", text.into());
        }
        let (q_first, layout) = (self.buffer.is_some_and(|b| b.q_first), self.layout());
        if self.further_remarks > 0 {
            let text = format!("{} further remarks left out", self.further_remarks);
            self.remarks.push(Remark::new("remarks-left-out", text));
        }
        let receivers = match self.cascaded {
            true => CASCADE_RECEIVERS.to_vec(),
            false => (0..16).filter(|rx| rx_mask >> rx & 1 == 1).collect(),
        };
        let mut config = RadarConfig {
            waveform,
            receivers,
            transmitters,
            sub_frame: chosen,
            sub_frames,
            array_preset: None,
            board: None,
            platform: self.platform,
            sdk_version: self.sdk_version,
            adc: AdcFormat { bits, q_first, layout },
            frames: (count > 0).then_some(count),
            compensation: self.compensation,
            antenna_lines: false,
            remarks: self.remarks,
        };
        config.board = self.antennas.board()?;
        config.antenna_lines = config.board.is_some();
        if layout != Layout::Cascade
            && config.board.is_none()
            && let Some((name, assumed)) = config.platform.as_deref().and_then(preset_of)
        {
            config.board = presets::preset(name).ok();
            config.remarks.extend(assumed);
        }
        config.find_preset();
        if let Some(applied) = config.has_coefficients() {
            let (code, text) = if applied {
                ("compensation-applied", "are applied, unless another calibration is given")
            } else {
                ("compensation-not-applied", "are not of all channels in use; not applied")
            };
            let text =
                format!("line {}: range bias and channel phases {text}", self.compensation_line);
            config.remarks.push(Remark::new(code, text));
        }
        Ok(config)
    }

    /// The frame, or its sub-frames, and the number of frames.
    fn frames(&self) -> Result<(Vec<Frame>, usize), FormatError> {
        let missing = |command, purpose| FormatError::MissingCommand { command, purpose };
        let advanced = self.mode.unwrap_or(self.frame.is_none() && self.advanced.is_some());
        if advanced {
            let advanced =
                self.advanced.ok_or(missing("advFrameCfg", "the number of sub-frames"))?;
            return Ok((advanced.parts(&self.sub_frames)?, advanced.frames));
        }
        let (frame, count) =
            self.frame.ok_or(missing("frameCfg", "chirps and loops of a frame"))?;
        Ok((vec![frame], count))
    }

    /// Waveform and transmitters of a frame or sub-frame.
    fn sub_frame(
        &mut self,
        number: usize,
        frame: &Frame,
        tx_mask: u32,
    ) -> Result<SubFrame, FormatError> {
        let at = frame.at();
        let of = |wanted| self.coding.iter().find(|coding| coding.sub_frame == wanted);
        let sequence = sequence(frame, &self.chirps, of(Some(number)).or_else(|| of(None)))?;
        let transmitters = sequence.order;
        if let Some(&tx) = transmitters.iter().find(|&&tx| tx_mask >> tx & 1 == 0) {
            return Err(at.error(
                "transmitters of its chirps",
                format!("those channelCfg enables (mask {tx_mask})"),
                format!("transmitter {tx} (mask {})", 1_u64 << tx),
            ));
        }
        let profile = self.used_profile(frame, &at)?;
        let waveform = Waveform {
            start_frequency_hz: profile.start_frequency_hz,
            slope_hz_per_s: profile.slope_hz_per_s,
            sample_rate_hz: profile.sample_rate_hz,
            sampling: self.sampling()?,
            samples: profile.samples,
            adc_start_s: profile.adc_start_s,
            chirp_interval_s: profile.idle_s + profile.ramp_s,
            transmitters: transmitters.len(),
            loops: frame.loops * sequence.repeats,
            frame_interval_s: frame.interval_s,
            multiplexing: sequence.multiplexing,
            doppler_bands: None,
        };
        waveform.check().map_err(|error| match error {
            InputError::OutOfRange { what, expected, given } => {
                at.error(what, expected, given.to_string())
            }
            other => other.into(),
        })?;
        Ok(SubFrame { waveform, transmitters })
    }

    /// Whether samples are complex or real, on which `adcCfg` and `adcbufCfg` agree.
    fn sampling(&self) -> Result<Sampling, FormatError> {
        let of = |real| if real { Sampling::Real } else { Sampling::Complex };
        let told = self.adc.map(|(_, format)| of(format == 0));
        let Some(buffer) = self.buffer else { return Ok(told.unwrap_or_default()) };
        let given = of(buffer.real);
        if let Some(told) = told.filter(|&told| told != given) {
            let line = Line { number: buffer.line, command: "adcbufCfg", arguments: vec![] };
            let name = |sampling| match sampling {
                Sampling::Complex => "0 (complex)",
                Sampling::Real => "1 (real)",
            };
            let expected = format!("{}, as adcCfg says", name(told));
            return Err(line.error("output format", expected, name(given)));
        }
        Ok(given)
    }

    /// Where samples stand: as the buffer's interleave says, which alone is of the board's own making; where nothing
    /// says it, as the platform has it.
    fn layout(&mut self) -> Layout {
        if self.cascaded {
            return Layout::Cascade;
        }
        let platform = self.platform.clone().unwrap_or_default();
        let of_platform = platform_layout(&platform);
        let Some(buffer) = self.buffer else {
            let layout = of_platform.unwrap_or(Layout::TwoLane);
            let receivers = match layout {
                Layout::FourLane => "receivers sample by sample",
                _ => "receivers one after another",
            };
            let text = format!("no adcbufCfg line: I before Q and {receivers} assumed");
            self.remark("assumed", text);
            return layout;
        };
        let layout = if buffer.receiver_major { Layout::TwoLane } else { Layout::FourLane };
        if let Some(other) = of_platform.filter(|&other| other != layout) {
            let lanes = if other == Layout::FourLane { "four" } else { "two" };
            let text = format!(
                "line {}: channel interleave {} is not what {platform} has, whose samples come over {lanes} lanes; \
                 it is taken at its word",
                buffer.line,
                u8::from(buffer.receiver_major)
            );
            self.remark("lanes", text);
        }
        layout
    }

    /// The one profile all chirps of the frame follow.
    fn used_profile(&mut self, frame: &Frame, line: &Line<'_>) -> Result<Profile, FormatError> {
        let mut used: Vec<usize> = self
            .chirps
            .iter()
            .filter(|c| c.first <= frame.last && c.last >= frame.first)
            .map(|c| c.profile)
            .collect();
        if let Some(forced) = frame.forced_profile {
            used = vec![forced];
        }
        boresight_math::order::sort_by(&mut used, Ord::cmp);
        used.dedup();
        if used.len() > 1 {
            return Err(line.error("profiles of its chirps", "one", format!("{used:?}")));
        }
        let id = used.first().copied().unwrap_or_default();
        let found = self.profiles.iter().find(|(known, _)| *known == id).map(|(_, p)| *p);
        if self.profiles.len() > 1 && frame.command == "frameCfg" {
            let text = format!("several profiles; the frame uses profile {id}");
            self.remark("several-profiles", text);
        }
        found.ok_or_else(|| {
            line.error("profile of its chirps", format!("a profileCfg line for {id}"), "none")
        })
    }
}
