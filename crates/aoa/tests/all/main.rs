//! Tests of angle-of-arrival estimators, in one program, which compiles and links in a fraction of the time of many.

#![allow(missing_docs, clippy::unwrap_used, clippy::panic, clippy::print_stdout)]

mod batch;
mod counting;
mod efficiency;
mod iaa_precision;
mod iaa_score;
mod mismatch;
mod overlap;
mod range_angle;
mod recovery;
mod reference;
mod refinement;
mod robustness;
#[path = "../../../../tests/support/size.rs"]
mod size;
mod sparse_reference;
mod sparse_robustness;
mod suits;
mod support;
mod theory;
