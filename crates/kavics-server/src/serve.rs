//! The server: an address, and an answer to each request.

use std::io;
use std::net::{Ipv4Addr, TcpListener};
use std::path::Path;
use std::pin::pin;
use std::sync::Arc;

use axum::Router;
use axum::extract::State;
use axum::http::{Request, Response};
use kavics_viewer::PageFolder;
use tokio::runtime::Builder;
use tokio::signal::ctrl_c;

use crate::ServerError;
use crate::answer::{Body, answer};

/// A server that has its address and does not answer yet.
#[derive(Debug)]
pub struct Server {
    folder: PageFolder,
    listener: TcpListener,
    port: u16,
}

/// What every answer needs.
#[derive(Debug)]
struct Place {
    folder: PageFolder,
    port: u16,
}

impl Server {
    /// A server of the results in `folder` at a port of 127.0.0.1, any free one for 0.
    ///
    /// # Errors
    /// A folder without results; a port that is taken.
    pub fn bind(folder: &Path, port: u16) -> Result<Self, ServerError> {
        let folder = PageFolder::open(folder)?;
        let bind = || {
            let listener = TcpListener::bind((Ipv4Addr::LOCALHOST, port))?;
            listener.set_nonblocking(true)?;
            let port = listener.local_addr()?.port();
            Ok((listener, port))
        };
        let (listener, port) = bind().map_err(|source| ServerError::Address { port, source })?;
        Ok(Self {
            folder,
            listener,
            port,
        })
    }

    /// Where the page is.
    pub fn address(&self) -> String {
        format!("http://127.0.0.1:{}/", self.port)
    }

    /// Answers requests until Ctrl-C, which is waited for before `ready` is called.
    ///
    /// # Errors
    /// A server that cannot start; `ready` that fails.
    pub fn run(self, ready: impl FnOnce() -> io::Result<()>) -> Result<(), ServerError> {
        let place = Arc::new(Place {
            folder: self.folder,
            port: self.port,
        });
        let listener = self.listener;
        let runtime = Builder::new_current_thread().enable_all().build()?;
        let served = runtime.block_on(async {
            let listener = tokio::net::TcpListener::from_std(listener)?;
            let routes = Router::new().fallback(respond).with_state(place);
            let mut stop = pin!(ctrl_c());
            tokio::select! {
                biased;
                stopped = &mut stop => return stopped,
                ready = async { ready() } => ready?,
            }
            tokio::select! {
                served = axum::serve(listener, routes) => served,
                stopped = stop => stopped,
            }
        });
        // A browser keeps its connections open; nobody waits for them, nor for a table that is being read.
        runtime.shutdown_background();
        Ok(served?)
    }
}

async fn respond(
    State(place): State<Arc<Place>>,
    request: Request<axum::body::Body>,
) -> Response<Body> {
    let (head, _) = request.into_parts();
    let read = move || answer(&place.folder, place.port, &head);
    // Tables are read aside, so that another request need not wait.
    let answered = tokio::task::spawn_blocking(read).await;
    answered.unwrap_or_else(|_| crate::answer::broken())
}
