//! Any bytes as a checkpoint that has the hash of its name: a run goes on from it, or a sentence says why not.
//!
//! The first byte chooses the scene, and whether the others are a checkpoint, or what is written over a whole one.
#![no_main]

use kavics_fuzz::Broken;
use libfuzzer_sys::fuzz_target;

fuzz_target!(|bytes: &[u8]| {
    let Some((&first, bytes)) = bytes.split_first() else {
        return;
    };
    let broken = Broken::off(first);
    let went_on = if first < 128 {
        broken.goes_on_from(bytes)
    } else {
        broken.goes_on_from(&broken.written_over(bytes))
    };
    if let Err(sentence) = went_on {
        assert!(!sentence.is_empty());
    }
});
