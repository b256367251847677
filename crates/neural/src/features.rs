//! The covariance as the networks of Sang et al. (2021) take it.

use boresight_aoa::Data;
use boresight_core::Complex64;
use boresight_signal::sample_covariance;
use ndarray::ArrayView2;

/// Elements of the array the networks are for.
pub(crate) const ELEMENTS: usize = 8;

/// Numbers in the upper triangle of an 8 x 8 covariance without its diagonal.
pub const COVARIANCE_FEATURES: usize = ELEMENTS * (ELEMENTS - 1);

/// Equation 8 of Sang et al.: the upper triangle of the covariance by rows without the diagonal, real and imaginary
/// parts, over its largest diagonal entry; zeros for a covariance of zeros. Any scale will do.
pub fn covariance_features(data: Data<'_>) -> Vec<f32> {
    match data {
        Data::Snapshots(snapshots) => upper_triangle(sample_covariance(snapshots).view()),
        Data::Covariance { matrix, .. } => upper_triangle(matrix),
    }
}

fn upper_triangle(matrix: ArrayView2<Complex64>) -> Vec<f32> {
    let largest = matrix.diag().iter().map(|z| z.re).fold(0.0, f64::max);
    let scale = if largest > 0.0 { 1.0 / largest } else { 0.0 };
    let elements = matrix.nrows();
    let entries = (0..elements).flat_map(|i| (i + 1..elements).map(move |k| [i, k]));
    entries
        .flat_map(|at| [matrix[at].re * scale, matrix[at].im * scale])
        .map(|x| x as f32)
        .collect()
}
