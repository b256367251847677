//! Clients of a bridge, a thread each: a slow one loses whole frames, and holds up neither the card nor the others.

use super::frames::{Counts, Frame};
use super::messages::{Status, text};
use crate::handshake::Connection;
use std::collections::VecDeque;
use std::io::ErrorKind;
use std::sync::{Condvar, Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};
use tungstenite::protocol::CloseFrame;
use tungstenite::protocol::frame::coding::CloseCode;
use tungstenite::{Bytes, Error, Message, WebSocket};

/// Frames that wait for a client; beyond them the oldest goes.
const MOST_WAITING: usize = 4;
/// How often a client is told what came.
const STATUS_EVERY: Duration = Duration::from_secs(1);
/// How long a client's own messages are looked for, and how often while frames come.
const LISTEN: Duration = Duration::from_millis(1);
const LISTEN_EVERY: Duration = Duration::from_millis(50);
/// How long a client that takes nothing is waited for.
const STALLED: Duration = Duration::from_secs(10);

/// What waits for one client.
#[derive(Default)]
struct Waiting {
    messages: VecDeque<Bytes>,
    counts: Counts,
    skipped: u64,
    closing: bool,
}

/// Where frames for one client are left.
#[derive(Default)]
pub(super) struct Mailbox {
    waiting: Mutex<Waiting>,
    filled: Condvar,
}

impl Mailbox {
    fn lock(&self) -> MutexGuard<'_, Waiting> {
        self.waiting.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Leaves a message, in place of the oldest where too many wait.
    pub fn leave(&self, message: Bytes, counts: Counts) {
        let mut waiting = self.lock();
        if waiting.messages.len() >= MOST_WAITING {
            waiting.messages.pop_front();
            waiting.skipped += 1;
        }
        waiting.messages.push_back(message);
        waiting.counts = counts;
        self.filled.notify_one();
    }

    /// Tells what came where no frame did.
    pub fn count(&self, counts: Counts) {
        self.lock().counts = counts;
    }

    /// Ends the client once it was told so.
    pub fn close(&self) {
        self.lock().closing = true;
        self.filled.notify_one();
    }

    /// The next message, if one comes before long; `None` when the client is to end.
    fn take(&self) -> Option<(Option<Bytes>, Counts, u64)> {
        let waiting = self.lock();
        let none = |waiting: &mut Waiting| waiting.messages.is_empty() && !waiting.closing;
        let (mut waiting, _) = self
            .filled
            .wait_timeout_while(waiting, LISTEN_EVERY, none)
            .unwrap_or_else(PoisonError::into_inner);
        let message = waiting.messages.pop_front();
        (!waiting.closing).then_some((message, waiting.counts, waiting.skipped))
    }
}

/// A frame as a client gets it.
pub(super) fn message(frame: &Frame) -> Bytes {
    [&frame.number.to_le_bytes()[..], &frame.samples].concat().into()
}

/// Sends a client the hello and its mailbox, until it goes or the bridge ends.
pub(super) fn serve(mut socket: WebSocket<Connection>, mailbox: &Mailbox, hello: String) {
    let stream = socket.get_ref().stream();
    let blocks = stream
        .set_nonblocking(false)
        .and_then(|()| stream.set_read_timeout(Some(LISTEN)))
        .and_then(|()| stream.set_write_timeout(Some(STALLED)));
    if blocks.is_err() || socket.send(Message::Text(hello.into())).is_err() {
        return;
    }
    let mut sent_frames = 0;
    let (mut told, mut listened) = (Instant::now(), Instant::now());
    loop {
        let Some((message, counts, skipped_frames)) = mailbox.take() else {
            let reason = "the bridge ends".into();
            let frame = CloseFrame { code: CloseCode::Away, reason };
            // Whether it hears that is its own affair.
            let _ = socket.close(Some(frame)).and_then(|()| socket.flush());
            return;
        };
        if let Some(message) = message {
            if socket.send(Message::Binary(message)).is_err() {
                return;
            }
            sent_frames += 1;
        }
        if told.elapsed() >= STATUS_EVERY {
            told = Instant::now();
            let status = Status { counts, sent_frames, skipped_frames };
            // The answer to a ping shows that the client has read everything before it.
            let told = socket
                .send(Message::Text(text(&status).into()))
                .and_then(|()| socket.send(Message::Ping(Bytes::new())));
            if told.is_err() {
                return;
            }
        }
        if listened.elapsed() < LISTEN_EVERY {
            continue;
        }
        listened = Instant::now();
        match socket.read() {
            // Nothing that a client says changes what it is sent; pings are answered by themselves.
            Ok(_) => {}
            Err(Error::Io(error))
                if matches!(error.kind(), ErrorKind::WouldBlock | ErrorKind::TimedOut) => {}
            Err(_) => return,
        }
    }
}
