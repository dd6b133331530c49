//! Scenes that are wrong, and what the user is told.

use std::fs;
use std::path::{Path, PathBuf};
use std::sync::LazyLock;

use kavics::scene::{Scene, SceneError};
use proptest::prelude::*;

fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/scenes_wrong")
}

fn no_reader(_: &Path, _: Option<usize>) -> Result<Vec<[f64; 3]>, String> {
    Err("lists of grains are read from csv here".to_owned())
}

fn message(text: &str, name: &str) -> Option<String> {
    match Scene::parse(text, name, &folder(), &no_reader) {
        Ok(_) => None,
        Err(SceneError::Wrong(message)) => Some(message),
        Err(SceneError::Unreadable { path, .. }) => panic!("{} was read", path.display()),
    }
}

/// Names and texts of the wrong scenes. The first word tells where the mistake is found: `text` by the TOML reader,
/// `value` without, `placed` with the placed grains.
fn wrong_scenes() -> Vec<(String, String)> {
    let mut scenes: Vec<(String, String)> = fs::read_dir(folder())
        .unwrap()
        .map(|entry| entry.unwrap().path())
        .filter(|path| path.extension().is_some_and(|e| e == "toml"))
        .map(|path| {
            let name = path.file_stem().unwrap().to_str().unwrap().to_owned();
            (name, fs::read_to_string(&path).unwrap())
        })
        .collect();
    scenes.sort();
    scenes
}

#[test]
fn every_wrong_scene_says_what_is_wrong_and_where() {
    for (name, text) in wrong_scenes() {
        let file = format!("{name}.toml");
        let message = message(&text, &file).unwrap_or_else(|| panic!("{name} is right"));
        assert!(message.contains(&format!("--> {file}:")), "{message}");
        assert!(message.contains('^'), "{message}");
        assert!(!message.contains('\u{1b}'), "{message}");
        insta::assert_snapshot!(name, message);
    }
}

#[test]
fn mistakes_of_all_kinds_are_shown() {
    let scenes = wrong_scenes();
    let of_kind = |kind: &str| {
        scenes
            .iter()
            .filter(|(name, _)| name.starts_with(kind))
            .count()
    };
    assert!(of_kind("text_") <= 40);
    assert!(of_kind("placed_") >= 60);
    assert!(scenes.len() >= 200);
}

#[test]
fn a_file_that_is_not_there_is_named() {
    let error = Scene::read(Path::new("nowhere.toml"), &no_reader).unwrap_err();
    assert!(error.to_string().starts_with("nowhere.toml: "), "{error}");
}

#[test]
fn a_list_that_cannot_be_read_is_no_mistake_of_the_scene() {
    // No file system takes a name of this length.
    let name = "a".repeat(5000);
    let text = fs::read_to_string(folder().join("placed_list_missing.toml")).unwrap();
    let text = text.replace("nowhere", &name);
    let error = Scene::parse(&text, "scene.toml", &folder(), &no_reader).unwrap_err();
    assert!(matches!(error, SceneError::Unreadable { .. }), "{error}");
}

/// Words that a mistaken user, or an evil one, puts in place of others.
const WORDS: [&str; 24] = [
    "nan",
    "-inf",
    "0",
    "-1",
    "1e308",
    "1e-308",
    "9223372036854775807",
    "\"\"",
    "\"3 m\"",
    "\"fit\"",
    "\"void\"",
    "true",
    "[]",
    "[[]]",
    "{}",
    "[1, 2, 3]",
    "\"é²\"",
    "\n[contact.é.cemented]\n",
    "\n[[stage]]\n",
    "=",
    "\"",
    "[0, 0]",
    "{ ids = [0] }",
    "{ edge = \"left\" }",
];

/// A scene in which a few words are replaced, doubled or left out.
fn mutated(text: &str, changes: &[(usize, u8, usize)]) -> String {
    let mut words: Vec<&str> = text.split_inclusive([' ', '\n']).collect();
    for (place, change, word) in changes {
        if words.is_empty() {
            break;
        }
        let place = place % words.len();
        match change % 3 {
            0 => words[place] = WORDS[word % WORDS.len()],
            1 => words.insert(place, words[(place + word) % words.len()]),
            _ => {
                words.remove(place);
            }
        }
    }
    words.concat()
}

/// What is mutated: wrong scenes, and as often a full one that is right.
static SEEDS: LazyLock<Vec<String>> = LazyLock::new(|| {
    let full = fs::read_to_string(folder().join("../scenes_right/full.toml")).unwrap();
    let pair = |(_, text)| [text, full.clone()];
    wrong_scenes().into_iter().flat_map(pair).collect()
});

/// Numbers that scenes rarely have.
const NUMBERS: [&str; 20] = [
    "0", "1", "2", "-1", "0.5", "1.5", "7", "1e-300", "1e300", "-1e300", "1e-9", "1e9", "\"1 mm\"",
    "31", "32", "1e16", "1e30", "1e-30", "1e25", "1e-25",
];

/// A scene in which a few numbers are others.
fn renumbered(text: &str, changes: &[(usize, usize)]) -> String {
    let mut words: Vec<String> = text
        .split_inclusive([' ', '\n', ','])
        .map(str::to_owned)
        .collect();
    let is_number = |word: &str| {
        let word = word.trim_start_matches('[');
        word.starts_with(|c: char| c.is_ascii_digit())
    };
    let numbers: Vec<usize> = (0..words.len()).filter(|i| is_number(&words[*i])).collect();
    for (place, number) in changes {
        let Some(place) = numbers.get(place % numbers.len().max(1)) else {
            break;
        };
        let word = &mut words[*place];
        let start = if word.starts_with('[') { "[" } else { "" };
        let end = word.split_off(word.len() - 1);
        *word = format!("{start}{}{end}", NUMBERS[number % NUMBERS.len()]);
    }
    words.concat()
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 2000, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn no_scene_makes_a_panic(
        scene in 0_usize..1000,
        changes in prop::collection::vec((0_usize..10_000, any::<u8>(), 0_usize..1000), 1..4),
    ) {
        let text = mutated(&SEEDS[scene % SEEDS.len()], &changes);
        message(&text, "scene.toml");
    }

    #[test]
    fn no_number_makes_a_panic(
        scene in 0_usize..1000,
        changes in prop::collection::vec((0_usize..10_000, 0_usize..1000), 1..4),
    ) {
        let text = renumbered(&SEEDS[scene % SEEDS.len()], &changes);
        message(&text, "scene.toml");
    }
}
