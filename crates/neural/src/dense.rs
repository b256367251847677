//! Products with constant matrices.
//!
//! tract multiplies tiles of 8 x 8, more than the 16 vector registers of WebAssembly's engines on x86 hold, and puts
//! rows into panels before and out of them after. Here tiles are 4 x 8, rows are used as they are, and the matrix of
//! weights is put into panels of 8 columns once.

use tract_onnx::prelude::*;
use tract_onnx::tract_core::internal::*;
use tract_onnx::tract_core::ops::einsum::EinSum;
use wide::f32x4;

/// Columns of a panel.
const COLUMNS: usize = 8;

/// Rows times a constant matrix. An axis of the product may be any axis, or several, of its operands.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Dense {
    /// Columns by eights, the last filled up with zeros: panels x inner numbers.
    panels: Vec<[f32; COLUMNS]>,
    /// Where in a row each inner number is.
    inner: Vec<usize>,
    /// Where in the output each column goes.
    columns: Vec<usize>,
    /// Where each row begins, and its part of the output.
    rows: Vec<(usize, usize)>,
    shape: TVec<usize>,
}

impl Eq for Dense {}

/// Replaces products with constant matrices.
pub(crate) fn densify(model: &mut TypedModel) -> TractResult<()> {
    for node in model.eval_order()? {
        let Some((dense, input)) = dense(model, node)? else { continue };
        let name = model.node(node).name.clone();
        let mut patch = TypedModelPatch::default();
        let taps = patch.taps(model, &[input])?;
        let outlet = patch.wire_node(format!("{name}.dense"), dense, &taps)?[0];
        patch.shunt_outside(model, OutletId::new(node, 0), outlet)?;
        patch.apply(model)?;
    }
    model.compact()
}

/// Length of an axis, and its steps in up to two tensors.
pub(crate) struct Run {
    pub length: usize,
    pub steps: [usize; 2],
}

/// Places in two tensors of all combinations of axes, the last fastest.
fn places(axes: &[Run]) -> Vec<[usize; 2]> {
    let mut all = vec![[0, 0]];
    for axis in axes {
        let along = |&[a, b]: &[usize; 2]| {
            (0..axis.length)
                .map(move |at| [a + at * axis.steps[0], b + at * axis.steps[1]])
                .collect::<Vec<_>>()
        };
        all = all.iter().flat_map(along).collect();
    }
    all
}

/// Steps of the axes of a tensor in C order.
pub(crate) fn steps(shape: &[usize]) -> Vec<usize> {
    (0..shape.len()).map(|at| shape[at + 1..].iter().product()).collect()
}

/// The product of a node and the outlet of its rows, if it is one with a constant matrix.
fn dense(model: &TypedModel, node: usize) -> TractResult<Option<(Dense, OutletId)>> {
    let node = model.node(node);
    let Some(op) = node.op_as::<EinSum>() else { return Ok(None) };
    let output = &node.outputs[0].fact;
    let (inputs, _) = model.node_facts(node.id)?;
    let plain = |fact: &TypedFact| fact.datum_type == f32::datum_type() && fact.is_plain();
    if inputs.len() != 2
        || op.q_params.is_some()
        || !plain(output)
        || !inputs.iter().all(|fact| plain(fact))
    {
        return Ok(None);
    }
    let Some(weights_at) = (0..2).rev().find(|&at| inputs[at].konst.is_some()) else {
        return Ok(None);
    };
    let rows_at = 1 - weights_at;
    let (Some(weights), Some(rows), Some(shape)) = (
        &inputs[weights_at].konst,
        inputs[rows_at].shape.as_concrete(),
        output.shape.as_concrete(),
    ) else {
        return Ok(None);
    };
    let of_weights = steps(weights.shape());
    let (of_rows, of_output) = (steps(rows), steps(shape));
    let (mut inner, mut columns, mut kept) = (Vec::new(), Vec::new(), Vec::new());
    let mut ordered: Vec<_> = op.axes.iter_all_axes().collect();
    // Rows in the order of the output, inner numbers and columns in that of the weights.
    ordered.sort_by_key(|axis| (axis.outputs[0].first(), axis.inputs[weights_at].first()));
    for axis in ordered {
        if axis.inputs.iter().chain(&axis.outputs).any(|places| places.len() > 1) {
            return Ok(None);
        }
        let [row, weight] = [rows_at, weights_at].map(|at| axis.inputs[at].first().copied());
        let long = weight.filter(|&at| weights.shape()[at] > 1);
        match (row, long, axis.outputs[0].first().copied()) {
            (Some(row), Some(weight), None) => {
                inner.push(Run { length: rows[row], steps: [of_rows[row], of_weights[weight]] });
            }
            (None, Some(weight), Some(out)) => {
                columns
                    .push(Run { length: shape[out], steps: [of_output[out], of_weights[weight]] });
            }
            (Some(row), None, Some(out)) => {
                kept.push(Run { length: rows[row], steps: [of_rows[row], of_output[out]] });
            }
            (Some(row), None, None) if rows[row] == 1 => {}
            (None, None, _) => {}
            _ => return Ok(None),
        }
    }
    let dense = Dense::new(weights, [&inner, &columns, &kept], shape)?;
    Ok(dense.map(|dense| (dense, node.inputs[rows_at])))
}

impl Op for Dense {
    fn name(&self) -> StaticName {
        "Dense".into()
    }

    op_as_typed_op!();
}

impl EvalOp for Dense {
    op_out_of_plan!();

    fn eval(&self, _: &EvalContext, inputs: TVec<TValue>) -> TractResult<TVec<TValue>> {
        let view = inputs[0].to_plain_array_view::<f32>()?;
        let given = view.as_slice().context("rows in C order")?;
        let mut tensor = Tensor::zero::<f32>(&self.shape)?;
        let mut output = tensor.to_plain_array_view_mut::<f32>()?;
        self.multiply(given, output.as_slice_mut().context("an output in C order")?);
        Ok(tvec!(tensor.into()))
    }
}

impl TypedOp for Dense {
    fn output_facts(&self, _: &[&TypedFact]) -> TractResult<TVec<TypedFact>> {
        Ok(tvec!(f32::fact(&self.shape)))
    }

    as_op!();
}

/// Numbers of rows that are worked on while all panels pass by.
const BLOCK: usize = 4096;

impl Dense {
    /// The product over the axes `inner` (steps in a row and in the weights) for all of `columns` (in the output and in
    /// the weights) and `rows` (in the input and in the output); nothing where it is too small to gain by it.
    pub fn new(
        weights: &Tensor,
        [inner, columns, rows]: [&[Run]; 3],
        shape: &[usize],
    ) -> TractResult<Option<Self>> {
        let (inner, columns, rows) = (places(inner), places(columns), places(rows));
        if inner.len() < 2 || columns.len() < 2 {
            return Ok(None);
        }
        let view = weights.to_plain_array_view::<f32>()?;
        let numbers = view.as_slice().context("weights in C order")?;
        let mut panels = vec![[0.0; COLUMNS]; columns.len().div_ceil(COLUMNS) * inner.len()];
        for (at, column) in columns.iter().enumerate() {
            for (row, place) in inner.iter().enumerate() {
                panels[at / COLUMNS * inner.len() + row][at % COLUMNS] =
                    numbers[place[1] + column[1]];
            }
        }
        Ok(Some(Self {
            panels,
            inner: inner.iter().map(|place| place[0]).collect(),
            columns: columns.iter().map(|place| place[0]).collect(),
            rows: rows.iter().map(|place| (place[0], place[1])).collect(),
            shape: shape.into(),
        }))
    }

    fn multiply(&self, given: &[f32], output: &mut [f32]) {
        let inner = self.inner.len();
        let block = (BLOCK / inner).max(1) * 4;
        let mut gathered = vec![0.0; block.min(self.rows.len()) * inner];
        // Whether eight columns lie side by side in the output.
        let together: Vec<bool> = self
            .columns
            .chunks(COLUMNS)
            .map(|columns| {
                columns.iter().enumerate().all(|(at, &column)| column == columns[0] + at)
            })
            .collect();
        let in_order = self.inner.iter().enumerate().all(|(at, &place)| at == place);
        for rows in self.rows.chunks(block) {
            for (&(from, _), row) in rows.iter().zip(gathered.chunks_exact_mut(inner)) {
                if in_order {
                    row.copy_from_slice(&given[from..from + inner]);
                } else {
                    for (own, &place) in row.iter_mut().zip(&self.inner) {
                        *own = given[from + place];
                    }
                }
            }
            let panels = self.panels.chunks_exact(inner).zip(self.columns.chunks(COLUMNS));
            for ((panel, columns), &together) in panels.zip(&together) {
                let mut put = |(_, to): (usize, usize), numbers: &[f32; COLUMNS]| {
                    if together {
                        let first = to + columns[0];
                        output[first..first + columns.len()]
                            .copy_from_slice(&numbers[..columns.len()]);
                    } else {
                        for (&column, &number) in columns.iter().zip(numbers) {
                            output[to + column] = number;
                        }
                    }
                };
                for (fours, gathered) in rows.chunks(4).zip(gathered.chunks(4 * inner)) {
                    if let [a, b, c, d] = *fours {
                        let tile = four_rows(panel, gathered, inner);
                        put(a, &tile[0]);
                        put(b, &tile[1]);
                        put(c, &tile[2]);
                        put(d, &tile[3]);
                    } else {
                        for (&row, numbers) in fours.iter().zip(gathered.chunks_exact(inner)) {
                            put(row, &one_row(panel, numbers));
                        }
                    }
                }
            }
        }
    }
}

fn halves(numbers: &[f32; COLUMNS]) -> [f32x4; 2] {
    let [a, b, c, d, e, f, g, h] = *numbers;
    [f32x4::new([a, b, c, d]), f32x4::new([e, f, g, h])]
}

fn numbers([low, high]: [f32x4; 2]) -> [f32; COLUMNS] {
    let ([a, b, c, d], [e, f, g, h]) = (low.to_array(), high.to_array());
    [a, b, c, d, e, f, g, h]
}

// Functions of their own: engines of WebAssembly optimise by function, and these are called often.
#[inline(never)]
fn four_rows(panel: &[[f32; COLUMNS]], rows: &[f32], inner: usize) -> [[f32; COLUMNS]; 4] {
    let (r0, rest) = rows.split_at(inner);
    let (r1, rest) = rest.split_at(inner);
    let (r2, rest) = rest.split_at(inner);
    let (panel, r3) = (&panel[..inner], &rest[..inner]);
    let [mut a0, mut a1, mut b0, mut b1] = [f32x4::ZERO; 4];
    let [mut c0, mut c1, mut d0, mut d1] = [f32x4::ZERO; 4];
    for k in 0..inner {
        let [low, high] = halves(&panel[k]);
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
    [numbers([a0, a1]), numbers([b0, b1]), numbers([c0, c1]), numbers([d0, d1])]
}

#[inline(never)]
fn one_row(panel: &[[f32; COLUMNS]], row: &[f32]) -> [f32; COLUMNS] {
    // Four sums at a time, since each has to wait for its last addition.
    let [mut a0, mut a1, mut b0, mut b1] = [f32x4::ZERO; 4];
    let [mut c0, mut c1, mut d0, mut d1] = [f32x4::ZERO; 4];
    let (fours, rest) = row.as_chunks::<4>();
    let (panels, last) = panel.as_chunks::<4>();
    for (numbers, panel) in fours.iter().zip(panels) {
        let [low, high] = halves(&panel[0]);
        let a = f32x4::splat(numbers[0]);
        a0 += a * low;
        a1 += a * high;
        let [low, high] = halves(&panel[1]);
        let b = f32x4::splat(numbers[1]);
        b0 += b * low;
        b1 += b * high;
        let [low, high] = halves(&panel[2]);
        let c = f32x4::splat(numbers[2]);
        c0 += c * low;
        c1 += c * high;
        let [low, high] = halves(&panel[3]);
        let d = f32x4::splat(numbers[3]);
        d0 += d * low;
        d1 += d * high;
    }
    for (&number, panel) in rest.iter().zip(last) {
        let [low, high] = halves(panel);
        let a = f32x4::splat(number);
        a0 += a * low;
        a1 += a * high;
    }
    numbers([(a0 + b0) + (c0 + d0), (a1 + b1) + (c1 + d1)])
}

#[cfg(test)]
pub(crate) mod tests {
    use super::*;
    use crate::engine::tests::same_after;

    /// Numbers without a pattern.
    pub(crate) fn numbers(shape: &[usize]) -> Tensor {
        let count: usize = shape.iter().product();
        let numbers: Vec<f32> = (0..count).map(|i| ((i * i) as f32 * 0.37).sin()).collect();
        Tensor::from_shape(shape, &numbers).expect("as many numbers as the shape has")
    }

    #[test]
    fn products_stay_the_same() {
        let cases: [(&str, &[usize], &[usize]); 7] = [
            ("abk,kn->abn", &[2, 5, 12], &[12, 9]),
            ("bk,kn->bn", &[1, 33], &[33, 8]),
            ("bk,nk->bn", &[7, 6], &[21, 6]),
            ("abk,khd->ahbd", &[2, 9, 12], &[12, 3, 7]),
            ("ahbd,hdn->abn", &[2, 3, 9, 8], &[3, 8, 10]),
            ("kab,kn->nab", &[12, 3, 4], &[12, 6]),
            ("abk,xkn->abn", &[3, 4, 300], &[1, 300, 17]),
        ];
        for (expression, rows, weights) in cases {
            let mut model = TypedModel::default();
            let source = model.add_source("rows", f32::fact(rows)).expect("a source");
            let matrix = model.add_const("weights", numbers(weights)).expect("a constant");
            let axes = expression.parse().expect("an expression");
            let op = EinSum::new(axes, f32::datum_type());
            let product = model.wire_node("product", op, &[source, matrix]).expect("a product");
            model.select_output_outlets(&product).expect("an output");
            same_after(model, &numbers(rows), densify, "Dense", 1);
        }
    }
}
