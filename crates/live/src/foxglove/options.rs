//! Options of the server.

use boresight_options::Described;
use serde::{Deserialize, Serialize};

/// How a drive is served.
#[derive(Debug, Clone, PartialEq, Described, Serialize, Deserialize)]
#[serde(default)]
pub struct ServeOptions {
    /// Address to listen at: that of this machine alone, or 0.0.0.0 for whoever reaches it.
    #[option(default = "127.0.0.1".into())]
    pub host: String,
    /// Port to listen at; 0 for any that is free.
    #[option(default = 8765)]
    pub port: u16,
    /// Times real time.
    #[option(default = 1.0, range = 0.01..=1e6)]
    pub rate: f64,
    /// Begin again after the end.
    #[serde(rename = "loop")]
    pub repeat: bool,
    /// Begin at once; by default when a viewer first asks for a topic.
    pub at_once: bool,
    /// Most viewers at a time.
    #[option(default = 16, range = 1..=1024)]
    pub clients: usize,
    /// Messages kept for a viewer that reads slowly, before further ones are lost to it.
    #[option(default = 8192, range = 16..=1e6)]
    pub queue: usize,
    /// Pages of this address may connect, beside those of this machine and of known viewers; * for all pages.
    pub origin: Option<String>,
}
