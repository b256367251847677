//! Tests of the bindings, in one program: in WebAssembly, some of them natively too.

#![allow(clippy::unwrap_used, clippy::panic, clippy::print_stdout)]

#[cfg(target_arch = "wasm32")]
mod bindings;
#[cfg(target_arch = "wasm32")]
mod drives;
#[cfg(target_arch = "wasm32")]
mod every_field;
#[cfg(target_arch = "wasm32")]
mod every_record;
mod golden;
mod images;
#[cfg(target_arch = "wasm32")]
mod support;
