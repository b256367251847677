//! What the parts of a packet hold.

use super::packet::{HEADER, Header, Part, u16_at, u32_at};
use super::{BoardFrame, BoardObject, BoardStats};
use crate::mmwave_cfg::RadarConfig;

/// What a configuration adds to the packets.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Scale {
    /// Width of a Doppler bin, m/s.
    rate_step_mps: f64,
    /// Virtual antennas.
    channels: usize,
}

impl Scale {
    pub fn of(config: &RadarConfig) -> Self {
        let waveform = &config.waveform;
        // The board pads its Doppler transform to a power of two.
        let bins = waveform.loops.next_power_of_two() as f64;
        Self {
            rate_step_mps: waveform.rate_resolution_mps() * waveform.loops as f64 / bins,
            channels: waveform.transmitters * config.receivers.len(),
        }
    }
}

/// Decodes the parts; `None` if one contradicts itself or the header.
pub(super) fn decode(
    header: &Header,
    header_bytes: usize,
    packet: &[u8],
    parts: &[Part<'_>],
    scale: Option<Scale>,
) -> Option<BoardFrame> {
    let sub_frame = if header_bytes == HEADER { u32_at(packet, 36)? } else { 0 };
    let mut frame = BoardFrame {
        frame_number: header.frame_number,
        sdk_version: header.version(),
        platform: header.platform_name(),
        sub_frame,
        cpu_cycles: header.cpu_cycles,
        objects: vec![],
        range_profile_db: None,
        noise_profile_db: None,
        azimuth_heat_map: None,
        range_doppler_db: None,
        stats: None,
        unknown_parts: 0,
        complete: true,
    };
    let modern = header.version()[0] >= 3;
    let db = profile_unit_db(header, modern, scale);
    let mut side: Option<&[u8]> = None;
    for part in parts {
        let bytes = part.payload;
        match part.kind {
            1 if modern => frame.objects = points(bytes, header.objects)?,
            1 => frame.objects = objects(bytes, scale)?,
            2 => frame.range_profile_db = Some(profile(bytes, db)?),
            3 => frame.noise_profile_db = Some(profile(bytes, db)?),
            4 | 8 => frame.azimuth_heat_map = Some(heat_map(bytes)?),
            5 => frame.range_doppler_db = Some(profile(bytes, db)?),
            6 => frame.stats = Some(stats(bytes)?),
            7 => side = Some(bytes),
            9 => {} // temperatures
            _ => frame.unknown_parts += 1,
        }
    }
    if let Some(side) = side {
        if side.len() < 4 * frame.objects.len() {
            return None;
        }
        for (object, entry) in frame.objects.iter_mut().zip(side.chunks_exact(4)) {
            object.snr_db = Some(f64::from(i16::from_le_bytes([entry[0], entry[1]])) * 0.1);
        }
    }
    Some(frame)
}

/// Decibels of one count of a profile. SDK 1 and 2 send the sum of `log2 |x|` over the virtual
/// antennas in Q8; SDK 3 the sum shifted right by the antennas' count rounded up to a power of two.
fn profile_unit_db(header: &Header, modern: bool, scale: Option<Scale>) -> f64 {
    let assumed = if header.platform >> 4 == 0xa164 { 8 } else { 12 };
    let channels = scale.map_or(assumed, |s| s.channels.max(1));
    let divisor = if modern {
        channels as f64 / channels.next_power_of_two() as f64
    } else {
        channels as f64
    };
    20.0 * 2.0_f64.log10() / (256.0 * divisor)
}

/// Detected objects of SDK 1 and 2: a count, a Q format, and 12 bytes each.
fn objects(bytes: &[u8], scale: Option<Scale>) -> Option<Vec<BoardObject>> {
    let count = usize::from(u16_at(bytes, 0)?);
    let q_format = u16_at(bytes, 2)?;
    let body = bytes.get(4..4 + 12 * count)?;
    if q_format > 15 {
        return None;
    }
    let unit = 1.0 / f64::from(1_u32 << q_format);
    Some(
        body.chunks_exact(12)
            .map(|entry| {
                let word = |k: usize| u16::from_le_bytes([entry[2 * k], entry[2 * k + 1]]);
                let signed = |k: usize| word(k) as i16;
                let metres = |k: usize| f64::from(signed(k)) * unit;
                let doppler = i32::from(signed(1));
                let rate = scale.map(|s| f64::from(doppler) * s.rate_step_mps);
                BoardObject {
                    range_bin: Some(usize::from(word(0))),
                    doppler_bin: Some(doppler),
                    peak: Some(f64::from(word(2))),
                    ..placed(metres(3), metres(4), metres(5), rate)
                }
            })
            .collect(),
    )
}

/// Detected points of SDK 3: x, y, z and range rate as floats.
fn points(bytes: &[u8], count: usize) -> Option<Vec<BoardObject>> {
    let body = bytes.get(..count.checked_mul(16)?)?;
    body.chunks_exact(16)
        .map(|entry| {
            let float = |k: usize| {
                let word = &entry[4 * k..4 * k + 4];
                let value = f64::from(f32::from_le_bytes([word[0], word[1], word[2], word[3]]));
                value.is_finite().then_some(value)
            };
            Some(placed(float(0)?, float(1)?, float(2)?, Some(float(3)?)))
        })
        .collect()
}

/// An object from the board's coordinates: x right, y forward, z up.
fn placed(right_m: f64, forward_m: f64, up_m: f64, rate_mps: Option<f64>) -> BoardObject {
    let left_m = if right_m == 0.0 { 0.0 } else { -right_m };
    let ground_m = forward_m.hypot(left_m);
    BoardObject {
        range_m: ground_m.hypot(up_m),
        rate_mps,
        azimuth_rad: left_m.atan2(forward_m),
        elevation_rad: up_m.atan2(ground_m),
        x_m: forward_m,
        y_m: left_m,
        z_m: up_m,
        range_bin: None,
        doppler_bin: None,
        peak: None,
        snr_db: None,
    }
}

fn profile(bytes: &[u8], unit_db: f64) -> Option<Vec<f64>> {
    let count = |word: &[u8]| f64::from(u16::from_le_bytes([word[0], word[1]]));
    let whole = bytes.len().is_multiple_of(2);
    whole.then(|| bytes.chunks_exact(2).map(|word| count(word) * unit_db).collect())
}

/// Q before I, 16 bits each.
fn heat_map(bytes: &[u8]) -> Option<Vec<f32>> {
    bytes.len().is_multiple_of(4).then(|| {
        bytes
            .chunks_exact(4)
            .flat_map(|entry| {
                let imaginary = i16::from_le_bytes([entry[0], entry[1]]);
                let real = i16::from_le_bytes([entry[2], entry[3]]);
                [f32::from(real), f32::from(imaginary)]
            })
            .collect()
    })
}

/// Times come in microseconds.
fn stats(bytes: &[u8]) -> Option<BoardStats> {
    let at = |index: usize| u32_at(bytes, 4 * index);
    let seconds = |index: usize| at(index).map(|time_us| f64::from(time_us) * 1e-6);
    Some(BoardStats {
        processing_s: seconds(0)?,
        transmit_s: seconds(1)?,
        frame_margin_s: seconds(2)?,
        chirp_margin_s: seconds(3)?,
        active_load_percent: at(4)?,
        idle_load_percent: at(5)?,
    })
}
