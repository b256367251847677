//! Plays the drive at its rate, as viewers and the options ask.

use super::play::Play;
use super::protocol::Playing;
use super::shared::{Seek, Shared, State};
use crate::error::LiveError;
use boresight_formats::foxglove::Message;
use std::ops::ControlFlow;
use std::sync::PoisonError;
use std::time::{Duration, Instant};

/// Between two looks for an end that is asked for.
const LOOK: Duration = Duration::from_millis(10);
/// Messages published between two such looks, where nothing has to be waited for.
const MESSAGES_A_LOOK: u64 = 64;
/// A viewer asks for one topic after the other; the drive begins when it has asked for no more for so long.
const SETTLED: Duration = Duration::from_millis(200);

/// Says how far the drive is, and hears whether to go on.
pub type Watch<'a> = &'a dyn Fn([usize; 2]) -> ControlFlow<()>;

/// What the drive waits for came.
enum Next {
    /// The time of a message.
    Due,
    /// A time to go to.
    Seek(Seek),
}

pub(super) struct Player<'a, 'b> {
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

/// Whether the end was asked for.
type Ended = ControlFlow<()>;

impl<'a, 'b> Player<'a, 'b> {
    pub(super) fn new(shared: &'a Shared, play: &'a mut Play<'b>, watch: Watch<'a>) -> Self {
        Self { shared, play, watch, since_look: 0 }
    }

    /// Plays until it is ended.
    pub(super) fn run(&mut self) -> Result<Ended, LiveError> {
        let mut out = vec![];
        self.restart(&mut out)?;
        out.drain(..).for_each(|message| self.shared.publish(message));
        let at_once = self.shared.options.at_once;
        if self
            .wait(|state| {
                at_once
                    || state.seek.is_some()
                    || state.asked.is_some_and(|asked| asked.elapsed() >= SETTLED)
            })
            .is_break()
        {
            return Ok(Ended::Break(()));
        }
        loop {
            self.shared.set_playing(self.state_now(), false, "");
            let seek = match self.drive(&mut out)? {
                ControlFlow::Break(()) => return Ok(Ended::Break(())),
                ControlFlow::Continue(seek) => seek,
            };
            let seek = match seek {
                Some(seek) => seek,
                None if self.shared.options.repeat => {
                    Seek { time_ns: self.play.span_ns()[0], ..Seek::default() }
                }
                None => {
                    self.shared.set_playing(Playing::Ended, false, "");
                    if self.wait(|state| state.seek.is_some()).is_break() {
                        return Ok(Ended::Break(()));
                    }
                    self.shared.lock().seek.take().unwrap_or_default()
                }
            };
            self.shared.set_playing(Playing::Waits, false, "");
            if self.seek(&seek, &mut out)?.is_break() {
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
    ) -> Result<ControlFlow<(), Option<Seek>>, LiveError> {
        let mut anchor: Option<Anchor> = None;
        loop {
            for message in out.drain(..) {
                match self.until_due(message.time_ns, &mut anchor) {
                    ControlFlow::Break(()) => return Ok(ControlFlow::Break(())),
                    ControlFlow::Continue(Next::Due) => self.shared.publish(message),
                    ControlFlow::Continue(Next::Seek(seek)) => {
                        return Ok(ControlFlow::Continue(Some(seek)));
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
    fn seek(&mut self, seek: &Seek, out: &mut Vec<Message>) -> Result<Ended, LiveError> {
        let to_ns = seek.time_ns;
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
        state.tell_playing(seek.from.as_ref(), true, &seek.id);
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
            if let Some(seek) = state.seek.take() {
                return ControlFlow::Continue(Next::Seek(seek));
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
