//! Orthonormal bases.

/// Length of what is left of a column over that of the column, below which it depends on those before it.
const DEPENDENT: f64 = 1e-9;

/// An orthonormal basis of the columns' span under the inner product `dot`, by Gram and Schmidt's method, done twice for
/// rounding (Giraud, Langou and Rozloznik 2005). Columns that depend on others add nothing.
pub(crate) fn orthonormal(
    columns: &[Vec<f64>],
    dot: impl Fn(&[f64], &[f64]) -> f64,
) -> Vec<Vec<f64>> {
    let mut basis: Vec<Vec<f64>> = vec![];
    for column in columns {
        let mut rest = column.clone();
        for _ in 0..2 {
            for known in &basis {
                let along = dot(known, &rest);
                rest.iter_mut().zip(known).for_each(|(x, y)| *x -= along * y);
            }
        }
        let length = dot(&rest, &rest).sqrt();
        if length > DEPENDENT * dot(column, column).sqrt() {
            rest.iter_mut().for_each(|x| *x /= length);
            basis.push(rest);
        }
    }
    basis
}
