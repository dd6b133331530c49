//! Files with lists of grains.

use std::fs;
use std::path::Path;

use kavics::assembly::Grain;
use kavics::geometry::Vector;
use kavics::scene::Scene;
use kavics_results::{read_grains, write_grains};

use crate::scenes::assert_apart;

/// A box that most lists fit into.
const BOX: &str = "[box]\nwidth = 100\nheight = 100\n[grains.listed]\nfile = ";

/// Reads bytes as a list whose name has this ending, and places its grains.
///
/// What was read is written and read again, with the same bits, in each format; what was placed lies apart in the box.
pub fn list_of_grains(bytes: &[u8], ending: &str) {
    let place = tempfile::tempdir().expect("room for files");
    let name = format!("list.{ending}");
    let list = place.path().join(&name);
    fs::write(&list, bytes).expect("room for a file");
    let frame = (bytes.len() % 2 == 1).then_some(0);
    if ending != "csv"
        && let Ok(rows) = read_grains(&list, frame)
    {
        assert_written_as_read(&rows, place.path());
    }
    let text = format!("{BOX}'{name}'\n");
    match Scene::place_grains(&text, "fuzz.toml", place.path(), &read_grains) {
        Ok(pack) => assert_apart(pack.grains.values(), 1e-6),
        Err(error) => assert!(error.to_string().contains("fuzz.toml"), "{error}"),
    }
}

fn assert_written_as_read(rows: &[[f64; 3]], folder: &Path) {
    let grain = |&[x, y, radius]: &[f64; 3]| Grain {
        centre: Vector::new(x, y),
        radius,
    };
    let grains: Vec<Grain> = rows.iter().map(grain).collect();
    for ending in ["parquet", "xyz", "dump"] {
        let path = folder.join(format!("again.{ending}"));
        write_grains(&path, &grains).expect("room for a file");
        // Texts are read with care; of a Parquet file the scene looks at the numbers.
        let Ok(again) = read_grains(&path, None) else {
            assert!(
                ending != "parquet" && (rows.is_empty() || !rows.iter().all(is_grain)),
                "{rows:?}"
            );
            continue;
        };
        assert_eq!(again.len(), rows.len(), "{ending}");
        for (found, expected) in again.iter().flatten().zip(rows.iter().flatten()) {
            let same = found.to_bits() == expected.to_bits() || found.is_nan() && expected.is_nan();
            assert!(same, "{found} is not {expected} in {ending}");
        }
    }
}

fn is_grain([x, y, radius]: &[f64; 3]) -> bool {
    x.abs() <= 1e30 && y.abs() <= 1e30 && (1e-30..=1e30).contains(radius)
}
