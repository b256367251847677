//! Drives with their calibration as messages for viewers ([`results`], [`play`]), and a server of the Foxglove WebSocket
//! protocol that plays them ([`server`]).

mod client;
pub mod options;
pub mod play;
mod player;
mod protocol;
mod queue;
pub mod results;
pub mod server;
mod shared;

pub use options::ServeOptions;
pub use play::Play;
pub use results::ResultTopics;
pub use server::Server;
pub use shared::Counts;
