//! What waits to be sent to one client.

use super::protocol;
use boresight_formats::foxglove::Message;
use std::collections::{HashSet, VecDeque};
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::time::Duration;

/// Bytes of messages that wait for a client, beyond which further ones are lost to it.
const MOST_BYTES: usize = 32 << 20;
/// Answers that wait for a client, beyond which it is taken for one that asks and does not read.
const MOST_ANSWERS: usize = 256;
/// Topics a client may ask for, the same ones twice included.
const MOST_SUBSCRIPTIONS: usize = 1024;

/// One frame to send.
#[derive(Debug)]
pub(super) enum Out {
    Text(String),
    Binary(Vec<u8>),
    /// A message by the client's own number for it.
    Data(u32, Arc<Message>),
}

/// The client's topics and what waits for it: answers in full, of messages as many as fit.
#[derive(Debug)]
pub(super) struct Outbox {
    most: usize,
    /// Whether the client knows the control of playback.
    pub(super) has_control: bool,
    inner: Mutex<Inner>,
    filled: Condvar,
}

#[derive(Debug, Default)]
struct Inner {
    answers: VecDeque<Out>,
    messages: VecDeque<Out>,
    bytes: usize,
    subscriptions: Vec<(u32, usize)>,
    lost: u64,
    wants_parameters: bool,
    is_overrun: bool,
}

impl Outbox {
    pub(super) fn new(most: usize, has_control: bool) -> Self {
        Self { most, has_control, inner: Mutex::default(), filled: Condvar::new() }
    }

    fn lock(&self) -> MutexGuard<'_, Inner> {
        self.inner.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Puts an answer before all messages.
    pub(super) fn answer(&self, out: Out) {
        let mut inner = self.lock();
        if inner.answers.len() >= MOST_ANSWERS {
            inner.is_overrun = true;
        } else {
            inner.answers.push_back(out);
        }
        self.filled.notify_one();
    }

    /// Puts a message at the end for each subscription to its channel, where there is room.
    pub(super) fn publish(&self, message: &Arc<Message>) {
        let inner = &mut *self.lock();
        for (id, _) in inner.subscriptions.iter().filter(|(_, on)| *on == message.channel) {
            if inner.messages.len() < self.most && inner.bytes < MOST_BYTES {
                inner.bytes += message.data.len();
                inner.messages.push_back(Out::Data(*id, Arc::clone(message)));
            } else {
                inner.lost += 1;
            }
        }
        self.filled.notify_one();
    }

    /// Puts the time at the end; one that nothing followed is replaced.
    pub(super) fn tell_time(&self, time_ns: u64) {
        let inner = &mut *self.lock();
        let time = Out::Binary(protocol::time(time_ns));
        if let Some(last @ Out::Binary(_)) = inner.messages.back_mut() {
            *last = time;
        } else if inner.messages.len() < self.most {
            inner.messages.push_back(time);
        }
        self.filled.notify_one();
    }

    /// Adds a subscription, with the message that holds on its channel; whether there was room for it.
    pub(super) fn subscribe(&self, id: u32, channel: usize, holds: Option<&Arc<Message>>) -> bool {
        let mut inner = self.lock();
        if inner.subscriptions.len() >= MOST_SUBSCRIPTIONS {
            return false;
        }
        inner.subscriptions.push((id, channel));
        if let Some(message) = holds {
            inner.bytes += message.data.len();
            inner.messages.push_back(Out::Data(id, Arc::clone(message)));
        }
        true
    }

    /// Takes subscriptions back; the number of those that there were.
    pub(super) fn unsubscribe(&self, ids: &[u32]) -> usize {
        let mut inner = self.lock();
        let before = inner.subscriptions.len();
        let ids: HashSet<u32> = ids.iter().copied().collect();
        inner.subscriptions.retain(|(id, _)| !ids.contains(id));
        before - inner.subscriptions.len()
    }

    pub(super) fn has_subscription(&self, id: u32) -> bool {
        self.lock().subscriptions.iter().any(|(known, _)| *known == id)
    }

    /// Whether changes of parameters are to be told.
    pub(super) fn want_parameters(&self, wanted: bool) {
        self.lock().wants_parameters = wanted;
    }

    pub(super) fn wants_parameters(&self) -> bool {
        self.lock().wants_parameters
    }

    /// What is to be sent next.
    pub(super) fn take(&self) -> Option<Out> {
        let inner = &mut *self.lock();
        let out = inner.answers.pop_front().or_else(|| inner.messages.pop_front())?;
        if let Out::Data(_, message) = &out {
            inner.bytes -= message.data.len();
        }
        Some(out)
    }

    /// Messages lost so far.
    pub(super) fn lost(&self) -> u64 {
        self.lock().lost
    }

    /// Whether the client asks and does not read.
    pub(super) fn is_overrun(&self) -> bool {
        self.lock().is_overrun
    }

    /// Waits until there is something to send, or for a while.
    pub(super) fn wait(&self, longest: Duration) {
        let inner = self.lock();
        if inner.answers.is_empty() && inner.messages.is_empty() {
            drop(self.filled.wait_timeout(inner, longest));
        }
    }
}
