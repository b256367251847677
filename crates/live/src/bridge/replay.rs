//! A recording sent as the card would send it.

use super::packet::write_header;
use crate::error::LiveError;
use boresight_formats::{Capture, RadarConfig};
use std::net::{IpAddr, Ipv4Addr, Ipv6Addr, SocketAddr, UdpSocket};
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread;
use std::time::{Duration, Instant};

/// Samples of a packet, as the card sends them.
const SAMPLE_BYTES: usize = 1456;
/// How long the sender sleeps at most.
const TICK: Duration = Duration::from_millis(2);

/// The address that a replay sends to, from its own port at the same IP address: that of the bridge, or loopback for a
/// bridge that listens at all addresses.
pub fn replay_target(bridge: SocketAddr) -> SocketAddr {
    let ip = match bridge.ip() {
        IpAddr::V4(ip) if ip.is_unspecified() => Ipv4Addr::LOCALHOST.into(),
        IpAddr::V6(ip) if ip.is_unspecified() => Ipv6Addr::LOCALHOST.into(),
        ip => ip,
    };
    SocketAddr::new(ip, bridge.port())
}

/// The frames of a recording, sent over and over.
pub struct Replay<'a> {
    /// Whole frames.
    samples: &'a [u8],
    bytes_per_s: f64,
}

impl<'a> Replay<'a> {
    /// The whole frames of a recording, at `rate` times the pace of its configuration.
    ///
    /// # Errors
    /// Those of laying the configuration over the recording, and of a rate that is not above 0.
    pub fn new(recording: &'a [u8], config: &RadarConfig, rate: f64) -> Result<Self, LiveError> {
        let positive = boresight_math::error::check_range("rate", rate, f64::MIN_POSITIVE, 1e6);
        positive.map_err(boresight_formats::FormatError::from)?;
        let capture = Capture::new(recording, config)?;
        let samples = &recording[..recording.len() - capture.trailing_bytes()];
        let frame_bytes = config.frame_bytes() as f64;
        let bytes_per_s = rate * frame_bytes / config.waveform.frame_interval_s.max(1e-4);
        Ok(Self { samples, bytes_per_s })
    }

    /// Sends until `stop`.
    ///
    /// # Errors
    /// [`LiveError::Socket`] where nothing can be sent.
    pub fn run(&self, to: SocketAddr, stop: &AtomicBool) -> Result<(), LiveError> {
        let failed = |error: std::io::Error| LiveError::Socket {
            what: "the replay",
            given: error.to_string(),
        };
        let to = replay_target(to);
        let socket = UdpSocket::bind((to.ip(), 0)).map_err(failed)?;
        let begun = Instant::now();
        let (mut sequence, mut offset) = (1_u32, 0_u64);
        let mut packet = Vec::with_capacity(1500);
        while !stop.load(Ordering::Relaxed) {
            if offset as f64 > begun.elapsed().as_secs_f64() * self.bytes_per_s {
                thread::sleep(TICK);
                continue;
            }
            packet.clear();
            packet.extend(write_header(sequence, offset));
            let at = (offset % self.samples.len() as u64) as usize;
            let repeated = self.samples[at..].iter().chain(self.samples).copied();
            packet.extend(repeated.take(SAMPLE_BYTES));
            socket.send_to(&packet, to).map_err(failed)?;
            sequence = sequence.wrapping_add(1).max(1);
            offset += (packet.len() - super::HEADER_BYTES) as u64;
        }
        Ok(())
    }
}
