//! The server: listens, gives each connection a thread, and plays the drive in its own.

use super::client;
use super::options::ServeOptions;
use super::play::Play;
use super::player::{Player, Watch};
use super::shared::{Counts, Shared};
use crate::admission::isolated;
use crate::error::LiveError;
use crate::origin::Origins;
use boresight_options::{Naming, check};
use std::io::ErrorKind;
use std::net::{SocketAddr, TcpListener, TcpStream};
use std::sync::atomic::Ordering;
use std::thread::{Builder, Scope};
use std::time::Duration;

/// Between two looks for new connections: the system keeps some hundred that wait, which come in few milliseconds.
const LOOK: Duration = Duration::from_millis(1);

/// A server that listens.
#[derive(Debug)]
pub struct Server {
    listener: TcpListener,
    options: ServeOptions,
    origins: Origins,
}

impl Server {
    /// Listens at the address of the options.
    ///
    /// # Errors
    /// [`boresight_core::InputError::OutOfRange`] naming an option, [`LiveError::Origin`] and [`LiveError::Listen`].
    pub fn bind(options: ServeOptions) -> Result<Self, LiveError> {
        check(&options, Naming::Rust)?;
        let ServeOptions { host, port, .. } = &options;
        let origins = Origins::of_viewers(options.origin.as_deref())?;
        let failed = |error: std::io::Error| LiveError::Listen {
            what: "viewers",
            address: format!("{host}:{port}"),
            given: error.to_string(),
        };
        let listener = TcpListener::bind((host.as_str(), *port)).map_err(failed)?;
        listener.set_nonblocking(true).map_err(failed)?;
        Ok(Self { listener, options, origins })
    }

    /// The address, with the port that was free where 0 was asked for.
    #[must_use]
    pub fn address(&self) -> Option<SocketAddr> {
        self.listener.local_addr().ok()
    }

    /// Serves a drive until `watch` ends it. After the last scan it stays, for viewers that come late.
    ///
    /// # Errors
    /// Those of [`Play::step`].
    pub fn run(self, play: &mut Play, watch: Watch) -> Result<Counts, LiveError> {
        let shared = Shared::new(self.options, self.origins, play);
        let listener = self.listener;
        let played = std::thread::scope(|scope| {
            let accepts = Builder::new().spawn_scoped(scope, || accept(&listener, scope, &shared));
            let played = match accepts {
                Ok(_) => Player::new(&shared, play, watch).run(),
                Err(error) => Err(LiveError::Listen {
                    what: "viewers",
                    address: "a thread of its own".into(),
                    given: error.to_string(),
                }),
            };
            shared.stopped.store(true, Ordering::Relaxed);
            played
        });
        played.map(|_| shared.tally.counts())
    }
}

fn accept<'scope>(
    listener: &TcpListener,
    scope: &'scope Scope<'scope, '_>,
    shared: &'scope Shared,
) {
    while !shared.is_stopped() {
        match listener.accept() {
            Ok((stream, _)) => connect(stream, scope, shared),
            Err(error) if error.kind() == ErrorKind::WouldBlock => std::thread::sleep(LOOK),
            // Too many open files, say: others may close.
            Err(_) => {
                shared.tally.refused.fetch_add(1, Ordering::Relaxed);
                std::thread::sleep(LOOK);
            }
        }
    }
}

fn connect<'scope>(stream: TcpStream, scope: &'scope Scope<'scope, '_>, shared: &'scope Shared) {
    let started = shared.admission.enter(stream).and_then(|ticket| {
        let work = move || isolated(|| client::run(ticket, shared));
        Builder::new().spawn_scoped(scope, work)
    });
    if started.is_err() {
        shared.tally.rejected.fetch_add(1, Ordering::Relaxed);
    }
}
