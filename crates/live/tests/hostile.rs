//! Connections that break the rules: neither do they hold the server up, nor does it grow.
#![allow(clippy::unwrap_used)]

mod viewer;

use boresight_live::foxglove::ServeOptions;
use serde_json::json;
use std::io::{Read, Write};
use std::net::{SocketAddr, TcpStream};
use std::time::{Duration, Instant};
use tungstenite::Message;
use viewer::{Viewer, connect, drive, sees_all, serve};

const V1: &str = "foxglove.websocket.v1";
const FAST: f64 = 1e6;

/// Sends bytes to a connection and reads what comes until it is closed.
fn raw(address: SocketAddr, bytes: &[u8]) -> String {
    let mut stream = TcpStream::connect(address).unwrap();
    stream.set_read_timeout(Some(Duration::from_secs(30))).unwrap();
    // The other end may close before it has read all.
    let _ = stream.write_all(bytes);
    let _ = stream.shutdown(std::net::Shutdown::Write);
    let mut answer = vec![];
    let _ = stream.read_to_end(&mut answer);
    String::from_utf8_lossy(&answer).into_owned()
}

#[test]
fn what_is_no_handshake_is_turned_away() {
    let log = drive(100);
    let options = ServeOptions { rate: FAST, ..ServeOptions::default() };
    let counts = serve(&log, options, |address| {
        let noise: Vec<u8> =
            (0..100_000_u32).map(|k| (k.wrapping_mul(2_654_435_761) >> 24) as u8).collect();
        for bytes in [
            &b""[..],
            b"\r\n\r\n",
            b"GET / HTTP/1.1\r\nHost: x\r\n\r\n",
            b"POST / HTTP/1.1\r\nHost: x\r\n\r\n",
            &noise,
            &[b'a'; 1 << 20],
        ] {
            assert!(!raw(address, bytes).contains(" 101 "), "{:?}", &bytes[..bytes.len().min(20)]);
        }
        let lines = "X: y\r\n".repeat(200_000);
        raw(address, format!("GET / HTTP/1.1\r\n{lines}").as_bytes());

        let refused = connect(address, V1, Some("https://example.com")).unwrap_err();
        assert!(refused.contains("403"), "{refused}");
        let refused = connect(address, "chat", None).unwrap_err();
        assert!(refused.contains("400"), "{refused}");
        assert!(connect(address, V1, Some("http://localhost:8080")).is_ok());
        let both = connect(address, "chat, foxglove.sdk.v1", None);
        assert!(both.is_ok(), "{both:?}");
        sees_all(address, 100);
    });
    assert_eq!((counts.clients, counts.rejected), (3, 9));
}

#[test]
fn messages_that_make_no_sense_are_answered_and_huge_ones_end_the_connection() {
    let log = drive(40);
    serve(&log, ServeOptions { rate: FAST, ..ServeOptions::default() }, |address| {
        let mut viewer = Viewer::new(address, V1);
        for text in [
            "",
            "null",
            "{",
            "[[[[[[[[[[[[[[[[[[[[",
            r#"{"op":"subscribe"}"#,
            r#"{"op":"subscribe","subscriptions":[{"id":-1,"channelId":0}]}"#,
            r#"{"op":"subscribe","subscriptions":[{"id":1,"channelId":18446744073709551615}]}"#,
            r#"{"op":"fly"}"#,
            r#"{"op":"unsubscribe","subscriptionIds":[7]}"#,
        ] {
            let before = viewer.statuses.len();
            viewer.socket.send(Message::Text(text.into())).unwrap();
            viewer.until(|viewer| viewer.statuses.len() > before);
        }
        for bytes in [&[][..], &[3], &[3, 0, 0, 0], &[1, 2, 3, 4, 5], &[0xff; 64], &[3; 60_000]] {
            let before = viewer.statuses.len();
            viewer.socket.send(Message::Binary(bytes.to_vec().into())).unwrap();
            viewer.until(|viewer| viewer.statuses.len() > before);
        }
        // The same number twice.
        viewer.subscribe(|topic| topic == "/car/motion");
        let before = viewer.statuses.len();
        viewer.subscribe(|topic| topic == "/car/motion");
        viewer.until(|viewer| viewer.statuses.len() > before);

        // One that is longer than any that is needed; a length beyond all memory.
        let mut huge = connect(address, V1, None).unwrap();
        let _ = huge.send(Message::Text("x".repeat(1 << 20).into()));
        let ended = (0..100).any(|_| huge.read().is_err());
        assert!(ended);
        let mut claims = connect(address, V1, None).unwrap();
        let header = [0x82, 0xff, 0x7f, 0xff, 0xff, 0xff, 0xff, 0xff, 0xff, 0xff, 0, 0, 0, 0];
        claims.get_mut().write_all(&header).unwrap();
        assert!((0..100).any(|_| claims.read().is_err()));
        sees_all(address, 40);
    });
}

#[test]
fn who_asks_and_does_not_read_is_cut_off() {
    let log = drive(10);
    serve(&log, ServeOptions { rate: FAST, ..ServeOptions::default() }, |address| {
        let mut asks = connect(address, V1, None).unwrap();
        let ask = json!({ "op": "getParameters", "parameterNames": [], "id": "x".repeat(30_000) });
        let stop = Instant::now() + Duration::from_secs(60);
        asks.get_mut().set_write_timeout(Some(Duration::from_secs(30))).unwrap();
        while asks.send(Message::Text(ask.to_string().into())).is_ok() {
            assert!(Instant::now() < stop, "it goes on taking questions");
        }
        sees_all(address, 10);
    });
}

#[test]
fn a_viewer_that_does_not_read_loses_whole_messages_and_is_told_and_others_lose_none() {
    let log = drive(20_000);
    // Room for all that the quick viewer asks for, and a third of what the slow one does.
    let options = ServeOptions { rate: FAST, queue: 30_000, ..ServeOptions::default() };
    let counts = serve(&log, options, |address| {
        let mut slow = Viewer::new(address, V1);
        slow.subscribe(|_| true);
        let mut quick = Viewer::new(address, "foxglove.sdk.v1");
        quick.subscribe(|topic| topic == "/radar/1/frame");
        quick.until(|viewer| viewer.of("/radar/1/frame").len() == 10_000);
        // Each message that comes is read as JSON: none is cut short.
        slow.until(|viewer| viewer.statuses.iter().any(|status| status["id"] == "lost"));
        assert!(slow.of("/radar/1/detections").len() < 10_000);
    });
    assert!(counts.lost > 1000, "{counts:?}");
}

#[test]
fn half_open_and_silent_connections_leave_places_for_viewers() {
    let log = drive(100);
    serve(&log, ServeOptions { rate: FAST, ..ServeOptions::default() }, |address| {
        let half_open: Vec<TcpStream> = (0..300)
            .map(|k| {
                let mut stream = TcpStream::connect(address).unwrap();
                // The server may have closed it for a later one.
                let _ = stream.write_all(&b"GET / HTTP/1.1\r\nX: "[..k % 20]);
                stream
            })
            .collect();
        sees_all(address, 100);
        // These have places, but answer no ping.
        let mut silent = vec![];
        while let Ok(socket) = connect(address, V1, None) {
            silent.push(socket);
            assert!(silent.len() <= 17);
        }
        while connect(address, V1, None).is_err() {
            std::thread::sleep(Duration::from_millis(20));
        }
        // It waits for the topics.
        Viewer::new(address, V1);
        drop(half_open);
    });
}

#[test]
fn requests_of_one_viewer_neither_disconnect_nor_delay_another() {
    const SDK: &str = "foxglove.sdk.v1";
    let log = drive(10);
    serve(&log, ServeOptions { rate: FAST, ..ServeOptions::default() }, |address| {
        let mut idle = Viewer::new(address, SDK);
        let mut eager = Viewer::new(address, SDK);
        // More than the sockets in between hold, while the other viewer does not read.
        for k in 0..600 {
            eager.control(1, 1.0, None, &format!("{k:060000}"));
            let known = eager.playing.len();
            eager.until(|viewer| viewer.playing.len() > known);
        }
        let last = format!("{:060000}", 599);
        idle.until(|viewer| viewer.playing.last().is_some_and(|playing| playing.4 == last));
    });
}
