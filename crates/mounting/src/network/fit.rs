//! Weighted least squares of a radar's motion (Kellner et al. 2013), as the networks are trained with it.

/// Added to the normal matrix' diagonal: this, and this times the sum of weights.
const RIDGE: f64 = 1e-6;
/// Of residuals, (m/s)^2.
const LEAST_VARIANCE: f64 = 1e-5;

/// Sight lines and range rates of a frame.
#[derive(Debug, Clone, Default)]
pub(super) struct Sights {
    pub(super) cos: Vec<f32>,
    pub(super) sin: Vec<f32>,
    pub(super) rate: Vec<f32>,
}

impl Sights {
    pub(super) fn len(&self) -> usize {
        self.rate.len()
    }

    /// The velocity along boresight and to its left, m/s, and the inverse normal matrix as xx, xy, yy.
    pub(super) fn fit(&self, weights: &[f32]) -> ([f32; 2], [f64; 3]) {
        let (mut a, mut b, mut sum) = ([0.0_f64; 3], [0.0_f64; 2], 0.0);
        for (i, weight) in weights.iter().enumerate() {
            let [cos, sin, rate, weight] =
                [self.cos[i], self.sin[i], self.rate[i], *weight].map(f64::from);
            sum += weight;
            a[0] += weight * cos * cos;
            a[1] += weight * cos * sin;
            a[2] += weight * sin * sin;
            b[0] -= weight * cos * rate;
            b[1] -= weight * sin * rate;
        }
        let ridge = RIDGE * (1.0 + sum);
        let (xx, xy, yy) = (a[0] + ridge, a[1], a[2] + ridge);
        let determinant = xx * yy - xy * xy;
        let inverse = [yy / determinant, -xy / determinant, xx / determinant];
        let x = inverse[0] * b[0] + inverse[1] * b[1];
        let y = inverse[1] * b[0] + inverse[2] * b[1];
        ([x as f32, y as f32], inverse)
    }

    /// Measured less expected range rate, m/s.
    pub(super) fn residual(&self, i: usize, [x, y]: [f32; 2]) -> f32 {
        self.rate[i] + x * self.cos[i] + y * self.sin[i]
    }

    /// By how much a range rate grows with an azimuth error, m/s a rad, without sign.
    pub(super) fn slope(&self, i: usize, [x, y]: [f32; 2]) -> f32 {
        (y * self.cos[i] - x * self.sin[i]).abs()
    }

    /// Equation 3 of Zhu et al. (2025): covariance of the motion as xx, xy, yy, (m/s)^2. `inliers` are weights from 0 to
    /// 1, whose sum stands for the number of inliers, and `weights` those of the fit.
    pub(super) fn equation_3(
        &self,
        velocity: [f32; 2],
        inliers: &[f32],
        weights: &[f32],
        inverse: [f64; 3],
    ) -> [f64; 3] {
        let squares = (0..self.len()).map(|i| {
            let residual = f64::from(self.residual(i, velocity));
            f64::from(weights[i]) * residual * residual
        });
        let (count, weight) = (sum(inliers), sum(weights));
        let variance = squares.sum::<f64>() / (count - 2.0).max(1.0);
        let scale = (weight + 1e-3) / (count + 1e-3);
        inverse.map(|term| term * (variance + LEAST_VARIANCE * scale))
    }
}

/// The sum of numbers.
pub(super) fn sum(values: &[f32]) -> f64 {
    values.iter().map(|value| f64::from(*value)).sum()
}
