//! Packets of a board that were recorded as messages of an MCAP file.

use super::{BoardFrame, BoardLog, UartStream};
use crate::error::FormatError;
use crate::mcap::{Channel, McapSink, McapStream, Message, Schema};
use crate::mmwave_cfg::RadarConfig;
use crate::ros::{Definitions, Encoding, decode};
use std::collections::BTreeMap;
use std::io::Read;

/// Bytes read from a file at a time.
const PIECE: usize = 1 << 20;

/// What comes of the bytes of a topic.
struct Port {
    /// How its messages hold the bytes; nothing where they are the bytes.
    held: Option<(Definitions, Encoding, Vec<usize>)>,
    stream: UartStream,
    frames: Vec<BoardFrame>,
}

struct Ports<'a> {
    topic: Option<&'a str>,
    config: Option<&'a RadarConfig>,
    by_channel: BTreeMap<u16, Port>,
}

impl McapSink for Ports<'_> {
    fn channel(&mut self, channel: &Channel, schema: Option<&Schema>) -> bool {
        if self.topic.is_some_and(|topic| topic != channel.topic) {
            return false;
        }
        let encoding =
            schema.and_then(|schema| Encoding::of_names(&channel.encoding, &schema.encoding));
        let held = match (encoding, schema) {
            (Some(encoding), Some(schema)) => {
                // Images and clouds have bytes too.
                let is_sensor = schema.name.starts_with("sensor_msgs/");
                let definitions = Definitions::parse(&schema.data).filter(|_| !is_sensor);
                let Some((definitions, path)) =
                    definitions.and_then(|all| all.path(0, "data").map(|path| (all, path)))
                else {
                    return false;
                };
                Some((definitions, encoding, path))
            }
            _ => None,
        };
        let stream = UartStream::new(self.config);
        let port = Port { held, stream, frames: vec![] };
        self.by_channel.insert(channel.id, port);
        true
    }

    fn message(&mut self, message: Message<'_>) -> bool {
        let Some(port) = self.by_channel.get_mut(&message.channel) else { return false };
        let bytes = match &port.held {
            None => Some(message.data),
            Some((definitions, encoding, path)) => decode(definitions, message.data, *encoding)
                .ok()
                .and_then(|value| value.bytes(path)),
        };
        if let Some(bytes) = bytes {
            port.frames.extend(port.stream.push(bytes));
        }
        bytes.is_some()
    }
}

impl BoardLog {
    /// Reads packets that were recorded in an MCAP file, as messages that are bytes or have bytes as
    /// `data` (`std_msgs/UInt8MultiArray`): those of a topic, or without one those of the topic with most.
    ///
    /// # Errors
    /// [`FormatError::Binary`] where the file is no MCAP, [`FormatError::Topic`] where the topic is not there
    /// or none has packets. The outer ones are those of the file.
    pub fn of_mcap(
        mut file: impl Read,
        topic: Option<&str>,
        config: Option<&RadarConfig>,
    ) -> Result<Result<Self, FormatError>, std::io::Error> {
        let mut ports = Ports { topic, config, by_channel: BTreeMap::new() };
        let mut stream = McapStream::default();
        let mut piece = vec![0; PIECE];
        loop {
            let count = file.read(&mut piece)?;
            if count == 0 {
                break;
            }
            if let Err(error) = stream.push(piece.get(..count).unwrap_or_default(), &mut ports) {
                return Ok(Err(error));
            }
        }
        let lost = stream.finish(&mut ports).remarks();
        let mut all: Vec<Port> = ports.by_channel.into_values().collect();
        for port in &mut all {
            let last = port.stream.finish();
            port.frames.extend(last);
        }
        let best = all.into_iter().max_by_key(|port| port.frames.len());
        let Some(Port { frames, stream, .. }) = best.filter(|port| !port.frames.is_empty()) else {
            return Ok(Err(FormatError::Topic {
                topic: topic.unwrap_or("of a board's packets").into(),
                expected: "messages of bytes with packets of a TI board".into(),
                given: "none".into(),
            }));
        };
        let mut counts = stream.counts();
        counts.remarks.extend(lost);
        Ok(Ok(Self { frames, counts: counts.into() }))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mcap::made::{channel, chunk, file, message, schema};
    use crate::ros::made::Cdr;
    use boresight_core::Diagnose;

    const DAT: &[u8] = include_bytes!(
        "../../../../recordings/awr1642/xwr16xx_crw_demo_visualizer_2018_1015v2.dat"
    );

    #[test]
    fn packets_in_messages_are_those_of_the_port() {
        let plain = BoardLog::parse(DAT, None);
        let array = "MultiArrayLayout layout\nuint8[] data\n===\nMSG: std_msgs/MultiArrayLayout\nuint32 data_offset";
        let mut records = vec![
            schema(1, "std_msgs/msg/UInt8MultiArray", "ros2msg", array),
            channel(1, 1, "/bytes", "cdr"),
            channel(2, 0, "/raw", ""),
            channel(3, 0, "/noise", ""),
        ];
        for piece in DAT.chunks(509) {
            records.push(message(1, 0, &Cdr::new().u32(0).bytes(piece).done()));
            records.push(message(2, 0, piece));
            records.push(message(3, 0, &[1, 2, 3]));
        }
        let bytes = file(&[chunk("zstd", &records.concat())], &[]);
        for topic in [None, Some("/bytes"), Some("/raw")] {
            let log = BoardLog::of_mcap(&bytes[..], topic, None).unwrap().unwrap();
            assert_eq!(log, plain, "{topic:?}");
        }
        for topic in ["/noise", "/missing"] {
            let error = BoardLog::of_mcap(&bytes[..], Some(topic), None).unwrap().unwrap_err();
            assert_eq!(error.code(), "unknown-topic");
        }
    }
}
