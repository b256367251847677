//! The sockets of a bridge.

use super::clients::{LISTEN, Mailbox, STALLED, message, serve};
use super::frames::{Counts, FrameAssembler};
use super::messages::{Hello, text};
use crate::LiveError;
use crate::origin::Origins;
use boresight_formats::RadarConfig;
use std::io::ErrorKind;
use std::net::{Shutdown, SocketAddr, TcpListener, TcpStream, UdpSocket};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, PoisonError};
use std::thread;
use std::time::{Duration, Instant};
use tungstenite::handshake::server::{Callback, ErrorResponse, Request, Response};
use tungstenite::http::{HeaderValue, StatusCode, header::ORIGIN};
use tungstenite::protocol::WebSocketConfig;
use tungstenite::{Message, accept_hdr_with_config};

/// More clients than somebody looks at.
const MOST_CLIENTS: usize = 16;
/// A client has nothing to say that is longer.
const MOST_SAID: usize = 1 << 16;
/// How long a call waits before it looks whether the bridge ends.
const PATIENCE: Duration = Duration::from_millis(50);
/// How often counts are told.
const REPORT_EVERY: Duration = Duration::from_secs(1);

/// Where a bridge listens, and whom it serves.
#[derive(Debug, Clone)]
pub struct BridgeOptions {
    /// Where the card sends its packets: port 4098 unless it was told otherwise.
    pub card: SocketAddr,
    /// Where clients connect.
    pub clients: SocketAddr,
    /// Pages that may.
    pub origins: Origins,
}

/// A bridge that listens.
pub struct Bridge {
    udp: UdpSocket,
    listener: TcpListener,
    origins: Origins,
    config: RadarConfig,
    config_text: String,
    assembler: FrameAssembler,
}

/// A client that is served.
struct Client {
    mailbox: Arc<Mailbox>,
    stream: TcpStream,
    thread: thread::JoinHandle<()>,
}

/// Clients as the threads of a bridge share them.
#[derive(Default)]
struct Clients(Mutex<Vec<Client>>);

impl Clients {
    fn each(&self, tell: impl Fn(&Mailbox)) {
        let clients = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        clients.iter().for_each(|client| tell(&client.mailbox));
    }

    /// How many there are, once those that went are left out.
    fn count(&self) -> usize {
        let mut clients = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        clients.retain(|client| !client.thread.is_finished());
        clients.len()
    }

    fn add(&self, client: Client) {
        self.0.lock().unwrap_or_else(PoisonError::into_inner).push(client);
    }

    /// Ends all; those that take nothing are cut off.
    fn close(&self) {
        let clients = std::mem::take(&mut *self.0.lock().unwrap_or_else(PoisonError::into_inner));
        clients.iter().for_each(|client| client.mailbox.close());
        let until = Instant::now() + Duration::from_secs(1);
        for Client { stream, thread, .. } in clients {
            while !thread.is_finished() && Instant::now() < until {
                thread::sleep(PATIENCE / 10);
            }
            // Of one that went by itself there is nothing to shut.
            let _ = stream.shutdown(Shutdown::Both);
            // A thread that panicked has told so on the standard error.
            let _ = thread.join();
        }
    }
}

impl Bridge {
    /// Listens for the card and for clients; frames have the size that the board's configuration says.
    ///
    /// # Errors
    /// Those of the configuration; [`LiveError::FrameSize`]; [`LiveError::Listen`] for an address that is taken or not
    /// this machine's.
    pub fn open(config: &[u8], options: &BridgeOptions) -> Result<Self, LiveError> {
        let parsed = RadarConfig::parse(config)?;
        let assembler = FrameAssembler::new(parsed.frame_bytes())?;
        let refused = |what, address: SocketAddr| {
            move |error: std::io::Error| LiveError::Listen {
                what,
                address: address.to_string(),
                given: error.to_string(),
            }
        };
        let udp = UdpSocket::bind(options.card).map_err(refused("UDP", options.card))?;
        let listener =
            TcpListener::bind(options.clients).map_err(refused("WebSocket", options.clients))?;
        udp.set_read_timeout(Some(PATIENCE)).map_err(socket("the card"))?;
        listener.set_nonblocking(true).map_err(socket("clients"))?;
        Ok(Self {
            udp,
            listener,
            origins: options.origins.clone(),
            config: parsed,
            config_text: String::from_utf8_lossy(config).into_owned(),
            assembler,
        })
    }

    /// The configuration.
    pub fn config(&self) -> &RadarConfig {
        &self.config
    }

    /// Where packets of the card are received.
    ///
    /// # Errors
    /// [`LiveError::Socket`] where the system does not say.
    pub fn card_address(&self) -> Result<SocketAddr, LiveError> {
        self.udp.local_addr().map_err(socket("the card"))
    }

    /// Where clients connect.
    ///
    /// # Errors
    /// [`LiveError::Socket`] where the system does not say.
    pub fn client_address(&self) -> Result<SocketAddr, LiveError> {
        self.listener.local_addr().map_err(socket("clients"))
    }

    /// Serves until `stop`, and gives what came. `report` is called once a second with what came so far and the number
    /// of clients.
    ///
    /// # Errors
    /// [`LiveError::Socket`] where the card's socket fails.
    pub fn run(
        self,
        stop: &AtomicBool,
        report: &mut dyn FnMut(Counts, usize),
    ) -> Result<Counts, LiveError> {
        let Self { udp, listener, origins, config, config_text, mut assembler } = self;
        let clients = Clients::default();
        let told = Mutex::new(Counts::default());
        let ended = AtomicBool::new(false);
        let ends = || stop.load(Ordering::Relaxed) || ended.load(Ordering::Relaxed);
        let result = thread::scope(|scope| {
            scope.spawn(|| {
                while !ends() {
                    let Ok((stream, _)) = listener.accept() else {
                        thread::sleep(PATIENCE);
                        continue;
                    };
                    if clients.count() >= MOST_CLIENTS {
                        continue;
                    }
                    let counts = *told.lock().unwrap_or_else(PoisonError::into_inner);
                    let hello = text(&Hello {
                        version: 1,
                        frame_bytes: config.frame_bytes(),
                        frame_interval_s: config.waveform.frame_interval_s,
                        config: &config_text,
                        counts,
                    });
                    if let Some(client) = welcome(stream, &origins, hello) {
                        clients.add(client);
                    }
                }
            });
            let result = receive(&udp, &mut assembler, &clients, &told, stop, report);
            ended.store(true, Ordering::Relaxed);
            result
        });
        clients.close();
        assembler.finish();
        result.map(|()| assembler.counts())
    }
}

/// Receives packets and hands frames out until `stop`.
fn receive(
    udp: &UdpSocket,
    assembler: &mut FrameAssembler,
    clients: &Clients,
    told: &Mutex<Counts>,
    stop: &AtomicBool,
    report: &mut dyn FnMut(Counts, usize),
) -> Result<(), LiveError> {
    let mut buffer = vec![0; 1 << 16];
    let mut reported = Instant::now();
    while !stop.load(Ordering::Relaxed) {
        match udp.recv(&mut buffer) {
            Ok(length) => {
                for frame in assembler.push(&buffer[..length]) {
                    let message = message(&frame);
                    let counts = assembler.counts();
                    clients.each(|mailbox| mailbox.leave(message.clone(), counts));
                }
            }
            // The last is what a port that nobody listens on answers to an answer.
            Err(error)
                if matches!(
                    error.kind(),
                    ErrorKind::WouldBlock
                        | ErrorKind::TimedOut
                        | ErrorKind::Interrupted
                        | ErrorKind::ConnectionReset
                ) => {}
            Err(error) => return Err(socket("the card")(error)),
        }
        if reported.elapsed() >= REPORT_EVERY {
            reported = Instant::now();
            let counts = assembler.counts();
            *told.lock().unwrap_or_else(PoisonError::into_inner) = counts;
            clients.each(|mailbox| mailbox.count(counts));
            report(counts, clients.count());
        }
    }
    Ok(())
}

/// A client in a thread of its own; `None` where none could be made. What it says first is read there, as a client may
/// take its time.
fn welcome(stream: TcpStream, origins: &Origins, hello: String) -> Option<Client> {
    stream.set_nonblocking(false).ok()?;
    stream.set_nodelay(true).ok()?;
    stream.set_read_timeout(Some(STALLED)).ok()?;
    stream.set_write_timeout(Some(STALLED)).ok()?;
    let mailbox = Arc::<Mailbox>::default();
    let (mine, origins) = (mailbox.clone(), origins.clone());
    let theirs = stream.try_clone().ok()?;
    let work = move || {
        let config = WebSocketConfig::default()
            .max_message_size(Some(MOST_SAID))
            .max_frame_size(Some(MOST_SAID));
        let Ok(mut socket) = accept_hdr_with_config(theirs, Door(&origins), Some(config)) else {
            return;
        };
        let listening = socket.get_ref().set_read_timeout(Some(LISTEN));
        if listening.is_ok() && socket.send(Message::Text(hello.into())).is_ok() {
            serve(socket, &mine);
        }
    };
    let thread = thread::Builder::new().name("bridge client".into()).spawn(work).ok()?;
    Some(Client { mailbox, stream, thread })
}

/// Lets a page in, or answers why not.
struct Door<'a>(&'a Origins);

impl Callback for Door<'_> {
    fn on_request(self, request: &Request, response: Response) -> Result<Response, ErrorResponse> {
        let allowed = match request.headers().get(ORIGIN).map(HeaderValue::to_str) {
            None => self.0.allow(None),
            Some(Ok(origin)) => self.0.allow(Some(origin)),
            Some(Err(_)) => false,
        };
        if allowed {
            return Ok(response);
        }
        let why = "this page may not read the radar: boresight bridge --origin\n";
        let mut refused = ErrorResponse::new(Some(why.into()));
        *refused.status_mut() = StatusCode::FORBIDDEN;
        Err(refused)
    }
}

fn socket(what: &'static str) -> impl FnOnce(std::io::Error) -> LiveError {
    move |error: std::io::Error| LiveError::Socket { what, given: error.to_string() }
}
