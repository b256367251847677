//! What goes over a socket of the Foxglove WebSocket protocol (github.com/foxglove/ws-protocol, docs/spec.md), and the control of
//! playback that its successor `foxglove.sdk.v1` has.

use boresight_formats::foxglove::Channel;
use boresight_formats::foxglove::messages::Time;
use serde::Deserialize;
use serde_json::{Value, json};

/// What is spoken, the preferred one first.
pub(super) const SUBPROTOCOLS: [&str; 2] = ["foxglove.sdk.v1", "foxglove.websocket.v1"];
/// The one that has the control of playback.
pub(super) const WITH_CONTROL: &str = SUBPROTOCOLS[0];

const MESSAGE_DATA: u8 = 1;
const TIME: u8 = 2;
const PLAYBACK_STATE: u8 = 5;
const PLAYBACK_CONTROL_REQUEST: u8 = 3;

/// How a status is to be taken.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Level {
    Warning = 1,
    Error = 2,
}

/// What the drive does.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Playing {
    Plays = 0,
    Paused = 1,
    /// It waits for the first viewer, or looks for a place.
    Waits = 2,
    Ended = 3,
}

/// What a client asks for.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(tag = "op", rename_all = "camelCase", rename_all_fields = "camelCase")]
pub(super) enum Request {
    Subscribe {
        subscriptions: Vec<Subscription>,
    },
    Unsubscribe {
        subscription_ids: Vec<u32>,
    },
    GetParameters {
        #[serde(default)]
        parameter_names: Vec<String>,
        id: Option<String>,
    },
    SetParameters {
        parameters: Vec<Parameter>,
        id: Option<String>,
    },
    SubscribeParameterUpdates {},
    UnsubscribeParameterUpdates {},
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct Subscription {
    pub(super) id: u32,
    pub(super) channel_id: u64,
}

#[derive(Debug, Clone, PartialEq, Deserialize)]
pub(super) struct Parameter {
    pub(super) name: String,
    #[serde(default)]
    pub(super) value: Value,
}

/// How a client wants the drive to go on.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Control {
    pub(super) paused: bool,
    pub(super) rate: f64,
    pub(super) seek_ns: Option<u64>,
    pub(super) id: String,
}

impl Control {
    /// From a binary message; what is wrong with it otherwise.
    pub(super) fn read(bytes: &[u8]) -> Result<Self, String> {
        match bytes.first() {
            Some(&PLAYBACK_CONTROL_REQUEST) => {}
            first => {
                return Err(format!(
                    "binary operation {first:?}; expected {PLAYBACK_CONTROL_REQUEST}"
                ));
            }
        }
        let (command, control) = Self::parts(&bytes[1..])
            .ok_or_else(|| format!("a control of playback of {} bytes ends early", bytes.len()))?;
        if command > 1 {
            return Err(format!("playback command {command}; expected 0 or 1"));
        }
        Ok(Self { paused: command == 1, ..control })
    }

    /// Command and what follows it; none if it ends early.
    fn parts(bytes: &[u8]) -> Option<(u8, Self)> {
        let (&[command], bytes) = bytes.split_first_chunk()?;
        let (&speed, bytes) = bytes.split_first_chunk()?;
        let (&[has_seek], bytes) = bytes.split_first_chunk()?;
        let (&seek, bytes) = bytes.split_first_chunk()?;
        let (&length, bytes) = bytes.split_first_chunk()?;
        let id = bytes.get(..u32::from_le_bytes(length) as usize)?;
        let control = Self {
            paused: false,
            rate: f32::from_le_bytes(speed).into(),
            seek_ns: (has_seek != 0).then(|| u64::from_le_bytes(seek)),
            id: String::from_utf8_lossy(id).into_owned(),
        };
        Some((command, control))
    }
}

/// What the server is. A client with the control of playback is told so, and the times that it may seek.
pub(super) fn server_info(session: &str, span_ns: [u64; 2], control: bool) -> String {
    let mut capabilities = vec!["time", "parameters", "parametersSubscribe"];
    let mut info = json!({
        "op": "serverInfo",
        "name": concat!("boresight ", env!("CARGO_PKG_VERSION")),
        "supportedEncodings": [],
        "metadata": {},
        "sessionId": session,
    });
    if control {
        capabilities.push("playbackControl");
        let [start, end] = span_ns.map(|ns| json!(Time::from(ns)));
        (info["dataStartTime"], info["dataEndTime"]) = (start, end);
    }
    info["capabilities"] = capabilities.into();
    info.to_string()
}

/// The channels; their numbers are their places.
pub(super) fn advertise(channels: &[Channel]) -> String {
    let channels: Vec<Value> = channels
        .iter()
        .enumerate()
        .map(|(id, channel)| {
            json!({
                "id": id,
                "topic": channel.topic,
                "encoding": channel.encoding,
                "schemaName": channel.schema_name,
                "schema": channel.schema,
                "schemaEncoding": channel.schema_encoding,
            })
        })
        .collect();
    json!({ "op": "advertise", "channels": channels }).to_string()
}

/// A status; one with an identifier replaces the one before.
pub(super) fn status(level: Level, message: &str, id: Option<&str>) -> String {
    let mut status = json!({ "op": "status", "level": level as u8, "message": message });
    if let Some(id) = id {
        status["id"] = id.into();
    }
    status.to_string()
}

/// Parameters by name, in answer to a request.
pub(super) fn parameter_values(parameters: &[(&str, Value)], id: Option<&str>) -> String {
    let parameters: Vec<Value> = parameters
        .iter()
        .map(|(name, value)| {
            let mut parameter = json!({ "name": name, "value": value });
            if value.is_f64() {
                parameter["type"] = "float64".into();
            }
            parameter
        })
        .collect();
    let mut values = json!({ "op": "parameterValues", "parameters": parameters });
    if let Some(id) = id {
        values["id"] = id.into();
    }
    values.to_string()
}

/// A message of a subscription.
pub(super) fn message_data(subscription: u32, time_ns: u64, data: &[u8]) -> Vec<u8> {
    let mut bytes = Vec::with_capacity(13 + data.len());
    bytes.push(MESSAGE_DATA);
    bytes.extend_from_slice(&subscription.to_le_bytes());
    bytes.extend_from_slice(&time_ns.to_le_bytes());
    bytes.extend_from_slice(data);
    bytes
}

/// The time of the drive.
pub(super) fn time(time_ns: u64) -> Vec<u8> {
    [&[TIME][..], &time_ns.to_le_bytes()].concat()
}

/// The state of playback.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Playback {
    pub(super) playing: Playing,
    pub(super) time_ns: u64,
    pub(super) rate: f64,
    pub(super) did_seek: bool,
    /// The identifier of the request that led to it; empty for none.
    pub(super) id: String,
}

impl Playback {
    /// As a binary message.
    pub(super) fn bytes(&self) -> Vec<u8> {
        [
            &[PLAYBACK_STATE, self.playing as u8][..],
            &self.time_ns.to_le_bytes(),
            &(self.rate as f32).to_le_bytes(),
            &[u8::from(self.did_seek)],
            &(self.id.len() as u32).to_le_bytes(),
            self.id.as_bytes(),
        ]
        .concat()
    }
}
