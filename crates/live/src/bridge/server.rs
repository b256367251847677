//! The sockets of a bridge.

use super::clients::{Mailbox, message, serve};
use super::frames::{Counts, FrameAssembler};
use super::messages::{Hello, text};
use crate::admission::{Admission, Ticket, isolated};
use crate::error::LiveError;
use crate::handshake::{Terms, handshake};
use crate::origin::Origins;
use boresight_formats::RadarConfig;
use std::io::ErrorKind;
use std::net::{IpAddr, Shutdown, SocketAddr, TcpListener, TcpStream, UdpSocket};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, PoisonError};
use std::thread;
use std::time::{Duration, Instant};

/// Maximum number of clients.
pub const MOST_CLIENTS: usize = 16;
/// Pause between two looks for new connections.
const LOOK: Duration = Duration::from_millis(10);
/// How long a call waits before it looks whether the bridge ends.
const PATIENCE: Duration = Duration::from_millis(50);
/// How often counts are told.
const REPORT_EVERY: Duration = Duration::from_secs(1);

/// Where a bridge listens, and whom it serves.
#[derive(Debug, Clone)]
pub struct BridgeOptions {
    /// Address that receives the card's packets. The factory setting of the port is 4098.
    pub card: SocketAddr,
    /// Address of the card; packets from other addresses are dropped. `None` accepts any sender.
    pub sender: Option<IpAddr>,
    /// Where clients connect.
    pub clients: SocketAddr,
    /// Pages that may.
    pub origins: Origins,
}

/// A bridge that listens.
pub struct Bridge {
    udp: UdpSocket,
    sender: Option<IpAddr>,
    listener: TcpListener,
    origins: Origins,
    config: RadarConfig,
    config_text: String,
    assembler: FrameAssembler,
}

/// A connection and its thread.
struct Client {
    mailbox: Arc<Mailbox>,
    stream: Arc<TcpStream>,
    thread: thread::JoinHandle<()>,
}

/// Clients as the threads of a bridge share them.
#[derive(Default)]
struct Clients(Mutex<Vec<Client>>);

impl Clients {
    /// Calls `tell` for each that has not ended, and removes the others.
    fn each(&self, tell: impl Fn(&Mailbox)) {
        let mut clients = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        clients.retain(|client| !client.thread.is_finished());
        clients.iter().for_each(|client| tell(&client.mailbox));
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
            sender: options.sender,
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
        let Self { udp, sender, listener, origins, config, config_text, assembler } = self;
        let clients = Clients::default();
        let admission = Admission::new(MOST_CLIENTS);
        let shared = Arc::new(Shared {
            origins,
            config,
            config_text,
            told: Mutex::default(),
            ended: AtomicBool::new(false),
        });
        let mut card = Card { udp, sender, assembler };
        let result = thread::scope(|scope| {
            scope.spawn(|| {
                while !stop.load(Ordering::Relaxed) && !shared.ends() {
                    let Ok((stream, _)) = listener.accept() else {
                        thread::sleep(LOOK);
                        continue;
                    };
                    if let Some(client) = welcome(stream, &admission, &shared) {
                        clients.add(client);
                    }
                }
            });
            let result = card.receive(&clients, &shared.told, stop, &mut |counts| {
                report(counts, admission.clients());
            });
            shared.ended.store(true, Ordering::Relaxed);
            result
        });
        clients.close();
        card.assembler.finish();
        result.map(|()| card.assembler.counts())
    }
}

/// What the threads of connections share.
struct Shared {
    origins: Origins,
    config: RadarConfig,
    config_text: String,
    told: Mutex<Counts>,
    ended: AtomicBool,
}

impl Shared {
    fn ends(&self) -> bool {
        self.ended.load(Ordering::Relaxed)
    }

    fn hello(&self) -> String {
        let counts = *self.told.lock().unwrap_or_else(PoisonError::into_inner);
        text(&Hello {
            version: 1,
            frame_bytes: self.config.frame_bytes(),
            frame_interval_s: self.config.waveform.frame_interval_s,
            config: &self.config_text,
            counts,
        })
    }
}

/// The side of the card.
struct Card {
    udp: UdpSocket,
    sender: Option<IpAddr>,
    assembler: FrameAssembler,
}

impl Card {
    /// Receives packets and hands frames out until `stop`.
    fn receive(
        &mut self,
        clients: &Clients,
        told: &Mutex<Counts>,
        stop: &AtomicBool,
        report: &mut dyn FnMut(Counts),
    ) -> Result<(), LiveError> {
        let mut buffer = vec![0; 1 << 16];
        let mut reported = Instant::now();
        while !stop.load(Ordering::Relaxed) {
            match self.udp.recv_from(&mut buffer) {
                Ok((_, from)) if self.sender.is_some_and(|sender| !is_same(sender, from.ip())) => {
                    self.assembler.count_foreign();
                }
                Ok((length, _)) => {
                    for frame in self.assembler.push(&buffer[..length]) {
                        let message = message(&frame);
                        let counts = self.assembler.counts();
                        set(told, counts);
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
                let counts = self.assembler.counts();
                set(told, counts);
                clients.each(|mailbox| mailbox.count(counts));
                report(counts);
            }
        }
        Ok(())
    }
}

fn set(told: &Mutex<Counts>, counts: Counts) {
    *told.lock().unwrap_or_else(PoisonError::into_inner) = counts;
}

/// Whether two addresses are the same. A socket of both families reports IPv4 senders as mapped to IPv6.
fn is_same(one: IpAddr, other: IpAddr) -> bool {
    one.to_canonical() == other.to_canonical()
}

/// Starts the thread of a connection; `None` where that is not possible.
fn welcome(stream: TcpStream, admission: &Arc<Admission>, shared: &Arc<Shared>) -> Option<Client> {
    let ticket = admission.enter(stream).ok()?;
    let mailbox = Arc::<Mailbox>::default();
    let stream = Arc::clone(ticket.stream());
    let (mine, shared) = (Arc::clone(&mailbox), Arc::clone(shared));
    let work = move || isolated(|| client(ticket, &mine, &shared));
    let thread = thread::Builder::new().name("bridge client".into()).spawn(work).ok()?;
    Some(Client { mailbox, stream, thread })
}

/// A connection from its handshake to its end.
fn client(ticket: Ticket, mailbox: &Mailbox, shared: &Shared) {
    let ends = || shared.ends();
    let terms = Terms { origins: &shared.origins, protocols: &[], ends: &ends };
    if let Ok((socket, _)) = handshake(ticket, &terms) {
        serve(socket, mailbox, shared.hello());
    }
}

fn socket(what: &'static str) -> impl FnOnce(std::io::Error) -> LiveError {
    move |error: std::io::Error| LiveError::Socket { what, given: error.to_string() }
}
