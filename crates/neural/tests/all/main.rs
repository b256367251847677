//! Tests of networks, in one program, which compiles and links in a fraction of the time of many.

#![allow(missing_docs, clippy::unwrap_used, clippy::panic, clippy::print_stdout)]

mod bad_input;
mod classifiers;
mod golden;
mod regions;
#[path = "../../../../tests/support/size.rs"]
mod size;
mod spectrum;
mod support;
mod target_set;
