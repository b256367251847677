//! Cells as calibration takes them: one vector over the channels each.

use crate::error::ArrayCalibrationError;
use boresight_core::{Complex64, Direction, InputError};
use boresight_math::error::{check_finite, check_positive};
use boresight_math::linalg::hermitian_eigen;
use boresight_signal::sample_covariance;
use ndarray::ArrayView2;

/// Power beside the strongest eigenvalue that noise may leave, in times of what it leaves on average.
const NOISE_MARGIN: f64 = 4.0;

/// Share of the power beside the strongest eigenvalue that never counts as a second target.
const SMALL_SHARE: f64 = 0.01;

/// A cell of a range-Doppler map, seen by all channels.
#[derive(Debug, Clone, PartialEq)]
pub struct Cell {
    /// The strongest eigenvector of its snapshots, of mean power 1 over the channels.
    pub(crate) signal: Vec<Complex64>,
    /// Power of its target in all snapshots over the noise of one, at one element.
    pub snr: f64,
    /// Share of its power that lies beside the strongest eigenvector.
    pub(crate) beside: f64,
    /// What noise alone puts there on average.
    pub(crate) noise_beside: f64,
    /// Direction of its target where that is known.
    pub direction: Option<Direction>,
    /// Its range, m.
    pub range_m: f64,
    /// Its range rate, m/s.
    pub rate_mps: f64,
    /// Range bin.
    pub range_bin: usize,
    /// Doppler bin.
    pub doppler_bin: usize,
}

impl Cell {
    /// A cell from its snapshots (channels x snapshots) and the power of noise at one channel.
    ///
    /// # Errors
    /// [`InputError`] for no snapshots, values that are not finite or all zero, or noise that is not
    /// positive.
    pub fn of(
        snapshots: ArrayView2<'_, Complex64>,
        noise_power: f64,
    ) -> Result<Self, ArrayCalibrationError> {
        let (channels, count) = snapshots.dim();
        if channels == 0 || count == 0 {
            return Err(InputError::Empty {
                what: "snapshots".into(),
                expected: "channels x snapshots".into(),
            }
            .into());
        }
        check_positive("noise_power", noise_power)?;
        check_finite("snapshots", snapshots.iter().flat_map(|z| [z.re, z.im]))?;
        let eigen = hermitian_eigen(sample_covariance(snapshots).view())?;
        let total: f64 = eigen.values.iter().map(|value| value.max(0.0)).sum();
        let first = eigen.values.first().copied().unwrap_or_default();
        check_positive("power of the snapshots", first)?;
        let m = channels as f64;
        let scale = m.sqrt();
        let power = (first / m - noise_power / count as f64).max(0.0);
        Ok(Self {
            signal: eigen.vectors.column(0).iter().map(|z| z * scale).collect(),
            snr: power * count as f64 / noise_power,
            beside: 1.0 - first / total,
            noise_beside: (m - 1.0) * noise_power / total,
            direction: None,
            range_m: 0.0,
            rate_mps: 0.0,
            range_bin: 0,
            doppler_bin: 0,
        })
    }

    /// The same with a target at a known direction.
    #[must_use]
    pub fn at(self, direction: Direction) -> Self {
        Self { direction: Some(direction), ..self }
    }

    /// Whether its snapshots lie on one line but for noise.
    pub(crate) fn is_one_line(&self) -> bool {
        self.beside <= SMALL_SHARE + NOISE_MARGIN * self.noise_beside
    }

    /// Variance of noise in each channel of the signal.
    pub(crate) fn variance(&self) -> f64 {
        1.0 / self.snr.max(f64::MIN_POSITIVE)
    }
}
