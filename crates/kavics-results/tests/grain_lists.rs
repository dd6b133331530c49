//! Lists of grains in files of others: what is read, what comes back, and what is told of wrong files.

use std::fs;
use std::path::Path;

use kavics::assembly::Grain;
use kavics::geometry::Vector;
use kavics::packing::{Purpose, random::stream};
use kavics_results::{read_grains, write_grains};

type Rows = Result<Vec<[f64; 3]>, String>;

fn read(name: &str, text: impl AsRef<[u8]>, frame: Option<usize>) -> Rows {
    let place = tempfile::tempdir().unwrap();
    let path = place.path().join(name);
    fs::write(&path, text).unwrap();
    read_grains(&path, frame)
}

fn xyz(text: &str) -> Rows {
    read("pack.xyz", text, None)
}

fn dump(text: &str) -> Rows {
    read("pack.dump", text, None)
}

const XYZ: &str = "2\nProperties=species:S:1:pos:R:3:radius:R:1\nA 1.5 2 0 0.5\nB 3 2.25 0 1\n";
const DUMP: &str = "ITEM: TIMESTEP\n0\nITEM: NUMBER OF ATOMS\n2\nITEM: BOX BOUNDS pp ff pp\n0 10\n-2 6\n-1 1\n\
                    ITEM: ATOMS id type x y radius\n2 1 3 2.25 1\n1 1 1.5 2 0.5\n";
const TWO: [[f64; 3]; 2] = [[1.5, 2.0, 0.5], [3.0, 2.25, 1.0]];

#[test]
fn every_format_gives_back_the_same_bits() {
    let grain = |k: i32| Grain {
        centre: Vector::new(0.1 * f64::from(k), -1e-7 / f64::from(k)),
        radius: 1.0 / f64::from(3 * k),
    };
    let grains: Vec<Grain> = (1..40).map(grain).collect();
    let place = tempfile::tempdir().unwrap();
    for ending in ["parquet", "xyz", "EXTXYZ", "dump", "lammpstrj", "lammps"] {
        let path = place.path().join("pack").with_extension(ending);
        write_grains(&path, &grains).unwrap();
        let rows = read_grains(&path, None).unwrap();
        let expected: Vec<[f64; 3]> = grains
            .iter()
            .map(|g| [g.centre.x, g.centre.y, g.radius])
            .collect();
        assert_eq!(rows, expected, "{ending}");
    }
}

#[test]
fn columns_of_extended_xyz_may_stand_in_any_order() {
    assert_eq!(xyz(XYZ).unwrap(), TWO);
    let text = "2\npbc=\"F F F\" Lattice=\"9 0 0 0 9 0 0 0 1\" Properties=Radius:R:1:force:R:3:id:I:1:pos:R:2 Time=0\n\
                0.5 0 0 0 7 1.5 2\n1 0 0 0 8 3 2.25\n";
    assert_eq!(xyz(text).unwrap(), TWO);
    let halved = XYZ.replace("radius", "diameter");
    assert_eq!(xyz(&halved).unwrap()[0], [1.5, 2.0, 0.25]);
}

#[test]
fn line_ends_of_windows_and_empty_lines_do_no_harm() {
    assert_eq!(xyz(&XYZ.replace('\n', "\r\n")).unwrap(), TWO);
    assert_eq!(xyz(&format!("\n{XYZ}\n \n")).unwrap(), TWO);
    assert_eq!(dump(&DUMP.replace('\n', "\r\n\r\n")).unwrap(), TWO);
    assert_eq!(xyz(XYZ.trim_end()).unwrap(), TWO);
}

#[test]
fn the_last_frame_is_read_unless_another_is_asked_for() {
    let other = XYZ.replace("1.5", "7.5");
    let both = format!("{other}\n{XYZ}");
    assert_eq!(xyz(&both).unwrap(), TWO);
    assert_eq!(read("a.xyz", &both, Some(1)).unwrap(), TWO);
    assert_eq!(read("a.xyz", &both, Some(0)).unwrap()[0][0], 7.5);
    // A run that is still writing: what is asked for is there.
    let cut = format!("{other}{}", &XYZ[..60]);
    assert_eq!(read("a.xyz", &cut, Some(0)).unwrap()[0][0], 7.5);
    let both = format!("ITEM: UNITS\nlj\n{}{DUMP}", DUMP.replace("1.5", "7.5"));
    assert_eq!(dump(&both).unwrap(), TWO);
    assert_eq!(read("a.dump", &both, Some(0)).unwrap()[0][0], 7.5);
    assert_eq!(
        read("a.dump", &both, Some(2)).unwrap_err(),
        "there is no frame 2; the file has 2, counted from 0"
    );
    assert_eq!(
        read("a.xyz", XYZ, Some(1)).unwrap_err(),
        "there is no frame 1; the file has 1, counted from 0"
    );
}

#[test]
fn grains_of_a_dump_come_in_the_order_of_their_ids() {
    assert_eq!(dump(DUMP).unwrap(), TWO);
    let without = DUMP.replace("id type", "mol type");
    assert_eq!(dump(&without).unwrap(), [TWO[1], TWO[0]]);
}

/// x = 0 + 10·s, y = −2 + 8·s.
#[test]
fn scaled_coordinates_of_a_dump_are_turned_into_lengths() {
    let scaled = DUMP
        .replace("x y radius", "xs ys diameter")
        .replace("3 2.25 1", "0.5 0.25 2")
        .replace("1.5 2 0.5", "0.25 0.75 1");
    assert_eq!(dump(&scaled).unwrap(), [[2.5, 4.0, 0.5], [5.0, 0.0, 1.0]]);
    let unwrapped = DUMP.replace("x y radius", "xu yu radius");
    assert_eq!(dump(&unwrapped).unwrap(), TWO);
    let tilted = scaled.replace("BOUNDS", "BOUNDS xy xz yz");
    assert_eq!(
        dump(&tilted).unwrap_err(),
        "line 5: scaled coordinates are read in an orthogonal box only"
    );
    // Plain coordinates need no box.
    assert_eq!(
        dump(&DUMP.replace("pp ff pp", "xy xz yz pp ff pp")).unwrap(),
        TWO
    );
}

/// What is changed of a right file, and what is told then.
type Wrong = [(&'static str, &'static str, &'static str)];

const WRONG_XYZ: &Wrong = &[
    (
        "2\nP",
        "3\nP",
        "line 1: 3 grains are announced, and 2 lines follow",
    ),
    (
        "2\nP",
        "1\nP",
        "line 4: \"B 3 2.25 0 1\" is not a number of grains",
    ),
    (
        "2\nP",
        "18446744073709551615\nP",
        "line 1: 18446744073709551615 grains are announced, and 2 lines follow",
    ),
    (
        "2\nP",
        "99999999999999999999\nP",
        "line 1: \"99999999999999999999\" is not a number of grains",
    ),
    ("2\nP", "-2\nP", "line 1: \"-2\" is not a number of grains"),
    (
        "2\nP",
        "two\nP",
        "line 1: \"two\" is not a number of grains",
    ),
    (
        "Properties",
        "Columns",
        "line 2: no `Properties=` names the columns",
    ),
    (
        "radius:R:1",
        "mass:R:1",
        "line 2: no `radius` or `diameter` among `species`, `pos`, `mass`",
    ),
    (
        "pos:R:3",
        "place:R:3",
        "line 2: no `pos` of two numbers among `species`, `place`, `radius`",
    ),
    (
        "pos:R:3",
        "pos:R:1",
        "line 2: no `pos` of two numbers among `species`, `pos`, `radius`",
    ),
    (
        ":radius:R:1",
        ":radius:R",
        "line 2: `radius:R` of `Properties` is not a name, a type and a number of words",
    ),
    (
        "radius:R:1",
        "radius:R:x",
        "line 2: `radius:R:x` of `Properties` is not a name, a type and a number of words",
    ),
    (
        "radius:R:1",
        "radius:Q:1",
        "line 2: `radius:Q:1` of `Properties` is not a name, a type and a number of words",
    ),
    (
        "radius:R:1",
        "radius:R:0",
        "line 2: `radius:R:0` of `Properties` is not a name, a type and a number of words",
    ),
    (
        "species:S:1",
        "species:S:18446744073709551615",
        "line 3: 5 words where `Properties` names 18446744073709551615",
    ),
    (
        "2.25 0 1",
        "2.25 1",
        "line 4: 4 words where `Properties` names 5",
    ),
    (
        "2.25 0 1",
        "2.25 0 1 1",
        "line 4: 6 words where `Properties` names 5",
    ),
    (
        "A 1.5",
        "A one",
        "line 3, column `x`: \"one\" is not a number",
    ),
    (
        "A 1.5",
        "A nan",
        "line 3, column `x`: nan is not a number up to 1e30",
    ),
    (
        "2.25",
        "-1e31",
        "line 4, column `y`: -1e31 is not a number up to 1e30",
    ),
    (
        "0 0.5",
        "0 -0.5",
        "line 3, column `radius`: -0.5 is not a positive number",
    ),
    (
        "0 0.5",
        "0 0",
        "line 3, column `radius`: 0 is not a positive number",
    ),
    (
        "0 0.5",
        "0 inf",
        "line 3, column `radius`: inf is not a number up to 1e30",
    ),
    (
        "\nA 1.5 2 0 0.5",
        "\n",
        "line 3: 0 words where `Properties` names 5",
    ),
];

const WRONG_DUMP: &Wrong = &[
    (
        "ITEM: TIMESTEP\n0",
        "LAMMPS data",
        "line 1: expected `ITEM: TIMESTEP`, not \"LAMMPS data\"",
    ),
    ("ITEM: TIMESTEP\n0", "", "the file is empty"),
    (
        "ATOMS\n2",
        "ATOMS\n3",
        "line 4: 3 atoms are announced, and 2 follow",
    ),
    (
        "ATOMS\n2",
        "ATOMS\n1",
        "line 4: 1 atoms are announced, and 2 follow",
    ),
    (
        "ATOMS\n2",
        "ATOMS\n18446744073709551615",
        "line 4: 18446744073709551615 atoms are announced, and 2 follow",
    ),
    (
        "ATOMS\n2",
        "ATOMS\n2.5",
        "line 4: \"2.5\" is not a number of grains",
    ),
    ("ATOMS\n2\n", "ATOMS\n", "line 3: no number follows"),
    (
        "ITEM: NUMBER OF ATOMS",
        "ITEM: NUMBER",
        "line 1: the frame has no `ITEM: NUMBER OF ATOMS`",
    ),
    (
        "ITEM: ATOMS id",
        "ITEM: BONDS id",
        "line 1: the frame has no `ITEM: ATOMS`",
    ),
    (
        "x y radius",
        "x y mass",
        "line 9: no `radius` or `diameter` among `id`, `type`, `x`, `y`, `mass`",
    ),
    (
        "x y radius",
        "z y radius",
        "line 9: no `x`, `xu` or `xs` among `id`, `type`, `z`, `y`, `radius`",
    ),
    (
        "x y radius",
        "x vy radius",
        "line 9: no `y`, `yu` or `ys` among `id`, `type`, `x`, `vy`, `radius`",
    ),
    ("3 2.25 1", "3 2.25", "line 10: 4 words for 5 columns"),
    (
        "3 2.25 1",
        "3 y 1",
        "line 10, column `y`: \"y\" is not a number",
    ),
    (
        "3 2.25 1",
        "3 NaN 1",
        "line 10, column `y`: NaN is not a number up to 1e30",
    ),
    (
        "3 2.25 1",
        "3 2.25 -1",
        "line 10, column `radius`: -1 is not a positive number",
    ),
    (
        "2 1 3",
        "1 1 3",
        "line 11, column `id`: 1 stands in line 10 as well",
    ),
    (
        "2 1 3",
        "-2 1 3",
        "line 10, column `id`: \"-2\" is not an id",
    ),
    ("0 10\n-2 6\n-1 1\n", "", ""),
];

fn expect(right: &str, wrong: &Wrong, read: fn(&str) -> Rows) {
    for (from, to, message) in wrong {
        let text = right.replacen(from, to, 1);
        assert_ne!(text, right, "{from}");
        match read(&text) {
            Err(told) => assert_eq!(told, *message, "{from} -> {to}"),
            // Bounds are only needed for scaled coordinates.
            Ok(_) => assert!(message.is_empty(), "{from} -> {to}"),
        }
    }
}

#[test]
fn a_wrong_file_is_told_with_line_column_and_value() {
    expect(XYZ, WRONG_XYZ, xyz);
    expect(DUMP, WRONG_DUMP, dump);
    let scaled = DUMP.replace("x y radius", "xs ys radius");
    let wrong: &Wrong = &[
        ("0 10\n-2 6\n-1 1\n", "0 10\n", "line 5: bounds are missing"),
        (
            "-2 6",
            "-2 6 0",
            "line 7: expected two bounds, not \"-2 6 0\"",
        ),
        (
            "-2 6",
            "-2 inf",
            "line 7, column `hi`: inf is not a number up to 1e30",
        ),
        (
            "ITEM: BOX",
            "ITEM: BX",
            "line 1: the frame has no `ITEM: BOX BOUNDS`",
        ),
    ];
    expect(&scaled, wrong, dump);
}

#[test]
fn what_is_no_list_is_told() {
    assert_eq!(xyz("").unwrap_err(), "the file is empty");
    assert_eq!(dump(" \n").unwrap_err(), "the file is empty");
    assert_eq!(xyz("2\n").unwrap_err(), "line 1: the file ends after it");
    let latin = read("a.xyz", b"1\nProperties=pos:R:2\n\xe9 1\n", None);
    assert_eq!(latin.unwrap_err(), "line 3: this is not text in UTF-8");
    let parquet = read("a.parquet", "", Some(0)).unwrap_err();
    assert_eq!(parquet, "a Parquet file has no frames");
    let other = read("a.pdb", "", None).unwrap_err();
    assert!(
        other.starts_with("expected a file that ends in .csv, "),
        "{other}"
    );
    assert!(
        read_grains(Path::new("nowhere.xyz"), None)
            .unwrap_err()
            .starts_with("cannot be read")
    );
}

#[test]
fn no_file_makes_a_panic() {
    const WORDS: [&str; 12] = [
        "ITEM: TIMESTEP",
        "ITEM: ATOMS",
        "18446744073709551615",
        "-1",
        "nan",
        "",
        "\n",
        "1e308",
        "\"",
        "=",
        ":",
        "é",
    ];
    for (text, read) in [(XYZ, xyz as fn(&str) -> Rows), (DUMP, dump)] {
        let mut draws = stream(1, Purpose::Order);
        for _ in 0..1000 {
            let mut parts: Vec<&str> = text.split_inclusive([' ', '\n', ':']).collect();
            for _ in 0..3 {
                let (place, word) = (draws.below(parts.len()), draws.below(2 * WORDS.len()));
                parts[place] = WORDS.get(word).copied().unwrap_or_default();
            }
            let _ = read(&parts.concat());
        }
    }
}

/// Among them are files on which libraries that decode them stop.
#[test]
fn whatever_fuzzing_begins_with_is_read_or_refused() {
    let room = tempfile::tempdir().expect("a temporary folder");
    let corpora = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../fuzz/corpus");
    let mut refused = 0;
    for ending in ["parquet", "xyz", "dump"] {
        let corpus = fs::read_dir(corpora.join(format!("grains_{ending}"))).expect("a corpus");
        for entry in corpus {
            let list = room.path().join(format!("list.{ending}"));
            fs::copy(entry.expect("a file").path(), &list).expect("room on the disk");
            refused += usize::from(read_grains(&list, None).is_err());
        }
    }
    assert!(refused > 2, "{refused}");
}
