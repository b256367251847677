//! Symmetric matrices of two rows, in closed form.

/// `[[xx, xy], [xy, yy]]`.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(crate) struct Symmetric {
    pub xx: f64,
    pub xy: f64,
    pub yy: f64,
}

/// Smallest ratio of determinant to product of diagonal (1 minus the squared correlation) at which
/// a matrix still counts as invertible.
const MIN_INDEPENDENCE: f64 = 1e-10;

impl Symmetric {
    /// Adds `weight * (x, y) (x, y)^T`.
    pub fn add(&mut self, x: f64, y: f64, weight: f64) {
        self.xx += weight * x * x;
        self.xy += weight * x * y;
        self.yy += weight * y * y;
    }

    /// The inverse; `None` where the matrix is not safely positive definite.
    pub fn inverse(self) -> Option<Self> {
        let diagonal = self.xx * self.yy;
        let determinant = diagonal - self.xy * self.xy;
        if !(self.xx > 0.0 && determinant > MIN_INDEPENDENCE * diagonal && determinant.is_finite())
        {
            return None;
        }
        let inverse = Self {
            xx: self.yy / determinant,
            xy: -self.xy / determinant,
            yy: self.xx / determinant,
        };
        (inverse.xx.is_finite() && inverse.yy.is_finite()).then_some(inverse)
    }

    /// Matrix times vector.
    pub fn times(self, [x, y]: [f64; 2]) -> [f64; 2] {
        [self.xx * x + self.xy * y, self.xy * x + self.yy * y]
    }

    /// `self * middle * self`.
    pub fn sandwich(self, middle: Self) -> Self {
        let [a, b] = [[self.xx, self.xy], [self.xy, self.yy]];
        let form = |p: [f64; 2], q: [f64; 2]| {
            let m = middle.times(q);
            p[0] * m[0] + p[1] * m[1]
        };
        Self { xx: form(a, a), xy: form(a, b), yy: form(b, b) }
    }

    /// All entries times a number.
    pub fn scaled(self, by: f64) -> Self {
        Self { xx: self.xx * by, xy: self.xy * by, yy: self.yy * by }
    }

    /// Row by row.
    pub fn rows(self) -> [[f64; 2]; 2] {
        [[self.xx, self.xy], [self.xy, self.yy]]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn inverse_and_sandwich_agree_with_their_definition() {
        let m = Symmetric { xx: 2.0, xy: -0.5, yy: 3.0 };
        let i = m.inverse().unwrap();
        let [x, y] = i.times(m.times([1.5, -0.25]));
        assert!((x - 1.5).abs() < 1e-14 && (y + 0.25).abs() < 1e-14);
        // The inverse between two copies of the matrix is the matrix.
        let back = m.sandwich(i);
        assert!((back.xx - 2.0).abs() < 1e-14 && (back.xy + 0.5).abs() < 1e-14);
        assert!((back.yy - 3.0).abs() < 1e-14);
        assert!(Symmetric { xx: 1.0, xy: 1.0, yy: 1.0 }.inverse().is_none());
        assert!(Symmetric { xx: f64::NAN, xy: 0.0, yy: 1.0 }.inverse().is_none());
    }
}
