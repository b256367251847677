//! What one call may take, known before it starts: one rule for all of them.
//!
//! A call that would take more operations or memory than the limits of its thread is refused with
//! [`InputError::TooLarge`], which names the limit. Operations are complex multiplications with an addition, by the
//! leading terms of the algorithm, with the iterations that it is asked for or, where it stops by itself, usually takes:
//! about a nanosecond each.

use boresight_math::error::InputError;
use boresight_options::{Described, Naming};
use serde::{Deserialize, Serialize};
use std::cell::Cell;

/// What one call may take.
#[derive(Debug, Clone, Copy, PartialEq, Described, Serialize, Deserialize)]
#[serde(default)]
pub struct Limits {
    /// Operations (complex multiplications): 1e10 take some ten seconds in a page; the largest number for no limit.
    #[option(default = 1e10, range = 1..)]
    pub operations: f64,
    /// Memory of what a call makes, in bytes (a gibibyte).
    #[option(default = 1_073_741_824.0, range = 1..)]
    pub bytes: f64,
}

thread_local! {
    static CURRENT: Cell<Limits> = Cell::new(Limits::initial());
}

impl Limits {
    /// Those of a thread that has set none. A native program can be interrupted, and has no limit on operations.
    fn initial() -> Self {
        let limits = Self::default();
        if cfg!(target_family = "wasm") { limits } else { Self { operations: f64::MAX, ..limits } }
    }

    /// Those of this thread.
    #[must_use]
    pub fn current() -> Self {
        CURRENT.get()
    }

    /// Makes them those of this thread, for calls to come.
    ///
    /// # Errors
    /// [`InputError::OutOfRange`] for less than 1 and for NaN.
    pub fn set(self) -> Result<(), InputError> {
        boresight_options::check(&self, Naming::Rust)?;
        CURRENT.set(self);
        Ok(())
    }
}

fn check(what: &str, measure: &'static str, given: f64, most: f64) -> Result<(), InputError> {
    if given <= most {
        return Ok(());
    }
    Err(InputError::TooLarge { what: what.into(), measure, most, given })
}

/// Checks what is about to be done.
///
/// # Errors
/// [`InputError::TooLarge`].
pub fn check_operations(what: &str, operations: f64) -> Result<(), InputError> {
    check(what, "operations", operations, Limits::current().operations)
}

/// Checks what is about to be allocated: the product of `sizes`, of which each takes `bytes` with its working copies.
/// Returns the product.
///
/// # Errors
/// [`InputError::TooLarge`].
pub fn check_bytes(what: &str, sizes: &[usize], bytes: usize) -> Result<usize, InputError> {
    let count: f64 = sizes.iter().map(|&size| size as f64).product();
    check(what, "bytes", count * bytes as f64, Limits::current().bytes)?;
    // As whole as the sizes are, and small enough to be exact; a product of sizes may overflow before a 0.
    Ok(count as usize)
}

#[cfg(test)]
mod tests {
    use super::*;
    use boresight_math::error::Diagnose;

    #[test]
    fn sizes_are_multiplied_without_overflow() {
        let most = 1 << 30;
        assert_eq!(check_bytes("a", &[4, 5], 8), Ok(20));
        assert_eq!(check_bytes("a", &[most / 16, 2], 8), Ok(most / 8));
        assert_eq!(check_bytes("a", &[usize::MAX, usize::MAX, 0], 8), Ok(0));
        let refused = check_bytes("a", &[usize::MAX, 2], 1);
        assert!(matches!(refused, Err(InputError::TooLarge { given, .. }) if given > 1e9));
        let refused = check_bytes("the map", &[most / 8 + 1], 8).unwrap_err();
        assert_eq!(refused.code(), "too-large");
        assert_eq!(
            refused.details().expected,
            "at most 1.074e9, limits.bytes: ask for less, or raise it"
        );
    }

    #[test]
    fn limits_hold_for_their_thread_until_they_are_raised() {
        assert_eq!(check_operations("a", 1e300), Ok(()));
        Limits { operations: 1e6, bytes: 100.0 }.set().unwrap();
        assert_eq!(check_operations("a", 1e6), Ok(()));
        let refused = check_operations("the estimate", 2e6).unwrap_err();
        assert!(refused.to_string().starts_with("the estimate would take 2.000e6 operations"));
        assert!(check_operations("a", f64::NAN).is_err());
        assert_eq!(check_bytes("a", &[5, 5], 4), Ok(25));
        assert!(check_bytes("a", &[26], 4).is_err());
        std::thread::spawn(|| assert_eq!(check_operations("a", 2e6), Ok(()))).join().unwrap();
        Limits { operations: f64::MAX, ..Limits::current() }.set().unwrap();
        assert_eq!(check_operations("a", 2e6), Ok(()));
        for wrong in [0.0, -1.0, f64::NAN] {
            assert!(Limits { operations: wrong, ..Limits::current() }.set().is_err());
        }
    }
}
