//! `kavics view`: results in the browser.

use std::io::{Write, stdout};

use kavics_server::{Server, open_browser};

use crate::arguments::ViewArguments;
use crate::failure::Failure;
use crate::scene_file::say;

pub fn view(arguments: &ViewArguments) -> Result<(), Failure> {
    let server = Server::bind(&arguments.results, arguments.port)?;
    let address = server.address();
    let ready = || {
        // Flushed, as a program that waits for the address reads it from a pipe.
        let mut out = stdout().lock();
        writeln!(out, "{address}").and_then(|()| out.flush())?;
        drop(out);
        say("served to this machine only, until Ctrl-C\n");
        if !arguments.no_open {
            open_browser(&address);
        }
        Ok(())
    };
    Ok(server.run(ready)?)
}
