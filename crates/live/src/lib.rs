//! Radars and results over sockets: a server of drives for viewers.

pub mod error;
pub mod foxglove;

pub use error::LiveError;
