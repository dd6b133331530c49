//! Opening the browser.

use std::env;
use std::process::{Command, Stdio};

/// Opens an address in the browser of the user, if there seems to be one; answers whether it was tried.
pub fn open_browser(address: &str) -> bool {
    let mut command = if cfg!(target_os = "macos") {
        Command::new("open")
    } else if cfg!(windows) {
        Command::new("explorer")
    } else {
        // Without a screen a browser in the terminal might start.
        let screen = ["DISPLAY", "WAYLAND_DISPLAY"];
        if screen.iter().all(|name| env::var_os(name).is_none()) {
            return false;
        }
        Command::new("xdg-open")
    };
    let command = command
        .arg(address)
        .stdin(Stdio::null())
        .stdout(Stdio::null())
        .stderr(Stdio::null());
    command.spawn().is_ok()
}
