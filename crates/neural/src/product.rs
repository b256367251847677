//! Rows times a matrix, in WebAssembly's vectors.
//!
//! tract multiplies tiles of 8 x 8, more than the 16 vector registers of WebAssembly's engines on x86 hold, and puts
//! rows into panels before and out of them after. Here tiles are 4 x 8, rows are used as they are, and the matrix is put
//! into panels of 8 columns, once if it is constant.

use crate::few_rows::{self, Order};
use wide::f32x4;

/// Columns of a panel.
const COLUMNS: usize = 8;

/// Eight columns' numbers of a row of the matrix.
pub(crate) type Columns = [f32; COLUMNS];

/// The same of numbers whose lower 16 bits are zero (bfloat16), half as much to read.
pub(crate) type ShortColumns = [u16; COLUMNS];

/// Eight columns' numbers in some precision.
pub(crate) trait Eight: Copy + Send + Sync {
    /// Whether widening costs, so that it pays to do it once for many rows.
    const WIDENED: bool;

    fn halves(&self) -> [f32x4; 2];
}

impl Eight for Columns {
    const WIDENED: bool = false;

    #[inline(always)]
    fn halves(&self) -> [f32x4; 2] {
        let [a, b, c, d, e, f, g, h] = *self;
        [f32x4::new([a, b, c, d]), f32x4::new([e, f, g, h])]
    }
}

impl Eight for ShortColumns {
    const WIDENED: bool = true;

    #[inline(always)]
    fn halves(&self) -> [f32x4; 2] {
        let [a, b, c, d, e, f, g, h] = *self;
        [widened([a, b, c, d]), widened([e, f, g, h])]
    }
}

#[inline(always)]
fn widened([a, b, c, d]: [u16; 4]) -> f32x4 {
    let wide = |x: u16| f32::from_bits(u32::from(x) << 16);
    f32x4::new([wide(a), wide(b), wide(c), wide(d)])
}

/// A matrix in panels of as few bytes as hold its numbers.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Panels {
    Whole(Vec<Columns>),
    Short(Vec<ShortColumns>),
}

impl Panels {
    /// Short where no number loses by it.
    pub fn of(whole: Vec<Columns>) -> Self {
        if whole.as_flattened().iter().any(|x| x.to_bits() & 0xffff != 0) {
            return Self::Whole(whole);
        }
        let mut short = vec![[0; COLUMNS]; whole.len()];
        let numbers = short.as_flattened_mut().iter_mut().zip(whole.as_flattened());
        numbers.for_each(|(short, x)| *short = (x.to_bits() >> 16) as u16);
        Self::Short(short)
    }
}

/// Rows times a matrix. An axis of the product may be any axis, or several, of its operands.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Layout {
    /// Where in a row each inner number is.
    inner: Vec<usize>,
    /// Where in the output each column goes.
    columns: Vec<usize>,
    /// Where each row begins, and its part of the output.
    rows: Vec<[usize; 2]>,
    /// Whether rows are one after the other, their numbers too.
    in_order: bool,
    /// For each eight columns whether they lie side by side in the output.
    together: Vec<bool>,
}

/// Length of an axis, and its steps in some tensors.
pub(crate) struct Run<const N: usize = 2> {
    pub length: usize,
    pub steps: [usize; N],
}

/// Most places of a product's rows, columns or inner numbers that are listed; tract multiplies what has more.
const MOST_PLACES: usize = 1 << 22;

/// Whether all combinations of axes can be listed.
pub(crate) fn listable<const N: usize>(axes: &[Run<N>]) -> bool {
    let count = axes.iter().try_fold(1usize, |count, axis| count.checked_mul(axis.length));
    count.is_some_and(|count| count <= MOST_PLACES)
}

/// Places in tensors of all combinations of axes, the last fastest.
pub(crate) fn places<const N: usize>(axes: &[Run<N>]) -> Vec<[usize; N]> {
    let mut all = vec![[0; N]];
    for axis in axes {
        let along = |from: &[usize; N]| {
            let from = *from;
            (0..axis.length)
                .map(move |at| std::array::from_fn(|of| from[of] + at * axis.steps[of]))
                .collect::<Vec<_>>()
        };
        all = all.iter().flat_map(along).collect();
    }
    all
}

fn firsts<const N: usize>(places: &[[usize; N]]) -> Vec<usize> {
    places.iter().map(|place| place[0]).collect()
}

/// Room for a matrix by columns in eights.
pub(crate) fn panels(inner: &[usize], columns: &[usize]) -> Vec<Columns> {
    vec![[0.0; COLUMNS]; columns.len().div_ceil(COLUMNS) * inner.len()]
}

/// Puts a matrix into panels: `inner` and `columns` are where its rows and columns are.
pub(crate) fn fill(panels: &mut [Columns], matrix: &[f32], inner: &[usize], columns: &[usize]) {
    for (panel, columns) in panels.chunks_exact_mut(inner.len()).zip(columns.chunks(COLUMNS)) {
        let together = together(columns);
        for (row, &from) in panel.iter_mut().zip(inner) {
            let side_by_side =
                matrix[from + columns[0]..].first_chunk::<COLUMNS>().filter(|_| together);
            match side_by_side {
                Some(eight) => *row = *eight,
                None => {
                    for (own, &column) in row.iter_mut().zip(columns) {
                        *own = matrix[from + column];
                    }
                }
            }
        }
    }
}

/// Whether these are eight columns side by side.
fn together(columns: &[usize]) -> bool {
    let side_by_side = |(at, &column): (usize, &usize)| column == columns[0] + at;
    columns.len() == COLUMNS && columns.iter().enumerate().all(side_by_side)
}

/// Numbers of four rows that are worked on while all panels pass by.
const BLOCK: usize = 4096;

/// Rows worked on at least: panels of long rows come from far away.
const LEAST_ROWS: usize = 32;

impl Layout {
    /// Nothing for a product too small to gain by it.
    pub fn new(
        inner: &[[usize; 2]],
        columns: &[[usize; 2]],
        rows: Vec<[usize; 2]>,
    ) -> Option<Self> {
        if inner.len() < 2 || columns.len() < 2 {
            return None;
        }
        let (inner, columns) = (firsts(inner), firsts(columns));
        let in_order = inner.iter().enumerate().all(|(at, &place)| at == place)
            && rows.iter().enumerate().all(|(at, row)| row[0] == at * inner.len());
        let together = columns.chunks(COLUMNS).map(together).collect();
        Some(Self { inner, columns, rows, in_order, together })
    }

    /// The product of `given` rows with the matrix in panels.
    pub fn multiply<E: Eight>(&self, given: &[f32], panels: &[E], output: &mut [f32]) {
        let inner = self.inner.len();
        let mut wide: Vec<Columns> = vec![];
        let block = (BLOCK / inner).max(LEAST_ROWS / 4) * 4;
        let room = if self.in_order { 0 } else { block.min(self.rows.len()) * inner };
        let mut gathered = vec![0.0; room];
        for (at, rows) in self.rows.chunks(block).enumerate() {
            let numbers = if self.in_order {
                &given[at * block * inner..][..rows.len() * inner]
            } else {
                for (&[from, _], row) in rows.iter().zip(gathered.chunks_exact_mut(inner)) {
                    for (own, &place) in row.iter_mut().zip(&self.inner) {
                        *own = given[from + place];
                    }
                }
                &gathered[..rows.len() * inner]
            };
            let (fours, single) = rows.as_chunks::<4>();
            for (at, panel) in panels.chunks_exact(inner).enumerate() {
                let widen = E::WIDENED && fours.len() > 1;
                if widen {
                    wide.clear();
                    wide.extend(panel.iter().map(|eight| numbers_of(eight.halves())));
                }
                for (rows, numbers) in fours.iter().zip(numbers.chunks_exact(4 * inner)) {
                    let four = match widen {
                        true => four_rows(&wide, numbers, inner),
                        false => four_rows(panel, numbers, inner),
                    };
                    for (&row, numbers) in rows.iter().zip(&four) {
                        self.put(at, row, numbers, output);
                    }
                }
            }
            let numbers = &numbers[4 * fours.len() * inner..];
            for (&row, numbers) in single.iter().zip(numbers.chunks_exact(inner)) {
                for (at, pair) in panels.chunks(2 * inner).enumerate() {
                    let both = one_row(pair, numbers);
                    for (of, eight) in both.iter().enumerate().take(pair.len() / inner) {
                        self.put(2 * at + of, row, eight, output);
                    }
                }
            }
        }
    }

    /// The product of few rows with a matrix whose inner numbers and columns are at `places`.
    pub fn multiply_few(
        &self,
        given: &[f32],
        matrix: &[f32],
        places: [&[usize]; 2],
        order: Order,
        output: &mut [f32],
    ) {
        let mut row = vec![0.0; self.inner.len()];
        let mut numbers = vec![0.0; self.columns.len()];
        for &[from, to] in &self.rows {
            row.iter_mut().zip(&self.inner).for_each(|(own, &place)| *own = given[from + place]);
            few_rows::product(&row, matrix, places, order, &mut numbers);
            for (&column, &number) in self.columns.iter().zip(&numbers) {
                output[to + column] = number;
            }
        }
    }

    /// Puts a row's numbers of a panel into the output.
    #[inline(always)]
    fn put(&self, panel: usize, [_, to]: [usize; 2], numbers: &Columns, output: &mut [f32]) {
        let columns = &self.columns[panel * COLUMNS..];
        let columns = &columns[..columns.len().min(COLUMNS)];
        let first = to + columns[0];
        let eight = output[first..].first_chunk_mut::<COLUMNS>();
        match eight.filter(|_| self.together[panel]) {
            Some(eight) => *eight = *numbers,
            None => {
                for (&column, &number) in columns.iter().zip(numbers) {
                    output[to + column] = number;
                }
            }
        }
    }
}

/// The numbers of two vectors.
pub(crate) fn numbers_of([low, high]: [f32x4; 2]) -> [f32; COLUMNS] {
    let ([a, b, c, d], [e, f, g, h]) = (low.to_array(), high.to_array());
    [a, b, c, d, e, f, g, h]
}

// Functions of their own: engines of WebAssembly optimise by function, and these are called often.
#[inline(never)]
fn four_rows<E: Eight>(panel: &[E], rows: &[f32], inner: usize) -> [Columns; 4] {
    let (r0, rest) = rows.split_at(inner);
    let (r1, rest) = rest.split_at(inner);
    let (r2, rest) = rest.split_at(inner);
    let (panel, r3) = (&panel[..inner], &rest[..inner]);
    let [mut a0, mut a1, mut b0, mut b1] = [f32x4::ZERO; 4];
    let [mut c0, mut c1, mut d0, mut d1] = [f32x4::ZERO; 4];
    for k in 0..inner {
        let [low, high] = panel[k].halves();
        let a = f32x4::splat(r0[k]);
        a0 += a * low;
        a1 += a * high;
        let b = f32x4::splat(r1[k]);
        b0 += b * low;
        b1 += b * high;
        let c = f32x4::splat(r2[k]);
        c0 += c * low;
        c1 += c * high;
        let d = f32x4::splat(r3[k]);
        d0 += d * low;
        d1 += d * high;
    }
    [numbers_of([a0, a1]), numbers_of([b0, b1]), numbers_of([c0, c1]), numbers_of([d0, d1])]
}

/// A row with two panels side by side, which share what is loaded of the row.
#[inline(never)]
fn one_row<E: Eight>(panels: &[E], row: &[f32]) -> [Columns; 2] {
    let inner = row.len();
    let (left, right) = (&panels[..inner], &panels[panels.len() - inner..]);
    // Sums of even and odd numbers apart, since each has to wait for its last addition.
    let [mut a0, mut a1, mut b0, mut b1] = [f32x4::ZERO; 4];
    let [mut c0, mut c1, mut d0, mut d1] = [f32x4::ZERO; 4];
    let (twos, rest) = row.as_chunks::<2>();
    let (lefts, last_left) = left.as_chunks::<2>();
    let (rights, last_right) = right.as_chunks::<2>();
    for ((numbers, left), right) in twos.iter().zip(lefts).zip(rights) {
        let number = f32x4::splat(numbers[0]);
        let ([low, high], [lower, higher]) = (left[0].halves(), right[0].halves());
        a0 += number * low;
        a1 += number * high;
        b0 += number * lower;
        b1 += number * higher;
        let number = f32x4::splat(numbers[1]);
        let ([low, high], [lower, higher]) = (left[1].halves(), right[1].halves());
        c0 += number * low;
        c1 += number * high;
        d0 += number * lower;
        d1 += number * higher;
    }
    if let ([number], [left], [right]) = (rest, last_left, last_right) {
        let number = f32x4::splat(*number);
        let ([low, high], [lower, higher]) = (left.halves(), right.halves());
        a0 += number * low;
        a1 += number * high;
        b0 += number * lower;
        b1 += number * higher;
    }
    [numbers_of([a0 + c0, a1 + c1]), numbers_of([b0 + d0, b1 + d1])]
}
