//! The handshake of a WebSocket, within a time limit, for connections that [`Admission`](crate::admission) has.

// The answer of a handshake is a type of tungstenite's.
#![allow(clippy::result_large_err)]

use crate::admission::Ticket;
use crate::origin::Origins;
use std::io::{Read, Write};
use std::net::TcpStream;
use std::sync::Arc;
use std::time::{Duration, Instant};
use tungstenite::WebSocket;
use tungstenite::handshake::HandshakeError;
use tungstenite::handshake::server::{ErrorResponse, Request, Response, ServerHandshake};
use tungstenite::http::{HeaderValue, StatusCode, header};
use tungstenite::protocol::WebSocketConfig;

/// Maximum duration of a handshake.
const LONGEST_WAIT: Duration = Duration::from_secs(5);
/// Pause between two attempts to read.
const PAUSE: Duration = Duration::from_millis(10);
/// Maximum size of a message from a client, in bytes.
const LONGEST: usize = 1 << 16;

/// A connection that counts its bytes and notes when the peer sends something.
#[derive(Debug)]
pub(crate) struct Connection {
    ticket: Arc<Ticket>,
    /// Number of bytes received.
    pub(crate) read: u64,
    /// Number of bytes sent.
    pub(crate) written: u64,
}

impl Connection {
    /// The socket below.
    pub(crate) fn stream(&self) -> &TcpStream {
        self.ticket.stream()
    }
}

impl Read for Connection {
    fn read(&mut self, buffer: &mut [u8]) -> std::io::Result<usize> {
        let count = self.stream().read(buffer)?;
        if count > 0 {
            self.read += count as u64;
            self.ticket.heard();
        }
        Ok(count)
    }
}

impl Write for Connection {
    fn write(&mut self, bytes: &[u8]) -> std::io::Result<usize> {
        let count = self.stream().write(bytes)?;
        self.written += count as u64;
        Ok(count)
    }

    fn flush(&mut self) -> std::io::Result<()> {
        self.stream().flush()
    }
}

/// Why a connection does not become a client.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Refusal {
    /// All places are taken by clients that are active.
    Full,
    /// There is no valid request in time, or its page or protocol is not accepted.
    Rejected,
}

/// What a server accepts.
pub(crate) struct Terms<'a> {
    /// Pages that may connect.
    pub(crate) origins: &'a Origins,
    /// Subprotocols, the preferred one first. If empty, none is required.
    pub(crate) protocols: &'a [&'static str],
    /// Whether the server ends.
    pub(crate) ends: &'a dyn Fn() -> bool,
}

/// Makes a connection a client. Returns its socket, which does not block, and its subprotocol, empty if none is
/// required.
pub(crate) fn handshake(
    ticket: Ticket,
    terms: &Terms<'_>,
) -> Result<(WebSocket<Connection>, &'static str), Refusal> {
    let until = Instant::now() + LONGEST_WAIT;
    let stream = ticket.stream();
    // Messages are written as a whole, so nothing is gained by collecting small packets.
    stream
        .set_nonblocking(true)
        .and_then(|()| stream.set_nodelay(true))
        .map_err(|_| Refusal::Rejected)?;
    let config = WebSocketConfig::default()
        .read_buffer_size(4096)
        .write_buffer_size(1 << 16)
        .max_write_buffer_size(usize::MAX)
        .max_message_size(Some(LONGEST))
        .max_frame_size(Some(LONGEST));
    let mut outcome = Err(Refusal::Rejected);
    let ticket = Arc::new(ticket);
    let connection = Connection { ticket: Arc::clone(&ticket), read: 0, written: 0 };
    let answer = |request: &Request, response| {
        let (answer, known) = answer(request, response, terms, || ticket.admit());
        outcome = known;
        answer
    };
    let mut state = ServerHandshake::start(connection, answer, Some(config)).handshake();
    let socket = loop {
        match state {
            Ok(socket) => break Some(socket),
            Err(HandshakeError::Failure(_)) => break None,
            Err(HandshakeError::Interrupted(middle)) => {
                if Instant::now() > until || (terms.ends)() {
                    break None;
                }
                std::thread::sleep(PAUSE);
                state = middle.handshake();
            }
        }
    };
    let protocol = outcome?;
    socket.map(|socket| (socket, protocol)).ok_or(Refusal::Rejected)
}

/// The answer to a request for a socket, with the subprotocol or the reason for a refusal.
fn answer(
    request: &Request,
    mut response: Response,
    terms: &Terms<'_>,
    admit: impl FnOnce() -> bool,
) -> (Result<Response, ErrorResponse>, Result<&'static str, Refusal>) {
    let refuse = |status, why: &str, refusal| {
        let mut refused = ErrorResponse::new(Some(format!("{why}\n")));
        *refused.status_mut() = status;
        (Err(refused), Err(refusal))
    };
    let headers = request.headers();
    let origin = headers.get(header::ORIGIN).map(|origin| origin.to_str().unwrap_or(""));
    if !terms.origins.allow(origin) {
        let why = "pages of this origin may not connect; --origin allows one";
        return refuse(StatusCode::FORBIDDEN, why, Refusal::Rejected);
    }
    let offered: Vec<&str> = headers
        .get_all(header::SEC_WEBSOCKET_PROTOCOL)
        .iter()
        .flat_map(|value| value.to_str().unwrap_or("").split(','))
        .map(str::trim)
        .collect();
    let protocol = match terms.protocols.iter().copied().find(|name| offered.contains(name)) {
        Some(name) => {
            let value = HeaderValue::from_static(name);
            response.headers_mut().insert(header::SEC_WEBSOCKET_PROTOCOL, value);
            name
        }
        None if terms.protocols.is_empty() => "",
        None => {
            let why = format!("expected the subprotocol {}", terms.protocols.join(" or "));
            return refuse(StatusCode::BAD_REQUEST, &why, Refusal::Rejected);
        }
    };
    if !admit() {
        let why = "all places are taken; try again later";
        return refuse(StatusCode::SERVICE_UNAVAILABLE, why, Refusal::Full);
    }
    (Ok(response), Ok(protocol))
}
