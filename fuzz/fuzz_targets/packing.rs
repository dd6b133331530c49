//! Any sizes, container and number: grains that lie apart in their container, or an error.
#![no_main]

use kavics_fuzz::{Numbers, pack};
use libfuzzer_sys::fuzz_target;

fuzz_target!(|bytes: &[u8]| {
    if let Some((&how, bytes)) = bytes.split_first() {
        pack(how, &mut Numbers::new(bytes));
    }
});
