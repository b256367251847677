//! Tests of mounting-angle estimation, in one program, which compiles and links in a fraction of the time of many.

#![allow(missing_docs, clippy::unwrap_used, clippy::panic, clippy::print_stdout)]

mod angle;
mod common;
mod delphi;
mod doubts;
mod extremes;
mod fusion;
mod honest;
mod joint;
mod merge;
mod motion;
mod outlook;
mod recursive;
mod reference;
mod robustness;
mod sessions;
mod signs;
mod simulated;
#[path = "../../../../tests/support/size.rs"]
mod size;
mod snapshot;
mod snapshot_versions;
mod statistics;
mod support;
mod tally;
mod tracked;
mod vehicles;
