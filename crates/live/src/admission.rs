//! Admission of connections: how many are in their handshake, how many are clients, and which gives way at a limit.
//!
//! Connections in their handshake and clients have separate places, so that a connection without a request takes no
//! client's place.

use std::io;
use std::net::{IpAddr, Shutdown, TcpStream};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

/// Maximum number of connections in their handshake. At the limit the oldest one is closed for a new one.
const MOST_PENDING: usize = 64;
/// Silence of a client after which it is sent a ping.
pub(crate) const PING_AFTER: Duration = Duration::from_secs(1);
/// Silence of a client after which it gives way to a new one when all places are taken. A client answers a ping once
/// it has read everything sent before, so this includes clients that read too slowly.
const SILENT: Duration = Duration::from_secs(3);

/// Connections of a server.
#[derive(Debug)]
pub(crate) struct Admission {
    most_clients: usize,
    start: Instant,
    places: Mutex<Places>,
}

#[derive(Debug, Default)]
struct Places {
    next: u64,
    /// In the order of their arrival.
    pending: Vec<Place>,
    clients: Vec<Place>,
}

/// One connection.
#[derive(Debug, Clone)]
struct Place {
    id: u64,
    peer: IpAddr,
    stream: Arc<TcpStream>,
    /// When the peer last sent something, in milliseconds since the start of the server.
    heard_ms: Arc<AtomicU64>,
}

impl Place {
    /// Closes the connection. Its thread notices at its next read or write.
    fn close(&self) {
        // The peer may have closed it already.
        let _ = self.stream.shutdown(Shutdown::Both);
    }
}

impl Admission {
    /// For a server with a maximum number of clients.
    pub(crate) fn new(most_clients: usize) -> Arc<Self> {
        Arc::new(Self { most_clients, start: Instant::now(), places: Mutex::default() })
    }

    fn lock(&self) -> MutexGuard<'_, Places> {
        self.places.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn now_ms(&self) -> u64 {
        u64::try_from(self.start.elapsed().as_millis()).unwrap_or(u64::MAX)
    }

    /// Number of clients.
    pub(crate) fn clients(&self) -> usize {
        self.lock().clients.len()
    }

    /// Registers a new connection as one in its handshake. At the limit another one is closed for it: the oldest of the
    /// address with the most such connections.
    ///
    /// # Errors
    /// Those of the system, for a connection that is closed already.
    pub(crate) fn enter(self: &Arc<Self>, stream: TcpStream) -> io::Result<Ticket> {
        let peer = stream.peer_addr()?.ip();
        let mut places = self.lock();
        if places.pending.len() >= MOST_PENDING
            && let Some((_, at)) = most_frequent(&places.pending)
        {
            places.pending.remove(at).close();
        }
        places.next += 1;
        let place = Place {
            id: places.next,
            peer,
            stream: Arc::new(stream),
            heard_ms: Arc::new(self.now_ms().into()),
        };
        places.pending.push(place.clone());
        Ok(Ticket { admission: Arc::clone(self), place })
    }
}

/// The number of connections of the address that has most of them, and the index of its first.
fn most_frequent(places: &[Place]) -> Option<(usize, usize)> {
    let peers: Vec<IpAddr> = places.iter().map(|place| place.peer).collect();
    let count = |peer| peers.iter().filter(|other| **other == peer).count();
    let at = (0..peers.len()).rev().max_by_key(|&at| count(peers[at]))?;
    Some((count(peers[at]), at))
}

/// The index of the client that gives way to one from `peer`: the one silent for the longest time, if that is long
/// enough; otherwise the first of the address with the most clients, if it keeps at least as many as `peer` then has.
fn gives_way(clients: &[Place], peer: IpAddr, now_ms: u64) -> Option<usize> {
    let heard = |at: &usize| clients[*at].heard_ms.load(Ordering::Relaxed);
    let silent = (0..clients.len()).min_by_key(heard);
    let is_silent = |at: &usize| u128::from(now_ms.saturating_sub(heard(at))) > SILENT.as_millis();
    silent.filter(is_silent).or_else(|| {
        let (most, at) = most_frequent(clients)?;
        let own = clients.iter().filter(|client| client.peer == peer).count();
        (most > own + 1).then_some(at)
    })
}

/// The place of a connection. Dropping it gives up the place and closes the connection.
#[derive(Debug)]
pub(crate) struct Ticket {
    admission: Arc<Admission>,
    place: Place,
}

impl Ticket {
    /// The connection.
    pub(crate) fn stream(&self) -> &Arc<TcpStream> {
        &self.place.stream
    }

    /// Notes that the peer sent something.
    pub(crate) fn heard(&self) {
        self.place.heard_ms.store(self.admission.now_ms(), Ordering::Relaxed);
    }

    /// Makes the connection a client. Returns whether there is a place for it.
    pub(crate) fn admit(&self) -> bool {
        let mut places = self.admission.lock();
        let Some(at) = places.pending.iter().position(|place| place.id == self.place.id) else {
            return false;
        };
        if places.clients.len() >= self.admission.most_clients {
            let now_ms = self.admission.now_ms();
            match gives_way(&places.clients, self.place.peer, now_ms) {
                Some(victim) => places.clients.remove(victim).close(),
                None => return false,
            }
        }
        let place = places.pending.remove(at);
        places.clients.push(place);
        true
    }
}

impl Drop for Ticket {
    fn drop(&mut self) {
        self.place.close();
        let mut places = self.admission.lock();
        let Places { pending, clients, .. } = &mut *places;
        for places in [pending, clients] {
            places.retain(|place| place.id != self.place.id);
        }
    }
}

/// Runs the work of one connection. A panic, which the panic hook has reported, ends this connection only.
pub(crate) fn isolated(work: impl FnOnce()) {
    // What is shared with other connections is behind locks that ignore poisoning.
    let _ = catch_unwind(AssertUnwindSafe(work));
}

#[cfg(test)]
#[allow(clippy::unwrap_used, clippy::panic)]
mod tests {
    use super::*;
    use std::net::TcpListener;

    fn places(heard: &[(u8, u64)]) -> Vec<Place> {
        let listener = TcpListener::bind("127.0.0.1:0").unwrap();
        let stream = Arc::new(TcpStream::connect(listener.local_addr().unwrap()).unwrap());
        let place = |&(peer, heard_ms): &(u8, u64)| Place {
            id: 0,
            peer: IpAddr::from([10, 0, 0, peer]),
            stream: Arc::clone(&stream),
            heard_ms: Arc::new(heard_ms.into()),
        };
        heard.iter().map(place).collect()
    }

    #[test]
    fn a_silent_client_gives_way_and_then_one_of_the_address_with_most() {
        let peer = |last| IpAddr::from([10, 0, 0, last]);
        let victim = |heard: &[(u8, u64)], from| gives_way(&places(heard), peer(from), 10_000);
        assert_eq!(victim(&[(1, 9000), (1, 6500), (2, 5000), (1, 6000)], 1), Some(2));
        assert_eq!(victim(&[(2, 9000), (1, 9000), (1, 9000), (1, 8000)], 2), Some(1));
        // A new client never leaves another address with fewer than its own.
        assert_eq!(victim(&[(1, 9000), (1, 9000), (2, 9000)], 2), None);
        assert_eq!(victim(&[(1, 9000), (1, 9000)], 1), None);
        assert_eq!(victim(&[(1, 9000), (2, 9000)], 3), None);
        assert_eq!(victim(&[(1, 9000), (1, 9000)], 3), Some(0));
    }

    #[test]
    fn a_flood_of_one_address_closes_its_own_connections() {
        assert_eq!(most_frequent(&places(&[(1, 0), (2, 0), (2, 0), (3, 0)])), Some((2, 1)));
        assert_eq!(most_frequent(&places(&[(1, 0), (2, 0)])), Some((1, 0)));
        assert_eq!(most_frequent(&[]), None);
    }

    #[test]
    fn a_connection_that_panics_gives_up_its_place_and_no_other() {
        let listener = TcpListener::bind("127.0.0.1:0").unwrap();
        let connect = || TcpStream::connect(listener.local_addr().unwrap()).unwrap();
        let admission = Admission::new(2);
        let [one, other] = [(); 2].map(|()| admission.enter(connect()).unwrap());
        assert!(one.admit() && other.admit());
        isolated(move || {
            let _held = one;
            panic!("expected by this test");
        });
        assert_eq!(admission.clients(), 1);
        assert!(admission.enter(connect()).unwrap().admit());
    }
}
