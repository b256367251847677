//! Newton steps on the power of one beam.

use crate::model::cosines::{Geometry, Point};
use boresight_core::Complex64;
use ndarray::Array2;

/// `sum_n |a^H y_n|^2` at a point.
pub(super) fn beam_power(geometry: &Geometry, y: &Array2<Complex64>, at: Point) -> f64 {
    let a = geometry.steering(at).vector;
    let mut sum = 0.0;
    for column in y.columns() {
        let x: Complex64 = a.iter().zip(column).map(|(a, y)| a.conj() * y).sum();
        sum += x.norm_sqr();
    }
    sum
}

/// One Newton step toward the maximum of [`beam_power`]; the point itself where the power is not
/// concave or the step would not raise it.
pub(super) fn step(geometry: &Geometry, y: &Array2<Complex64>, at: Point) -> Point {
    let steering = geometry.steering(at);
    let bends: Vec<[f64; 3]> = (0..geometry.elements()).map(|k| geometry.bends(at, k)).collect();
    let (mut power, mut g, mut h) = (0.0, [0.0; 2], [0.0; 3]);
    let minus_j = Complex64::new(0.0, -1.0);
    for column in y.columns() {
        // The beam x = a^H y, its first and second derivatives.
        let mut x = Complex64::ZERO;
        let mut first = [Complex64::ZERO; 2];
        let mut second = [Complex64::ZERO; 3];
        for (k, y) in column.iter().enumerate() {
            let z = steering.vector[k].conj() * y;
            let [v, w] = steering.slopes[k];
            let [vv, vw, ww] = bends[k];
            x += z;
            first[0] += z * v;
            second[0] += z * Complex64::new(-v * v, -vv);
            if geometry.axes == 2 {
                first[1] += z * w;
                second[1] += z * Complex64::new(-v * w, -vw);
                second[2] += z * Complex64::new(-w * w, -ww);
            }
        }
        first = first.map(|f| minus_j * f);
        power += x.norm_sqr();
        for axis in 0..2 {
            g[axis] += 2.0 * (x.conj() * first[axis]).re;
        }
        let pairs = [(0, 0), (0, 1), (1, 1)];
        for (h, (second, (p, q))) in h.iter_mut().zip(second.iter().zip(pairs)) {
            *h += 2.0 * (x.conj() * second + first[p].conj() * first[q]).re;
        }
    }
    let most = geometry.half_beam();
    let change = if geometry.axes == 1 {
        if h[0] >= 0.0 {
            return at;
        }
        [-g[0] / h[0], 0.0]
    } else {
        let determinant = h[0] * h[2] - h[1] * h[1];
        if h[0] >= 0.0 || determinant <= 1e-12 * h[0] * h[2] {
            return at;
        }
        [(-g[0] * h[2] + g[1] * h[1]) / determinant, (-g[1] * h[0] + g[0] * h[1]) / determinant]
    };
    let next = geometry.moved(at, change.map(|c| c.clamp(-most, most)));
    if beam_power(geometry, y, next) > power { next } else { at }
}

#[cfg(test)]
mod tests {
    use super::*;
    use boresight_core::presets::preset;
    use boresight_core::steering::steering_vector;
    use boresight_core::{Array, Direction};
    use ndarray::Axis;

    #[test]
    fn converges_quadratically_to_the_peak() {
        let solid = Array::new(&[[0.0; 3], [0.5, 1.0, 0.0], [0.0, 2.0, 1.0], [0.3, 0.0, 2.0]]);
        for (array, at) in [
            (preset("lrr48").unwrap(), Direction::azimuth(0.4)),
            (preset("awr1843").unwrap(), Direction::new(0.4, 0.1)),
            (solid.unwrap(), Direction::new(0.4, 0.1)),
        ] {
            let geometry = Geometry::new(&array);
            let y = steering_vector(&array, at).insert_axis(Axis(1));
            let truth = geometry.point(at);
            let mut point = geometry.moved(truth, [0.2 * geometry.half_beam(); 2]);
            for _ in 0..6 {
                point = step(&geometry, &y, point);
            }
            assert!(geometry.distance(point, truth) < 1e-7, "{point:?} {truth:?}");
        }
    }
}
