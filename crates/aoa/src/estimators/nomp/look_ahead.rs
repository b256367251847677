//! Whether sources hide behind each other.

use super::{Fitted, Nomp, Verdict};
use boresight_core::Complex64;

/// A source whose steering vector keeps less of its power than this beside those before is none.
const DEPENDENT: f64 = 1e-6;

impl Nomp {
    /// How many sources there are at least, going by a plain orthogonal matching pursuit from what was
    /// found: up to the last one that hides another which stands out. 0 if there is none.
    pub(super) fn look_ahead(&mut self, fitted: &Fitted, total: f64) -> usize {
        let elements = self.geometry.elements();
        let mut basis: Vec<Vec<Complex64>> = Vec::new();
        for &point in &fitted.points {
            if let Some(vector) = beside(&basis, self.geometry.steering(point).vector) {
                basis.push(vector);
            }
        }
        let mut residual = fitted.residual.clone();
        for found in fitted.points.len().. {
            if found + 1 >= elements || found > self.options.max_sources {
                break;
            }
            let (point, power) = self.strongest(&residual, 1.0);
            match self.stands_out(power, &residual, total, found, None) {
                Verdict::Source => return found + 1,
                Verdict::Noise => break,
                Verdict::Hidden => {}
            }
            let Some(vector) = beside(&basis, self.geometry.steering(point).vector) else { break };
            for mut column in residual.columns_mut() {
                let part: Complex64 = vector.iter().zip(&column).map(|(q, y)| q.conj() * y).sum();
                column.iter_mut().zip(&vector).for_each(|(y, q)| *y -= q * part);
            }
            basis.push(vector);
        }
        0
    }
}

/// The part of a vector outside an orthonormal basis, at length one; nothing where little is left.
fn beside(basis: &[Vec<Complex64>], mut vector: Vec<Complex64>) -> Option<Vec<Complex64>> {
    let before = vector.len() as f64;
    for q in basis {
        let part: Complex64 = q.iter().zip(&vector).map(|(q, a)| q.conj() * a).sum();
        vector.iter_mut().zip(q).for_each(|(a, q)| *a -= q * part);
    }
    let power: f64 = vector.iter().map(|a| a.norm_sqr()).sum();
    if power < DEPENDENT * before {
        return None;
    }
    let scale = 1.0 / power.sqrt();
    vector.iter_mut().for_each(|a| *a *= scale);
    Some(vector)
}
