//! One connection: what it asks for, and what it is sent.

use super::protocol::{
    self, Control, Level, Parameter, Request, SUBPROTOCOLS, Subscription, WITH_CONTROL,
};
use super::queue::{Out, Outbox};
use super::shared::Shared;
use crate::admission::{PING_AFTER, Ticket};
use crate::handshake::{Connection, Refusal, Terms, handshake};
use serde_json::Value;
use std::io::ErrorKind;
use std::sync::Arc;
use std::sync::atomic::Ordering;
use std::time::{Duration, Instant};
use tungstenite::{Error, Message, WebSocket};

/// A client that takes no byte for so long is gone.
const STALLED: Duration = Duration::from_secs(20);
/// A client that sends nothing for so long, not even the answer to a ping, is gone.
const SILENT: Duration = Duration::from_secs(60);
/// Between two looks at a socket on which nothing happens.
const PAUSE: Duration = Duration::from_millis(10);
/// Between two words on lost messages.
const BETWEEN_LOSSES: Duration = Duration::from_secs(1);
/// Between a close frame and the end, for the client to answer.
const FAREWELL: Duration = Duration::from_millis(200);
/// Bytes handed to the socket at a time.
const BATCH: usize = 1 << 18;
/// Messages of a client that are looked at before it is sent something again.
const MOST_READ: usize = 64;

/// Serves a connection until it ends.
pub(super) fn run(ticket: Ticket, shared: &Shared) {
    let ends = || shared.is_stopped();
    let terms = Terms { origins: &shared.origins, protocols: &SUBPROTOCOLS, ends: &ends };
    let (socket, protocol) = match handshake(ticket, &terms) {
        Ok(client) => client,
        Err(refusal) => {
            let count = match refusal {
                Refusal::Full => &shared.tally.refused,
                Refusal::Rejected => &shared.tally.rejected,
            };
            count.fetch_add(1, Ordering::Relaxed);
            return;
        }
    };
    shared.tally.clients.fetch_add(1, Ordering::Relaxed);
    let outbox = Arc::new(Outbox::new(shared.options.queue, protocol == WITH_CONTROL));
    let entered = Entered::new(shared, &outbox);
    let mut client = Client { socket, shared, outbox: Arc::clone(&outbox), lost_told: 0 };
    client.serve();
    let Client { socket, .. } = client;
    drop(entered);
    shared.tally.lost.fetch_add(outbox.lost(), Ordering::Relaxed);
    shared.tally.bytes.fetch_add(socket.get_ref().written, Ordering::Relaxed);
}

/// A client's entry among those that results are sent to, which ends with this value, after a panic too.
struct Entered<'a>(&'a Shared, &'a Arc<Outbox>);

impl<'a> Entered<'a> {
    fn new(shared: &'a Shared, outbox: &'a Arc<Outbox>) -> Self {
        shared.enter(outbox);
        Self(shared, outbox)
    }
}

impl Drop for Entered<'_> {
    fn drop(&mut self) {
        self.0.leave(self.1);
    }
}

struct Client<'a> {
    socket: WebSocket<Connection>,
    shared: &'a Shared,
    outbox: Arc<Outbox>,
    lost_told: u64,
}

/// When something last came or went, and how much had by then.
struct Mark {
    count: u64,
    at: Instant,
}

impl Mark {
    /// How long the count has been the same.
    fn since(&mut self, count: u64) -> Duration {
        if count != self.count {
            *self = Self { count, at: Instant::now() };
        }
        self.at.elapsed()
    }
}

/// Whether writing goes on, waits for the client, or is over.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Flow {
    Idle,
    Sent,
    Stalled,
    Over,
}

impl Client<'_> {
    fn serve(&mut self) {
        let start = || Mark { count: 0, at: Instant::now() };
        let (mut read, mut written, mut losses) = (start(), start(), Instant::now());
        let mut asked = false;
        while !self.shared.is_stopped() {
            if self.receive().is_err() {
                // After an error nothing can be read, least of all an answer.
                let _ = self.socket.close(None);
                return;
            }
            if self.outbox.is_overrun() {
                break;
            }
            let flow = self.send();
            let silent = read.since(self.socket.get_ref().read);
            let stalled = written.since(self.socket.get_ref().written);
            match flow {
                Flow::Over => return,
                Flow::Stalled if stalled > STALLED => return,
                Flow::Stalled => std::thread::sleep(PAUSE),
                Flow::Idle => self.outbox.wait(PAUSE),
                Flow::Sent => {}
            }
            if silent > SILENT {
                return;
            }
            if silent < PING_AFTER {
                asked = false;
            } else if !std::mem::replace(&mut asked, true) {
                // A failure shows when it is next read or written.
                let _ = self.socket.write(Message::Ping(Vec::new().into()));
            }
            if losses.elapsed() > BETWEEN_LOSSES {
                losses = Instant::now();
                self.tell_losses();
            }
        }
        self.part();
    }

    /// Says good-bye, for a while.
    fn part(&mut self) {
        let until = Instant::now() + FAREWELL;
        let mut closed = self.socket.close(None).is_err_and(|error| !would_block(&error));
        while !closed && Instant::now() < until {
            closed = match self.socket.read() {
                Ok(_) => false,
                Err(error) => !would_block(&error),
            };
            std::thread::sleep(PAUSE);
        }
    }

    fn tell_losses(&mut self) {
        let lost = self.outbox.lost();
        if lost > self.lost_told {
            self.lost_told = lost;
            let text = format!("{lost} messages were lost: this client reads too slowly");
            self.warn(Level::Warning, &text, Some("lost"));
        }
    }

    fn warn(&self, level: Level, text: &str, id: Option<&str>) {
        self.outbox.answer(Out::Text(protocol::status(level, text, id)));
    }

    /// Looks at what the client sent; an error where the connection is over.
    fn receive(&mut self) -> Result<(), ()> {
        for _ in 0..MOST_READ {
            match self.socket.read() {
                Ok(Message::Text(text)) => self.text(&text),
                Ok(Message::Binary(bytes)) => self.binary(&bytes),
                Ok(_) => {}
                Err(error) if would_block(&error) => return Ok(()),
                Err(_) => return Err(()),
            }
        }
        Ok(())
    }

    /// Sends what waits, as far as the client takes it.
    fn send(&mut self) -> Flow {
        match self.socket.flush() {
            Ok(()) => {}
            Err(error) if would_block(&error) => return Flow::Stalled,
            Err(_) => return Flow::Over,
        }
        let mut bytes = 0;
        while bytes < BATCH {
            let Some(out) = self.outbox.take() else { break };
            let message = match out {
                Out::Text(text) => Message::Text(text.into()),
                Out::Binary(binary) => Message::Binary(binary.into()),
                Out::Data(subscription, message) => {
                    self.shared.tally.sent.fetch_add(1, Ordering::Relaxed);
                    let data = protocol::message_data(subscription, message.time_ns, &message.data);
                    Message::Binary(data.into())
                }
            };
            bytes += message.len();
            match self.socket.write(message) {
                Ok(()) => {}
                // It lies in the socket's buffer then.
                Err(error) if would_block(&error) => return Flow::Stalled,
                Err(_) => return Flow::Over,
            }
        }
        match self.socket.flush() {
            Ok(()) if bytes == 0 => Flow::Idle,
            Ok(()) => Flow::Sent,
            Err(error) if would_block(&error) => Flow::Stalled,
            Err(_) => Flow::Over,
        }
    }

    fn binary(&mut self, bytes: &[u8]) {
        match Control::read(bytes) {
            Ok(control) if self.outbox.has_control => self.control(control),
            Ok(_) => self.warn(Level::Error, "playback is controlled over foxglove.sdk.v1", None),
            Err(what) => self.warn(Level::Error, &what, None),
        }
    }

    fn control(&self, control: Control) {
        if let Err(what) = self.shared.control(control, &self.outbox) {
            self.warn(Level::Error, &what, None);
        }
    }

    fn text(&mut self, text: &str) {
        match serde_json::from_str(text) {
            Ok(Request::Subscribe { subscriptions }) => self.subscribe(&subscriptions),
            Ok(Request::Unsubscribe { subscription_ids }) => {
                let known = self.outbox.unsubscribe(&subscription_ids);
                if known < subscription_ids.len() {
                    let unknown = subscription_ids.len() - known;
                    let text = format!("{unknown} of the subscriptions taken back were none");
                    self.warn(Level::Warning, &text, None);
                }
            }
            Ok(Request::GetParameters { parameter_names, id }) => {
                self.tell_parameters(&parameter_names, id.as_deref());
            }
            Ok(Request::SetParameters { parameters, id }) => {
                for Parameter { name, value } in &parameters {
                    self.set(name, value);
                }
                if id.is_some() {
                    let names: Vec<String> = parameters.into_iter().map(|p| p.name).collect();
                    self.tell_parameters(&names, id.as_deref());
                }
            }
            Ok(Request::SubscribeParameterUpdates {}) => self.outbox.want_parameters(true),
            Ok(Request::UnsubscribeParameterUpdates {}) => self.outbox.want_parameters(false),
            Err(error) => {
                self.warn(Level::Error, &format!("not understood: {error}"), None);
            }
        }
    }

    fn subscribe(&self, subscriptions: &[Subscription]) {
        for &Subscription { id, channel_id } in subscriptions {
            let place = usize::try_from(channel_id).ok();
            let Some(channel) = place.filter(|at| *at < self.shared.channels.len()) else {
                self.warn(Level::Error, &format!("there is no channel {channel_id}"), None);
                continue;
            };
            if self.outbox.has_subscription(id) {
                self.warn(Level::Error, &format!("there is a subscription {id} already"), None);
            } else if !self.shared.subscribe(&self.outbox, id, channel) {
                self.warn(Level::Error, "too many subscriptions", None);
                return;
            }
        }
    }

    fn tell_parameters(&self, names: &[String], id: Option<&str>) {
        let mut parameters = self.shared.parameters().to_vec();
        parameters.retain(|(name, _)| names.is_empty() || names.iter().any(|n| n == name));
        self.outbox.answer(Out::Text(protocol::parameter_values(&parameters, id)));
    }

    fn set(&self, name: &str, value: &Value) {
        let [(_, rate), (_, paused)] = self.shared.parameters();
        let (rate, paused) = match name {
            "rate" => (value.clone(), paused),
            "paused" => (rate, value.clone()),
            _ => {
                self.warn(Level::Error, &format!("there is no parameter {name:?}"), None);
                return;
            }
        };
        match (rate.as_f64(), paused.as_bool()) {
            (Some(rate), Some(paused)) => {
                self.control(Control { paused, rate, seek_ns: None, id: String::new() });
            }
            _ => {
                let expected = if name == "rate" { "a number" } else { "true or false" };
                let text = format!("{name} is {value}; expected {expected}");
                self.warn(Level::Error, &text, None);
            }
        }
    }
}

fn would_block(error: &Error) -> bool {
    matches!(error, Error::Io(error) if matches!(error.kind(), ErrorKind::WouldBlock | ErrorKind::Interrupted))
}
