//! From chirps to the sequence of transmitters.

use super::frames::{BinaryPhase, Frame};
use super::line::Line;
use crate::error::FormatError;
use boresight_core::Multiplexing;

/// A run of chirps with the same settings.
#[derive(Debug, Clone, Copy)]
pub(super) struct Chirps {
    /// Line they stood on.
    pub line: usize,
    /// First chirp.
    pub first: usize,
    /// Last chirp.
    pub last: usize,
    /// Profile it follows.
    pub profile: usize,
    /// Bits of the transmitters that send.
    pub tx_mask: u32,
}

/// Transmitters in a loop.
pub(super) struct Sequence {
    /// In order of transmission.
    pub order: Vec<usize>,
    /// How often that order repeats within one loop of the frame.
    pub repeats: usize,
    pub multiplexing: Multiplexing,
}

/// The sequence of a frame's chirps.
pub(super) fn sequence(
    frame: &Frame,
    chirps: &[Chirps],
    coding: Option<&BinaryPhase>,
) -> Result<Sequence, FormatError> {
    let at = frame.at();
    let mut all = Vec::with_capacity(frame.last + 1 - frame.first);
    for index in frame.first..=frame.last {
        let found = chirps.iter().rev().find(|c| (c.first..=c.last).contains(&index));
        all.push(*found.ok_or_else(|| {
            at.error("chirps", format!("a chirpCfg line for chirp {index}"), "none")
        })?);
    }
    match coding.and_then(|coding| Some((coding, coding.chirps?))) {
        Some((coding, pair)) => binary_phase(frame, &all, coding, pair),
        None => in_turn(&at, &all),
    }
}

/// One transmitter a chirp.
fn in_turn(at: &Line<'_>, chirps: &[Chirps]) -> Result<Sequence, FormatError> {
    let mut order = Vec::with_capacity(chirps.len());
    for chirp in chirps {
        let mask = chirp.tx_mask;
        if mask.count_ones() != 1 {
            let line = Line { number: chirp.line, command: "chirpCfg", arguments: vec![] };
            return Err(line.error(
                "transmitter mask",
                "one transmitter a chirp (time division), or bpmCfg",
                format!("{mask} ({} transmitters)", mask.count_ones()),
            ));
        }
        order.push(mask.trailing_zeros() as usize);
    }
    let period = (1..=order.len())
        .find(|&n| {
            order.len() % n == 0 && order.iter().zip(order.iter().skip(n)).all(|(a, b)| a == b)
        })
        .unwrap_or(order.len());
    let cycle = &order[..period];
    let repeated = cycle.iter().enumerate().any(|(k, tx)| cycle[..k].contains(tx));
    if repeated {
        return Err(at.error(
            "the order of transmitters",
            "each transmitter once in a cycle",
            format!("{cycle:?}"),
        ));
    }
    let repeats = order.len() / period;
    Ok(Sequence { order: cycle.to_vec(), repeats, multiplexing: Multiplexing::TimeDivision })
}

/// Two transmitters in both chirps of a loop, in phase first.
fn binary_phase(
    frame: &Frame,
    chirps: &[Chirps],
    coding: &BinaryPhase,
    pair: [usize; 2],
) -> Result<Sequence, FormatError> {
    let at = Line { number: coding.line, command: "bpmCfg", arguments: vec![] };
    if pair != [frame.first, frame.last] || chirps.len() != 2 {
        return Err(at.error(
            "chirps",
            format!("the two of the frame, first the one in phase ({})", frame.first),
            format!("{} and {}; the frame has {} to {}", pair[0], pair[1], frame.first, frame.last),
        ));
    }
    for chirp in chirps {
        let mask = chirp.tx_mask;
        if mask.count_ones() != 2 || mask != chirps[0].tx_mask {
            let line = Line { number: chirp.line, command: "chirpCfg", arguments: vec![] };
            let expected = "the same two transmitters in both chirps of bpmCfg";
            return Err(line.error("transmitter mask", expected, mask.to_string()));
        }
    }
    let mask = chirps[0].tx_mask;
    let order = (0..32).filter(|tx| mask >> tx & 1 == 1).collect();
    Ok(Sequence { order, repeats: 1, multiplexing: Multiplexing::BinaryPhase })
}
