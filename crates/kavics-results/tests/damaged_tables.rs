//! Tables in which a bit has turned: the values are those that were written, or an error names the file.

mod block;

use std::fs::{self, OpenOptions};
use std::io::{Seek, SeekFrom, Write};
use std::path::Path;

use arrow_array::RecordBatch;
use kavics::assembly::Grain;
use kavics::geometry::Vector;
use kavics_results::{Columns, ResultsError, TableHead, is_guarded, read_grains, write_grains};

fn run() -> tempfile::TempDir {
    let place = tempfile::tempdir().expect("a temporary folder");
    block::write(&place.path().join("block.results"), &block::scene(7, 5));
    place
}

/// Turns a bit of every so many bytes, another one each time, and reads the table again.
fn turn(path: &Path, stride: usize) {
    let mut file = OpenOptions::new().write(true).open(path).expect("a table");
    let mut put = |byte: u8, at: usize| {
        file.seek(SeekFrom::Start(at as u64)).expect("a place");
        file.write_all(&[byte]).expect("room");
    };
    let whole = fs::read(path).expect("a table");
    let written = values(path).expect("a table");
    let name = path.file_name().expect("a name").to_string_lossy();
    let bits = [0, 5, 2, 7, 1, 4, 6, 3].into_iter().cycle();
    for (at, bit) in (0..whole.len()).step_by(stride).zip(bits) {
        put(whole[at] ^ 1 << bit, at);
        match values(path) {
            Ok(values) => assert!(values == written, "byte {at} of {}", path.display()),
            Err(error) => assert!(error.to_string().contains(&*name), "byte {at}: {error}"),
        }
        if let Ok(head) = TableHead::read(path) {
            assert_eq!(head.rows, rows(&written), "byte {at} of {}", path.display());
        }
        put(whole[at], at);
    }
}

fn values(path: &Path) -> Result<Vec<RecordBatch>, ResultsError> {
    Ok(Columns::read(path)?.batches().to_vec())
}

fn rows(batches: &[RecordBatch]) -> usize {
    batches.iter().map(RecordBatch::num_rows).sum()
}

/// A decoder that panics is stopped, and says nothing.
fn be_quiet() {
    let usual = std::panic::take_hook();
    std::panic::set_hook(Box::new(move |panic| {
        if !is_guarded() {
            usual(panic);
        }
    }));
}

#[test]
fn a_turned_bit_never_changes_a_value() {
    be_quiet();
    let place = run();
    for (table, stride) in [
        ("steps", 11),
        ("events", 3),
        ("grains/000005", 3),
        ("contacts/000005", 5),
        ("sides/000005", 1),
    ] {
        let path = place.path().join(format!("block.results/{table}.parquet"));
        turn(&path, stride);
    }
}

/// More bytes than a block of the checksums, and more rows than a row group.
#[test]
fn a_turned_bit_far_inside_is_found_by_those_who_read_there() {
    let place = tempfile::tempdir().expect("a temporary folder");
    let path = place.path().join("grains.parquet");
    let grain = |number: usize| Grain {
        centre: Vector::new((number as f64).sin(), (number as f64).cos()),
        radius: 1.0 + (number as f64 * 0.7).sin() / 2.0,
    };
    let grains: Vec<Grain> = (0..100_000).map(grain).collect();
    write_grains(&path, &grains).expect("room");
    let mut bytes = fs::read(&path).expect("a list");
    let middle = bytes.len() / 2;
    bytes[middle] ^= 1;
    fs::write(&path, &bytes).expect("room");
    let said = read_grains(&path, None).expect_err("a damaged list");
    assert_eq!(said, "damaged: its bytes are not those that were written");
    let first = Columns::read_rows(&path, Some(&["x"]), 0..10).expect("whole rows");
    assert_eq!(first.numbers("x").expect("a column")[9], 9_f64.sin());
    assert_eq!(TableHead::read(&path).expect("a whole head").rows, 100_000);
}

/// A file of another writer, which kept our metadata, is of other bytes than we wrote.
#[test]
fn a_table_that_others_wrote_is_not_held_against_our_checksums() {
    let place = run();
    let path = place.path().join("block.results/grains/000005.parquet");
    let mut bytes = fs::read(&path).expect("a table");
    let is_writer = |window: &[u8]| window == b"kavics version ";
    let at = bytes.windows(15).rposition(is_writer).expect("our name");
    bytes[at..at + 6].copy_from_slice(b"others");
    let first = Columns::read(&path).expect("a table");
    fs::write(&path, &bytes).expect("room");
    let again = Columns::read(&path).expect("a table of others");
    assert!(first.batches() == again.batches());
}
