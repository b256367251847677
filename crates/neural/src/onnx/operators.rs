//! The operators a model may use: those of ordinary layers, without control flow, state, randomness and strings.

/// Fewest and most inputs, most outputs.
pub(super) struct Arity {
    pub inputs: [usize; 2],
    pub outputs: usize,
}

const ANY: usize = usize::MAX;

/// What an operator takes and gives, if it is supported.
pub(super) fn arity(operator: &str) -> Option<Arity> {
    let (inputs, outputs) = match operator {
        "Constant" => ([0, 0], 1),
        "Abs" | "Acos" | "Acosh" | "Asin" | "Asinh" | "Atan" | "Atanh" | "Cast" | "Ceil"
        | "Celu" | "ConstantOfShape" | "Cos" | "Cosh" | "Elu" | "Erf" | "Exp" | "Flatten"
        | "Floor" | "Gelu" | "GlobalAveragePool" | "GlobalMaxPool" | "HardSigmoid"
        | "HardSwish" | "Identity" | "LeakyRelu" | "Log" | "LogSoftmax" | "LpNormalization"
        | "Mish" | "Neg" | "Not" | "Reciprocal" | "Relu" | "Round" | "Selu" | "Shape"
        | "Sigmoid" | "Sign" | "Sin" | "Sinh" | "Size" | "Softmax" | "Softplus" | "Softsign"
        | "Sqrt" | "Tan" | "Tanh" | "ThresholdedRelu" | "Transpose" | "ArgMax" | "ArgMin"
        | "AveragePool" => ([1, 1], 1),
        "MaxPool" => ([1, 1], 1),
        "Add" | "And" | "Div" | "Equal" | "Greater" | "GreaterOrEqual" | "Less" | "LessOrEqual"
        | "MatMul" | "Mod" | "Mul" | "Or" | "PRelu" | "Pow" | "Sub" | "Xor" | "Expand"
        | "Reshape" | "Tile" | "Gather" | "CumSum" => ([2, 2], 1),
        "TopK" => ([2, 2], 2),
        "Where" | "InstanceNormalization" | "ScatterElements" | "ScatterND" => ([3, 3], 1),
        "Conv" | "ConvTranspose" | "Gemm" | "LayerNormalization" => ([2, 3], 1),
        "BatchNormalization" => ([5, 5], 1),
        "Clip" => ([1, 3], 1),
        "Dropout" => ([1, 1], 1),
        "Pad" => ([1, 3], 1),
        "Slice" => ([1, 5], 1),
        "Squeeze" | "Unsqueeze" | "ReduceL1" | "ReduceL2" | "ReduceLogSum" | "ReduceLogSumExp"
        | "ReduceMax" | "ReduceMean" | "ReduceMin" | "ReduceProd" | "ReduceSum"
        | "ReduceSumSquare" | "Trilu" => ([1, 2], 1),
        "Split" => ([1, 2], ANY),
        "Concat" | "Max" | "Min" | "Mean" | "Sum" | "Einsum" => ([1, ANY], 1),
        _ => return None,
    };
    Some(Arity { inputs, outputs })
}

/// The input of an operator that sets the size of its output.
pub(super) fn size_input(operator: &str) -> Option<usize> {
    match operator {
        "ConstantOfShape" => Some(0),
        "Expand" | "Tile" | "Pad" | "Reshape" => Some(1),
        _ => None,
    }
}

/// Fewest axes of an operator's first input.
pub(super) fn fewest_axes(operator: &str) -> usize {
    match operator {
        "Conv" | "ConvTranspose" | "MaxPool" | "AveragePool" => 3,
        "Trilu" => 2,
        "Flatten" | "Split" | "MatMul" => 1,
        _ => 0,
    }
}
