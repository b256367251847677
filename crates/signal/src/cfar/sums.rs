//! Sums over rectangles of a map that wraps along Doppler.

use super::stencil::Rectangle;
use ndarray::ArrayView2;

/// Cumulative sums over rows and columns, in `f64`: a rectangle takes four of them. Sums are exact
/// to 1e-16 of the whole map's total, so that noise up to 120 dB below it keeps four digits.
pub struct CumulativeSums {
    sums: Vec<f64>,
    stride: usize,
    reach: usize,
    dopplers: usize,
}

impl CumulativeSums {
    /// Space for a map of `ranges` x `dopplers` and rectangles that reach `reach` to either side.
    pub fn new(ranges: usize, dopplers: usize, reach: usize) -> Self {
        let stride = dopplers + 2 * reach + 1;
        Self { sums: vec![0.0; (ranges + 1) * stride], stride, reach, dopplers }
    }

    /// Sums up a map.
    pub fn fill(&mut self, map: ArrayView2<f32>) {
        let (reach, dopplers, stride) = (self.reach, self.dopplers, self.stride);
        for (r, row) in map.outer_iter().enumerate() {
            let (above, below) = self.sums.split_at_mut((r + 1) * stride);
            let above = &above[r * stride..];
            let mut sum = 0.0;
            let wrapped = (0..reach)
                .map(|c| row[dopplers - reach + c])
                .chain(row.iter().copied())
                .chain((0..reach).map(|c| row[c]));
            for (c, value) in wrapped.enumerate() {
                sum += f64::from(value);
                below[c + 1] = above[c + 1] + sum;
            }
        }
    }

    /// Adds to each entry of `totals`, one a Doppler bin, the sum over its rectangle.
    pub fn add(&self, rectangle: &Rectangle, totals: &mut [f64]) {
        let column = |offset: isize| (self.reach as isize + offset) as usize;
        let (left, right) = (column(rectangle.offsets.start), column(rectangle.offsets.end));
        let row = |r: usize, c: usize| &self.sums[r * self.stride + c..][..self.dopplers];
        let (top, bottom) = (rectangle.rows.start, rectangle.rows.end);
        let corners = row(bottom, right).iter().zip(row(bottom, left));
        let corners = corners.zip(row(top, right).iter().zip(row(top, left)));
        for (total, ((br, bl), (tr, tl))) in totals.iter_mut().zip(corners) {
            *total += (br - bl) - (tr - tl);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use ndarray::Array2;

    #[test]
    fn rectangles_wrap_along_doppler() {
        let map = Array2::from_shape_fn((4, 6), |(r, d)| (10 * r + d) as f32);
        let mut sums = CumulativeSums::new(4, 6, 2);
        sums.fill(map.view());
        let rectangle = Rectangle { rows: 1..3, offsets: -2..1 };
        let mut totals = vec![0.0; 6];
        sums.add(&rectangle, &mut totals);
        for d in 0..6_isize {
            let expected: f32 = (1..3)
                .flat_map(|r| (-2..1).map(move |o| (r, (d + o).rem_euclid(6) as usize)))
                .map(|cell| map[cell])
                .sum();
            assert_eq!(totals[d as usize], f64::from(expected));
        }
    }
}
