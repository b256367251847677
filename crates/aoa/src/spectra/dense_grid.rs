//! Products with the steering matrix of a whole grid, for arrays of any shape.

use boresight_core::{Array, Complex64, Direction, steering};
use ndarray::Array2;

/// Grid points worked on at a time.
const BLOCK: usize = 128;

/// Most entries of the steering matrix that are kept; beyond, it is made again in each pass.
const KEPT: usize = 1 << 22;

/// Steering vectors of one block of the grid, elements x points, real and imaginary parts apart.
#[derive(Debug, Clone)]
struct Block {
    re: Vec<[f64; BLOCK]>,
    im: Vec<[f64; BLOCK]>,
}

/// Steering vectors of a grid, kept or made when needed.
pub(crate) struct DenseGrid {
    array: Array,
    directions: Vec<Direction>,
    kept: Vec<Block>,
}

impl DenseGrid {
    /// Prepares for an array and the directions of a grid.
    pub fn new(array: &Array, directions: Vec<Direction>) -> Self {
        let kept = if directions.len().saturating_mul(array.len()) <= KEPT {
            directions.chunks(BLOCK).map(|chunk| block(array, chunk)).collect()
        } else {
            Vec::new()
        };
        Self { array: array.clone(), directions, kept }
    }

    /// Number of grid points.
    pub fn len(&self) -> usize {
        self.directions.len()
    }

    /// Calls `f` with the index of the first point and the steering vectors of every block.
    fn for_blocks(&self, mut f: impl FnMut(usize, usize, &Block)) {
        for (b, directions) in self.directions.chunks(BLOCK).enumerate() {
            match self.kept.get(b) {
                Some(kept) => f(b * BLOCK, directions.len(), kept),
                None => f(b * BLOCK, directions.len(), &block(&self.array, directions)),
            }
        }
    }

    /// Lower triangle of `A P A^H` for the powers of all points.
    pub fn covariance(&self, power: &[f64]) -> Array2<Complex64> {
        let k = self.array.len();
        let mut r = Array2::<Complex64>::zeros((k, k));
        let (mut re, mut im) = ([0.0; BLOCK], [0.0; BLOCK]);
        self.for_blocks(|first, count, block| {
            let mut p = [0.0; BLOCK];
            p[..count].copy_from_slice(&power[first..first + count]);
            for i in 0..k {
                for l in 0..BLOCK {
                    re[l] = block.re[i][l] * p[l];
                    im[l] = block.im[i][l] * p[l];
                }
                for j in 0..=i {
                    r[[i, j]] += dot(&block.re[j], &block.im[j], &re, &im);
                }
            }
        });
        r
    }

    /// `a^H M a` for every point and a Hermitian `M` in its lower triangle.
    pub fn quadratic(&self, m: &Array2<Complex64>) -> Vec<f64> {
        let mut out = vec![0.0; self.len()];
        self.for_blocks(|first, count, block| {
            let values = quadratic_form(block, m);
            out[first..first + count].copy_from_slice(&values[..count]);
        });
        out
    }

    /// `sum_n |a^H x_n|^2` for every point.
    pub fn responses(&self, vectors: &[Vec<Complex64>]) -> Vec<f64> {
        let mut out = vec![0.0; self.len()];
        self.for_blocks(|first, count, block| {
            let mut sum = [0.0; BLOCK];
            for x in vectors {
                add_response(&mut sum, block, x);
            }
            out[first..first + count].copy_from_slice(&sum[..count]);
        });
        out
    }
}

fn block(array: &Array, directions: &[Direction]) -> Block {
    let zero = vec![[0.0; BLOCK]; array.len()];
    let mut block = Block { re: zero.clone(), im: zero };
    for (l, &direction) in directions.iter().enumerate() {
        for (k, z) in steering::steering_vector(array, direction).iter().enumerate() {
            block.re[k][l] = z.re;
            block.im[k][l] = z.im;
        }
    }
    block
}

/// `sum conj(a) b`, in eight running sums.
fn dot(
    a_re: &[f64; BLOCK],
    a_im: &[f64; BLOCK],
    b_re: &[f64; BLOCK],
    b_im: &[f64; BLOCK],
) -> Complex64 {
    const LANES: usize = 8;
    let (mut re, mut im) = ([0.0; LANES], [0.0; LANES]);
    for at in (0..BLOCK).step_by(LANES) {
        for l in 0..LANES {
            let (a, b) = (a_re[at + l], a_im[at + l]);
            let (c, d) = (b_re[at + l], b_im[at + l]);
            re[l] += a * c + b * d;
            im[l] += a * d - b * c;
        }
    }
    Complex64::new(re.iter().sum(), im.iter().sum())
}

/// Adds `z x` to `sum`.
#[inline(always)]
fn add_scaled(
    sum: (&mut [f64; BLOCK], &mut [f64; BLOCK]),
    z: Complex64,
    x_re: &[f64; BLOCK],
    x_im: &[f64; BLOCK],
) {
    for l in 0..BLOCK {
        sum.0[l] += z.re * x_re[l] - z.im * x_im[l];
        sum.1[l] += z.re * x_im[l] + z.im * x_re[l];
    }
}

/// `|a^H x|^2` added to `sum` for each point of a block.
fn add_response(sum: &mut [f64; BLOCK], block: &Block, x: &[Complex64]) {
    let (mut re, mut im) = ([0.0; BLOCK], [0.0; BLOCK]);
    for (k, z) in x.iter().enumerate() {
        // x^H a has the magnitude of a^H x.
        add_scaled((&mut re, &mut im), z.conj(), &block.re[k], &block.im[k]);
    }
    for l in 0..BLOCK {
        sum[l] += re[l] * re[l] + im[l] * im[l];
    }
}

/// `a^H M a` for each point of a block and a Hermitian `M` in its lower triangle.
fn quadratic_form(block: &Block, m: &Array2<Complex64>) -> [f64; BLOCK] {
    let mut out = [0.0; BLOCK];
    for i in 0..m.nrows() {
        let (mut re, mut im) = ([0.0; BLOCK], [0.0; BLOCK]);
        for j in 0..i {
            add_scaled((&mut re, &mut im), 2.0 * m[[i, j]], &block.re[j], &block.im[j]);
        }
        let diagonal = Complex64::new(m[[i, i]].re, 0.0);
        add_scaled((&mut re, &mut im), diagonal, &block.re[i], &block.im[i]);
        for l in 0..BLOCK {
            out[l] += block.re[i][l] * re[l] + block.im[i][l] * im[l];
        }
    }
    out
}
