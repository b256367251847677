//! More connections than there is room for. In a process of its own, whose memory is measured.
#![allow(clippy::unwrap_used)]

mod viewer;

use boresight_live::foxglove::ServeOptions;
use std::io::Write;
use std::net::TcpStream;
use std::time::{Duration, Instant};
use viewer::{connect, drive, sees_all, serve};

const V1: &str = "foxglove.websocket.v1";
const FAST: f64 = 1e6;

/// Memory of this process that is in use, bytes; 0 where the system does not tell.
fn memory() -> usize {
    let statm = std::fs::read_to_string("/proc/self/statm").unwrap_or_default();
    let pages = statm.split_whitespace().nth(1).and_then(|pages| pages.parse::<usize>().ok());
    pages.unwrap_or_default() * 4096
}

#[test]
fn a_thousand_connections_neither_stop_it_nor_make_it_grow() {
    let log = drive(100);
    let options = ServeOptions { rate: FAST, clients: 8, ..ServeOptions::default() };
    let mut before = 0;
    let counts = serve(&log, options, |address| {
        before = memory();
        // Half-open ones hold the places until their time is up.
        let held: Vec<TcpStream> = (0..8).map(|_| TcpStream::connect(address).unwrap()).collect();
        for k in 0..1000 {
            let mut stream = TcpStream::connect(address).unwrap();
            if k % 2 == 0 {
                let _ = stream.write_all(b"GET / HTTP/1.1\r\n");
            }
        }
        drop(held);
        let until = Instant::now() + Duration::from_secs(60);
        while connect(address, V1, None).is_err() {
            assert!(Instant::now() < until, "no place came free");
            std::thread::sleep(Duration::from_millis(20));
        }
        sees_all(address, 100);
        let grown = memory().saturating_sub(before);
        assert!(grown < 64 << 20, "{grown} bytes more");
    });
    assert!(counts.refused + counts.rejected >= 1000, "{counts:?}");
}
