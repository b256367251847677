//! Which topics a drive is made of.

use super::TopicOptions;
use super::topic::Topic;
use crate::error::FormatError;

/// Refuses topics that are named and are not there, or are none of their kind.
fn check_named(
    named: &[String],
    all: &[Topic],
    expected: &str,
    is_one: impl Fn(&Topic) -> bool,
) -> Result<(), FormatError> {
    for name in named {
        if !all.iter().any(|topic| topic.name == *name && is_one(topic)) {
            let found = all.iter().find(|topic| topic.name == *name);
            let why = |topic: &Topic| {
                let why = topic.refused.clone().unwrap_or_else(|| "it has no messages".into());
                format!("{}: {why}", topic.message_type)
            };
            return Err(FormatError::Topic {
                topic: name.clone(),
                expected: format!(
                    "{expected}; there are {}",
                    listed(all, |topic| topic.name.clone())
                ),
                given: found.map_or("not in the file".into(), why),
            });
        }
    }
    Ok(())
}

/// The first topics, in words.
fn listed(all: &[Topic], words: impl Fn(&Topic) -> String) -> String {
    const SHOWN: usize = 12;
    let mut text = all.iter().take(SHOWN).map(words).collect::<Vec<_>>().join(", ");
    if all.len() > SHOWN {
        text += &format!(" and {} more", all.len() - SHOWN);
    }
    if text.is_empty() { "no topics".into() } else { text }
}

/// Places of the radars' topics; `lost` says what of the file was not read.
pub(super) fn choose_radars(
    options: &TopicOptions,
    all: &mut [Topic],
    lost: &str,
) -> Result<Vec<usize>, FormatError> {
    let is_radar = |topic: &Topic| topic.is_radar() && topic.messages > 0;
    check_named(&options.radar_topics, all, "a topic with detections", is_radar)?;
    let are_named = !options.radar_topics.is_empty();
    let any = all.iter().any(|topic| is_radar(topic) && !topic.is_tracks());
    let mut radars = vec![];
    for (place, topic) in all.iter_mut().enumerate() {
        if !topic.is_radar() {
            continue;
        }
        if topic.messages == 0 {
            topic.refuse("it has no messages");
        } else if topic.is_tracks() && any && !are_named {
            topic.refuse("tracks, which are filtered; there are detections");
        } else if radars.len() == usize::from(u8::MAX) {
            topic.refuse("there are more than 255 radars");
        } else {
            radars.push(place);
        }
    }
    if radars.is_empty() {
        let why = |topic: &Topic| {
            let why = topic.refused.as_deref().unwrap_or("the car's motion or frames");
            format!("{} ({}): {why}", topic.name, topic.message_type)
        };
        let mut given = listed(all, why);
        if !lost.is_empty() {
            given += &format!("; {lost}");
        }
        return Err(FormatError::NoDriveLog { expected: no_radar(), given });
    }
    Ok(radars)
}

/// What is looked for in a recording.
pub(in super::super) fn no_radar() -> String {
    "an .mcap file with detections of a radar (radar_msgs/RadarScan, sensor_msgs/PointCloud2 with a velocity, or messages with \
     range, azimuth and velocity)"
        .into()
}

/// Places of the topic with the speed, or of the only one with the yaw rate, and of a further one with
/// the yaw rate.
pub(super) fn choose_motions(
    options: &TopicOptions,
    all: &mut [Topic],
) -> Result<Option<(usize, Option<usize>)>, FormatError> {
    let is_motion = |topic: &Topic| topic.motion().is_some() && topic.messages > 0;
    check_named(&options.motion_topics, all, "a topic with the car's motion", is_motion)?;
    let first = |has_speed: bool| {
        let of_kind = |topic: &&(usize, &Topic)| {
            is_motion(topic.1) && topic.1.motion().is_some_and(|m| m.has_speed() == has_speed)
        };
        let all: Vec<_> = all.iter().enumerate().collect();
        // Those with a pose before others.
        let best = all.iter().filter(of_kind).min_by_key(|(_, topic)| !topic.has_pose());
        best.map(|(place, _)| *place)
    };
    let chosen = match (first(true), first(false)) {
        (Some(speed), rate) => Some((speed, rate)),
        (None, rate) => rate.map(|rate| (rate, None)),
    };
    for (place, topic) in all.iter_mut().enumerate() {
        let is_chosen = chosen.is_some_and(|(one, other)| one == place || other == Some(place));
        if topic.motion().is_some() && !is_chosen {
            let none = topic.messages == 0;
            topic.refuse(if none {
                "it has no messages"
            } else {
                "the motion is read from another topic"
            });
        }
    }
    Ok(chosen)
}
