//! `boresight log`: what is in a drive log.

use super::{log_statistics, mcap, messages};
use crate::arguments::LogArguments;
use crate::destination::Destination;
use crate::drive::open_path;
use crate::error::CliError;
use crate::files::{self, Files};
use crate::output::remark;
use crate::terminal::one_line;
use boresight_core::drive::DriveLog;
use boresight_formats::drive_log::table::{write_detections, write_motion};
use boresight_formats::{DriveRead, DriveTopic, MountingSource, json};
use boresight_mounting::CalibrationOptions;
use boresight_mounting::signs::{SignFindings, find_signs};
use boresight_options::Named;
use serde_json::{Map, Value, json};
use std::io::{BufWriter, Write};

/// What is in a log, as text or JSON.
pub fn run(arguments: &LogArguments, files: &Files) -> Result<String, CliError> {
    if let Some(topic) = &arguments.messages {
        let [path] = &arguments.log.paths[..] else {
            return Err(CliError::Option {
                option: "--messages",
                expected: "one file as PATH".into(),
                given: format!("{} paths", arguments.log.paths.len()),
            });
        };
        return messages::run(path, topic, files);
    }
    let read = open_path(&arguments.log, None, files)?;
    remark(read.report.remarks.iter().map(|remark| remark.message.clone()));
    if let Some(folder) = &arguments.export {
        let detections = files.destination(&folder.join("detections.csv"))?;
        let motion = files.destination(&folder.join("motion.csv"))?;
        files::make_folder(folder)?;
        export(files, detections, |out| write_detections(&read.log, out))?;
        export(files, motion, |out| write_motion(&read.log, out))?;
    }
    if let Some(path) = &arguments.mcap {
        mcap::write_log(&read, files, files.destination(path)?)?;
    }
    if arguments.statistics {
        return log_statistics::run(&read.log, arguments.json);
    }
    let signs = find_signs(&read.log, CalibrationOptions::default().max_gap_s)?;
    Ok(if arguments.json {
        format!("{:#}\n", as_json(&read, &signs))
    } else {
        as_text(&read, &signs)
    })
}

fn export(
    files: &Files,
    destination: Destination,
    write: impl FnOnce(&mut BufWriter<&mut dyn Write>) -> std::io::Result<()>,
) -> Result<(), CliError> {
    let path = destination.named().to_owned();
    files.write_with(destination, |file| {
        let mut out = BufWriter::new(file);
        write(&mut out).and_then(|()| out.flush()).map_err(|error| CliError::File {
            action: "write",
            path,
            error,
        })
    })
}

/// A radar's share of a log: its number, scans and detections.
fn by_sensor(log: &DriveLog) -> impl Iterator<Item = (u8, usize, usize)> {
    log.sensors.iter().map(|sensor| {
        let scans = log.scans.iter().filter(|scan| scan.sensor == sensor.id);
        (sensor.id, scans.clone().count(), scans.map(|scan| scan.detections.len()).sum())
    })
}

/// First and last of the times, s.
fn span(times: impl Iterator<Item = f64>) -> Option<(f64, f64)> {
    times.fold(None, |span, t| Some(span.map_or((t, t), |(a, b): (f64, f64)| (a.min(t), b.max(t)))))
}

fn spans(log: &DriveLog) -> [Option<(f64, f64)>; 2] {
    [span(log.scans.iter().map(|s| s.time_s)), span(log.motion.iter().map(|s| s.time_s))]
}

fn as_json(read: &DriveRead, signs: &SignFindings) -> Value {
    let log = &read.log;
    let sensors: Vec<Value> = log
        .sensors
        .iter()
        .zip(by_sensor(log))
        .map(|(sensor, (id, scans, detections))| {
            let mounting = sensor.mounting.map(|mounting| json::result(&mounting));
            json!({ "id": id, "scans": scans, "detections": detections, "mounting": mounting })
        })
        .collect();
    let [radar, motion] = spans(log).map(|s| s.map(|(a, b)| json!({ "startS": a, "endS": b })));
    let dropped: Map<String, Value> =
        read.report.drops().map(|(reason, n)| (reason.name().into(), n.into())).collect();
    let report = &read.report;
    let sequence = report
        .sequence
        .as_ref()
        .map(|(name, category)| json!({ "name": name, "category": category }));
    json!({
        "format": read.format.name(),
        "sequence": sequence,
        "mountings": json::result(&report.mountings),
        "topics": json::result(&report.topics),
        "startS": report.start_s,
        "sensors": sensors,
        "scans": log.scans.len(),
        "detections": log.scans.iter().map(|s| s.detections.len()).sum::<usize>(),
        "radarSpan": radar,
        "motionSamples": log.motion.len(),
        "motionSpan": motion,
        "speeds": log.motion.iter().filter(|s| s.speed_mps.is_some()).count(),
        "poses": log.motion.iter().filter(|s| s.pose.is_some()).count(),
        "rowsRead": { "detections": report.detections, "motion": report.motion },
        "incomplete": { "detections": report.incomplete, "motion": report.motion_incomplete },
        "dropped": dropped,
        "signs": json::result(signs),
    })
}

/// What a topic is used for.
fn topic_line(topic: &DriveTopic) -> String {
    let used = match topic.sensor {
        Some(id) => format!("{} {id}", topic.used_as.name()),
        None => topic.used_as.name().into(),
    };
    let clock = topic.clock.map_or(String::new(), |clock| format!(", times by {}", clock.name()));
    let [name, message_type] = [&topic.name, &topic.message_type].map(|text| one_line(text));
    let DriveTopic { messages, note, .. } = topic;
    let plural = if *messages == 1 { "" } else { "s" };
    format!(
        "topic       {name} ({message_type}, {messages} message{plural}): {used}{clock}; {note}\n"
    )
}

fn as_text(read: &DriveRead, signs: &SignFindings) -> String {
    let log = &read.log;
    let seconds = |span: Option<(f64, f64)>| {
        span.map_or("none".to_owned(), |(a, b)| format!("{a:.3} to {b:.3} s ({:.3} s)", b - a))
    };
    let [radar, motion] = spans(log).map(seconds);
    let detections: usize = log.scans.iter().map(|scan| scan.detections.len()).sum();
    let report = &read.report;
    let name = report.sequence.as_ref().map_or(String::new(), |(name, category)| {
        let category = category.as_ref().map_or(String::new(), |text| format!(" ({text})"));
        one_line(&format!("sequence    {name}{category}")) + "\n"
    });
    let mut text = format!(
        "format      {}\n{name}scans       {}, {radar}\ndetections  {detections} of {} rows\n",
        read.format.name(),
        log.scans.len(),
        report.detections,
    );
    for (sensor, (id, scans, detections)) in log.sensors.iter().zip(by_sensor(log)) {
        let place = sensor.mounting.map_or("not stated".to_owned(), |m| {
            format!("x {:.3} m, y {:.3} m, yaw {:.2} deg", m.x_m, m.y_m, m.yaw_rad.to_degrees())
        });
        text +=
            &format!("sensor {id:<4} {scans} scans, {detections} detections, mounting: {place}\n");
    }
    text +=
        &format!("motion      {} samples of {} rows, {motion}\n", log.motion.len(), report.motion);
    if let Some(source) = report.mountings {
        text += match source {
            MountingSource::SensorsJson => "mountings   from sensors.json\n",
            MountingSource::CalibratedSensor => "mountings   from calibrated_sensor.json\n",
            MountingSource::TfStatic => "mountings   from the recording's fixed transforms\n",
            _ => "mountings   those of the format's own car\n",
        };
    }
    for topic in &report.topics {
        text += &topic_line(topic);
    }
    for (count, lacking) in [
        (report.incomplete, "detections without range, cross-section, compensated rate or place"),
        (report.motion_incomplete, "motion samples without speed or pose"),
    ] {
        if count > 0 {
            text += &format!("kept        {count} {lacking}\n");
        }
    }
    for (reason, count) in report.drops() {
        text += &format!("dropped     {count} {}\n", reason.name());
    }
    for remark in [signs.azimuth_remark(), signs.range_rate_remark()] {
        text += &format!("signs       {}\n", remark.message);
    }
    text
}
