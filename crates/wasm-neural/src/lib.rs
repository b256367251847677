//! JavaScript bindings of the networks: a module of its own, loaded when asked for.
//!
//! It holds what `boresight-wasm` calls the chain as well, so that captures are processed here by
//! the same code, with a network for an estimator.

mod constructors;
mod network;
mod regions;
mod tensors;

pub use network::{Network, NetworkDescription};
