//! Vectors and covariances of the plane in turned axes.

/// A vector in axes whose first lies along `[cos, sin]`.
pub(crate) fn turned([x, y]: [f64; 2], [cos, sin]: [f64; 2]) -> [f64; 2] {
    [x * cos + y * sin, y * cos - x * sin]
}

/// A covariance xx, xy, yy in axes whose first lies along `[cos, sin]`.
pub(crate) fn turned_covariance([xx, xy, yy]: [f64; 3], [cos, sin]: [f64; 2]) -> [f64; 3] {
    let both = 2.0 * xy * sin * cos;
    [
        xx * cos * cos + yy * sin * sin + both,
        (yy - xx) * sin * cos + xy * (cos * cos - sin * sin),
        xx * sin * sin + yy * cos * cos - both,
    ]
}
