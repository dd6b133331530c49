//! Any bytes as a Parquet list of grains: grains that can be placed, or a sentence.
#![no_main]

use kavics_fuzz::{let_guarded_panics_pass, list_of_grains};
use libfuzzer_sys::fuzz_target;

fuzz_target!(init: let_guarded_panics_pass(), |bytes: &[u8]| list_of_grains(bytes, "parquet"));
