//! `boresight serve`: a drive, live, for viewers.

use super::calibrate::{ids, mounted, read_network};
use crate::arguments::ServeArguments;
use crate::drive::open_path;
use crate::error::CliError;
use crate::files::Files;
use crate::output::remark;
use crate::run::Run;
use crate::terminal::report;
use boresight_core::Progress;
use boresight_formats::json;
use boresight_live::foxglove::play::Setup;
use boresight_live::foxglove::{Counts, Play, Server};
use boresight_mounting::CalibrationOptions;

/// Serves until Ctrl-C; what became of connections and messages, as text or JSON.
pub fn run(arguments: &ServeArguments, files: &Files) -> Result<String, CliError> {
    let read = open_path(&arguments.log, None, files)?;
    remark(read.report.remarks.iter().map(|remark| remark.message.clone()));
    let wanted = |id: u8| arguments.sensor.is_none_or(|sensor| sensor == id);
    let flags = &arguments.flags;
    let radars = read
        .log
        .sensors
        .iter()
        .filter(|sensor| wanted(sensor.id))
        .map(|sensor| {
            let given = [flags.given("x_m"), flags.given("y_m")];
            Ok((sensor.id, mounted(flags.options, sensor, given)?))
        })
        .collect::<Result<Vec<(u8, CalibrationOptions)>, CliError>>()?;
    if let (true, Some(sensor)) = (radars.is_empty(), arguments.sensor) {
        return Err(CliError::Option {
            option: "--sensor",
            expected: format!("a radar of the log: {}", ids(&read.log)),
            given: sensor.to_string(),
        });
    }
    let network = arguments.network.as_deref().map(|path| read_network(path, files)).transpose()?;
    let network = network.unwrap_or_else(boresight_validate::candidates::network);
    let setup = Setup { radars, joint: arguments.joint, network: Some(network) };
    let mut play = Play::new(&read.log, &read.report.remarks, setup)?;
    let server = Server::bind(arguments.serve.options.clone())?;
    if let Some(address) = server.address() {
        // Who starts it by a program waits for this line.
        report(&format!("serving at ws://{address}; Ctrl-C ends it\n"));
    }
    let run = Run::start("scans")?;
    let counts = server.run(&mut play, &|[done, total]| run.report(Progress { done, total }))?;
    run.finish();
    Ok(if arguments.json { format!("{:#}\n", json::result(&counts)) } else { text(&counts) })
}

fn text(counts: &Counts) -> String {
    let Counts { clients, refused, rejected, published, sent, lost, bytes } = counts;
    format!(
        "clients      {clients}; {refused} connections refused as too many, {rejected} without a handshake\n\
         published    {published} messages\n\
         sent         {sent} messages, {bytes} bytes\n\
         lost         {lost} messages, to viewers that read too slowly\n"
    )
}
