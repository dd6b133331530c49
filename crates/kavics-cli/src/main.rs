//! The kavics command.
fn main() {}
