//! `boresight bridge`.

use crate::arguments::BridgeArguments;
use crate::error::CliError;
use crate::files::{Files, config_text};
use crate::output::remark;
use crate::run::interrupted;
use boresight_formats::json;
use boresight_live::bridge::{Bridge, BridgeOptions, Counts, Replay};
use boresight_live::origin::Origins;
use std::io::IsTerminal;
use std::net::SocketAddr;
use std::sync::atomic::Ordering;
use std::thread;

/// Runs the bridge until Ctrl-C and returns what came.
pub fn run(arguments: &BridgeArguments, files: &Files) -> Result<String, CliError> {
    let config = config_text(&arguments.config, files)?;
    let options = BridgeOptions {
        card: arguments.listen(),
        sender: arguments.sender(),
        clients: SocketAddr::new(arguments.host, arguments.port),
        origins: Origins::new(&arguments.origin)?,
    };
    let recording = arguments.replay.as_ref().map(|path| files.read(path)).transpose()?;
    let bridge = Bridge::open(&config, &options)?;
    let replay = recording
        .as_deref()
        .map(|bytes| Replay::new(bytes, bridge.config(), arguments.rate))
        .transpose()?;
    let (card, clients) = (bridge.card_address()?, bridge.client_address()?);
    remark(bridge.config().remarks.iter().map(|remark| remark.message.clone()));
    remark([
        format!(
            "packets from {} are received at udp {card}, {} bytes a frame",
            options.sender.map_or("any address".into(), |sender| sender.to_string()),
            bridge.config().frame_bytes()
        ),
        format!("pages connect to ws://{clients}; Ctrl-C ends"),
    ]);
    let shown = std::io::stderr().is_terminal();
    let stop = interrupted()?;
    let counts = thread::scope(|scope| {
        let sending = replay.as_ref().map(|replay| scope.spawn(|| replay.run(card, &stop)));
        let served = bridge.run(&stop, &mut |counts, clients| {
            if shown {
                remark([format!("clients: {clients}; {}", sentence(&counts))]);
            }
        });
        stop.store(true, Ordering::Relaxed);
        // A sender that panicked has told so.
        let sent = sending.and_then(|thread| thread.join().ok()).unwrap_or(Ok(()));
        let counts = served?;
        sent.map(|()| counts)
    })?;
    Ok(if arguments.json {
        format!("{:#}\n", json::result(&counts))
    } else {
        format!("{}\n", sentence(&counts))
    })
}

fn sentence(counts: &Counts) -> String {
    let Counts {
        frames,
        damaged_frames,
        packets,
        lost_packets,
        lost_bytes,
        reordered,
        duplicates,
        malformed,
        foreign,
        restarts,
        ..
    } = counts;
    let mut text = format!(
        "frames: {frames}, dropped: {damaged_frames}; packets: {packets}, lost: {lost_packets} ({lost_bytes} bytes)"
    );
    for (count, what) in [
        (reordered, "out of order"),
        (duplicates, "twice"),
        (malformed, "malformed"),
        (foreign, "from other senders"),
        (restarts, "starts of the card"),
    ] {
        if *count > 0 {
            text += &format!(", {what}: {count}");
        }
    }
    text
}
