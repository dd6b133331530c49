//! Any text as a scene file: a scene whose first load steps are found or told to have no equilibrium, or an error with
//! its place.
#![no_main]

use std::path::Path;

use kavics::scene::Scene;
use kavics_fuzz::{MOST_PLACED, first_load_steps};
use libfuzzer_sys::fuzz_target;

fuzz_target!(|text: &str| {
    if Scene::planned_grains(text).is_some_and(|grains| grains > MOST_PLACED) {
        return;
    }
    let no_list = |_: &Path, _| Err("there are no lists".to_owned());
    match Scene::parse(text, "fuzz.toml", Path::new("/nowhere"), &no_list) {
        Ok(scene) => first_load_steps(&scene),
        Err(error) => assert!(error.to_string().contains("fuzz.toml"), "{error}"),
    }
});
