//! Why nothing is served.

use kavics_viewer::PageError;
use thiserror::Error;

/// Nothing is served.
#[derive(Debug, Error)]
pub enum ServerError {
    /// The folder holds no results.
    #[error("{0}")]
    Page(#[from] PageError),
    /// The address is taken or not to be had.
    #[error("127.0.0.1:{port}: {source}")]
    Address {
        /// The port asked for; 0 for any.
        port: u16,
        /// Why.
        source: std::io::Error,
    },
    /// The server came to an end.
    #[error("server: {0}")]
    Ended(#[from] std::io::Error),
}
