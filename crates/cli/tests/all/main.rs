//! Tests of the command line, in one program, which compiles and links in a fraction of the time of many.

#![allow(missing_docs, clippy::unwrap_used, clippy::panic, clippy::print_stdout)]

mod augment;
mod boards;
mod command_line;
mod common;
mod drives;
mod fleet;
mod fleet_isolation;
mod fleet_merge;
mod hostile_names;
mod image;
mod inputs;
mod networks;
mod output;
#[path = "../../../../tests/support/size.rs"]
mod size;
mod validate;
