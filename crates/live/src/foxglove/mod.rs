//! Drives with their calibration as messages for viewers ([`results`], [`play`]), and a server of the Foxglove WebSocket
//! protocol that plays them ([`server`]).

mod client;
pub mod options;
pub mod origin;
pub mod play;
mod protocol;
mod queue;
pub mod results;
pub mod server;

pub use options::ServeOptions;
pub use play::Play;
pub use results::ResultTopics;
pub use server::{Counts, Server};

#[cfg(test)]
mod tests;
