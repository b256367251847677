//! Products of two tensors, run by [`crate::product`].

use crate::few_rows::{MOST_ROWS, Order, order};
use crate::product::{Layout, Panels, Run, fill, listable, panels, places};
use tract_onnx::prelude::*;
use tract_onnx::tract_core::internal::*;
use tract_onnx::tract_core::ops::einsum::EinSum;

/// Rows times a constant matrix.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Dense {
    /// Columns by eights, the last filled up with zeros: panels x inner numbers.
    panels: Panels,
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
    /// Order of the matrix, where rows are so few that it is read where it lies.
    order: Option<Order>,
    shape: TVec<usize>,
}

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

/// An operator and its inputs.
type Replacement = (Box<dyn TypedOp>, TVec<OutletId>);

/// What stands for a node, if it is a product.
fn replacement(model: &TypedModel, node: usize) -> TractResult<Option<Replacement>> {
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
        match &self.panels {
            Panels::Whole(panels) => self.layout.multiply(given, panels, output),
            Panels::Short(panels) => self.layout.multiply(given, panels, output),
        }
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
        let places = [&*self.inner, &*self.columns];
        if let Some(order) = self.order {
            for &[rows, own, to] in &self.products {
                let (given, matrix) = (&given[rows..], &matrix[own..]);
                self.layout.multiply_few(given, matrix, places, order, &mut output[to..]);
            }
            return Ok(tvec!(tensor.into()));
        }
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

fn seconds(places: &[[usize; 2]]) -> Vec<usize> {
    places.iter().map(|place| place[1]).collect()
}

impl Dense {
    /// The product over the axes `inner` (steps in a row and in the weights) for all of `columns` (in the output and in
    /// the weights) and `rows` (in the input and in the output); nothing where it is too small to gain by it, or too
    /// large to list.
    pub fn new(
        weights: &Tensor,
        [inner, columns, rows]: [&[Run]; 3],
        shape: &[usize],
    ) -> TractResult<Option<Self>> {
        if ![inner, columns, rows].into_iter().all(listable) {
            return Ok(None);
        }
        let (inner, columns) = (places(inner), places(columns));
        let Some(layout) = Layout::new(&inner, &columns, places(rows)) else { return Ok(None) };
        let view = weights.to_plain_array_view::<f32>()?;
        let numbers = view.as_slice().context("weights in C order")?;
        let (inner, columns) = (seconds(&inner), seconds(&columns));
        let mut panels = panels(&inner, &columns);
        fill(&mut panels, numbers, &inner, &columns);
        Ok(Some(Self { panels: Panels::of(panels), layout, shape: shape.into() }))
    }
}

impl Product {
    fn new(matrix_at: usize, axes: &Axes, shape: &[usize]) -> Option<Self> {
        let Axes { inner, columns, rows, products } = axes;
        if ![inner, columns, rows].into_iter().all(|axes| listable(axes)) || !listable(products) {
            return None;
        }
        let (inner, columns, rows) = (places(inner), places(columns), places(rows));
        let few = rows.len() <= MOST_ROWS;
        let layout = Layout::new(&inner, &columns, rows)?;
        let (inner, columns) = (seconds(&inner), seconds(&columns));
        Some(Self {
            matrix_at,
            layout,
            order: if few { order(&inner, &columns) } else { None },
            inner,
            columns,
            products: places(products),
            shape: shape.into(),
        })
    }
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
        let cases: [(&str, &[usize], &[usize]); 9] = [
            ("bmk,bkn->bmn", &[3, 1, 12], &[3, 12, 16]),
            ("mk,kn->mn", &[1, 13], &[13, 19]),
            ("mk,nk->mn", &[2, 21], &[11, 21]),
            ("km,nk->nm", &[21, 3], &[11, 21]),
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
    fn what_is_too_large_to_list_is_left_alone() {
        let mut model = TypedModel::default();
        let source = model.add_source("rows", f32::fact([1 << 23, 2])).expect("a source");
        let matrix = model.add_const("weights", numbers(&[2, 2])).expect("a constant");
        let op = EinSum::new("mk,kn->mn".parse().expect("an expression"), f32::datum_type());
        let product = model.wire_node("product", op, &[source, matrix]).expect("a product");
        model.select_output_outlets(&product).expect("an output");
        densify(&mut model).expect("a change");
        assert!(model.nodes().iter().all(|node| node.op.name() != "Dense"), "{model}");
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
        for (case, (expression, rows, weights)) in cases.iter().chain(&cases).enumerate() {
            let mut matrix = numbers(weights);
            if case >= cases.len() {
                // Held in half the bytes.
                let mut view = matrix.to_plain_array_view_mut::<f32>().expect("numbers");
                view.mapv_inplace(|x| f32::from_bits(x.to_bits() & 0xffff_0000));
            }
            let mut model = TypedModel::default();
            let source = model.add_source("rows", f32::fact(*rows)).expect("a source");
            let matrix = model.add_const("weights", matrix).expect("a constant");
            let axes = expression.parse().expect("an expression");
            let op = EinSum::new(axes, f32::datum_type());
            let product = model.wire_node("product", op, &[source, matrix]).expect("a product");
            model.select_output_outlets(&product).expect("an output");
            same_after(model, &numbers(rows), densify, "Dense", 1);
        }
    }
}
