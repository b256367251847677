//! Range bias and channel coefficients: `compRangeBiasAndRxChanPhase`.

use super::RadarConfig;
use super::line::Line;
use crate::error::FormatError;
use boresight_core::array::Channel;
use boresight_core::{
    Array, ArrayCalibration, CalibrationMethod, ChannelCalibration, Complex64, InputError,
    NotIdentifiable,
};
use boresight_math::decibels::db_to_amplitude;
use boresight_math::phasor::cis;
use std::fmt::{self, Display, Formatter};

/// Receivers of a chip; the line names all of them.
const CHIP_RECEIVERS: usize = 4;

/// Most transmitters the line is read for: those of four cascaded chips.
const MOST_TRANSMITTERS: usize = 16;

/// What a board takes off ranges and multiplies the virtual channels by before it estimates angles.
#[derive(Debug, Clone, PartialEq)]
pub struct Compensation {
    /// What measured ranges are too long by, m.
    pub range_bias_m: f64,
    /// One a virtual channel of the chip, used or not: all four receivers of a transmitter after each other.
    pub coefficients: Vec<Complex64>,
}

impl Compensation {
    /// Reads the arguments of the line.
    pub(super) fn of(line: &Line<'_>) -> Option<Self> {
        let numbers: Vec<f64> = line
            .arguments
            .iter()
            .map(|word| word.parse().ok().filter(|number: &f64| number.is_finite()))
            .collect::<Option<_>>()?;
        let (&range_bias_m, rest) = numbers.split_first()?;
        let most = MOST_TRANSMITTERS * CHIP_RECEIVERS;
        let whole = rest.len() % (2 * CHIP_RECEIVERS) == 0 && rest.len() <= 2 * most;
        if !whole || range_bias_m.abs() > 1000.0 {
            return None;
        }
        let coefficients =
            rest.chunks_exact(2).map(|pair| Complex64::new(pair[0], pair[1])).collect();
        Some(Self { range_bias_m, coefficients })
    }
}

impl Display for Compensation {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        // 5 digits are finer than the board's 15 bits.
        let rounded = |x: f64| {
            let x = (x * 1e5).round() / 1e5;
            if x == 0.0 { 0.0 } else { x }
        };
        write!(f, "compRangeBiasAndRxChanPhase {}", rounded(self.range_bias_m))?;
        for c in &self.coefficients {
            write!(f, " {} {}", rounded(c.re), rounded(c.im))?;
        }
        Ok(())
    }
}

impl RadarConfig {
    /// The calibration that the configuration's coefficients are, for an array of its channels; nothing for neutral ones,
    /// or where the line is absent or has not all channels in use.
    pub fn calibration(&self, array: &Array) -> Option<ArrayCalibration> {
        let compensation = self.compensation.as_ref().filter(|found| !self.is_neutral(found))?;
        let coefficients = self.coefficients(compensation)?;
        if array.tx().len() * array.rx().len() != coefficients.len() {
            return None;
        }
        let gains: Vec<f64> = coefficients.iter().map(|c| -20.0 * c.norm().log10()).collect();
        let mean = gains.iter().sum::<f64>() / gains.len().max(1) as f64;
        let channel = |(c, gain): (&Complex64, f64)| ChannelCalibration {
            gain_db: gain - mean,
            phase_rad: c.conj().arg(),
            ..ChannelCalibration::default()
        };
        Some(ArrayCalibration {
            channels: coefficients.iter().zip(gains).map(channel).collect(),
            range_bias_m: compensation.range_bias_m,
            method: CalibrationMethod::BoardConfiguration,
            not_identifiable: vec![NotIdentifiable::CommonGain, NotIdentifiable::CommonPhase],
            ..ArrayCalibration::neutral(array)
        })
    }

    /// Whether there are coefficients to apply, and whether they are of all channels in use; nothing for neutral ones.
    pub(super) fn has_coefficients(&self) -> Option<bool> {
        let found = self.compensation.as_ref().filter(|found| !self.is_neutral(found))?;
        Some(self.coefficients(found).is_some())
    }

    /// Whether a line changes nothing: all 1, or the signs of antennas that are mounted turned.
    fn is_neutral(&self, of: &Compensation) -> bool {
        let is_one = |c: &Complex64| *c == Complex64::ONE;
        let turned = || self.coefficients(of).is_some_and(|left| left.iter().all(is_one));
        of.range_bias_m == 0.0 && (of.coefficients.iter().all(is_one) || turned())
    }

    /// The coefficients of the channels in use but for the signs of turned antennas; nothing where one is missing, nought
    /// or far from 1.
    fn coefficients(&self, of: &Compensation) -> Option<Vec<Complex64>> {
        let usable = |c: &Complex64| (1e-4..1e4).contains(&c.norm());
        self.chip_channels()
            .zip(self.signs())
            .map(|(at, sign)| of.coefficients.get(at).copied().filter(usable).map(|c| c * sign))
            .collect()
    }

    /// Signs that the line has for channels in use besides what it corrects: those of turned antennas, unless lines of
    /// the antennas' own say them.
    fn signs(&self) -> Vec<f64> {
        let array = self.array().filter(|_| !self.antenna_lines);
        let of = |tx: usize, rx: usize| match &array {
            Some(array) if array.is_inverted(Channel { tx, rx }) => -1.0,
            _ => 1.0,
        };
        let receivers = self.receivers.len();
        let pairs =
            (0..self.transmitters.len()).flat_map(|tx| (0..receivers).map(move |rx| (tx, rx)));
        pairs.map(|(tx, rx)| of(tx, rx)).collect()
    }

    /// The array with the configuration's coefficients taken into account.
    ///
    /// # Errors
    /// [`InputError`] for coefficients out of range.
    pub fn compensated(&self, array: &Array) -> Result<Array, InputError> {
        match self.calibration(array) {
            Some(calibration) => array.calibrated(&calibration),
            None => Ok(array.clone()),
        }
    }

    /// The line that makes the board apply a calibration: gain and phase of each channel and the range bias. The greatest
    /// coefficient has magnitude 1; channels not in use get 1. Displacements and coupling have no place in it.
    ///
    /// # Errors
    /// A calibration that is wrong in itself, or of other channels than the configuration has.
    pub fn compensation_of(
        &self,
        calibration: &ArrayCalibration,
    ) -> Result<Compensation, FormatError> {
        calibration.check()?;
        let channels: Vec<usize> = self.chip_channels().collect();
        let given = [calibration.tx.len(), calibration.rx.len()];
        if calibration.channels.len() != channels.len() {
            return Err(InputError::OtherArray {
                expected: format!("{} transmitters x {} receivers", given[0], given[1]),
                given: format!(
                    "{} transmitters x {} receivers",
                    self.transmitters.len(),
                    self.receivers.len()
                ),
            }
            .into());
        }
        let last = channels.iter().max().copied().unwrap_or_default();
        let transmitters = self.chip_transmitters().max(last / CHIP_RECEIVERS + 1);
        let least = calibration.channels.iter().map(|c| c.gain_db).fold(f64::INFINITY, f64::min);
        let mut coefficients = vec![Complex64::ONE; transmitters * CHIP_RECEIVERS];
        for ((&at, channel), sign) in channels.iter().zip(&calibration.channels).zip(self.signs()) {
            let amplitude = sign * db_to_amplitude(least - channel.gain_db);
            coefficients[at] = cis(-channel.phase_rad) * amplitude;
        }
        Ok(Compensation { range_bias_m: calibration.range_bias_m, coefficients })
    }

    /// Place of each channel in use among those of the chip.
    fn chip_channels(&self) -> impl Iterator<Item = usize> + '_ {
        let of = |tx: &usize| {
            self.receivers.iter().map({
                let first = tx * CHIP_RECEIVERS;
                move |rx| first + rx
            })
        };
        self.transmitters.iter().flat_map(of)
    }

    /// Transmitters of the platform's chip.
    fn chip_transmitters(&self) -> usize {
        match &self.compensation {
            Some(found) => found.coefficients.len() / CHIP_RECEIVERS,
            None => self.board.as_ref().map_or(0, |board| board.tx().len()),
        }
    }
}
