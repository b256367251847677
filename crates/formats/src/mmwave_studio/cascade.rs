//! The four chips of a cascade: settings that they share are taken from the master.

use super::field::Field;
use super::{command, frame, identical, iq_swap, is_one_bit, profiles, samples};
use crate::dca1000::layout::{CHIP_TRANSMITTERS, CHIPS};
use crate::error::FormatError;

/// Bits of the receivers of one chip.
const CHIP_RECEIVERS: f64 = 15.0;
/// Highest chirp number of mmWaveLink.
const LAST_CHIRP: f64 = 511.0;

pub fn translate(
    all: &Field<'_>,
    devices: &[Field<'_>],
    text: &mut String,
) -> Result<(), FormatError> {
    if devices.len() != CHIPS {
        return Err(FormatError::ConfigField {
            field: all.path.clone(),
            expected: "one device, or the four of a cascade".into(),
            given: format!("{} devices", devices.len()),
        });
    }
    let chips: Vec<_> = devices.iter().map(|device| device.at("rfConfig")).collect();
    let master = &chips[0];
    let mut transmitters = 0;
    for (k, chip) in chips.iter().enumerate() {
        let channels = chip.at("rlChanCfg_t");
        let expected = "0xF: all receivers of each chip of a cascade";
        channels.at("rxChannelEn").allow(&[CHIP_RECEIVERS], expected)?;
        transmitters |= mask(&channels.at("txChannelEn"), k)?;
    }
    let format = devices[0].at("rawDataCaptureConfig.rlDevDataFmtCfg_t");
    command(text, "channelCfg", &[65_535.0, f64::from(transmitters), 1.0]);
    samples(&master.at("rlAdcOutCfg_t.fmt"), text)?;
    command(text, "adcbufCfg", &[-1.0, 0.0, iq_swap(&format)?, 0.0, 0.0]);
    profiles(master, text)?;
    chirps(&chips, text)?;
    frame(master, text)
}

/// One command a chirp, with the transmitters of all chips.
fn chirps(chips: &[Field<'_>], text: &mut String) -> Result<(), FormatError> {
    let frame = chips[0].at("rlFrameCfg_t");
    let [first, last] = frame.numbers(["chirpStartIdx", "chirpEndIdx"])?;
    let whole = first.fract() == 0.0 && last.fract() == 0.0;
    if !(whole && first >= 0.0 && first <= last && last <= LAST_CHIRP) {
        return Err(frame.at("chirpEndIdx").error("a chirp from the first to 511"));
    }
    for index in first as u32..=last as u32 {
        let mut transmitters = 0;
        let mut of_master = None;
        for (k, chip) in chips.iter().enumerate() {
            let chirp = chirp_of(chip, f64::from(index))?;
            identical(&chirp)?;
            transmitters |= mask(&chirp.at("txEnable"), k)?;
            of_master.get_or_insert(chirp);
        }
        let Some(chirp) = of_master else { continue };
        if !is_one_bit(f64::from(transmitters)) {
            return Err(chirp.at("txEnable").error("chirps of one transmitter of all chips each"));
        }
        let (index, profile) = (f64::from(index), chirp.at("profileId").number()?);
        let values = [index, index, profile, 0.0, 0.0, 0.0, 0.0, f64::from(transmitters)];
        command(text, "chirpCfg", &values);
    }
    Ok(())
}

/// The settings of a chip that contain a chirp.
fn chirp_of<'a>(chip: &Field<'a>, index: f64) -> Result<Field<'a>, FormatError> {
    let chirps = chip.at("rlChirps");
    for one in chirps.items("at least one chirp")? {
        let one = one.at("rlChirpCfg_t");
        let [first, last] = one.numbers(["chirpStartIdx", "chirpEndIdx"])?;
        if (first..=last).contains(&index) {
            return Ok(one);
        }
    }
    Err(FormatError::ConfigField {
        field: chirps.path,
        expected: format!("settings of chirp {index}"),
        given: "none".into(),
    })
}

/// Bits of a chip's transmitters among those of all chips.
fn mask(field: &Field<'_>, chip: usize) -> Result<u32, FormatError> {
    let bits = field.number()?;
    let most = f64::from((1_u32 << CHIP_TRANSMITTERS) - 1);
    if bits.fract() == 0.0 && (0.0..=most).contains(&bits) {
        return Ok((bits as u32) << (CHIP_TRANSMITTERS * chip));
    }
    Err(field.error("the bits of a chip's three transmitters"))
}
