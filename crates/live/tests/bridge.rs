//! The bridge over sockets of this machine.

#![allow(clippy::unwrap_used, clippy::panic)]

use boresight_core::Diagnose;
use boresight_live::LiveError;
use boresight_live::bridge::{Bridge, BridgeOptions, Counts, MOST_CLIENTS, Replay, write_header};
use boresight_live::origin::Origins;
use serde_json::Value;
use std::io::Write;
use std::net::{SocketAddr, TcpStream, UdpSocket};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread::{self, JoinHandle};
use std::time::Duration;
use tungstenite::client::IntoClientRequest;
use tungstenite::{Error, Message, WebSocket, client};

const CFG: &[u8] = include_bytes!("../../../recordings/awr1642/profile.cfg");
const BIN: &[u8] =
    include_bytes!("../../../recordings/awr1642/xwr16xx_crw_dca_module_2018_1015v2.bin");
const FRAME: usize = 131_072;
const PAYLOAD: usize = 1456;
const SLOWLY: Duration = Duration::from_millis(4);
const TEXT_LIMIT: Duration = Duration::from_secs(20);

struct Running {
    card: SocketAddr,
    clients: SocketAddr,
    stop: Arc<AtomicBool>,
    thread: JoinHandle<Result<Counts, LiveError>>,
}

fn options() -> BridgeOptions {
    let local = SocketAddr::from(([127, 0, 0, 1], 0));
    BridgeOptions { card: local, sender: None, clients: local, origins: Origins::default() }
}

fn start(options: &BridgeOptions) -> Running {
    let bridge = Bridge::open(CFG, options).unwrap();
    let (card, clients) = (bridge.card_address().unwrap(), bridge.client_address().unwrap());
    let stop = Arc::new(AtomicBool::new(false));
    let asked = stop.clone();
    let thread = thread::spawn(move || bridge.run(&asked, &mut |_, _| {}));
    Running { card, clients, stop, thread }
}

impl Running {
    fn end(self) -> Counts {
        self.stop.store(true, Ordering::Relaxed);
        self.thread.join().unwrap().unwrap()
    }

    fn connect(&self, origin: Option<&str>) -> Result<WebSocket<TcpStream>, Box<Error>> {
        let stream = TcpStream::connect(self.clients).unwrap();
        stream.set_read_timeout(Some(TEXT_LIMIT)).unwrap();
        let mut request = format!("ws://{}/", self.clients).into_client_request().unwrap();
        if let Some(origin) = origin {
            request.headers_mut().insert("Origin", origin.parse().unwrap());
        }
        match client(request, stream) {
            Ok((socket, _)) => Ok(socket),
            Err(tungstenite::HandshakeError::Failure(error)) => Err(Box::new(error)),
            Err(error) => panic!("{error}"),
        }
    }

    /// A client that has been greeted.
    fn greeted(&self) -> (WebSocket<TcpStream>, Value) {
        let mut socket = self.connect(None).unwrap();
        let Message::Text(text) = socket.read().unwrap() else { panic!("a hello") };
        let hello = serde_json::from_str(&text).unwrap();
        (socket, hello)
    }
}

/// Packets of a card from its start.
fn packets(samples: &[u8]) -> Vec<Vec<u8>> {
    samples
        .chunks(PAYLOAD)
        .zip(1_u32..)
        .map(|(chunk, number)| {
            let offset = u64::from(number - 1) * PAYLOAD as u64;
            [&write_header(number, offset)[..], chunk].concat()
        })
        .collect()
}

/// Sends packets, sixteen at a time: a system drops what a program takes too slowly.
fn send<'a>(to: SocketAddr, packets: impl IntoIterator<Item = &'a Vec<u8>>, pause: Duration) {
    let socket = UdpSocket::bind("127.0.0.1:0").unwrap();
    for (k, packet) in packets.into_iter().enumerate() {
        socket.send_to(packet, to).unwrap();
        if k % 16 == 15 {
            thread::sleep(pause);
        }
    }
}

/// The next frame: its number and samples. What is told between goes to `told`.
fn frame(socket: &mut WebSocket<TcpStream>, told: &mut Vec<Value>) -> Option<(u64, Vec<u8>)> {
    loop {
        match socket.read() {
            Ok(Message::Binary(bytes)) => {
                let (number, samples) = bytes.split_first_chunk().unwrap();
                return Some((u64::from_le_bytes(*number), samples.to_vec()));
            }
            // Half a minute without a frame is too long.
            Ok(Message::Text(_)) if told.len() >= 30 => return None,
            Ok(Message::Text(text)) => told.push(serde_json::from_str(&text).unwrap()),
            Ok(_) => {}
            Err(_) => return None,
        }
    }
}

/// Whether samples are those of a frame of the recording.
fn is_recorded(number: u64, samples: &[u8]) -> bool {
    let at = number as usize * FRAME % BIN.len();
    samples == &BIN[at..at + FRAME]
}

#[test]
fn a_recording_comes_frame_by_frame() {
    let bridge = start(&options());
    let (mut socket, hello) = bridge.greeted();
    assert_eq!(hello["type"], "hello");
    assert_eq!(hello["frameBytes"], FRAME);
    assert_eq!(hello["frameIntervalS"], 0.04);
    assert_eq!(hello["config"].as_str().unwrap().as_bytes(), CFG);
    let (to, ended) = (bridge.card, Arc::new(AtomicBool::new(false)));
    let sender = thread::spawn({
        let ended = ended.clone();
        move || {
            let config = boresight_formats::RadarConfig::parse(CFG).unwrap();
            Replay::new(BIN, &config, 2.0).unwrap().run(to, &ended)
        }
    });
    // A busy machine may lose some.
    let mut last = None;
    for _ in 0..20 {
        let (number, samples) = frame(&mut socket, &mut vec![]).unwrap();
        assert!(last.is_none_or(|last| number > last), "{number} after {last:?}");
        assert!(is_recorded(number, &samples), "{number}");
        last = Some(number);
    }
    ended.store(true, Ordering::Relaxed);
    sender.join().unwrap().unwrap();
    let counts = bridge.end();
    assert!(counts.frames >= 20 && counts.malformed == 0 && counts.restarts == 0, "{counts:?}");
    // The client is told that the bridge ends.
    while let Ok(message) = socket.read() {
        if let Message::Close(reason) = message {
            assert_eq!(reason.unwrap().reason.as_str(), "the bridge ends");
            return;
        }
    }
    panic!("no farewell");
}

#[test]
fn loss_order_and_copies_are_told() {
    let bridge = start(&options());
    let (mut socket, _) = bridge.greeted();
    let mut sent = packets(BIN);
    // Two packets of frame 3 are swapped, one of frame 4 comes twice, one of frame 5 not at all.
    let first = |frame: usize| (frame * FRAME).div_ceil(PAYLOAD);
    sent.swap(first(3) + 10, first(3) + 20);
    sent.insert(first(4) + 10, sent[first(4) + 9].clone());
    sent.remove(first(5) + 10);
    send(bridge.card, &sent, SLOWLY);
    let mut told = vec![];
    for expected in [0, 1, 2, 3, 4, 6, 7] {
        let (number, samples) = frame(&mut socket, &mut told).unwrap();
        assert_eq!(number, expected);
        assert!(is_recorded(number, &samples), "{number}");
    }
    // The next client is told in its hello, this one once a second.
    let status = loop {
        let Ok(Message::Text(text)) = socket.read() else { continue };
        let status: Value = serde_json::from_str(&text).unwrap();
        if status["sentFrames"] == 7 && status["counts"]["frames"] == 7 {
            break status;
        }
    };
    assert_eq!(status["type"], "status");
    assert_eq!(status["skippedFrames"], 0);
    let (_, hello) = bridge.greeted();
    assert_eq!(hello["counts"], status["counts"]);
    let counts = bridge.end();
    let expected = Counts {
        packets: sent.len() as u64 - 1,
        bytes: (BIN.len() - PAYLOAD) as u64,
        lost_packets: 1,
        lost_bytes: PAYLOAD as u64,
        reordered: 10,
        duplicates: 1,
        frames: 7,
        damaged_frames: 1,
        ..Counts::default()
    };
    assert_eq!(counts, expected);
    assert_eq!(status["counts"], serde_json::to_value(counts).unwrap());
}

#[test]
fn a_slow_client_loses_whole_frames_and_costs_the_others_none() {
    let bridge = start(&options());
    let ((mut slow, _), (mut quick, _)) = (bridge.greeted(), bridge.greeted());
    let repeated: Vec<u8> = (0..60).flat_map(|_| BIN).copied().collect();
    let sent = packets(&repeated);
    let to = bridge.card;
    let sender = thread::spawn(move || send(to, &sent, SLOWLY / 4));
    let mut seen = 0;
    loop {
        let (number, samples) = frame(&mut quick, &mut vec![]).unwrap();
        assert!(is_recorded(number, &samples), "{number}");
        seen += 1;
        if number >= 440 {
            break;
        }
    }
    sender.join().unwrap();
    // It reads only now, and finds whole frames with gaps between them.
    let (mut last, mut gaps, mut got) = (None, 0, 0_u64);
    let skipped = loop {
        match slow.read().unwrap() {
            Message::Binary(bytes) => {
                let (number, samples) = bytes.split_first_chunk().unwrap();
                let number = u64::from_le_bytes(*number);
                assert!(is_recorded(number, samples), "{number}");
                gaps += last.map_or(0, |last| number - last - 1);
                (last, got) = (Some(number), got + 1);
            }
            Message::Text(text) => {
                let status: Value = serde_json::from_str(&text).unwrap();
                let skipped = status["skippedFrames"].as_u64().unwrap();
                if status["sentFrames"] == got && skipped > 0 {
                    break skipped;
                }
            }
            _ => {}
        }
    };
    let counts = bridge.end();
    assert_eq!(got + skipped, counts.frames);
    assert!(gaps > 0 && got < seen, "{got} frames, {gaps} passed over; the quick one got {seen}");
}

#[test]
fn only_pages_that_may_are_let_in() {
    let bridge = start(&options());
    for origin in ["https://evil.example", "null", "http://localhost.evil.example"] {
        let error = *bridge.connect(Some(origin)).unwrap_err();
        assert!(matches!(&error, Error::Http(response) if response.status() == 403), "{error}");
    }
    for origin in [None, Some("http://localhost:4173"), Some("http://127.0.0.1")] {
        assert!(bridge.connect(origin).is_ok(), "{origin:?}");
    }
    bridge.end();
    let named = Origins::new(&["https://radar.example".into()]).unwrap();
    let bridge = start(&BridgeOptions { origins: named, ..options() });
    assert!(bridge.connect(Some("https://radar.example")).is_ok());
    assert!(bridge.connect(Some("https://radar.example:444")).is_err());
    bridge.end();
}

#[test]
fn addresses_and_configurations_that_cannot_be_are_refused() {
    let bridge = start(&options());
    let taken = [
        BridgeOptions { card: bridge.card, ..options() },
        BridgeOptions { clients: bridge.clients, ..options() },
    ];
    for options in taken {
        let error = Bridge::open(CFG, &options).err().unwrap();
        assert!(matches!(error, LiveError::Listen { .. }), "{error}");
        assert_eq!(error.code(), "cannot-listen");
    }
    bridge.end();
    let error = Bridge::open(b"sensorStart", &options()).err().unwrap();
    assert_eq!(error.code(), "config-incomplete");
}

#[test]
fn many_clients_and_those_that_say_nothing_do_no_harm() {
    let bridge = start(&options());
    let silent: Vec<TcpStream> =
        (0..4).map(|_| TcpStream::connect(bridge.clients).unwrap()).collect();
    let greeted: Vec<_> = (0..8).map(|_| bridge.greeted()).collect();
    drop(greeted);
    let (mut socket, _) = bridge.greeted();
    send(bridge.card, &packets(&BIN[..2 * FRAME]), SLOWLY);
    assert_eq!(frame(&mut socket, &mut vec![]).unwrap().0, 0);
    drop(silent);
    bridge.end();
}

#[test]
fn packets_of_other_senders_are_dropped_and_counted() {
    let local = "127.0.0.1".parse().unwrap();
    for (sender, expected) in [("127.0.0.2".parse().unwrap(), 0), (local, 1)] {
        let bridge = start(&BridgeOptions { sender: Some(sender), ..options() });
        let (mut socket, _) = bridge.greeted();
        send(bridge.card, &packets(&BIN[..FRAME]), SLOWLY);
        // The status says when all packets have come.
        let status = loop {
            let Ok(Message::Text(text)) = socket.read() else { continue };
            let status: Value = serde_json::from_str(&text).unwrap();
            let counts = &status["counts"];
            if counts["foreign"].as_u64().unwrap() + counts["packets"].as_u64().unwrap() > 90 {
                break status;
            }
        };
        let counts = bridge.end();
        assert_eq!(status["counts"]["frames"], expected, "{sender}");
        assert_eq!((counts.packets == 0, counts.foreign == 0), (expected == 0, expected == 1));
    }
}

#[test]
fn half_open_connections_take_no_place_of_a_client() {
    let bridge = start(&options());
    let half_open: Vec<TcpStream> = (0..300)
        .map(|k| {
            let mut stream = TcpStream::connect(bridge.clients).unwrap();
            // The server may have closed it for a later one.
            let _ = stream.write_all(&b"GET / HTTP/1.1\r\nX: "[..k % 20]);
            stream
        })
        .collect();
    let (mut socket, _) = bridge.greeted();
    send(bridge.card, &packets(&BIN[..2 * FRAME]), SLOWLY);
    assert!(frame(&mut socket, &mut vec![]).is_some());
    drop(half_open);
    bridge.end();
}

#[test]
fn clients_that_never_read_give_way_to_a_new_one() {
    let bridge = start(&options());
    // None of them answers a ping.
    let silent: Vec<_> = (0..MOST_CLIENTS).map(|_| bridge.connect(None).unwrap()).collect();
    let error = *bridge.connect(None).unwrap_err();
    assert!(matches!(&error, Error::Http(response) if response.status() == 503), "{error}");
    let mut socket = loop {
        if let Ok(socket) = bridge.connect(None) {
            break socket;
        }
        thread::sleep(SLOWLY);
    };
    send(bridge.card, &packets(&BIN[..2 * FRAME]), SLOWLY);
    assert!(frame(&mut socket, &mut vec![]).is_some());
    drop(silent);
    bridge.end();
}

#[test]
fn messages_that_are_too_long_end_their_own_connection_alone() {
    let bridge = start(&options());
    let (mut socket, _) = bridge.greeted();
    for bytes in
        [&b"\x82\xff\x7f\xff\xff\xff\xff\xff\xff\xff\0\0\0\0"[..], &[0xff; 1000], b"\x81\x01x"]
    {
        let (mut hostile, _) = bridge.greeted();
        hostile.get_mut().write_all(bytes).unwrap();
        while hostile.read().is_ok() {}
    }
    send(bridge.card, &packets(&BIN[..2 * FRAME]), SLOWLY);
    assert!(frame(&mut socket, &mut vec![]).is_some());
    bridge.end();
}
