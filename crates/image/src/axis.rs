//! Evenly spaced points.

use crate::error::ImageError;
use boresight_core::InputError;
use boresight_math::error::check_range;

/// Most points of an axis.
const MAX_POINTS: usize = 16_384;

/// Evenly spaced points, ascending.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Axis {
    first: f64,
    step: f64,
    count: usize,
}

impl Axis {
    /// `count` points from `first` to `last`, both included. `what` names it in errors.
    ///
    /// # Errors
    /// [`InputError::OutOfRange`] for limits that are not finite or do not ascend, fewer than two
    /// points or too many.
    pub fn new(what: &str, first: f64, last: f64, count: usize) -> Result<Self, ImageError> {
        check_range(what, first, -1e6, 1e6)?;
        check_range(what, last, -1e6, 1e6)?;
        check_range(&format!("points of {what}"), count as f64, 2.0, MAX_POINTS as f64)?;
        let step = (last - first) / (count - 1) as f64;
        if step > 1e-9 {
            return Ok(Self { first, step, count });
        }
        let expected = format!("an end above the beginning, {first}");
        Err(InputError::OutOfRange { what: what.into(), expected, given: last }.into())
    }

    /// First point.
    pub fn first(&self) -> f64 {
        self.first
    }

    /// Distance of the points.
    pub fn step(&self) -> f64 {
        self.step
    }

    /// Number of points.
    #[allow(clippy::len_without_is_empty)] // an axis has at least two points
    pub fn len(&self) -> usize {
        self.count
    }

    /// Last point.
    pub fn last(&self) -> f64 {
        self.value(self.count - 1)
    }

    /// Point `index`.
    pub fn value(&self, index: usize) -> f64 {
        self.first + self.step * index as f64
    }

    /// All points.
    pub fn values(&self) -> Vec<f64> {
        (0..self.count).map(|index| self.value(index)).collect()
    }

    /// Position of a value in steps from the first point.
    pub(crate) fn position(&self, value: f64) -> f64 {
        (value - self.first) / self.step
    }

    /// The two points around a value and their shares in it; `None` for a point that is not there.
    pub(crate) fn shares(&self, value: f64) -> [Option<(usize, f64)>; 2] {
        let position = self.position(value);
        let below = position.floor();
        let fraction = position - below;
        let point = |index: f64, share: f64| {
            (index >= 0.0 && index < self.count as f64).then_some((index as usize, share))
        };
        [point(below, 1.0 - fraction), point(below + 1.0, fraction)]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use boresight_core::Diagnose;

    #[test]
    fn shares_interpolate_and_end_with_the_axis() {
        let axis = Axis::new("range_m", 2.0, 4.0, 5).unwrap();
        assert_eq!(axis.values(), [2.0, 2.5, 3.0, 3.5, 4.0]);
        assert_eq!(axis.shares(3.125), [Some((2, 0.75)), Some((3, 0.25))]);
        assert_eq!(axis.shares(4.0), [Some((4, 1.0)), None]);
        assert_eq!(axis.shares(1.75), [None, Some((0, 0.5))]);
        assert_eq!(axis.shares(1.4), [None, None]);
        assert_eq!(axis.shares(f64::NAN), [None, None]);
        assert_eq!(axis.shares(1e300), [None, None]);
    }

    #[test]
    fn what_is_no_axis_is_refused() {
        for (first, last, count, what) in [
            (1.0, 1.0, 2, "range_m"),
            (1.0, 0.0, 2, "range_m"),
            (0.0, 1.0, 1, "points of range_m"),
            (f64::NAN, 1.0, 2, "range_m"),
            (0.0, 1e7, 2, "range_m"),
            (0.0, 1.0, MAX_POINTS + 1, "points of range_m"),
        ] {
            let refused = Axis::new("range_m", first, last, count).unwrap_err();
            assert_eq!((refused.code(), &*refused.details().what), ("out-of-range", what));
        }
    }
}
