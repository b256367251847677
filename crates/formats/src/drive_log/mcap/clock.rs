//! Which clock the times of a drive are told by.

use super::TopicClock;
use super::topic::{Times, Topic};
use boresight_core::Remark;

/// Stamps of topics whose clocks are further apart than this are not compared, ns.
const APART_NS: i64 = 10_000_000_000;

/// The clock that times are told by.
pub(super) struct Clock {
    /// That of recording, for all.
    is_log: bool,
}

impl Clock {
    /// By the times of each topic's first message.
    pub fn of_firsts(firsts: impl Iterator<Item = Times>) -> (Self, Option<Remark>) {
        let apart = firsts.map(|Times { log_ns, stamp_ns }| {
            stamp_ns.map_or(0, |stamp| stamp.saturating_sub(log_ns))
        });
        let (least, most) =
            apart.fold((i64::MAX, i64::MIN), |(least, most), d| (least.min(d), most.max(d)));
        // Without any topic the least is the greatest.
        let span = most.saturating_sub(least);
        let is_log = span > APART_NS;
        let remark = is_log.then(|| {
            let text = format!(
                "the stamps of the topics are on clocks {:.0} s apart; times are those of recording",
                span as f64 / 1e9
            );
            Remark::new("clocks-differ", text)
        });
        (Self { is_log }, remark)
    }

    /// That of a topic.
    pub fn of(&self, topic: &Topic) -> TopicClock {
        let is_stamped = topic.first.is_some_and(|times| times.stamp_ns.is_some());
        if is_stamped && !self.is_log { TopicClock::Stamp } else { TopicClock::LogTime }
    }

    /// A time of a topic, ns.
    pub fn time_ns(&self, topic: &Topic, times: Times) -> i64 {
        match self.of(topic) {
            TopicClock::LogTime => times.log_ns,
            // A message without one keeps its distance from the first.
            TopicClock::Stamp => times.stamp_ns.unwrap_or_else(|| {
                let first = topic.first.unwrap_or(times);
                let apart = first.stamp_ns.unwrap_or(0).saturating_sub(first.log_ns);
                times.log_ns.saturating_add(apart)
            }),
        }
    }
}
