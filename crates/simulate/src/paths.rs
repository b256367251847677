//! Paths of spherical waves: from the transmitter of each virtual element to a target and back to its receiver.
//!
//! In the far field element `k` adds the phase `+pi p_k . u` of [`boresight_core::steering`]. Positions thus
//! describe the response as measured. With the sign of the beat of a data cube a path that is *longer* gives more
//! phase, so the near field takes the path over the point-reflected position `-p_k lambda / 2`, which tends to the
//! far field's phase with growing range.

use boresight_core::array::Position;
use boresight_core::{Array, Complex64, Imperfections};
use boresight_math::phasor::cis;
use ndarray::Array1;
use std::f64::consts::TAU;

/// The ends of the paths of an array's virtual elements.
#[derive(Debug, Clone)]
pub(crate) struct Paths {
    wavelength_m: f64,
    /// Transmitter and receiver of each element, metres, reflected through the origin.
    ends_m: Vec<[[f64; 3]; 2]>,
}

impl Paths {
    /// For transmitters and receivers of virtual elements, half wavelengths.
    pub fn new(wavelength_m: f64, elements: impl IntoIterator<Item = [Position; 2]>) -> Self {
        let metres = -wavelength_m / 2.0;
        let in_metres = |ends: [Position; 2]| ends.map(|end| end.map(|x| x * metres));
        Self { wavelength_m, ends_m: elements.into_iter().map(in_metres).collect() }
    }

    /// For the elements of an array, whose displacements are their receivers'.
    pub fn of(wavelength_m: f64, array: &Array, imperfections: Option<&Imperfections>) -> Self {
        let elements = array.channels().iter().enumerate().map(|(k, channel)| {
            let error = imperfections.map_or([0.0; 3], |i| i.displacement[k]);
            [array.tx()[channel.tx], moved(array.rx()[channel.rx], error)]
        });
        Self::new(wavelength_m, elements)
    }

    /// Length of the path over a virtual element, m, for a target in the direction of a unit vector.
    pub fn length_m(&self, element: usize, range_m: f64, unit: &[f64; 3]) -> f64 {
        let leg = |from: &[f64; 3]| {
            let d = [0, 1, 2].map(|a| range_m * unit[a] - from[a]);
            (d[0] * d[0] + d[1] * d[1] + d[2] * d[2]).sqrt()
        };
        let [tx_m, rx_m] = &self.ends_m[element];
        leg(tx_m) + leg(rx_m)
    }

    /// Response of each element to a target, of phase zero where the path is twice the range and of magnitude one.
    pub fn response(&self, range_m: f64, unit: &[f64; 3]) -> Array1<Complex64> {
        let phase = |k| TAU * (self.length_m(k, range_m, unit) - 2.0 * range_m) / self.wavelength_m;
        (0..self.ends_m.len()).map(|k| cis(phase(k))).collect()
    }
}

/// A position and its error.
pub(crate) fn moved(p: Position, error: Position) -> Position {
    [p[0] + error[0], p[1] + error[1], p[2] + error[2]]
}
