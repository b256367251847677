//! What waits to be sent to one client.

use super::protocol::{self, Playback};
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

/// The messages of a client, as many as fit.
struct Room<'a> {
    most: usize,
    messages: &'a mut VecDeque<Out>,
    bytes: &'a mut usize,
    lost: &'a mut u64,
}

impl Room<'_> {
    /// Puts a message at the end, or counts it as lost.
    fn put(&mut self, subscription: u32, message: &Arc<Message>) {
        if self.messages.len() < self.most && *self.bytes < MOST_BYTES {
            *self.bytes += message.data.len();
            self.messages.push_back(Out::Data(subscription, Arc::clone(message)));
        } else {
            *self.lost += 1;
        }
    }
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
    /// The latest state of playback and of parameters that the client did not ask for. Only the latest is kept, so
    /// that requests of other clients cannot fill the queue of this one.
    playback: Option<Playback>,
    parameters: Option<String>,
    messages: VecDeque<Out>,
    bytes: usize,
    subscriptions: Vec<(u32, usize)>,
    lost: u64,
    wants_parameters: bool,
    is_overrun: bool,
}

impl Inner {
    fn take_state(&mut self) -> Option<Out> {
        let playback = self.playback.take().map(|playback| Out::Binary(playback.bytes()));
        playback.or_else(|| self.parameters.take().map(Out::Text))
    }
}

impl Outbox {
    pub(super) fn new(most: usize, has_control: bool) -> Self {
        Self { most, has_control, inner: Mutex::default(), filled: Condvar::new() }
    }

    fn lock(&self) -> MutexGuard<'_, Inner> {
        self.inner.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Puts an answer before all messages, and behind the states that waited before it.
    pub(super) fn answer(&self, out: Out) {
        let inner = &mut *self.lock();
        if inner.answers.len() >= MOST_ANSWERS {
            inner.is_overrun = true;
        } else {
            while let Some(state) = inner.take_state() {
                inner.answers.push_back(state);
            }
            inner.answers.push_back(out);
        }
        self.filled.notify_one();
    }

    /// Replaces the state of playback that waits. A seek in the replaced one remains noted.
    pub(super) fn tell_playback(&self, mut playback: Playback) {
        let mut inner = self.lock();
        playback.did_seek |= inner.playback.take().is_some_and(|before| before.did_seek);
        inner.playback = Some(playback);
        self.filled.notify_one();
    }

    /// Replaces the parameters that wait.
    pub(super) fn tell_parameters(&self, values: String) {
        self.lock().parameters = Some(values);
        self.filled.notify_one();
    }

    /// Puts a message at the end for each subscription to its channel, where there is room.
    pub(super) fn publish(&self, message: &Arc<Message>) {
        let inner = &mut *self.lock();
        let Inner { subscriptions, messages, bytes, lost, .. } = inner;
        let mut room = Room { most: self.most, messages, bytes, lost };
        for (id, _) in subscriptions.iter().filter(|(_, on)| *on == message.channel) {
            room.put(*id, message);
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
        let Inner { subscriptions, messages, bytes, lost, .. } = &mut *self.lock();
        if subscriptions.len() >= MOST_SUBSCRIPTIONS {
            return false;
        }
        subscriptions.push((id, channel));
        if let Some(message) = holds {
            Room { most: self.most, messages, bytes, lost }.put(id, message);
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
        let out = inner
            .answers
            .pop_front()
            .or_else(|| inner.take_state())
            .or_else(|| inner.messages.pop_front())?;
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
        let Inner { answers, playback, parameters, messages, .. } = &*inner;
        let is_empty = answers.is_empty() && messages.is_empty();
        if is_empty && playback.is_none() && parameters.is_none() {
            drop(self.filled.wait_timeout(inner, longest));
        }
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::super::protocol::Playing;
    use super::*;

    fn playback(id: &str, did_seek: bool) -> Playback {
        Playback { playing: Playing::Paused, time_ns: 7, rate: 1.0, did_seek, id: id.into() }
    }

    #[test]
    fn states_that_were_not_asked_for_replace_each_other() {
        let outbox = Outbox::new(16, true);
        for k in 0..10 * MOST_ANSWERS {
            outbox.tell_playback(playback(&k.to_string(), k == 3));
            outbox.tell_parameters(k.to_string());
        }
        assert!(!outbox.is_overrun());
        let last = (10 * MOST_ANSWERS - 1).to_string();
        let Some(Out::Binary(bytes)) = outbox.take() else { unreachable!() };
        assert_eq!(bytes, playback(&last, true).bytes());
        assert!(matches!(outbox.take(), Some(Out::Text(text)) if text == last));
        assert!(outbox.take().is_none());
    }

    #[test]
    fn subscriptions_taken_back_and_made_again_leave_the_queue_in_its_bounds() {
        let outbox = Outbox::new(16, false);
        let message = Arc::new(Message { channel: 0, time_ns: 0, data: vec![0; 100] });
        for _ in 0..1000 {
            assert!(outbox.subscribe(1, 0, Some(&message)));
            outbox.unsubscribe(&[1]);
        }
        let inner = outbox.lock();
        assert_eq!((inner.messages.len(), inner.lost, inner.bytes), (16, 984, 1600));
    }
}
