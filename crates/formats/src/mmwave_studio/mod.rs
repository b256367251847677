//! The JSON configuration of Texas Instruments' mmWave Studio: `NAME.mmwave.json`, and
//! `NAME.setup.json`, which names the board.
//!
//! Both are translated into the commands of a `.cfg` file, whose reader ([`crate::mmwave_cfg`]) checks
//! the values. Field names are those of TI's mmWaveLink interface.

mod cascade;
mod field;

use crate::error::FormatError;
use field::{Field, parse};

/// Appends a command of a `.cfg` file.
fn command(text: &mut String, name: &str, values: &[f64]) {
    text.push_str(name);
    for value in values {
        text.push(' ');
        text.push_str(&value.to_string());
    }
    text.push('\n');
}

/// Whether text is JSON rather than the commands of a `.cfg` file.
pub fn is_json(text: &[u8]) -> bool {
    let text = text.strip_prefix("\u{feff}".as_bytes()).unwrap_or(text);
    text.trim_ascii_start().first() == Some(&b'{')
}

/// Translates mmWave Studio's JSON into the text of a `.cfg` file. Without `setup` the text does not
/// name the board.
///
/// # Errors
/// [`FormatError::ConfigField`] for a field that is missing or has a value that is not supported:
/// advanced frames, phase coding, chirps of several transmitters, and formats that the DCA1000
/// does not record; [`FormatError::Json`] for text that is not JSON.
pub fn config_text(mmwave: &[u8], setup: Option<&[u8]>) -> Result<String, FormatError> {
    let mut text = String::new();
    if let Some(setup) = setup {
        let value = parse(setup, ".setup.json")?;
        text = format!("% Platform:{}\n", platform(&Field::root(&value))?);
    }
    let value = parse(mmwave, ".mmwave.json")?;
    translate(&Field::root(&value), &mut text)?;
    Ok(text)
}

/// The name of a device: three letters and four digits, as in awr1843.
fn platform<'a>(setup: &Field<'a>) -> Result<&'a str, FormatError> {
    let device = setup.at("mmWaveDevice");
    let is_name = |name: &&str| {
        let (letters, rest) = name.split_at_checked(3).unwrap_or_default();
        let digits = rest.get(..4).unwrap_or_default();
        letters.bytes().all(|byte| byte.is_ascii_alphabetic())
            && digits.len() == 4
            && digits.bytes().all(|byte| byte.is_ascii_digit())
            && rest.bytes().all(|byte| byte.is_ascii_alphanumeric())
    };
    let name = device.text().filter(is_name);
    name.ok_or_else(|| device.error("the name of a device, such as \"awr1843\""))
}

fn translate(file: &Field<'_>, text: &mut String) -> Result<(), FormatError> {
    let all = file.at("mmWaveDevices");
    let devices = all.items("at least one device, as mmWave Studio writes it in .mmwave.json")?;
    for device in &devices {
        let rf = device.at("rfConfig");
        rf.at("waveformType").allow_text("legacyFrameChirp", "frames of identical chirps")?;
        rf.at("MIMOScheme").allow_text("TDM", "one transmitter at a time")?;
        for chirp in rf.at("rlBpmChirps").optional_items() {
            chirp.at("rlBpmChirpCfg_t.constBpmVal").allow(&[0.0], "0: no phase coding")?;
        }
    }
    match &devices[..] {
        [device] => single(device, text),
        _ => cascade::translate(&all, &devices, text),
    }
}

fn single(device: &Field<'_>, text: &mut String) -> Result<(), FormatError> {
    let rf = device.at("rfConfig");
    let channels = rf.at("rlChanCfg_t");
    channels.at("cascading").allow(&[0.0], "0: one chip")?;
    let masks = channels.numbers(["rxChannelEn", "txChannelEn"])?;
    command(text, "channelCfg", &[masks[0], masks[1], 0.0]);
    let format = rf.at("rlAdcOutCfg_t.fmt");
    samples(&format, text)?;
    let is_real = format.at("b2AdcOutFmt").number()? == 0.0;
    layout(&device.at("rawDataCaptureConfig"), is_real, text)?;
    profiles(&rf, text)?;
    for chirps in rf.at("rlChirps").items("at least one chirp")? {
        let chirps = chirps.at("rlChirpCfg_t");
        identical(&chirps)?;
        let enabled = chirps.at("txEnable");
        let transmitter = enabled.number()?;
        if !is_one_bit(transmitter) {
            return Err(enabled.error("one bit: chirps of one transmitter each"));
        }
        let [first, last, profile] =
            chirps.numbers(["chirpStartIdx", "chirpEndIdx", "profileId"])?;
        let values = [first, last, profile, 0.0, 0.0, 0.0, 0.0, transmitter];
        command(text, "chirpCfg", &values);
    }
    frame(&rf, text)
}

fn samples(format: &Field<'_>, text: &mut String) -> Result<(), FormatError> {
    format.at("b2AdcBits").allow(&[0.0, 1.0, 2.0], "0, 1 or 2 (12, 14 or 16 bits)")?;
    format.at("b2AdcOutFmt").allow(&[0.0, 1.0, 2.0], "0 (real), 1 or 2 (complex samples)")?;
    command(text, "adcCfg", &format.numbers(["b2AdcBits", "b2AdcOutFmt"])?);
    Ok(())
}

fn layout(capture: &Field<'_>, is_real: bool, text: &mut String) -> Result<(), FormatError> {
    let path = capture.at("rlDevDataPathCfg_t");
    path.at("intfSel").allow(&[1.0], "1: LVDS, which the DCA1000 records")?;
    path.at("transferFmtPkt0").allow(&[1.0], "0x1: samples only")?;
    path.at("transferFmtPkt1").allow(&[0.0], "0x0: no second packet")?;
    let lanes = capture.at("rlDevLaneEnable_t.laneEn");
    let known =
        "0x3: two lanes (xWR16xx, xWR18xx, xWR68xx), or 0xF: four (xWR12xx, xWR14xx, xWR22xx)";
    lanes.allow(&[3.0, 15.0], known)?;
    let format = capture.at("rlDevDataFmtCfg_t");
    let interleave = format.at("chInterleave");
    let two = "1: one receiver after another, over two lanes";
    let four = "0: receivers sample by sample, over four lanes";
    match lanes.value {
        None => interleave.allow(&[0.0, 1.0], two)?,
        Some(_) if lanes.number()? == 15.0 => interleave.allow(&[0.0], four)?,
        Some(_) => interleave.allow(&[1.0], two)?,
    }
    let swap = iq_swap(&format)?;
    let values = [-1.0, f64::from(u8::from(is_real)), swap, interleave.number()?, 0.0];
    command(text, "adcbufCfg", &values);
    Ok(())
}

fn iq_swap(format: &Field<'_>) -> Result<f64, FormatError> {
    let swap = format.at("iqSwapSel");
    swap.allow(&[0.0, 1.0], "0 (I first) or 1 (Q first)")?;
    swap.number()
}

fn profiles(rf: &Field<'_>, text: &mut String) -> Result<(), FormatError> {
    for profile in rf.at("rlProfiles").items("at least one profile")? {
        let profile = profile.at("rlProfileCfg_t");
        let [id, start, idle, adc, ramp, slope, samples, rate] = profile.numbers([
            "profileId",
            "startFreqConst_GHz",
            "idleTimeConst_usec",
            "adcStartTimeConst_usec",
            "rampEndTime_usec",
            "freqSlopeConst_MHz_usec",
            "numAdcSamples",
            "digOutSampleRate",
        ])?;
        let values =
            [id, start, idle, adc, ramp, 0.0, 0.0, slope, 0.0, samples, rate, 0.0, 0.0, 0.0];
        command(text, "profileCfg", &values);
    }
    Ok(())
}

/// Refuses chirps that differ from their profile.
fn identical(chirps: &Field<'_>) -> Result<(), FormatError> {
    let variations =
        ["startFreqVar_MHz", "freqSlopeVar_KHz_usec", "idleTimeVar_usec", "adcStartTimeVar_usec"];
    variations.into_iter().try_for_each(|name| chirps.at(name).allow(&[0.0], "0: identical chirps"))
}

fn frame(rf: &Field<'_>, text: &mut String) -> Result<(), FormatError> {
    let frame = rf.at("rlFrameCfg_t");
    let [first, last, loops, frames, period] = frame.numbers([
        "chirpStartIdx",
        "chirpEndIdx",
        "numLoops",
        "numFrames",
        "framePeriodicity_msec",
    ])?;
    command(text, "frameCfg", &[first, last, loops, frames, period, 1.0, 0.0]);
    Ok(())
}

/// Whether a bit mask names one transmitter.
fn is_one_bit(mask: f64) -> bool {
    mask.fract() == 0.0 && (1.0..=65_536.0).contains(&mask) && (mask as u32).is_power_of_two()
}

#[cfg(test)]
mod tests;
