//! IAA by matrix products over the whole grid: any array, any directions.

use super::inverse::Singular;
use super::kernel::{Kernel, weighted_power};
use boresight_core::linalg::Cholesky;
use boresight_core::{Array, Complex64, Direction, steering};
use ndarray::{Array2, ArrayView2};

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

/// The dense form.
pub struct DenseKernel {
    array: Array,
    directions: Vec<Direction>,
    kept: Vec<Block>,
    snapshots: Vec<Vec<Complex64>>,
    power: Vec<f64>,
}

impl DenseKernel {
    /// Plans for an array and the directions of the grid.
    pub fn new(array: &Array, directions: Vec<Direction>) -> Self {
        let kept = if directions.len().saturating_mul(array.len()) <= KEPT {
            directions.chunks(BLOCK).map(|chunk| block(array, chunk)).collect()
        } else {
            Vec::new()
        };
        let power = vec![0.0; directions.len()];
        Self { array: array.clone(), directions, kept, snapshots: Vec::new(), power }
    }

    /// Calls `f` with every block of steering vectors and the powers of its points.
    fn for_blocks(&mut self, mut f: impl FnMut(&Block, &mut [f64])) {
        for (b, (directions, power)) in
            self.directions.chunks(BLOCK).zip(self.power.chunks_mut(BLOCK)).enumerate()
        {
            match self.kept.get(b) {
                Some(kept) => f(kept, power),
                None => f(&block(&self.array, directions), power),
            }
        }
    }

    /// Lower triangle of `A P A^H`.
    fn covariance(&mut self) -> Array2<Complex64> {
        let k = self.array.len();
        let mut r = Array2::<Complex64>::zeros((k, k));
        let (mut re, mut im) = ([0.0; BLOCK], [0.0; BLOCK]);
        self.for_blocks(|block, power| {
            for i in 0..k {
                let mut p = [0.0; BLOCK];
                p[..power.len()].copy_from_slice(power);
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

impl Kernel for DenseKernel {
    fn start(&mut self, y: ArrayView2<Complex64>, scale: f64) {
        let snapshots: Vec<Vec<Complex64>> =
            y.columns().into_iter().map(|c| c.iter().map(|z| z * scale).collect()).collect();
        let gain = 1.0 / (y.nrows() * y.nrows() * y.ncols()) as f64;
        self.for_blocks(|block, power| {
            let mut sum = [0.0; BLOCK];
            for y in &snapshots {
                add_response(&mut sum, block, y);
            }
            for (power, sum) in power.iter_mut().zip(sum) {
                *power = sum * gain;
            }
        });
        self.snapshots = snapshots;
    }

    fn iterate(&mut self, loading: f64) -> Result<(), Singular> {
        let mut r = self.covariance();
        let diagonal = r[[0, 0]].re + loading;
        for d in r.diag_mut() {
            *d += loading;
        }
        let factor = Cholesky::new(r.view()).map_err(|_| Singular)?;
        let smallest = 4.0 * r.nrows() as f64 * f64::EPSILON * diagonal;
        if !factor.lower().diag().iter().all(|d| d.re * d.re > smallest) {
            return Err(Singular);
        }
        let inverse = factor.inverse();
        let snapshots = std::mem::take(&mut self.snapshots);
        let solved: Vec<Vec<Complex64>> =
            snapshots.iter().map(|y| factor.solve(ndarray::ArrayView1::from(y)).to_vec()).collect();
        self.snapshots = snapshots;
        let count = solved.len() as f64;
        self.for_blocks(|block, power| {
            let d = quadratic_form(block, &inverse);
            let mut sum = [0.0; BLOCK];
            for x in &solved {
                add_response(&mut sum, block, x);
            }
            for (l, power) in power.iter_mut().enumerate() {
                *power = weighted_power(sum[l], d[l], count);
            }
        });
        Ok(())
    }

    fn element_power(&self) -> f64 {
        self.power.iter().sum()
    }

    fn power(&self) -> Vec<f64> {
        self.power.clone()
    }

    fn map_power(&mut self, change: &mut dyn FnMut(f64) -> f64) {
        for power in &mut self.power {
            *power = change(*power);
        }
    }
}
