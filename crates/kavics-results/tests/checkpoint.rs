//! Checkpoints: read back as they were written, and never believed when damaged.

mod block;

use std::fs;
use std::path::{Path, PathBuf};

use kavics::equilibrium::{Memory, MemoryColumn};
use kavics::ids::PerGrain;
use kavics::measure::Tensor;
use kavics::scene::Scene;
use kavics_results::{Checkpoint, Options, Results, ResultsError};
use proptest::prelude::*;
use xxhash_rust::xxh3::xxh3_64;

fn memory(numbers: Vec<f64>) -> Memory {
    let mut memory = Memory::default();
    let columns = [
        ("path.numbers", MemoryColumn::Numbers(numbers)),
        ("path.counts", MemoryColumn::Integers(vec![7, -1])),
        ("contact.phase", MemoryColumn::Codes(vec![3; 50])),
        ("nothing", MemoryColumn::Codes(Vec::new())),
    ];
    for (name, column) in columns {
        memory.columns.insert(name.to_owned(), column);
    }
    memory
}

/// Two checkpoints of a made-up run; their paths, the older one first.
fn two(folder: &Path, scene: &Scene) -> [PathBuf; 2] {
    let mut results = Results::create(folder, scene, Options::default()).expect("an empty place");
    let stress = PerGrain::filled(Tensor::default(), scene.assembly.grains.len());
    for step in 0..3 {
        let equilibrium = block::equilibrium(scene, step);
        results
            .push(&equilibrium, &block::measures(step), &stress)
            .expect("room on the disk");
        results
            .checkpoint(memory(vec![step as f64]))
            .expect("room on the disk");
    }
    let mut paths: Vec<PathBuf> = fs::read_dir(folder.join("checkpoint"))
        .expect("a folder")
        .map(|entry| entry.expect("an entry").path())
        .collect();
    paths.sort();
    paths.try_into().expect("two generations")
}

fn numbers(checkpoint: &Checkpoint) -> &MemoryColumn {
    &checkpoint.memory.columns["path.numbers"]
}

#[test]
fn damage_anywhere_is_seen_and_the_older_checkpoint_is_taken() {
    let place = tempfile::tempdir().expect("a temporary folder");
    let (folder, scene) = (place.path().join("results"), block::scene(7, 5));
    let [_, newer] = two(&folder, &scene);
    let whole = fs::read(&newer).expect("a file");
    let taken = || {
        Checkpoint::newest(&folder, &scene)
            .expect("a checkpoint")
            .expect("one")
    };
    assert_eq!(numbers(&taken()), &MemoryColumn::Numbers(vec![2.0]));
    let stride = whole.len() / 200;
    for place in (0..whole.len()).step_by(stride.max(1)) {
        let mut damaged = whole.clone();
        damaged[place] ^= 1 << (place % 8);
        for bytes in [damaged.as_slice(), &whole[..place]] {
            fs::write(&newer, bytes).expect("room on the disk");
            let older = taken();
            assert_eq!(
                numbers(&older),
                &MemoryColumn::Numbers(vec![1.0]),
                "byte {place}"
            );
            assert_eq!(older.notes.len(), 1);
        }
    }
}

/// The hash keeps damage out; what is made to have it must be read with care all the same.
#[test]
fn bytes_that_were_changed_together_with_their_hash_are_read_with_care() {
    let place = tempfile::tempdir().expect("a temporary folder");
    let (folder, scene) = (place.path().join("results"), block::scene(7, 5));
    let [older, newer] = two(&folder, &scene);
    fs::remove_file(older).expect("a file");
    let whole = fs::read(&newer).expect("a file");
    fs::remove_file(&newer).expect("a file");
    let mut refused = 0;
    for place in (0..whole.len()).step_by(7) {
        let mut changed = whole.clone();
        changed[place] = !changed[place];
        let name = format!("checkpoint/000001-{:016x}.arrow", xxh3_64(&changed));
        fs::write(folder.join(&name), changed).expect("room on the disk");
        refused += usize::from(Checkpoint::newest(&folder, &scene).is_err());
        fs::remove_file(folder.join(&name)).expect("a file");
    }
    assert!(refused > 100, "{refused}");
}

#[test]
fn where_both_are_damaged_both_are_named() {
    let place = tempfile::tempdir().expect("a temporary folder");
    let (folder, scene) = (place.path().join("results"), block::scene(7, 5));
    for path in two(&folder, &scene) {
        fs::write(path, "ARROW1").expect("room on the disk");
    }
    let refused = Checkpoint::newest(&folder, &scene)
        .expect_err("a refusal")
        .to_string();
    assert_eq!(refused.matches("damaged").count(), 2, "{refused}");
    assert!(refused.contains("no checkpoint is whole"), "{refused}");
}

#[test]
fn other_grains_under_the_same_words_are_refused() {
    let place = tempfile::tempdir().expect("a temporary folder");
    let (folder, scene) = (place.path().join("results"), block::scene(7, 5));
    two(&folder, &scene);
    let mut moved = scene.clone();
    let grain = moved
        .assembly
        .grains
        .values_mut()
        .first_mut()
        .expect("a grain");
    grain.radius *= 1.0 + f64::EPSILON;
    let refused = Checkpoint::newest(&folder, &moved).expect_err("a refusal");
    assert!(
        matches!(refused, ResultsError::OtherAssembly { .. }),
        "{refused}"
    );
}

#[test]
fn a_folder_without_checkpoints_has_none() {
    let place = tempfile::tempdir().expect("a temporary folder");
    let scene = block::scene(7, 5);
    let found = Checkpoint::newest(&place.path().join("absent"), &scene).expect("no mistake");
    assert!(found.is_none());
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(32))]

    #[test]
    fn every_bit_of_a_number_comes_back(bits in prop::collection::vec(any::<u64>(), 0..20)) {
        let place = tempfile::tempdir().expect("a temporary folder");
        let (folder, scene) = (place.path().join("results"), block::scene(7, 5));
        let mut results = Results::create(&folder, &scene, Options::default()).expect("an empty place");
        let values: Vec<f64> = bits.iter().map(|&bits| f64::from_bits(bits)).collect();
        results.checkpoint(memory(values)).expect("room on the disk");
        let found = Checkpoint::newest(&folder, &scene).expect("a checkpoint").expect("one");
        let MemoryColumn::Numbers(values) = numbers(&found) else {
            panic!("other values");
        };
        let found: Vec<u64> = values.iter().map(|value| value.to_bits()).collect();
        prop_assert_eq!(found, bits);
    }
}

#[test]
fn results_that_go_on_have_the_bytes_of_results_that_went_through() {
    let place = tempfile::tempdir().expect("a temporary folder");
    let (whole, broken) = (place.path().join("whole"), place.path().join("broken"));
    let scene = block::scene(7, 5);
    block::write(&whole, &scene);
    two(&broken, &scene);
    let checkpoint = Checkpoint::newest(&broken, &scene)
        .expect("a checkpoint")
        .expect("one");
    let options = Options {
        threads: 1,
        ..Options::default()
    };
    let mut results =
        Results::resume(&broken, &scene, options, &checkpoint).expect("a place to go on");
    let stress = PerGrain::filled(Tensor::default(), scene.assembly.grains.len());
    results.go_on_from(block::equilibrium(&scene, 2), stress.clone());
    for step in 3..block::FACTORS.len() {
        results
            .push(
                &block::equilibrium(&scene, step),
                &block::measures(step),
                &stress,
            )
            .expect("room on the disk");
    }
    results
        .finish(kavics_results::RunState::Done, None)
        .expect("room on the disk");
    assert!(block::files(&broken) == block::files(&whole));
}
