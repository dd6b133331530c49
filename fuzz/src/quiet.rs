//! Panics of libraries that the program catches are no finds.

use std::panic::{set_hook, take_hook};

/// From now on a panic while a file of others is decoded does not end the target.
pub fn let_guarded_panics_pass() {
    let usual = take_hook();
    set_hook(Box::new(move |panic| {
        if !kavics_results::is_guarded() {
            usual(panic);
        }
    }));
}
