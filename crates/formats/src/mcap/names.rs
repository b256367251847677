//! The schemas and channels of a file.

use super::record::{Channel, Schema, opcode};
use super::sink::McapSink;
use std::collections::BTreeMap;

/// Most that is held of definitions, bytes.
const MAX_SCHEMA_BYTES: usize = 64 << 20;

/// The schemas and channels of a file.
#[derive(Default)]
pub(super) struct Names {
    pub schemas: BTreeMap<u16, Schema>,
    schema_bytes: usize,
    pub channels: BTreeMap<u16, (Channel, bool)>,
}

impl Names {
    pub fn wants(&self, channel: u16) -> bool {
        self.channels.get(&channel).is_some_and(|(_, wanted)| *wanted)
    }

    pub fn set(&mut self, channel: u16, is_wanted: bool) {
        if let Some((_, wanted)) = self.channels.get_mut(&channel) {
            *wanted = is_wanted;
        }
    }

    /// Takes a record that may be a schema or a channel, and gives its number if it is new: later ones
    /// of the same number repeat it. Nothing if it cannot be read.
    pub fn take(
        &mut self,
        opcode: u8,
        content: &[u8],
        sink: &mut dyn McapSink,
    ) -> Option<Option<u16>> {
        if opcode == opcode::SCHEMA {
            let schema = Schema::read(content)?;
            let id = schema.id;
            let bytes = self.schema_bytes.saturating_add(content.len());
            if id == 0 || self.schemas.contains_key(&id) || bytes > MAX_SCHEMA_BYTES {
                return Some(None);
            }
            self.schema_bytes = bytes;
            self.schemas.insert(id, schema);
            return Some(Some(id));
        }
        if opcode == opcode::CHANNEL {
            let channel = Channel::read(content)?;
            let id = channel.id;
            if self.channels.contains_key(&id) {
                return Some(None);
            }
            let wanted = sink.channel(&channel, self.schemas.get(&channel.schema));
            self.channels.insert(id, (channel, wanted));
            return Some(Some(id));
        }
        Some(None)
    }
}
