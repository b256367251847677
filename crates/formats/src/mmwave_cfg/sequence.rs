//! From chirps to the time-division sequence of transmitters.

use super::line::Line;
use crate::error::FormatError;

/// A run of chirps with the same settings.
#[derive(Debug, Clone, Copy)]
pub(super) struct Chirps {
    /// First chirp.
    pub first: usize,
    /// Last chirp.
    pub last: usize,
    /// Profile it follows.
    pub profile: usize,
    /// Bits of the transmitters that send.
    pub tx_mask: u32,
}

/// Transmitters in order of transmission, and how often that order repeats within one loop.
pub(super) fn transmitters(
    frame: &Line<'_>,
    chirps: &[Chirps],
    first: usize,
    last: usize,
) -> Result<(Vec<usize>, usize), FormatError> {
    let mut order = Vec::with_capacity(last + 1 - first);
    for index in first..=last {
        let chirp =
            chirps.iter().rev().find(|c| (c.first..=c.last).contains(&index)).ok_or_else(|| {
                frame.error("chirps", format!("a chirpCfg line for chirp {index}"), "none")
            })?;
        order.push(chirp.tx_mask.trailing_zeros() as usize);
    }
    let period = (1..=order.len())
        .find(|&n| {
            order.len() % n == 0 && order.iter().zip(order.iter().skip(n)).all(|(a, b)| a == b)
        })
        .unwrap_or(order.len());
    let cycle = &order[..period];
    let repeated = cycle.iter().enumerate().any(|(k, tx)| cycle[..k].contains(tx));
    if repeated {
        return Err(frame.error(
            "the order of transmitters",
            "each transmitter once in a cycle",
            format!("{cycle:?}"),
        ));
    }
    Ok((cycle.to_vec(), order.len() / period))
}
