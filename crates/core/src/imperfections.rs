//! What makes a real array differ from its drawing: gain, phase, position and coupling.

use crate::array::{Array, Position};
use crate::direction::Direction;
use crate::steering::steering_vector;
use boresight_math::decibels::db_to_amplitude;
use boresight_math::error::{InputError, check_finite, check_range};
use boresight_math::phasor::cis;
use boresight_math::random::Random;
use boresight_options::{Described, Flat};
use ndarray::{Array1, Array2};
use num_complex::Complex64;
use serde::{Deserialize, Serialize};

/// Errors of each element and coupling between them. The response becomes
/// `C diag(g exp(j phi)) a(p + dp)`.
#[derive(Debug, Clone, PartialEq)]
pub struct Imperfections {
    /// Gain of each element, dB.
    pub gain_db: Vec<f64>,
    /// Phase of each element, rad.
    pub phase_rad: Vec<f64>,
    /// Displacement of each element, half wavelengths.
    pub displacement: Vec<Position>,
    /// Mutual coupling matrix, elements x elements; the identity if absent.
    pub coupling: Option<Array2<Complex64>>,
}

/// Standard deviations from which [`Imperfections::random`] draws, and the coupling of neighbours.
#[derive(Debug, Clone, Copy, PartialEq, Default, Described, Serialize, Deserialize)]
#[serde(default)]
pub struct ImperfectionSpread {
    /// Standard deviation of the gain of the elements.
    #[option(range = 0..=100)]
    pub gain_db: f64,
    /// Standard deviation of the phase of the elements.
    #[option(range = 0..=3600)]
    pub phase_rad: f64,
    /// Standard deviation of the displacement of the elements along y, half wavelengths.
    #[option(range = 0..=100)]
    pub position: f64,
    /// Coupling between elements half a wavelength apart; falls with the square of the distance,
    /// with the phase of its travel. No coupling if absent.
    #[option(range = -200..=0)]
    pub coupling_db: Option<f64>,
}

/// Errors of an array's elements, drawn from normal distributions.
#[derive(Debug, Clone, Copy, PartialEq, Default, Described, Serialize, Deserialize)]
#[option(name = "Imperfections")]
#[serde(default)]
pub struct ImperfectionOptions {
    /// How large they are.
    pub spread: Flat<ImperfectionSpread>,
    /// Seed they are drawn from; that of the simulation if absent.
    pub seed: Option<u64>,
}

impl ImperfectionOptions {
    /// Draws the errors for `array`; none where nothing is asked for.
    ///
    /// # Errors
    /// As [`Imperfections::random`].
    pub fn draw(&self, array: &Array, seed: u64) -> Result<Option<Imperfections>, InputError> {
        if *self.spread == ImperfectionSpread::default() {
            return Ok(None);
        }
        Imperfections::random(array, *self.spread, self.seed.unwrap_or(seed)).map(Some)
    }
}

impl Imperfections {
    /// A perfect array of `elements`.
    pub fn none(elements: usize) -> Self {
        Self {
            gain_db: vec![0.0; elements],
            phase_rad: vec![0.0; elements],
            displacement: vec![[0.0; 3]; elements],
            coupling: None,
        }
    }

    /// Draws errors for `array` from normal distributions, stream `u64::MAX` of `seed`.
    ///
    /// # Errors
    /// [`InputError::OutOfRange`] for a negative or not finite spread, or coupling above 0 dB.
    pub fn random(
        array: &Array,
        spread: ImperfectionSpread,
        seed: u64,
    ) -> Result<Self, InputError> {
        check_range("gain spread (dB)", spread.gain_db, 0.0, 100.0)?;
        check_range("phase spread (rad)", spread.phase_rad, 0.0, 100.0)?;
        check_range("position spread (half wavelengths)", spread.position, 0.0, 100.0)?;
        let coupling = match spread.coupling_db {
            Some(db) => {
                check_range("coupling (dB)", db, -200.0, 0.0)?;
                Some(coupling_by_distance(array, db_to_amplitude(db)))
            }
            None => None,
        };
        let mut random = Random::new(seed, u64::MAX);
        let mut drawn = Self { coupling, ..Self::none(array.len()) };
        for k in 0..array.len() {
            drawn.gain_db[k] = spread.gain_db * random.normal();
            drawn.phase_rad[k] = spread.phase_rad * random.normal();
            drawn.displacement[k][1] = spread.position * random.normal();
        }
        Ok(drawn)
    }

    /// Checks that there is one finite entry an element.
    ///
    /// # Errors
    /// [`InputError::Shape`] or [`InputError::NotFinite`].
    pub fn check(&self, elements: usize) -> Result<(), InputError> {
        let expected = |what: &str, given: Vec<usize>, expected: String| InputError::Shape {
            what: what.into(),
            expected,
            given,
        };
        for (what, len) in [
            ("gain errors", self.gain_db.len()),
            ("phase errors", self.phase_rad.len()),
            ("position errors", self.displacement.len()),
        ] {
            if len != elements {
                return Err(expected(what, vec![len], format!("[{elements}]")));
            }
        }
        check_finite("gain errors", self.gain_db.iter().copied())?;
        check_finite("phase errors", self.phase_rad.iter().copied())?;
        check_finite("position errors", self.displacement.iter().flatten().copied())?;
        if let Some(coupling) = &self.coupling {
            if coupling.dim() != (elements, elements) {
                let (rows, columns) = coupling.dim();
                let shape = format!("[{elements}, {elements}]");
                return Err(expected("coupling matrix", vec![rows, columns], shape));
            }
            check_finite("coupling matrix", coupling.iter().flat_map(|z| [z.re, z.im]))?;
        }
        Ok(())
    }

    /// The response of `array` with these errors.
    ///
    /// # Errors
    /// As [`Imperfections::check`].
    pub fn steering_vector(
        &self,
        array: &Array,
        direction: Direction,
    ) -> Result<Array1<Complex64>, InputError> {
        self.check(array.len())?;
        let moved: Vec<Position> = array
            .positions()
            .iter()
            .zip(&self.displacement)
            .map(|(p, d)| [p[0] + d[0], p[1] + d[1], p[2] + d[2]])
            .collect();
        let mut response = steering_vector(&Array::new(&moved)?, direction);
        self.apply(&mut response);
        Ok(response)
    }

    /// Applies gain, phase and coupling, in this order, to a vector over the elements whose
    /// displacement is already in it.
    pub fn apply(&self, response: &mut Array1<Complex64>) {
        for (k, value) in response.iter_mut().enumerate() {
            *value *= cis(self.phase_rad[k]) * db_to_amplitude(self.gain_db[k]);
        }
        if let Some(coupling) = &self.coupling {
            *response = coupling.dot(response);
        }
    }
}

fn coupling_by_distance(array: &Array, nearest: f64) -> Array2<Complex64> {
    let p = array.positions();
    Array2::from_shape_fn((array.len(), array.len()), |(i, k)| {
        if i == k {
            return Complex64::new(1.0, 0.0);
        }
        let distance = (0..3).map(|a| (p[i][a] - p[k][a]).powi(2)).sum::<f64>().sqrt();
        let travel = distance.max(1.0);
        cis(-std::f64::consts::PI * travel) * (nearest / (travel * travel))
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_perfect_array_is_left_alone() {
        let array = Array::ula(6).unwrap();
        let at = Direction::azimuth(0.4);
        let plain = steering_vector(&array, at);
        assert_eq!(Imperfections::none(6).steering_vector(&array, at).unwrap(), plain);
    }

    #[test]
    fn errors_have_the_asked_spread_and_repeat_with_the_seed() {
        let array = Array::ula(900).unwrap();
        let spread = ImperfectionSpread {
            gain_db: 1.0,
            phase_rad: 0.2,
            position: 0.05,
            coupling_db: Some(-20.0),
        };
        let drawn = Imperfections::random(&array, spread, 3).unwrap();
        assert_eq!(drawn, Imperfections::random(&array, spread, 3).unwrap());
        let rms = |x: &[f64]| (x.iter().map(|v| v * v).sum::<f64>() / x.len() as f64).sqrt();
        // The standard error of a standard deviation is sqrt(1 / 2n) = 2.4 %; five of it.
        assert!((rms(&drawn.gain_db) - 1.0).abs() < 0.12);
        assert!((rms(&drawn.phase_rad) / 0.2 - 1.0).abs() < 0.12);
        let coupling = drawn.coupling.unwrap();
        assert!((coupling[[0, 1]].norm() - 0.1).abs() < 1e-12);
        assert!((coupling[[0, 2]].norm() - 0.025).abs() < 1e-12);
    }

    #[test]
    fn wrong_lengths_are_named() {
        let array = Array::ula(4).unwrap();
        let error = Imperfections::none(3).steering_vector(&array, Direction::default());
        assert!(matches!(error, Err(InputError::Shape { .. })));
    }
}
