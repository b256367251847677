//! The server: who is connected, what holds, and how the drive goes on.

use super::client;
use super::options::ServeOptions;
use super::play::Play;
use super::protocol::{self, Control, Playing};
use super::queue::{Out, Outbox};
use crate::LiveError;
use boresight_core::describe::{self, Described, Naming};
use boresight_formats::foxglove::{Channel, Message};
use serde::Serialize;
use serde_json::{Value, json};
use std::io::ErrorKind;
use std::net::{SocketAddr, TcpListener, TcpStream};
use std::ops::ControlFlow;
use std::sync::atomic::{AtomicBool, AtomicU64, AtomicUsize, Ordering};
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::thread::{Builder, Scope};
use std::time::{Duration, Instant, SystemTime, UNIX_EPOCH};

/// Between two looks for new connections, and for an end that is asked for.
const LOOK: Duration = Duration::from_millis(10);
/// The rate a client may ask for is one an option may have.
const RATES: [f64; 2] = [0.01, 1e6];
/// Messages published between two looks for an end that is asked for, where nothing has to be waited for.
const MESSAGES_A_LOOK: u64 = 64;

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
    fn counts(&self) -> Counts {
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
    pub(super) channels: Vec<Channel>,
    pub(super) tally: Tally,
    advertise: String,
    session: String,
    span_ns: [u64; 2],
    state: Mutex<State>,
    /// Something that the drive waits for.
    changed: Condvar,
    stopped: AtomicBool,
    connections: AtomicUsize,
}

struct State {
    clients: Vec<Arc<Outbox>>,
    /// Of channels whose last message holds, that message.
    holds: Vec<Option<Arc<Message>>>,
    time_ns: u64,
    rate: f64,
    paused: bool,
    playing: Playing,
    /// A time to go to, and who asked by which name.
    seek: Option<(u64, String)>,
    has_viewer: bool,
}

impl Shared {
    fn new(options: ServeOptions, play: &Play) -> Self {
        let channels = play.channels().to_vec();
        let started = SystemTime::now().duration_since(UNIX_EPOCH).unwrap_or_default();
        Self {
            advertise: protocol::advertise(&channels),
            session: format!("{}-{}", started.as_nanos(), std::process::id()),
            span_ns: play.span_ns(),
            state: Mutex::new(State {
                clients: vec![],
                holds: vec![None; channels.len()],
                time_ns: play.span_ns()[0],
                rate: options.rate,
                paused: false,
                playing: Playing::Waits,
                seek: None,
                has_viewer: false,
            }),
            tally: Tally::default(),
            changed: Condvar::new(),
            stopped: AtomicBool::new(false),
            connections: AtomicUsize::new(0),
            channels,
            options,
        }
    }

    fn lock(&self) -> MutexGuard<'_, State> {
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
        state.tell_playing(Some(client), false, "");
        state.clients.push(Arc::clone(client));
    }

    pub(super) fn leave(&self, client: &Arc<Outbox>) {
        self.lock().clients.retain(|other| !Arc::ptr_eq(other, client));
    }

    /// Adds a subscription; whether there was room.
    pub(super) fn subscribe(&self, client: &Outbox, id: u32, channel: usize) -> bool {
        let mut state = self.lock();
        let done = client.subscribe(id, channel, state.holds[channel].as_ref());
        state.has_viewer |= done;
        self.changed.notify_all();
        done
    }

    /// Parameters by name.
    pub(super) fn parameters(&self) -> [(&'static str, Value); 2] {
        self.lock().parameters()
    }

    /// Makes the drive go on as asked, and tells all clients; what is wrong with it otherwise.
    pub(super) fn control(&self, control: Control, from: Option<&Outbox>) -> Result<(), String> {
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
            state.seek = Some((seek_ns.clamp(start, end), control.id));
        } else {
            if matches!(state.playing, Playing::Plays | Playing::Paused) {
                state.playing = if control.paused { Playing::Paused } else { Playing::Plays };
            }
            state.tell_playing(None, false, &control.id);
        }
        let values = protocol::parameter_values(&state.parameters(), None);
        for client in state.clients.iter().filter(|client| client.wants_parameters()) {
            if from.is_none_or(|from| !std::ptr::eq(from, &raw const **client)) {
                client.answer(Out::Text(values.clone()));
            }
        }
        self.changed.notify_all();
        Ok(())
    }

    fn publish(&self, message: Message) {
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

    fn set_playing(&self, playing: Playing, did_seek: bool, id: &str) {
        let mut state = self.lock();
        state.playing = playing;
        state.tell_playing(None, did_seek, id);
    }
}

impl State {
    fn parameters(&self) -> [(&'static str, Value); 2] {
        [("rate", json!(self.rate)), ("paused", json!(self.paused))]
    }

    /// Tells one client or all what the drive does, where they know the control of playback.
    fn tell_playing(&self, client: Option<&Arc<Outbox>>, did_seek: bool, id: &str) {
        let bytes = protocol::playback_state(self.playing, self.time_ns, self.rate, did_seek, id);
        let told = client.map_or(&self.clients[..], std::slice::from_ref);
        for client in told.iter().filter(|client| client.has_control) {
            client.answer(Out::Binary(bytes.clone()));
        }
    }
}

/// A server that listens.
#[derive(Debug)]
pub struct Server {
    listener: TcpListener,
    options: ServeOptions,
}

/// Says how far the drive is, and hears whether to go on.
pub type Watch<'a> = &'a dyn Fn([usize; 2]) -> ControlFlow<()>;

impl Server {
    /// Listens at the address of the options.
    ///
    /// # Errors
    /// [`boresight_core::CoreError::OutOfRange`] naming an option, and [`LiveError::Listen`].
    pub fn bind(options: ServeOptions) -> Result<Self, LiveError> {
        describe::check(&options, Naming::Rust)?;
        let ServeOptions { host, port, .. } = &options;
        let failed = |error: std::io::Error| LiveError::Listen {
            address: format!("{host}:{port}"),
            given: error.to_string(),
        };
        let listener = TcpListener::bind((host.as_str(), *port)).map_err(failed)?;
        listener.set_nonblocking(true).map_err(failed)?;
        Ok(Self { listener, options })
    }

    /// The address, with the port that was free where 0 was asked for.
    #[must_use]
    pub fn address(&self) -> Option<SocketAddr> {
        self.listener.local_addr().ok()
    }

    /// Serves a drive until `watch` ends it. After the last scan it stays, for viewers that come late.
    ///
    /// # Errors
    /// Those of [`Play::step`].
    pub fn run(self, play: &mut Play, watch: Watch) -> Result<Counts, LiveError> {
        let shared = Shared::new(self.options, play);
        let listener = self.listener;
        let played = std::thread::scope(|scope| {
            let accepts = Builder::new().spawn_scoped(scope, || accept(&listener, scope, &shared));
            let played = match accepts {
                Ok(_) => Player { shared: &shared, play, watch, since_look: 0 }.run(),
                Err(error) => Err(LiveError::Listen {
                    address: "a thread of its own".into(),
                    given: error.to_string(),
                }),
            };
            shared.stopped.store(true, Ordering::Relaxed);
            played
        });
        played.map(|_| shared.tally.counts())
    }
}

/// Counts a connection for as long as it is there.
struct Connection<'a>(&'a Shared);

impl Drop for Connection<'_> {
    fn drop(&mut self) {
        self.0.connections.fetch_sub(1, Ordering::Relaxed);
    }
}

fn accept<'scope>(
    listener: &TcpListener,
    scope: &'scope Scope<'scope, '_>,
    shared: &'scope Shared,
) {
    while !shared.is_stopped() {
        match listener.accept() {
            Ok((stream, _)) => connect(stream, scope, shared),
            Err(error) if error.kind() == ErrorKind::WouldBlock => std::thread::sleep(LOOK),
            // Too many open files, say: others may close.
            Err(_) => {
                shared.tally.refused.fetch_add(1, Ordering::Relaxed);
                std::thread::sleep(LOOK);
            }
        }
    }
}

fn connect<'scope>(stream: TcpStream, scope: &'scope Scope<'scope, '_>, shared: &'scope Shared) {
    let before = shared.connections.fetch_add(1, Ordering::Relaxed);
    let connection = Connection(shared);
    let serve = move || {
        client::run(stream, shared);
        drop(connection);
    };
    if before >= shared.options.clients || Builder::new().spawn_scoped(scope, serve).is_err() {
        shared.tally.refused.fetch_add(1, Ordering::Relaxed);
    }
}

/// What the drive waits for came.
enum Next {
    /// The time of a message.
    Due,
    /// A time to go to.
    Seek(u64, String),
}

struct Player<'a, 'b> {
    shared: &'a Shared,
    play: &'a mut Play<'b>,
    watch: Watch<'a>,
    since_look: u64,
}

/// A moment of the drive and of the world, from which the others follow.
struct Anchor {
    at: Instant,
    time_ns: u64,
    rate: f64,
}

impl Anchor {
    fn due(&self, time_ns: u64) -> Option<Duration> {
        let after_s = time_ns.saturating_sub(self.time_ns) as f64 / 1e9 / self.rate;
        // What is too far for a duration is never due.
        let after = Duration::try_from_secs_f64(after_s).unwrap_or(Duration::MAX);
        after.checked_sub(self.at.elapsed()).filter(|left| !left.is_zero())
    }
}

type Ended = ControlFlow<()>;

impl Player<'_, '_> {
    /// Plays until it is ended.
    fn run(&mut self) -> Result<Ended, LiveError> {
        let mut out = vec![];
        self.restart(&mut out)?;
        out.drain(..).for_each(|message| self.shared.publish(message));
        let at_once = self.shared.options.at_once;
        if self.wait(|state| at_once || state.has_viewer || state.seek.is_some()).is_break() {
            return Ok(Ended::Break(()));
        }
        loop {
            self.shared.set_playing(self.state_now(), false, "");
            let seek = match self.drive(&mut out)? {
                ControlFlow::Break(()) => return Ok(Ended::Break(())),
                ControlFlow::Continue(seek) => seek,
            };
            let (to_ns, id) = match seek {
                Some(seek) => seek,
                None if self.shared.options.repeat => (self.play.span_ns()[0], String::new()),
                None => {
                    self.shared.set_playing(Playing::Ended, false, "");
                    if self.wait(|state| state.seek.is_some()).is_break() {
                        return Ok(Ended::Break(()));
                    }
                    self.shared.lock().seek.take().unwrap_or_default()
                }
            };
            self.shared.set_playing(Playing::Waits, false, "");
            if self.seek(to_ns, &id, &mut out)?.is_break() {
                return Ok(Ended::Break(()));
            }
        }
    }

    fn state_now(&self) -> Playing {
        if self.shared.lock().paused { Playing::Paused } else { Playing::Plays }
    }

    /// Plays to the end, or until a time to go to is asked for.
    fn drive(
        &mut self,
        out: &mut Vec<Message>,
    ) -> Result<ControlFlow<(), Option<(u64, String)>>, LiveError> {
        let mut anchor: Option<Anchor> = None;
        loop {
            for message in out.drain(..) {
                match self.until_due(message.time_ns, &mut anchor) {
                    ControlFlow::Break(()) => return Ok(ControlFlow::Break(())),
                    ControlFlow::Continue(Next::Due) => self.shared.publish(message),
                    ControlFlow::Continue(Next::Seek(to_ns, id)) => {
                        return Ok(ControlFlow::Continue(Some((to_ns, id))));
                    }
                }
            }
            if !self.play.step(out)? {
                return Ok(ControlFlow::Continue(None));
            }
        }
    }

    fn restart(&mut self, out: &mut Vec<Message>) -> Result<(), LiveError> {
        out.clear();
        self.play.begin(out)?;
        self.shared.lock().holds.fill(None);
        Ok(())
    }

    /// Goes to a time from the start, calibrating all that lies between, and tells what holds there.
    fn seek(&mut self, to_ns: u64, id: &str, out: &mut Vec<Message>) -> Result<Ended, LiveError> {
        let mut fresh = vec![];
        self.restart(&mut fresh)?;
        out.clear();
        let mut holds: Vec<Option<Message>> = vec![None; self.shared.channels.len()];
        loop {
            for message in fresh.drain(..) {
                let channel = message.channel;
                if message.time_ns >= to_ns {
                    out.push(message);
                } else if self.shared.channels[channel].lasting {
                    holds[channel] = Some(message);
                }
            }
            if (self.watch)(self.play.progress()).is_break() {
                return Ok(Ended::Break(()));
            }
            if !out.is_empty() || !self.play.step(&mut fresh)? {
                break;
            }
        }
        holds.into_iter().flatten().for_each(|message| self.shared.publish(message));
        let mut state = self.shared.lock();
        state.time_ns = to_ns;
        state.clients.iter().for_each(|client| client.tell_time(to_ns));
        state.playing = if state.paused { Playing::Paused } else { Playing::Plays };
        state.tell_playing(None, true, id);
        Ok(Ended::Continue(()))
    }

    /// Waits until something is so.
    fn wait(&self, is_so: impl Fn(&State) -> bool) -> Ended {
        let mut state = self.shared.lock();
        while !is_so(&state) {
            state = self
                .shared
                .changed
                .wait_timeout(state, LOOK)
                .unwrap_or_else(PoisonError::into_inner)
                .0;
            if (self.watch)(self.play.progress()).is_break() {
                return Ended::Break(());
            }
        }
        Ended::Continue(())
    }

    /// Waits for the time of a message at the rate of the drive, or for a time to go to.
    fn until_due(&mut self, time_ns: u64, anchor: &mut Option<Anchor>) -> ControlFlow<(), Next> {
        let mut state = self.shared.lock();
        loop {
            if let Some((to_ns, id)) = state.seek.take() {
                return ControlFlow::Continue(Next::Seek(to_ns, id));
            }
            // It starts anew where the rate changes and after a pause.
            if state.paused || anchor.as_ref().is_some_and(|anchor| anchor.rate != state.rate) {
                *anchor = None;
            }
            let rate = state.rate;
            let left = if state.paused {
                Some(LOOK)
            } else {
                let from = state.time_ns.min(time_ns);
                anchor
                    .get_or_insert_with(|| Anchor { at: Instant::now(), time_ns: from, rate })
                    .due(time_ns)
            };
            self.since_look += 1;
            if left.is_some() || self.since_look >= MESSAGES_A_LOOK {
                self.since_look = 0;
                if (self.watch)(self.play.progress()).is_break() {
                    return ControlFlow::Break(());
                }
            }
            let Some(left) = left else { return ControlFlow::Continue(Next::Due) };
            state = self
                .shared
                .changed
                .wait_timeout(state, left.min(LOOK))
                .unwrap_or_else(PoisonError::into_inner)
                .0;
        }
    }
}
