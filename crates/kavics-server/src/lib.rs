//! A results folder in the browser: served on this machine, to this machine, and read only.
//!
//! In: a results folder. Out: answers to GET and HEAD at 127.0.0.1, which are the files of the page and the pieces of page
//! data. No path is taken from a request: names are looked up.

mod answer;
mod browser;
mod error;
mod request;
mod serve;

pub use browser::open_browser;
pub use error::ServerError;
pub use kavics_viewer::PageError;
pub use serve::Server;
