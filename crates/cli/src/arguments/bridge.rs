//! What `bridge` takes.

use clap::Args;
use std::net::SocketAddr;
use std::path::PathBuf;

/// Arguments of `bridge`.
#[derive(Debug, Args)]
#[command(after_help = "\
The card sends UDP packets in raw mode to 192.168.33.30, port 4098, once it was told so by mmWave Studio or DCA1000EVM_CLI_Control; this \
machine needs that address on the card's network interface. Pages connect to ws://127.0.0.1:8417, such as the page Live of the demo. A \
frame that lacks packets is dropped and counted.
Pages of servers on this machine may connect. Others are named by --origin; pages from files have the origin null, and so has any page \
that wants it.")]
pub struct BridgeArguments {
    /// The board's configuration (.cfg), which tells how large frames are.
    #[arg(long, value_name = "CFG")]
    pub config: PathBuf,
    /// Port that pages connect to; 0 for any that is free.
    #[arg(long, default_value_t = 8417)]
    pub port: u16,
    /// Address that pages connect to; those of other machines reach it where it is not 127.0.0.1.
    #[arg(long, value_name = "ADDRESS", default_value = "127.0.0.1")]
    pub host: std::net::IpAddr,
    /// Address and port that the card sends to.
    #[arg(long, value_name = "ADDRESS:PORT", default_value = "0.0.0.0:4098")]
    pub listen: SocketAddr,
    /// A page beside those of this machine that may connect, such as `https://example.org`; can be given again.
    #[arg(long, value_name = "ORIGIN")]
    pub origin: Vec<String>,
    /// A recording (.bin) that is sent over and over in place of a card, to the address of --listen.
    #[arg(long, value_name = "BIN")]
    pub replay: Option<PathBuf>,
    /// Times the pace of the configuration at which a recording is sent.
    #[arg(long, default_value_t = 1.0, requires = "replay")]
    pub rate: f64,
    /// Print what came as JSON at the end.
    #[arg(long)]
    pub json: bool,
}
