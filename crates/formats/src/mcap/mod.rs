//! MCAP files, as robots and test cars record them: messages of many topics, in chunks that may be packed.
//!
//! [`McapStream`] takes the bytes of a file as they come and hands on the messages of the channels that
//! are wanted; whatever else is in the file is passed over. The memory it takes is that of one chunk.
//! A file that was cut is read as far as it goes, and what is lost is counted.
//!
//! What the messages are is no matter here: [`crate::ros`] decodes those of ROS.

mod chunk;
mod counts;
#[cfg(test)]
pub(crate) mod made;
mod names;
mod record;
mod sink;
mod split;
mod stream;
#[cfg(test)]
mod tests;
mod unpack;
#[cfg(not(target_arch = "wasm32"))]
pub mod write;

pub use counts::McapCounts;
pub use record::{Channel, MAGIC, Message, Schema};
pub use sink::McapSink;
pub use stream::McapStream;
