//! Products of rows with a matrix.
//!
//! tract multiplies tiles of 8 x 8, more than the 16 vector registers of WebAssembly's engines on x86 hold, and puts
//! rows into panels before and out of them after. Here tiles are 4 x 8, rows are used as they are, and the matrix is put
//! into panels of 8 columns, once if it is constant.

use tract_onnx::prelude::*;
use tract_onnx::tract_core::internal::*;
use tract_onnx::tract_core::ops::einsum::EinSum;
use wide::f32x4;

/// Columns of a panel.
const COLUMNS: usize = 8;

/// Rows times a matrix. An axis of the product may be any axis, or several, of its operands.
#[derive(Debug, Clone, PartialEq, Eq)]
struct Layout {
    /// Where in a row each inner number is.
    inner: Vec<usize>,
    /// Where in the output each column goes.
    columns: Vec<usize>,
    /// Where each row begins, and its part of the output.
    rows: Vec<[usize; 2]>,
    /// Whether rows are one after the other, their numbers too.
    in_order: bool,
}

/// Rows times a constant matrix.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Dense {
    /// Columns by eights, the last filled up with zeros: panels x inner numbers.
    panels: Vec<Columns>,
    layout: Layout,
    shape: TVec<usize>,
}

impl Eq for Dense {}

/// Rows times a matrix that both depend on what is given, for each combination of axes that both have.
#[derive(Debug, Clone, PartialEq, Eq)]
struct Product {
    /// Which operand is the matrix.
    matrix_at: usize,
    /// Where in the matrix each inner number and each column is.
    inner: Vec<usize>,
    columns: Vec<usize>,
    layout: Layout,
    /// Where each product's rows, matrix and output begin.
    products: Vec<[usize; 3]>,
    shape: TVec<usize>,
}

type Columns = [f32; COLUMNS];

/// Replaces products of two tensors.
pub(crate) fn densify(model: &mut TypedModel) -> TractResult<()> {
    for node in model.eval_order()? {
        let name = format!("{}.dense", model.node(node).name);
        let Some((op, inputs)) = replacement(model, node)? else { continue };
        let mut patch = TypedModelPatch::default();
        let taps = patch.taps(model, &inputs)?;
        let outlet = patch.wire_node(name, op, &taps)?[0];
        patch.shunt_outside(model, OutletId::new(node, 0), outlet)?;
        patch.apply(model)?;
    }
    model.compact()
}

/// Length of an axis, and its steps in some tensors.
pub(crate) struct Run<const N: usize = 2> {
    pub length: usize,
    pub steps: [usize; N],
}

/// Places in tensors of all combinations of axes, the last fastest.
fn places<const N: usize>(axes: &[Run<N>]) -> Vec<[usize; N]> {
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

/// Steps of the axes of a tensor in C order.
pub(crate) fn steps(shape: &[usize]) -> Vec<usize> {
    (0..shape.len()).map(|at| shape[at + 1..].iter().product()).collect()
}

/// The axes of a product, each with its steps: inner ones in a row and in the matrix, columns in the output and in the
/// matrix, rows in the input and in the output, and those of all three.
#[derive(Default)]
struct Axes {
    inner: Vec<Run>,
    columns: Vec<Run>,
    rows: Vec<Run>,
    products: Vec<Run<3>>,
}

/// The operator in place of a node, with its inputs, if it is a product.
fn replacement(
    model: &TypedModel,
    node: usize,
) -> TractResult<Option<(Box<dyn TypedOp>, TVec<OutletId>)>> {
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
    let constant = (0..2).rev().find(|&at| inputs[at].konst.is_some());
    let matrix_at = constant.unwrap_or(1);
    let (Some(rows), Some(matrix), Some(shape)) = (
        inputs[1 - matrix_at].shape.as_concrete(),
        inputs[matrix_at].shape.as_concrete(),
        output.shape.as_concrete(),
    ) else {
        return Ok(None);
    };
    let Some(axes) = axes(op, matrix_at, [rows, matrix, shape]) else { return Ok(None) };
    if let Some(weights) = &inputs[matrix_at].konst {
        if !axes.products.is_empty() {
            return Ok(None);
        }
        let dense = Dense::new(weights, [&axes.inner, &axes.columns, &axes.rows], shape)?;
        return Ok(dense.map(|dense| (dense.into(), tvec!(node.inputs[1 - matrix_at]))));
    }
    let product = Product::new(matrix_at, &axes, shape);
    Ok(product.map(|product| (product.into(), node.inputs.as_slice().into())))
}

/// `shapes` are those of rows, matrix and output.
fn axes(op: &EinSum, matrix_at: usize, shapes: [&[usize]; 3]) -> Option<Axes> {
    let [of_rows, of_matrix, of_output] = shapes.map(steps);
    let [rows, matrix, shape] = shapes;
    let mut axes = Axes::default();
    let mut ordered: Vec<_> = op.axes.iter_all_axes().collect();
    // Rows in the order of the output, inner numbers and columns in that of the matrix.
    ordered.sort_by_key(|axis| (axis.outputs[0].first(), axis.inputs[matrix_at].first()));
    for axis in ordered {
        if axis.inputs.iter().chain(&axis.outputs).any(|places| places.len() > 1) {
            return None;
        }
        let place = |at: usize| axis.inputs[at].first().copied();
        let row = place(1 - matrix_at);
        let long = place(matrix_at).filter(|&at| matrix[at] > 1);
        match (row, long, axis.outputs[0].first().copied()) {
            (Some(row), Some(own), None) if rows[row] == matrix[own] => {
                let steps = [of_rows[row], of_matrix[own]];
                axes.inner.push(Run { length: rows[row], steps });
            }
            (None, Some(own), Some(out)) => {
                let steps = [of_output[out], of_matrix[own]];
                axes.columns.push(Run { length: shape[out], steps });
            }
            (Some(row), None, Some(out)) => {
                let steps = [of_rows[row], of_output[out]];
                axes.rows.push(Run { length: rows[row], steps });
            }
            (Some(row), Some(own), Some(out)) => {
                let along = if rows[row] == 1 { 0 } else { of_rows[row] };
                let steps = [along, of_matrix[own], of_output[out]];
                axes.products.push(Run { length: shape[out], steps });
            }
            (Some(row), None, None) if rows[row] == 1 => {}
            (None, None, _) => {}
            _ => return None,
        }
    }
    Some(axes)
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
        let output = output.as_slice_mut().context("an output in C order")?;
        self.layout.multiply(given, &self.panels, output);
        Ok(tvec!(tensor.into()))
    }
}

impl TypedOp for Dense {
    fn output_facts(&self, _: &[&TypedFact]) -> TractResult<TVec<TypedFact>> {
        Ok(tvec!(f32::fact(&self.shape)))
    }

    as_op!();
}

impl Op for Product {
    fn name(&self) -> StaticName {
        "Product".into()
    }

    op_as_typed_op!();
}

impl EvalOp for Product {
    op_out_of_plan!();

    fn eval(&self, _: &EvalContext, inputs: TVec<TValue>) -> TractResult<TVec<TValue>> {
        let view = inputs[1 - self.matrix_at].to_plain_array_view::<f32>()?;
        let given = view.as_slice().context("rows in C order")?;
        let view = inputs[self.matrix_at].to_plain_array_view::<f32>()?;
        let matrix = view.as_slice().context("a matrix in C order")?;
        let mut tensor = Tensor::zero::<f32>(&self.shape)?;
        let mut output = tensor.to_plain_array_view_mut::<f32>()?;
        let output = output.as_slice_mut().context("an output in C order")?;
        let mut panels = panels(&self.inner, &self.columns);
        for &[rows, own, to] in &self.products {
            fill(&mut panels, &matrix[own..], &self.inner, &self.columns);
            self.layout.multiply(&given[rows..], &panels, &mut output[to..]);
        }
        Ok(tvec!(tensor.into()))
    }
}

impl TypedOp for Product {
    fn output_facts(&self, _: &[&TypedFact]) -> TractResult<TVec<TypedFact>> {
        Ok(tvec!(f32::fact(&self.shape)))
    }

    as_op!();
}

fn firsts<const N: usize>(places: &[[usize; N]]) -> Vec<usize> {
    places.iter().map(|place| place[0]).collect()
}

fn seconds(places: &[[usize; 2]]) -> Vec<usize> {
    places.iter().map(|place| place[1]).collect()
}

impl Dense {
    /// The product over the axes `inner` (steps in a row and in the weights) for all of `columns` (in the output and in
    /// the weights) and `rows` (in the input and in the output); nothing where it is too small to gain by it.
    pub fn new(
        weights: &Tensor,
        [inner, columns, rows]: [&[Run]; 3],
        shape: &[usize],
    ) -> TractResult<Option<Self>> {
        let (inner, columns) = (places(inner), places(columns));
        let Some(layout) = Layout::new(&inner, &columns, places(rows)) else { return Ok(None) };
        let view = weights.to_plain_array_view::<f32>()?;
        let numbers = view.as_slice().context("weights in C order")?;
        let (inner, columns) = (seconds(&inner), seconds(&columns));
        let mut panels = panels(&inner, &columns);
        fill(&mut panels, numbers, &inner, &columns);
        Ok(Some(Self { panels, layout, shape: shape.into() }))
    }
}

impl Product {
    fn new(matrix_at: usize, axes: &Axes, shape: &[usize]) -> Option<Self> {
        let (inner, columns) = (places(&axes.inner), places(&axes.columns));
        Some(Self {
            matrix_at,
            layout: Layout::new(&inner, &columns, places(&axes.rows))?,
            inner: seconds(&inner),
            columns: seconds(&columns),
            products: places(&axes.products),
            shape: shape.into(),
        })
    }
}

/// Room for a matrix by columns in eights.
fn panels(inner: &[usize], columns: &[usize]) -> Vec<Columns> {
    vec![[0.0; COLUMNS]; columns.len().div_ceil(COLUMNS) * inner.len()]
}

/// Puts a matrix into panels: `inner` and `columns` are where its rows and columns are.
fn fill(panels: &mut [Columns], matrix: &[f32], inner: &[usize], columns: &[usize]) {
    for (panel, columns) in panels.chunks_exact_mut(inner.len()).zip(columns.chunks(COLUMNS)) {
        let together = together(columns) && columns.len() == COLUMNS;
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

/// Whether columns lie side by side.
fn together(columns: &[usize]) -> bool {
    columns.iter().enumerate().all(|(at, &column)| column == columns[0] + at)
}

/// Numbers of rows that are worked on while all panels pass by.
const BLOCK: usize = 4096;

impl Layout {
    /// Nothing for a product too small to gain by it.
    fn new(
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
        Some(Self { inner, columns, rows, in_order })
    }

    /// The product of `given` rows with the matrix in panels.
    fn multiply(&self, given: &[f32], panels: &[Columns], output: &mut [f32]) {
        let inner = self.inner.len();
        let block = (BLOCK / inner).max(1) * 4;
        let room = if self.in_order { 0 } else { block.min(self.rows.len()) * inner };
        let mut gathered = vec![0.0; room];
        let together: Vec<bool> = self.columns.chunks(COLUMNS).map(together).collect();
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
            let panels = panels.chunks_exact(inner).zip(self.columns.chunks(COLUMNS));
            for ((panel, columns), &together) in panels.zip(&together) {
                let mut put = |[_, to]: [usize; 2], numbers: &Columns| {
                    let first = to + columns[0];
                    let eight = output[first..].first_chunk_mut::<COLUMNS>();
                    match eight.filter(|_| together && columns.len() == COLUMNS) {
                        Some(eight) => *eight = *numbers,
                        None => {
                            for (&column, &number) in columns.iter().zip(numbers) {
                                output[to + column] = number;
                            }
                        }
                    }
                };
                for (fours, numbers) in rows.chunks(4).zip(numbers.chunks(4 * inner)) {
                    if let [a, b, c, d] = *fours {
                        let tile = four_rows(panel, numbers, inner);
                        put(a, &tile[0]);
                        put(b, &tile[1]);
                        put(c, &tile[2]);
                        put(d, &tile[3]);
                    } else {
                        for (&row, numbers) in fours.iter().zip(numbers.chunks_exact(inner)) {
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
    use tract_onnx::tract_core::ops::array::Slice;

    /// Numbers without a pattern.
    pub(crate) fn numbers(shape: &[usize]) -> Tensor {
        let count: usize = shape.iter().product();
        let numbers: Vec<f32> = (0..count).map(|i| ((i * i) as f32 * 0.37).sin()).collect();
        Tensor::from_shape(shape, &numbers).expect("as many numbers as the shape has")
    }

    #[test]
    fn products_of_two_inputs_stay_the_same() {
        let cases: [(&str, &[usize], &[usize]); 6] = [
            ("bmk,bkn->bmn", &[3, 1, 12], &[3, 12, 16]),
            ("bmk,kn->bmn", &[2, 6, 9], &[9, 5]),
            ("bhqc,bhkc->bhqk", &[2, 3, 5, 4], &[2, 3, 7, 4]),
            ("bqhc,bkhc->bhqk", &[2, 5, 3, 4], &[2, 7, 3, 4]),
            ("bhqk,bkhc->bqhc", &[2, 3, 5, 7], &[2, 7, 3, 8]),
            ("amk,bkn->bmn", &[1, 6, 9], &[4, 9, 10]),
        ];
        for (expression, rows, matrix) in cases {
            let mut model = TypedModel::default();
            let source = model.add_source("numbers", f32::fact([600])).expect("a source");
            let mut part = |name: &str, from: usize, shape: &[usize]| {
                let length: usize = shape.iter().product();
                let own = Slice::new(0, from, from + length);
                let own = model.wire_node(format!("{name}.own"), own, &[source]).expect("a part");
                let to: TVec<TDim> = shape.iter().map(|&length| length.into()).collect();
                let shaped = AxisOp::Reshape(0, tvec!(length.into()), to);
                model.wire_node(name, shaped, &own).expect("a shape")[0]
            };
            let (rows, matrix) = (part("rows", 0, rows), part("matrix", 7, matrix));
            let op = EinSum::new(expression.parse().expect("an expression"), f32::datum_type());
            let product = model.wire_node("product", op, &[rows, matrix]).expect("a product");
            model.select_output_outlets(&product).expect("an output");
            same_after(model, &numbers(&[600]), densify, "Product", 1);
        }
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
