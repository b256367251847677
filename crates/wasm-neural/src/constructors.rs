//! Constructors of statics, by which tract's kernels register.

#![allow(unsafe_code)]

use std::sync::Once;

static ONCE: Once = Once::new();

/// Runs the constructors, once. A module that does not call them itself has the linker put a call into every exported
/// function, which then takes a tenth of a millisecond more.
pub fn construct() {
    ONCE.call_once(|| {
        #[cfg(target_family = "wasm")]
        {
            unsafe extern "C" {
                fn __wasm_call_ctors();
            }
            // SAFETY: made by the linker for this; takes and returns nothing, and is called here alone.
            unsafe { __wasm_call_ctors() };
        }
    });
}
