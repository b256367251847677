//! Elementwise functions, on many numbers at a time.

use tract_onnx::tract_core::internal::ElementWiseMiniOp;
use tract_onnx::tract_core::ops::binary::BinMiniOp;
use tract_onnx::tract_core::ops::math;
use wide::f32x4;

/// A function of one number or two.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Function {
    Add,
    Sub,
    SubFrom,
    Mul,
    Div,
    Min,
    Max,
    Sqrt,
    InverseSqrt,
    Inverse,
    Square,
    Negate,
    Abs,
    Sin,
    Cos,
    Ln,
}

/// The numbers a function takes: one for each of its own, or one for all.
#[derive(Clone, Copy)]
pub(crate) enum Operand<'a> {
    One(f32),
    Many(&'a [f32]),
}

impl Function {
    /// That of an operator on one tensor.
    pub fn of_one(op: &dyn ElementWiseMiniOp) -> Option<Self> {
        Some(match () {
            () if op.is::<math::Sqrt>() => Self::Sqrt,
            () if op.is::<math::Rsqrt>() => Self::InverseSqrt,
            () if op.is::<math::Recip>() => Self::Inverse,
            () if op.is::<math::Square>() => Self::Square,
            () if op.is::<math::Neg>() => Self::Negate,
            () if op.is::<math::Abs>() => Self::Abs,
            () if op.is::<math::Sin>() => Self::Sin,
            () if op.is::<math::Cos>() => Self::Cos,
            () if op.is::<math::Ln>() => Self::Ln,
            () => return None,
        })
    }

    /// That of an operator on two tensors.
    pub fn of_two(op: &dyn BinMiniOp) -> Option<Self> {
        Some(match () {
            () if op.is::<math::Add>() => Self::Add,
            () if op.is::<math::Sub>() => Self::Sub,
            () if op.is::<math::SubF>() => Self::SubFrom,
            () if op.is::<math::Mul>() => Self::Mul,
            () if op.is::<math::Div>() => Self::Div,
            () if op.is::<math::Min>() => Self::Min,
            () if op.is::<math::Max>() => Self::Max,
            () => return None,
        })
    }

    /// Its values; functions of one number take `a`.
    // A function of its own: engines of WebAssembly optimise by function, and this one is called often.
    #[inline(never)]
    pub fn run(self, a: Operand, b: Operand, out: &mut [f32]) {
        match self {
            Self::Add => two(a, b, out, |a, b| a + b),
            Self::Sub => two(a, b, out, |a, b| a - b),
            Self::SubFrom => two(a, b, out, |a, b| b - a),
            Self::Mul => two(a, b, out, |a, b| a * b),
            Self::Div => two(a, b, out, |a, b| a / b),
            Self::Min => two(a, b, out, |a, b| if a < b { a } else { b }),
            Self::Max => two(a, b, out, |a, b| if a > b { a } else { b }),
            Self::Sqrt => one(a, out, f32::sqrt),
            Self::InverseSqrt => one(a, out, |a| a.sqrt().recip()),
            Self::Inverse => one(a, out, f32::recip),
            Self::Square => one(a, out, |a| a * a),
            Self::Negate => one(a, out, |a| -a),
            Self::Abs => one(a, out, f32::abs),
            Self::Sin => within(a, out, TURNED, |a, out| one(a, out, |a| sine(a, 0)), f32::sin),
            Self::Cos => within(a, out, TURNED, |a, out| one(a, out, |a| sine(a, 1)), f32::cos),
            Self::Ln => within(a, out, [f32::MIN_POSITIVE, f32::MAX], logarithms, f32::ln),
        }
    }
}

/// Angles that are reduced to a quarter of a turn without loss, rad.
const TURNED: [f32; 2] = [-8192.0, 8192.0];

/// Sine of an angle within [`TURNED`], or its cosine for 1 quarter ahead.
///
/// Without branches, so that compilers work on several at a time. The angle less multiples of a quarter turn, whose three
/// parts leave their products with small integers exact (Cody and Waite 1980), and Taylor-like polynomials of the least
/// largest error (Moshier's Cephes library).
#[inline(always)]
fn sine(angle: f32, ahead: u32) -> f32 {
    // Added to a number of the size of an integer of 22 bits, it rounds that and leaves it in the last bits.
    const ROUNDS: f32 = 1.5 * (1 << 23) as f32;
    let rounded = angle * std::f32::consts::FRAC_2_PI + ROUNDS;
    let quarters = rounded.to_bits().wrapping_add(ahead);
    let turns = rounded - ROUNDS;
    let x = angle - turns * 1.570_312_5 - turns * 4.837_513e-4 - turns * 7.549_79e-8;
    let x2 = x * x;
    let odd = x + x * x2 * (-1.666_665_5e-1 + x2 * (8.332_161e-3 + x2 * -1.951_529_6e-4));
    let even =
        1.0 - 0.5 * x2 + x2 * x2 * (4.166_664_6e-2 + x2 * (-1.388_731_6e-3 + x2 * 2.443_315_7e-5));
    let one = if quarters & 1 == 0 { odd } else { even };
    f32::from_bits(one.to_bits() ^ ((quarters & 2) << 30))
}

/// `quick` where all numbers are within a range, `exact` else.
fn within(
    a: Operand,
    out: &mut [f32],
    [least, most]: [f32; 2],
    quick: impl Fn(Operand, &mut [f32]),
    exact: impl Fn(f32) -> f32,
) {
    let Operand::Many(numbers) = a else { return one(a, out, exact) };
    if numbers.iter().fold(true, |all, &x| all & (x >= least) & (x <= most)) {
        quick(a, out);
    } else {
        one(a, out, exact);
    }
}

/// Logarithms of normal numbers above zero.
fn logarithms(a: Operand, out: &mut [f32]) {
    let Operand::Many(a) = a else { return one(a, out, f32::ln) };
    let ((to, last_to), (from, last)) = (out.as_chunks_mut::<4>(), a.as_chunks::<4>());
    for (out, &a) in to.iter_mut().zip(from) {
        *out = f32x4::new(a).ln().to_array();
    }
    one(Operand::Many(last), last_to, f32::ln);
}

fn one(a: Operand, out: &mut [f32], function: impl Fn(f32) -> f32) {
    match a {
        Operand::One(a) => out.fill(function(a)),
        Operand::Many(a) => {
            for (out, &a) in out.iter_mut().zip(a) {
                *out = function(a);
            }
        }
    }
}

fn two(a: Operand, b: Operand, out: &mut [f32], function: impl Fn(f32, f32) -> f32) {
    match (a, b) {
        (Operand::Many(a), Operand::Many(b)) => {
            for ((out, &a), &b) in out.iter_mut().zip(a).zip(b) {
                *out = function(a, b);
            }
        }
        (Operand::Many(a), Operand::One(b)) => {
            for (out, &a) in out.iter_mut().zip(a) {
                *out = function(a, b);
            }
        }
        (Operand::One(a), Operand::Many(b)) => {
            for (out, &b) in out.iter_mut().zip(b) {
                *out = function(a, b);
            }
        }
        (Operand::One(a), Operand::One(b)) => out.fill(function(a, b)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn many_at_a_time_agree_with_one_by_one() {
        // Both sides of every quadrant, of the range that is reduced without loss, and numbers that have no logarithm.
        let angles: Vec<f32> =
            (-40_000..40_001).map(|k| k as f32 * 0.25).chain([1e7, -3e9, 0.0, -0.0]).collect();
        let positive: Vec<f32> = (-300..300).map(|k| (k as f32 * 0.28).exp()).collect();
        type Case<'a> = (Function, &'a [f32], fn(f64) -> f64);
        let cases: [Case; 3] = [
            (Function::Sin, &angles, f64::sin),
            (Function::Cos, &angles, f64::cos),
            (Function::Ln, &positive, f64::ln),
        ];
        for (function, given, exact) in cases {
            let mut out = vec![0.0; given.len()];
            for (given, out) in given.chunks(64).zip(out.chunks_mut(64)) {
                function_of(function, given, out);
            }
            for (&x, &y) in given.iter().zip(&out) {
                let right = exact(f64::from(x));
                // Rounding, and what reducing an angle of 8192 costs.
                let most = 4e-7 * right.abs().max(1.0);
                assert!(
                    (f64::from(y) - right).abs() <= most,
                    "{function:?} of {x}: {y}, not {right}"
                );
            }
        }
        let mut out = [0.0; 5];
        function_of(Function::Ln, &[0.0, -1.0, f32::INFINITY, f32::NAN, 1.0], &mut out);
        assert!(out[0] == f32::NEG_INFINITY && out[1].is_nan() && out[2] == f32::INFINITY);
        assert!(out[3].is_nan() && out[4] == 0.0);
        function_of(Function::Sin, &[f32::INFINITY, f32::NAN, 0.0, 1.0, 2.0], &mut out);
        assert!(out[0].is_nan() && out[1].is_nan() && out[2] == 0.0);
    }

    fn function_of(function: Function, given: &[f32], out: &mut [f32]) {
        function.run(Operand::Many(given), Operand::One(0.0), out);
    }
}
