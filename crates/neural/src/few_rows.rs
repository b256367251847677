//! Few rows times a matrix, read where it lies: putting it into panels would take longer than the product.

use wide::f32x4;

/// Most rows of a product for which this pays.
pub(crate) const MOST_ROWS: usize = 3;

/// Numbers of a vector.
const LANES: usize = 4;

/// How the numbers of a matrix follow each other.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Order {
    /// All columns of one inner number.
    ByInner,
    /// All inner numbers of one column.
    ByColumn,
}

/// The order of a matrix whose inner numbers and columns are at these places; `None` if neither is contiguous.
pub(crate) fn order(inner: &[usize], columns: &[usize]) -> Option<Order> {
    let contiguous =
        |places: &[usize]| places.iter().enumerate().all(|(at, &p)| p == places[0] + at);
    match (contiguous(columns), contiguous(inner)) {
        (true, _) => Some(Order::ByInner),
        (_, true) => Some(Order::ByColumn),
        _ => None,
    }
}

/// Writes the product of a row with a matrix to `output`, a number for each column.
pub(crate) fn product(
    row: &[f32],
    matrix: &[f32],
    [inner, columns]: [&[usize]; 2],
    order: Order,
    output: &mut [f32],
) {
    match order {
        Order::ByInner => {
            output.fill(0.0);
            let numbers = |at: usize| &matrix[inner[at] + columns[0]..][..columns.len()];
            let (fours, rest) = row.as_chunks::<LANES>();
            for (at, weights) in fours.iter().enumerate() {
                let of = std::array::from_fn(|k| numbers(LANES * at + k));
                add_four(*weights, of, output);
            }
            for (at, &weight) in rest.iter().enumerate() {
                let own = numbers(LANES * fours.len() + at);
                output.iter_mut().zip(own).for_each(|(sum, x)| *sum += weight * x);
            }
        }
        Order::ByColumn => {
            for (sum, &column) in output.iter_mut().zip(columns) {
                *sum = dot(row, &matrix[column + inner[0]..][..row.len()]);
            }
        }
    }
}

/// Adds four weighted vectors to `sums`, which is read and written once for all four.
#[inline(never)]
fn add_four(weights: [f32; LANES], vectors: [&[f32]; LANES], sums: &mut [f32]) {
    let [w0, w1, w2, w3] = weights;
    let (w0, w1, w2, w3) = (f32x4::splat(w0), f32x4::splat(w1), f32x4::splat(w2), f32x4::splat(w3));
    let [v0, v1, v2, v3] = vectors;
    let (v0, v1) = (v0.as_chunks::<LANES>().0, v1.as_chunks::<LANES>().0);
    let (v2, v3) = (v2.as_chunks::<LANES>().0, v3.as_chunks::<LANES>().0);
    let (chunks, rest) = sums.as_chunks_mut::<LANES>();
    let done = LANES * chunks.len();
    let count = chunks.len();
    let (v0, v1, v2, v3) = (&v0[..count], &v1[..count], &v2[..count], &v3[..count]);
    for k in 0..count {
        let (a, b) = (w0 * f32x4::new(v0[k]), w1 * f32x4::new(v1[k]));
        let (c, d) = (w2 * f32x4::new(v2[k]), w3 * f32x4::new(v3[k]));
        chunks[k] = (f32x4::new(chunks[k]) + (a + b) + (c + d)).to_array();
    }
    for (at, sum) in rest.iter_mut().enumerate() {
        *sum += (0..LANES).map(|k| weights[k] * vectors[k][done + at]).sum::<f32>();
    }
}

/// The scalar product, in four sums of four numbers each: one sum would wait for each addition.
#[inline(never)]
fn dot(a: &[f32], b: &[f32]) -> f32 {
    let (a_fours, a_rest) = a.as_chunks::<LANES>();
    let (b_fours, b_rest) = b.as_chunks::<LANES>();
    let (a_wide, a_left) = a_fours.as_chunks::<4>();
    let (b_wide, b_left) = b_fours.as_chunks::<4>();
    let [mut s0, mut s1, mut s2, mut s3] = [f32x4::ZERO; 4];
    for (a, b) in a_wide.iter().zip(b_wide) {
        s0 += f32x4::new(a[0]) * f32x4::new(b[0]);
        s1 += f32x4::new(a[1]) * f32x4::new(b[1]);
        s2 += f32x4::new(a[2]) * f32x4::new(b[2]);
        s3 += f32x4::new(a[3]) * f32x4::new(b[3]);
    }
    for (a, b) in a_left.iter().zip(b_left) {
        s0 += f32x4::new(*a) * f32x4::new(*b);
    }
    let rest: f32 = a_rest.iter().zip(b_rest).map(|(a, b)| a * b).sum();
    ((s0 + s1) + (s2 + s3)).reduce_add() + rest
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn both_orders_give_the_sum_of_products() {
        for (inner, columns) in [(1, 1), (4, 9), (33, 16), (96, 21)] {
            let number = |at: usize| ((at * at) as f32 * 0.37).sin();
            let row: Vec<f32> = (0..inner).map(number).collect();
            let matrix: Vec<f32> = (0..5 + inner * columns).map(number).collect();
            let places = |count: usize, step: usize| (0..count).map(|at| at * step).collect();
            let cases: [(Order, Vec<usize>, Vec<usize>); 2] = [
                (Order::ByInner, places(inner, columns), places(columns, 1)),
                (Order::ByColumn, places(inner, 1), places(columns, inner)),
            ];
            for (by, k, c) in cases {
                let matrix = &matrix[5..];
                let mut output = vec![f32::NAN; columns];
                product(&row, matrix, [&k, &c], by, &mut output);
                for (given, &column) in output.iter().zip(&c) {
                    let exact =
                        row.iter().zip(&k).map(|(x, k)| x * matrix[k + column]).sum::<f32>();
                    assert!((given - exact).abs() < 1e-4, "{by:?}, {inner} x {columns}");
                }
            }
        }
    }

    #[test]
    fn a_matrix_with_gaps_has_no_order() {
        assert_eq!(order(&[0, 2], &[0, 8]), None);
        assert_eq!(order(&[0, 8], &[3, 4]), Some(Order::ByInner));
        assert_eq!(order(&[0, 1], &[0, 8]), Some(Order::ByColumn));
    }
}
