//! The fast form in single precision, and in double as soon as single is not enough.

use super::fast::FastKernel;
use super::fourier::LatticeFourier;
use super::inverse::Singular;
use super::kernel::Kernel;
use super::residues::Residues;
use boresight_core::{Complex64, Lattice};
use ndarray::ArrayView2;

/// `a^H R^-1 a` is a sum of `K^2` terms of the size of the diagonal of `R^-1`. Toward a strong source they
/// cancel; where they cancel to less than this share of the diagonal's sum, single precision leaves the
/// angles less sure than 0.001 deg.
const LEAST_SHARE: f32 = 2.5e-4;

/// Iterates in single precision up to the first iteration that would lose accuracy, which it makes again in
/// double precision, with all that follow.
pub struct AdaptiveKernel {
    single: FastKernel<f32, Residues<f32>>,
    double: FastKernel<f64, LatticeFourier<f64>>,
    in_double: bool,
}

impl AdaptiveKernel {
    /// Plans for a lattice and a grid of `grid` points uniform in the sine over `[-1, 1)`; nothing where
    /// these do not suit [`Residues`], without which single precision is hardly faster.
    pub fn new(lattice: &Lattice, grid: usize) -> Option<Self> {
        let single = Residues::of(lattice, grid)?;
        let double = LatticeFourier::new(grid, lattice.spacing, lattice.span());
        Some(Self {
            single: FastKernel::new(lattice, grid, single, LEAST_SHARE),
            double: FastKernel::new(lattice, grid, double, 0.0),
            in_double: false,
        })
    }

    fn switch(&mut self) {
        self.in_double = true;
        self.double.take_power(&self.single);
    }

    fn current(&self) -> &dyn Kernel {
        if self.in_double { &self.double } else { &self.single }
    }
}

impl Kernel for AdaptiveKernel {
    fn start(&mut self, y: ArrayView2<Complex64>, scale: f64) {
        self.in_double = false;
        self.single.start(y, scale);
        self.double.take_snapshots(y, scale);
    }

    fn iterate(&mut self, loading: f64) -> Result<(), Singular> {
        if !self.in_double {
            if self.single.iterate(loading).is_ok() {
                return Ok(());
            }
            self.switch();
        }
        self.double.iterate(loading)
    }

    fn element_power(&self) -> f64 {
        self.current().element_power()
    }

    fn power_from(&self, first: usize, out: &mut [f64]) {
        self.current().power_from(first, out);
    }

    fn map_power(&mut self, change: &mut dyn FnMut(f64) -> f64) {
        if self.in_double {
            self.double.map_power(change);
        } else {
            self.single.map_power(change);
        }
    }
}
