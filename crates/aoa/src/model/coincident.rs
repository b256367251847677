//! Virtual elements at one place, as MIMO arrays have whose transmitters repeat positions of receivers.
//!
//! What such elements differ by is noise alone, which a covariance modelled as that of plane waves does not explain: its
//! inverse weighs the difference without bound. Averaging them loses nothing (their mean is a sufficient statistic for
//! what is received at that place) and leaves each place with one element. The noise of the mean is smaller than that
//! of one element by their number; an inverse covariance weighting that fits only plane waves is the same for elements
//! scaled to equal noise.

use boresight_core::array::Position;
use boresight_core::{Array, Complex64, InputError};
use ndarray::{Array2, ArrayView2, Axis};

/// Largest distance of elements that count as coincident, half wavelengths. Array calibration moves elements apart by less. The
/// mean of two elements so far apart is within 1.3 % of a wave's amplitude at their middle.
const NEAR: f64 = 0.1;
/// The same as a share of the mean distance that the array's elements have along y.
const NEAR_SHARE: f64 = 0.1;

/// The elements of an array in groups of coincident ones.
#[derive(Debug, Clone)]
pub(crate) struct Coincident {
    /// Index of the place of each element.
    place: Vec<usize>,
    /// One over the number of elements of each place.
    share: Vec<f64>,
    /// One element at each place.
    array: Array,
    /// Means of the last snapshots.
    means: Array2<Complex64>,
}

impl Coincident {
    /// Finds coincident elements; none where all elements have places of their own.
    ///
    /// # Errors
    /// Those of [`Array::new`].
    pub fn new(array: &Array) -> Result<Option<Self>, InputError> {
        let near = NEAR.min(NEAR_SHARE * array.aperture() / array.len() as f64);
        let mut groups: Vec<Vec<Position>> = Vec::new();
        let mut place = Vec::with_capacity(array.len());
        for position in array.positions() {
            let at = groups.iter().position(|group| distance(&group[0], position) <= near);
            let at = at.unwrap_or_else(|| {
                groups.push(Vec::new());
                groups.len() - 1
            });
            groups[at].push(*position);
            place.push(at);
        }
        if groups.len() == array.len() {
            return Ok(None);
        }
        let share: Vec<f64> = groups.iter().map(|group| 1.0 / group.len() as f64).collect();
        let middle = |(group, share): (&Vec<Position>, &f64)| -> Position {
            let first = group[0];
            std::array::from_fn(|axis| {
                // About the first, so that elements at the same place stay there to the last digit.
                first[axis] + share * group.iter().map(|p| p[axis] - first[axis]).sum::<f64>()
            })
        };
        let places: Vec<Position> = groups.iter().zip(&share).map(middle).collect();
        let means = Array2::zeros((places.len(), 0));
        Ok(Some(Self { place, share, array: Array::new(&places)?, means }))
    }

    /// The array with one element at each place.
    pub fn array(&self) -> &Array {
        &self.array
    }

    /// Mean snapshots of each place.
    pub fn average(&mut self, snapshots: ArrayView2<'_, Complex64>) -> ArrayView2<'_, Complex64> {
        let shape = (self.share.len(), snapshots.ncols());
        if self.means.dim() != shape {
            self.means = Array2::zeros(shape);
        }
        self.means.fill(Complex64::default());
        for (row, &place) in snapshots.axis_iter(Axis(0)).zip(&self.place) {
            self.means.row_mut(place).scaled_add(self.share[place].into(), &row);
        }
        self.means.view()
    }
}

fn distance(p: &Position, q: &Position) -> f64 {
    p.iter().zip(q).map(|(a, b)| (a - b) * (a - b)).sum::<f64>().sqrt()
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;

    #[test]
    fn elements_at_one_place_are_averaged_and_others_stay() {
        let at = |y: f64| [0.0, y, 0.0];
        let array = Array::new(&[0.0, 1.0, 2.0, 1.02, 3.0, 1.0].map(at)).unwrap();
        let mut coincident = Coincident::new(&array).unwrap().unwrap();
        let places: Vec<f64> = coincident.array().positions().iter().map(|p| p[1]).collect();
        let middle = 1.0 + 0.02 / 3.0;
        for (found, expected) in places.iter().zip([0.0, middle, 2.0, 3.0]) {
            assert!((found - expected).abs() < 1e-15, "{places:?}");
        }
        let y = Array2::from_shape_fn((6, 2), |(i, t)| Complex64::new(i as f64, t as f64));
        let means = coincident.average(y.view()).to_owned();
        assert_eq!(means.column(1).mapv(|z| z.re).to_vec(), [0.0, 3.0, 2.0, 4.0]);
        assert_eq!(coincident.average(y.view()), means);
        assert!(Coincident::new(&Array::ula(8).unwrap()).unwrap().is_none());
        // All within a tenth of a half wavelength, as positions in metres would be: still elements of their own.
        let small = Array::new(&[0.0, 0.01, 0.02, 0.03].map(at)).unwrap();
        assert!(Coincident::new(&small).unwrap().is_none());
    }
}
