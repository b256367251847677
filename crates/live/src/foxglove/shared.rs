//! What connections and the drive share: who is connected, what holds, and how the drive is to go on.

use super::options::ServeOptions;
use super::play::Play;
use super::protocol::{self, Control, Playback, Playing};
use super::queue::{Out, Outbox};
use crate::admission::Admission;
use crate::origin::Origins;
use boresight_formats::foxglove::{Channel, Message};
use boresight_options::Described;
use serde::Serialize;
use serde_json::{Value, json};
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::time::{Instant, SystemTime, UNIX_EPOCH};

/// The rate a client may ask for is one an option may have.
const RATES: [f64; 2] = [0.01, 1e6];

/// What became of connections and messages.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Described, Serialize)]
#[option(name = "ServeCounts")]
pub struct Counts {
    /// Connections that became clients.
    pub clients: u64,
    /// Connections refused because there were too many.
    pub refused: u64,
    /// Connections without a handshake, with none of the protocols spoken, or from pages that may not connect.
    pub rejected: u64,
    /// Messages of the drive.
    pub published: u64,
    /// Messages sent, to each client that asked for them.
    pub sent: u64,
    /// Messages lost to clients that read too slowly.
    pub lost: u64,
    /// Bytes sent.
    pub bytes: u64,
}

#[derive(Debug, Default)]
pub(super) struct Tally {
    pub(super) clients: AtomicU64,
    pub(super) refused: AtomicU64,
    pub(super) rejected: AtomicU64,
    pub(super) published: AtomicU64,
    pub(super) sent: AtomicU64,
    pub(super) lost: AtomicU64,
    pub(super) bytes: AtomicU64,
}

impl Tally {
    pub(super) fn counts(&self) -> Counts {
        let of = |count: &AtomicU64| count.load(Ordering::Relaxed);
        Counts {
            clients: of(&self.clients),
            refused: of(&self.refused),
            rejected: of(&self.rejected),
            published: of(&self.published),
            sent: of(&self.sent),
            lost: of(&self.lost),
            bytes: of(&self.bytes),
        }
    }
}

/// What connections and the drive share.
pub(super) struct Shared {
    pub(super) options: ServeOptions,
    /// Pages that may connect.
    pub(super) origins: Origins,
    pub(super) channels: Vec<Channel>,
    pub(super) tally: Tally,
    pub(super) admission: Arc<Admission>,
    /// Whether all are to end.
    pub(super) stopped: AtomicBool,
    /// Something that the drive waits for.
    pub(super) changed: Condvar,
    advertise: String,
    session: String,
    span_ns: [u64; 2],
    state: Mutex<State>,
}

/// A request to go to a time.
#[derive(Debug, Default)]
pub(super) struct Seek {
    pub(super) time_ns: u64,
    /// The identifier of the request; empty for none.
    pub(super) id: String,
    /// The client that asked.
    pub(super) from: Option<Arc<Outbox>>,
}

pub(super) struct State {
    pub(super) clients: Vec<Arc<Outbox>>,
    /// Of channels whose last message holds, that message.
    pub(super) holds: Vec<Option<Arc<Message>>>,
    pub(super) time_ns: u64,
    pub(super) rate: f64,
    pub(super) paused: bool,
    pub(super) playing: Playing,
    pub(super) seek: Option<Seek>,
    /// When a topic was last asked for.
    pub(super) asked: Option<Instant>,
}

impl Shared {
    pub(super) fn new(options: ServeOptions, origins: Origins, play: &Play) -> Self {
        let channels = play.channels().to_vec();
        let started = SystemTime::now().duration_since(UNIX_EPOCH).unwrap_or_default();
        Self {
            advertise: protocol::advertise(&channels),
            session: format!("{}-{}", started.as_nanos(), std::process::id()),
            span_ns: play.span_ns(),
            origins,
            state: Mutex::new(State {
                clients: vec![],
                holds: vec![None; channels.len()],
                time_ns: play.span_ns()[0],
                rate: options.rate,
                paused: false,
                playing: Playing::Waits,
                seek: None,
                asked: None,
            }),
            tally: Tally::default(),
            changed: Condvar::new(),
            stopped: AtomicBool::new(false),
            admission: Admission::new(options.clients),
            channels,
            options,
        }
    }

    pub(super) fn lock(&self) -> MutexGuard<'_, State> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }

    pub(super) fn is_stopped(&self) -> bool {
        self.stopped.load(Ordering::Relaxed)
    }

    /// Takes a new client in: it is told what the server is and has.
    pub(super) fn enter(&self, client: &Arc<Outbox>) {
        let mut state = self.lock();
        let info = protocol::server_info(&self.session, self.span_ns, client.has_control);
        client.answer(Out::Text(info));
        client.answer(Out::Text(self.advertise.clone()));
        client.tell_time(state.time_ns);
        state.answer_playing(client, false, "");
        state.clients.push(Arc::clone(client));
    }

    pub(super) fn leave(&self, client: &Arc<Outbox>) {
        self.lock().clients.retain(|other| !Arc::ptr_eq(other, client));
    }

    /// Adds a subscription; whether there was room.
    pub(super) fn subscribe(&self, client: &Outbox, id: u32, channel: usize) -> bool {
        let mut state = self.lock();
        let done = client.subscribe(id, channel, state.holds[channel].as_ref());
        if done {
            state.asked = Some(Instant::now());
        }
        self.changed.notify_all();
        done
    }

    /// Parameters by name.
    pub(super) fn parameters(&self) -> [(&'static str, Value); 2] {
        self.lock().parameters()
    }

    /// Makes the drive go on as asked, and tells all clients; what is wrong with it otherwise.
    pub(super) fn control(&self, control: Control, from: &Arc<Outbox>) -> Result<(), String> {
        let [low, high] = RATES;
        if !(low..=high).contains(&control.rate) {
            return Err(format!(
                "rate is {}; expected a number from {low} to {high}",
                control.rate
            ));
        }
        let mut state = self.lock();
        (state.paused, state.rate) = (control.paused, control.rate);
        // To play on after the end is to play again.
        let again = state.playing == Playing::Ended && !control.paused;
        let seek_ns = control.seek_ns.or(again.then_some(self.span_ns[0]));
        if let Some(seek_ns) = seek_ns {
            let [start, end] = self.span_ns;
            let time_ns = seek_ns.clamp(start, end);
            state.seek = Some(Seek { time_ns, id: control.id, from: Some(Arc::clone(from)) });
        } else {
            if matches!(state.playing, Playing::Plays | Playing::Paused) {
                state.playing = if control.paused { Playing::Paused } else { Playing::Plays };
            }
            state.tell_playing(Some(from), false, &control.id);
        }
        let values = protocol::parameter_values(&state.parameters(), None);
        for client in state.clients.iter().filter(|client| client.wants_parameters()) {
            if !Arc::ptr_eq(client, from) {
                client.tell_parameters(values.clone());
            }
        }
        self.changed.notify_all();
        Ok(())
    }

    pub(super) fn publish(&self, message: Message) {
        self.tally.published.fetch_add(1, Ordering::Relaxed);
        let message = Arc::new(message);
        let mut state = self.lock();
        if state.time_ns != message.time_ns {
            state.time_ns = message.time_ns;
            state.clients.iter().for_each(|client| client.tell_time(message.time_ns));
        }
        if self.channels[message.channel].lasting {
            state.holds[message.channel] = Some(Arc::clone(&message));
        }
        state.clients.iter().for_each(|client| client.publish(&message));
    }

    pub(super) fn set_playing(&self, playing: Playing, did_seek: bool, id: &str) {
        let mut state = self.lock();
        state.playing = playing;
        state.tell_playing(None, did_seek, id);
    }
}

impl State {
    fn parameters(&self) -> [(&'static str, Value); 2] {
        [("rate", json!(self.rate)), ("paused", json!(self.paused))]
    }

    fn playback(&self, did_seek: bool, id: &str) -> Playback {
        let Self { playing, time_ns, rate, .. } = *self;
        Playback { playing, time_ns, rate, did_seek, id: id.into() }
    }

    /// Answers a client's request with the state of playback.
    fn answer_playing(&self, client: &Outbox, did_seek: bool, id: &str) {
        if client.has_control {
            client.answer(Out::Binary(self.playback(did_seek, id).bytes()));
        }
    }

    /// Reports the state of playback to all clients that know it: to the one that asked for a change as an answer.
    pub(super) fn tell_playing(&self, from: Option<&Arc<Outbox>>, did_seek: bool, id: &str) {
        let playback = self.playback(did_seek, id);
        for client in self.clients.iter().filter(|client| client.has_control) {
            if from.is_some_and(|from| Arc::ptr_eq(from, client)) {
                self.answer_playing(client, did_seek, id);
            } else {
                client.tell_playback(playback.clone());
            }
        }
    }
}
