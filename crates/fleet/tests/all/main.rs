//! Tests of fleets of drives, in one program, which compiles and links in a fraction of the time of many.

#![allow(missing_docs, clippy::unwrap_used, clippy::panic, clippy::print_stdout)]

mod compatibility;
mod faults;
mod history;
mod hostile;
mod outlying;
mod pieces;
mod report;
mod simulated;
#[path = "../../../../tests/support/size.rs"]
mod size;
mod support;
mod tables;
mod workers;
