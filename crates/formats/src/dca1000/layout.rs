//! Where each sample of a frame stands in its bytes.

use boresight_core::Sampling;
use boresight_options::Described;
use serde::{Deserialize, Serialize};

/// Lanes of a four-lane board, whether its receivers are in use or not.
const LANES: usize = 4;

/// Receivers of one chip of a cascade.
pub(crate) const CHIP_RECEIVERS: usize = 4;

/// Transmitters of one chip of a cascade.
pub(crate) const CHIP_TRANSMITTERS: usize = 3;

/// Chips of a cascade: master, slave 1, slave 2, slave 3.
pub(crate) const CHIPS: usize = 4;

/// The receivers from the left to the right of the board, by their numbers: those of the third slave, the master, the
/// second slave and the first. Frames have them in this order.
pub const CASCADE_RECEIVERS: [usize; CHIPS * CHIP_RECEIVERS] =
    [12, 13, 14, 15, 0, 1, 2, 3, 8, 9, 10, 11, 4, 5, 6, 7];

/// How samples lie in the bytes of a capture, as little-endian 16-bit numbers.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Described, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Layout {
    /// Two lanes (xWR16xx, xWR18xx, xWR64xx, xWR68xx): the receivers of a chirp one after another; complex samples in
    /// pairs `I0 I1 Q0 Q1`.
    TwoLane,
    /// Four lanes (xWR12xx, xWR14xx, xWR22xx): of each sample the four receivers, all I before all Q; lanes of receivers
    /// that are off hold zeros.
    FourLane,
    /// Four chips (MMWCAS-RF-EVM with MMWCAS-DSP-EVM), a file each: of each sample the four receivers, `I Q` of each;
    /// the chips' frames in turn, as the reader of cascades puts them.
    Cascade,
}

/// What lies in a frame's bytes, and how.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Plan {
    pub layout: Layout,
    pub sampling: Sampling,
    /// Chirps of a frame, of all transmitters.
    pub chirps: usize,
    pub samples: usize,
    /// Numbers of the receivers, in the order of the frame.
    pub receivers: Vec<usize>,
}

impl Plan {
    /// 16-bit numbers of a frame; `u64::MAX` where there are more.
    pub fn words(&self) -> u64 {
        let receivers = match self.layout {
            Layout::TwoLane => self.receivers.len(),
            Layout::FourLane => LANES,
            Layout::Cascade => CHIPS * CHIP_RECEIVERS,
        };
        [self.chirps, receivers, self.samples, self.words_a_sample()]
            .iter()
            .fold(1_u64, |product, &factor| product.saturating_mul(factor as u64))
    }

    fn words_a_sample(&self) -> usize {
        match self.sampling {
            Sampling::Complex => 2,
            Sampling::Real => 1,
        }
    }

    /// Calls `put` for each sample: its place in the frame (chirps x receivers x samples) and the places of its two
    /// numbers in the bytes, in the order in which they stand there. Of a real sample both are the same.
    pub fn each(&self, put: impl FnMut(usize, [usize; 2])) {
        match (self.layout, self.sampling) {
            (Layout::TwoLane, Sampling::Complex) => self.two_lane(put),
            (Layout::TwoLane, Sampling::Real) => self.two_lane_real(put),
            (Layout::FourLane, _) => self.four_lane(put),
            (Layout::Cascade, _) => self.cascade(put),
        }
    }

    fn two_lane(&self, mut put: impl FnMut(usize, [usize; 2])) {
        for sample in 0..self.chirps * self.receivers.len() * self.samples {
            let first = 4 * (sample / 2) + sample % 2;
            put(sample, [first, first + 2]);
        }
    }

    fn two_lane_real(&self, mut put: impl FnMut(usize, [usize; 2])) {
        for sample in 0..self.chirps * self.receivers.len() * self.samples {
            put(sample, [sample, sample]);
        }
    }

    fn four_lane(&self, mut put: impl FnMut(usize, [usize; 2])) {
        let group = LANES * self.words_a_sample();
        for chirp in 0..self.chirps {
            for (r, &lane) in self.receivers.iter().enumerate() {
                let row = (chirp * self.receivers.len() + r) * self.samples;
                for n in 0..self.samples {
                    let start = (chirp * self.samples + n) * group;
                    put(row + n, [start + lane, start + group - LANES + lane]);
                }
            }
        }
    }

    fn cascade(&self, mut put: impl FnMut(usize, [usize; 2])) {
        let each = self.words_a_sample();
        let sample_words = CHIP_RECEIVERS * each;
        let chip_words = self.chirps * self.samples * sample_words;
        for chirp in 0..self.chirps {
            for (r, &receiver) in self.receivers.iter().enumerate() {
                let (chip, on_chip) = (receiver / CHIP_RECEIVERS, receiver % CHIP_RECEIVERS);
                let row = (chirp * self.receivers.len() + r) * self.samples;
                for n in 0..self.samples {
                    let start = chip * chip_words
                        + (chirp * self.samples + n) * sample_words
                        + on_chip * each;
                    put(row + n, [start, start + each - 1]);
                }
            }
        }
    }
}
