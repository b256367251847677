//! What takes the messages of a file as it is read.

use super::record::{Channel, Message, Schema};

/// What takes the messages of a file.
pub trait McapSink {
    /// A channel that the file names, with its schema if there is one; whether its messages are wanted.
    fn channel(&mut self, channel: &Channel, schema: Option<&Schema>) -> bool;

    /// A message of a wanted channel; whether more of them are wanted.
    fn message(&mut self, message: Message<'_>) -> bool;
}
