//! Any coordinates and radii: as grains of a scene, and as discs of a power diagram.
#![no_main]

use kavics_fuzz::{Numbers, as_grains, as_power_diagram};
use libfuzzer_sys::fuzz_target;

fuzz_target!(|bytes: &[u8]| {
    let mut numbers = Numbers::new(bytes);
    let [width, height] = [numbers.next(), numbers.next()];
    let rows: Vec<[f64; 3]> = numbers.rows().take(64).collect();
    as_grains(width, height, &rows);
    as_power_diagram(width, height, &rows);
});
