//! Drives and results as MCAP files.

use crate::destination::Destination;
use crate::error::CliError;
use crate::files::Files;
use boresight_formats::DriveRead;
use boresight_formats::foxglove::{Channel, DriveTopics, Message};
use boresight_formats::mcap::write::McapWriter;
use std::io::{BufWriter, Write};

/// A file that is being written.
pub(super) struct Mcap<'a> {
    writer: McapWriter<BufWriter<&'a mut dyn Write>>,
    /// Messages that are to be written next.
    pub(super) out: Vec<Message>,
}

impl Mcap<'_> {
    /// Writes the messages that are to be written next.
    pub(super) fn write(&mut self) -> Result<(), CliError> {
        Ok(self.out.drain(..).try_for_each(|message| self.writer.write(&message))?)
    }
}

/// Writes a file of messages on some channels whole or not at all, with what `fill` puts into it.
pub(super) fn write<T>(
    files: &Files,
    destination: Destination,
    channels: &[Channel],
    fill: impl FnOnce(&mut Mcap) -> Result<T, CliError>,
) -> Result<T, CliError> {
    files.write_with(destination, |file| {
        let writer = McapWriter::new(BufWriter::new(file), "", channels)?;
        let mut mcap = Mcap { writer, out: vec![] };
        let value = fill(&mut mcap)?;
        mcap.write()?;
        mcap.writer.finish()?;
        Ok(value)
    })
}

/// Writes a drive by itself.
pub(super) fn write_log(
    read: &DriveRead,
    files: &Files,
    destination: Destination,
) -> Result<(), CliError> {
    let mut topics = DriveTopics::new(&read.log, |_| true)?;
    let channels = topics.channels().to_vec();
    write(files, destination, &channels, |mcap| {
        topics.begin(&read.report.remarks, &mut mcap.out);
        for scan in &read.log.scans {
            topics.scan(scan, None, &mut mcap.out);
            mcap.write()?;
        }
        topics.finish(&mut mcap.out);
        Ok(())
    })
}
