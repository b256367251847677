//! What `bridge` takes.

use boresight_live::bridge::replay_target;
use clap::Args;
use std::net::{IpAddr, Ipv4Addr, SocketAddr};
use std::path::PathBuf;

/// Factory setting of the card's address.
const CARD: IpAddr = IpAddr::V4(Ipv4Addr::new(192, 168, 33, 180));
/// Factory setting of the address that the card sends to.
const HOST: IpAddr = IpAddr::V4(Ipv4Addr::new(192, 168, 33, 30));
/// Factory setting of the port that the card sends to.
const PORT: u16 = 4098;

/// Arguments of `bridge`.
#[derive(Debug, Args)]
#[command(after_help = "\
The card sends UDP packets in raw mode to 192.168.33.30, port 4098, after mmWave Studio or DCA1000EVM_CLI_Control has configured it; \
this machine needs that address on the card's network interface. Frames with missing packets are dropped and counted.
Exposed by default: UDP 192.168.33.30:4098 (with --replay 127.0.0.1:4098), which accepts packets from the card's address alone; and \
TCP 127.0.0.1:8417, a WebSocket without authentication or encryption for up to 16 clients. UDP senders can be forged, so connect the card \
to an interface of its own. Whoever reaches the address of --host can read the radar.
Pages of servers on this machine may connect. --origin names others; pages from files have the origin null, and any page can take it.")]
pub struct BridgeArguments {
    /// The board's configuration: a .cfg file, or .mmwave.json of mmWave Studio. It gives the size of a frame.
    #[arg(long, value_name = "CFG")]
    pub config: PathBuf,
    /// Port that pages connect to; 0 for any that is free.
    #[arg(long, default_value_t = 8417)]
    pub port: u16,
    /// Address that pages connect to; other machines can connect unless it is 127.0.0.1.
    #[arg(long, value_name = "ADDRESS", default_value = "127.0.0.1")]
    pub host: IpAddr,
    /// Address and port that receive the card's packets; 192.168.33.30:4098 if absent, 127.0.0.1:4098 with --replay.
    #[arg(long, value_name = "ADDRESS:PORT")]
    pub listen: Option<SocketAddr>,
    /// Address of the card, or `any`; packets from other senders are dropped. 192.168.33.180 if absent, this machine with --replay.
    #[arg(long, value_name = "ADDRESS")]
    pub card: Option<Sender>,
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

/// A sender of packets.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Sender {
    /// Any address.
    Any,
    /// One address.
    Only(IpAddr),
}

impl std::str::FromStr for Sender {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, Self::Err> {
        match text {
            "any" => Ok(Self::Any),
            _ => text.parse().map(Self::Only).map_err(|_| "expected an IP address, or any".into()),
        }
    }
}

impl BridgeArguments {
    /// The address that receives packets.
    pub fn listen(&self) -> SocketAddr {
        let host = if self.replay.is_some() { Ipv4Addr::LOCALHOST.into() } else { HOST };
        self.listen.unwrap_or(SocketAddr::new(host, PORT))
    }

    /// The address whose packets are accepted; `None` for any.
    pub fn sender(&self) -> Option<IpAddr> {
        match self.card {
            Some(Sender::Any) => None,
            Some(Sender::Only(address)) => Some(address),
            None if self.replay.is_some() => Some(replay_target(self.listen()).ip()),
            None => Some(CARD),
        }
    }
}
