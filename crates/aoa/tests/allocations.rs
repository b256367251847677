//! A batch through an estimator that has seen one like it allocates nothing.
#![allow(clippy::unwrap_used, unsafe_code)]

use boresight_aoa::batch::BatchEstimate;
use boresight_aoa::{Estimator, EstimatorOptions, Method, SourceCount};
use boresight_core::presets::preset;
use boresight_core::{Array, Random};
use ndarray::Array3;
use std::alloc::{GlobalAlloc, Layout, System};
use std::cell::Cell;

thread_local! {
    static ALLOCATIONS: Cell<usize> = const { Cell::new(0) };
}

/// The system's allocator, counted by thread.
struct Counting;

fn count() {
    // A thread that ends has no counter any more.
    let _ = ALLOCATIONS.try_with(|allocations| allocations.set(allocations.get() + 1));
}

// SAFETY: all is handed on to the system's allocator.
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        count();
        unsafe { System.alloc(layout) }
    }

    unsafe fn dealloc(&self, pointer: *mut u8, layout: Layout) {
        unsafe { System.dealloc(pointer, layout) }
    }

    unsafe fn realloc(&self, pointer: *mut u8, layout: Layout, size: usize) -> *mut u8 {
        count();
        unsafe { System.realloc(pointer, layout, size) }
    }
}

#[global_allocator]
static ALLOCATOR: Counting = Counting;

/// Allocations of the second of two equal batches of 40 cells.
fn allocations(method: Method, array: &Array, spectra: bool) -> usize {
    let snapshots = if method.requirements().min_snapshots > 1 { 16 } else { 1 };
    let shape = (40, array.len(), snapshots);
    let mut random = Random::new(91, 0);
    let cells = Array3::from_shape_fn(shape, |_| random.complex_normal(1.0));
    let options =
        EstimatorOptions { sources: SourceCount::Known(2), ..EstimatorOptions::default() };
    let mut estimator = Estimator::new(method, array, &options).unwrap();
    let mut out = BatchEstimate::new(method);
    estimator.estimate_batch_into(cells.view(), spectra, &mut out).unwrap();
    let before = ALLOCATIONS.get();
    estimator.estimate_batch_into(cells.view(), spectra, &mut out).unwrap();
    ALLOCATIONS.get() - before
}

#[test]
fn iaa_allocates_nothing_a_cell() {
    for name in ["lrr48", "ula16"] {
        let array = preset(name).unwrap();
        for spectra in [false, true] {
            assert_eq!(allocations(Method::Iaa, &array, spectra), 0, "{name}, {spectra}");
        }
    }
}

/// The others hold matrices and results of a cell in memory of their own; this holds how often they
/// ask for it, with a quarter to spare, so that it does not grow unseen.
#[test]
fn allocations_of_the_others_are_known() {
    let array = preset("ula16").unwrap();
    for (method, most) in [
        (Method::Bartlett, 40),
        (Method::Capon, 45),
        (Method::Music, 100),
        (Method::SingleSnapshotMusic, 65),
        (Method::RootMusic, 100),
        (Method::Esprit, 125),
        (Method::MinNorm, 105),
        (Method::Nomp, 660),
        (Method::AtomicNorm, 4000),
        (Method::MaximumLikelihood, 750),
        (Method::SparseBayesian, 40000),
    ] {
        let count = allocations(method, &array, false) / 40;
        println!("{}: {count} a cell", method.name());
        assert!((1..=most).contains(&count), "{}: {count}", method.name());
    }
}
