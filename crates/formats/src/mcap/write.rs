//! Writes MCAP files: chunks that are not packed, with their indexes and checksums, in one pass over any output.

use crate::error::FormatError;
use crate::foxglove::{Channel, Message};
use mcap::records::MessageHeader;
use mcap::write::NoSeek;
use std::collections::BTreeMap;
use std::io::Write;

const WHAT: &str = "MCAP file";
const LIBRARY: &str = concat!("boresight ", env!("CARGO_PKG_VERSION"));

/// Writes messages as they come. Beside one chunk (a mebibyte) an entry a chunk is held in memory, for the index.
pub struct McapWriter<W: Write> {
    writer: mcap::Writer<NoSeek<W>>,
    /// A channel's number in the file, and messages on it so far.
    channels: Vec<(u16, u32)>,
}

impl<W: Write> McapWriter<W> {
    /// Begins a file of messages on these channels. `profile` names what the messages keep to; empty for nothing.
    ///
    /// # Errors
    /// [`FormatError::NotWritten`] where `out` takes no bytes, or there are more than 65,535 channels.
    pub fn new(out: W, profile: &str, channels: &[Channel]) -> Result<Self, FormatError> {
        let options = mcap::WriteOptions::new()
            .compression(None)
            .profile(profile)
            .library(LIBRARY)
            .disable_seeking(true);
        let mut writer = options.create(NoSeek::new(out)).map_err(failed)?;
        let channels = channels
            .iter()
            .map(|channel| {
                let Channel { topic, encoding, schema_name, schema_encoding, schema, .. } = channel;
                let schema = writer.add_schema(schema_name, schema_encoding, schema.as_bytes())?;
                Ok((writer.add_channel(schema, topic, encoding, &BTreeMap::new())?, 0))
            })
            .collect::<Result<_, _>>()
            .map_err(failed)?;
        Ok(Self { writer, channels })
    }

    /// Adds a message.
    ///
    /// # Errors
    /// [`FormatError::NotWritten`] where the output takes no bytes, or the channel is none of the file's.
    pub fn write(&mut self, message: &Message) -> Result<(), FormatError> {
        let Some((channel_id, count)) = self.channels.get_mut(message.channel) else {
            let given = format!("channel {} of {}", message.channel, self.channels.len());
            return Err(FormatError::NotWritten { what: WHAT, given });
        };
        let header = MessageHeader {
            channel_id: *channel_id,
            sequence: *count,
            log_time: message.time_ns,
            publish_time: message.time_ns,
        };
        *count = count.wrapping_add(1);
        self.writer.write_to_known_channel(&header, &message.data).map_err(failed)
    }

    /// Writes the last chunk and the index, and flushes the output.
    ///
    /// # Errors
    /// [`FormatError::NotWritten`] where the output takes no bytes.
    pub fn finish(mut self) -> Result<(), FormatError> {
        self.writer.finish().map_err(failed)?;
        let mut out = self.writer.into_inner().into_inner();
        out.flush()
            .map_err(|error| FormatError::NotWritten { what: WHAT, given: error.to_string() })
    }
}

fn failed(error: mcap::McapError) -> FormatError {
    FormatError::NotWritten { what: WHAT, given: error.to_string() }
}
