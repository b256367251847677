//! From a connection to a socket.

// The answer of a handshake is a type of tungstenite's.
#![allow(clippy::result_large_err)]

use super::protocol::SUBPROTOCOLS;
use super::shared::Shared;
use crate::origin::Origins;
use std::io::{Read, Write};
use std::net::TcpStream;
use std::time::{Duration, Instant};
use tungstenite::WebSocket;
use tungstenite::handshake::HandshakeError;
use tungstenite::handshake::server::{
    ErrorResponse, Request as HttpRequest, Response, ServerHandshake,
};
use tungstenite::http::{HeaderValue, StatusCode, header};
use tungstenite::protocol::WebSocketConfig;

/// A handshake takes no longer.
const LONGEST_WAIT: Duration = Duration::from_secs(5);
/// Between two looks at a socket on which nothing happens.
const PAUSE: Duration = Duration::from_millis(10);
/// Bytes of the longest message a client may send.
const LONGEST: usize = 1 << 16;

/// A socket that counts.
#[derive(Debug)]
pub(super) struct Counted {
    stream: TcpStream,
    /// Bytes that came.
    pub(super) read: u64,
    /// Bytes that went.
    pub(super) written: u64,
}

impl Read for Counted {
    fn read(&mut self, buffer: &mut [u8]) -> std::io::Result<usize> {
        let count = self.stream.read(buffer)?;
        self.read += count as u64;
        Ok(count)
    }
}

impl Write for Counted {
    fn write(&mut self, bytes: &[u8]) -> std::io::Result<usize> {
        let count = self.stream.write(bytes)?;
        self.written += count as u64;
        Ok(count)
    }

    fn flush(&mut self) -> std::io::Result<()> {
        self.stream.flush()
    }
}

/// The socket of a connection and the protocol it speaks; none where it makes no handshake in time, or may not.
pub(super) fn handshake(
    stream: TcpStream,
    shared: &Shared,
) -> Option<(WebSocket<Counted>, &'static str)> {
    let until = Instant::now() + LONGEST_WAIT;
    stream.set_nonblocking(true).ok()?;
    // Messages are whole when they are written.
    stream.set_nodelay(true).ok()?;
    let config = WebSocketConfig::default()
        .read_buffer_size(4096)
        .write_buffer_size(1 << 16)
        .max_write_buffer_size(usize::MAX)
        .max_message_size(Some(LONGEST))
        .max_frame_size(Some(LONGEST));
    let mut spoken = None;
    let answer =
        |request: &HttpRequest, response| answer(request, response, &shared.origins, &mut spoken);
    let counted = Counted { stream, read: 0, written: 0 };
    let mut state = ServerHandshake::start(counted, answer, Some(config)).handshake();
    let socket = loop {
        match state {
            Ok(socket) => break socket,
            Err(HandshakeError::Failure(_)) => return None,
            Err(HandshakeError::Interrupted(middle)) => {
                if Instant::now() > until || shared.is_stopped() {
                    return None;
                }
                std::thread::sleep(PAUSE);
                state = middle.handshake();
            }
        }
    };
    Some((socket, spoken?))
}

/// The answer to a request for a socket, or why it gets none.
fn answer(
    request: &HttpRequest,
    mut response: Response,
    origins: &Origins,
    spoken: &mut Option<&'static str>,
) -> Result<Response, ErrorResponse> {
    let refuse = |status, why: &str| {
        let mut refused = ErrorResponse::new(Some(format!("{why}\n")));
        *refused.status_mut() = status;
        Err(refused)
    };
    let origin = request.headers().get(header::ORIGIN).map(|origin| origin.to_str().unwrap_or(""));
    if !origins.allow(origin) {
        return refuse(
            StatusCode::FORBIDDEN,
            "pages of this origin may not connect; --origin allows one",
        );
    }
    let offered: Vec<&str> = request
        .headers()
        .get_all(header::SEC_WEBSOCKET_PROTOCOL)
        .iter()
        .flat_map(|value| value.to_str().unwrap_or("").split(','))
        .map(str::trim)
        .collect();
    let Some(name) = SUBPROTOCOLS.into_iter().find(|name| offered.contains(name)) else {
        return refuse(
            StatusCode::BAD_REQUEST,
            "expected a subprotocol foxglove.sdk.v1 or foxglove.websocket.v1",
        );
    };
    response.headers_mut().insert(header::SEC_WEBSOCKET_PROTOCOL, HeaderValue::from_static(name));
    *spoken = Some(name);
    Ok(response)
}
