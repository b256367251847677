//! A batch through an estimator that has seen one like it allocates nothing.
#![allow(clippy::unwrap_used, unsafe_code)]

use boresight_aoa::batch::BatchEstimate;
use boresight_aoa::{Estimator, Method, Options};
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
    let mut random = Random::new(91, 0);
    let cells = Array3::from_shape_fn((40, array.len(), 1), |_| random.complex_normal(1.0));
    let mut estimator = Estimator::new(method, array, &Options::default()).unwrap();
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
    // The counter counts.
    assert!(allocations(Method::Nomp, &preset("ula16").unwrap(), false) > 0);
}
