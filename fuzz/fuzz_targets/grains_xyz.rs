//! Any bytes as an extended XYZ list of grains: grains that can be placed, or a sentence.
#![no_main]

use kavics_fuzz::list_of_grains;
use libfuzzer_sys::fuzz_target;

fuzz_target!(|bytes: &[u8]| list_of_grains(bytes, "xyz"));
