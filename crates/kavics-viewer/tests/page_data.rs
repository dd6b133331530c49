//! Page data read back as the page reads them.

#[path = "../../kavics-results/tests/block/mod.rs"]
mod block;

use std::io::Read;
use std::path::Path;

use arrow_array::RecordBatch;
use arrow_array::cast::AsArray;
use arrow_array::types::{Float32Type, Float64Type, Int32Type, UInt8Type};
use arrow_ipc::reader::StreamReader;
use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use kavics::scene::Scene;
use kavics_results::ResultsFolder;
use kavics_viewer::{Content, Embedded, PageFolder, Piece, StepChoice, embed};

struct Block {
    place: tempfile::TempDir,
    folder: PageFolder,
}

/// The results of a block of 32 discs over five load steps.
fn block() -> Block {
    of_scene(&block::scene(7, 5))
}

fn of_scene(scene: &Scene) -> Block {
    let place = tempfile::tempdir().expect("a temporary folder");
    let path = place.path().join("block.results");
    block::write(&path, scene);
    let folder = PageFolder::open(&path).expect("results");
    Block { place, folder }
}

impl Block {
    fn results(&self) -> ResultsFolder {
        ResultsFolder::open(&self.place.path().join("block.results")).expect("results")
    }

    fn table(&self, name: &str, columns: Option<&[&str]>) -> RecordBatch {
        let piece = Piece::of_name(name).expect("a known name");
        match self.folder.piece(piece, columns).expect(name) {
            Content::Arrow(bytes) => batch(&bytes),
            Content::Json(text) => panic!("{text}"),
        }
    }

    fn json(&self, name: &str) -> serde_json::Value {
        let piece = Piece::of_name(name).expect("a known name");
        match self.folder.piece(piece, None).expect(name) {
            Content::Json(text) => serde_json::from_str(&text).expect("JSON"),
            Content::Arrow(_) => panic!("{name} is a table"),
        }
    }

    fn embedded(&self, choice: &StepChoice, budget: usize) -> Embedded {
        embed(&self.folder, choice, budget).expect("results")
    }
}

/// The only batch of a stream.
fn batch(bytes: &[u8]) -> RecordBatch {
    let reader = StreamReader::try_new(bytes, None).expect("an Arrow stream");
    let mut batches: Vec<RecordBatch> = reader.collect::<Result<_, _>>().expect("batches");
    assert_eq!(batches.len(), 1);
    batches.remove(0)
}

fn names(batch: &RecordBatch) -> Vec<String> {
    let schema = batch.schema();
    let fields = schema.fields().iter();
    fields.map(|field| field.name().clone()).collect()
}

fn singles(batch: &RecordBatch, column: &str) -> Vec<f32> {
    batch[column]
        .as_primitive::<Float32Type>()
        .values()
        .to_vec()
}

fn integers(batch: &RecordBatch, column: &str) -> Vec<i32> {
    batch[column].as_primitive::<Int32Type>().values().to_vec()
}

/// The words of a column, by the names in its metadata.
fn words(batch: &RecordBatch, column: &str) -> Vec<String> {
    let schema = batch.schema();
    let field = schema.field_with_name(column).expect("a column");
    let names: Vec<String> =
        serde_json::from_str(&field.metadata()["values"]).expect("names in JSON");
    let codes = batch[column].as_primitive::<UInt8Type>().values();
    codes
        .iter()
        .map(|&code| names[usize::from(code)].clone())
        .collect()
}

/// What stands in the elements of a page, by name.
fn element<'a>(html: &'a str, name: &str) -> Option<&'a str> {
    let start = html.find(&format!("data-name=\"{name}\""))?;
    let rest = &html[start..];
    let (from, to) = (rest.find('>')? + 1, rest.find("</script>")?);
    Some(&rest[from..to])
}

fn embedded_table(html: &str, name: &str) -> RecordBatch {
    let bytes = STANDARD
        .decode(element(html, name).expect(name))
        .expect("base64");
    let mut stream = Vec::new();
    let mut decoder = flate2::read::ZlibDecoder::new(bytes.as_slice());
    decoder.read_to_end(&mut stream).expect("the zlib format");
    batch(&stream)
}

#[test]
fn a_table_holds_the_values_of_the_results() {
    let block = block();
    let stored = block.results().grains(3).expect("a table");
    let table = block.table("grains/3", None);
    for column in ["x", "y", "radius", "ux", "uy", "stress_yy"] {
        let expected = stored.numbers(column).expect("a column");
        let expected: Vec<f32> = expected.iter().map(|&value| value as f32).collect();
        assert_eq!(singles(&table, column), expected, "{column}");
    }
    assert_eq!(
        words(&table, "state"),
        stored.texts("state").expect("words")
    );
    let contacts: Vec<Option<i64>> = stored.integers("contacts").expect("counts");
    let found: Vec<Option<i64>> = integers(&table, "contacts")
        .into_iter()
        .map(|count| Some(i64::from(count)))
        .collect();
    assert_eq!(found, contacts);
    assert!(!names(&table).contains(&"step".to_owned()));
}

#[test]
fn columns_come_as_asked_for() {
    let block = block();
    let columns = ["uy", "displacement", "x"];
    assert_eq!(names(&block.table("grains/3", Some(&columns))), columns);
    let steps = block.table("steps", Some(&["load_factor", "stage"]));
    assert_eq!(names(&steps), ["load_factor", "stage"]);
    let factors = steps["load_factor"]
        .as_primitive::<Float64Type>()
        .values()
        .to_vec();
    let stored = block.results().steps().expect("a table");
    assert_eq!(factors, stored.numbers("load_factor").expect("a column"));
}

#[test]
fn made_columns_are_made_of_their_sources() {
    let block = block();
    let grains = block.table("grains/5", None);
    let (ux, uy) = (singles(&grains, "ux"), singles(&grains, "uy"));
    let (xx, yy) = (singles(&grains, "stress_xx"), singles(&grains, "stress_yy"));
    let close = |found: f32, expected: f32| {
        assert!(
            (found - expected).abs() <= 1e-6 * expected.abs(),
            "{found} {expected}"
        );
    };
    for (row, found) in singles(&grains, "displacement").into_iter().enumerate() {
        close(found, ux[row].hypot(uy[row]));
    }
    for (row, found) in singles(&grains, "mean_stress").into_iter().enumerate() {
        close(found, 0.5 * (xx[row] + yy[row]));
    }
    let contacts = block.table("contacts/5", None);
    let (normal, shear) = (
        singles(&contacts, "normal_force"),
        singles(&contacts, "shear_force"),
    );
    for (row, found) in singles(&contacts, "total_force").into_iter().enumerate() {
        close(found, normal[row].hypot(shear[row]));
    }
}

#[test]
fn a_contact_tells_the_event_in_which_it_broke() {
    let block = block();
    let events = block.results().events().expect("a table");
    let kinds = events.texts("kind").expect("words");
    let contacts = events.integers("contact").expect("ids");
    let broken = |row: &usize| kinds[*row] == "broke";
    let rows: Vec<usize> = (0..events.len()).filter(broken).collect();
    assert!(!rows.is_empty());
    let after = integers(&block.table("contacts/5", Some(&["broke_at"])), "broke_at");
    for row in rows {
        let contact = contacts[row].expect("a contact") as usize;
        assert_eq!(after[contact], row as i32);
        let row = block.json(&format!("row/contacts/5/{contact}"));
        assert_eq!(row["broke_at"], after[contact]);
    }
    let before = integers(&block.table("contacts/0", Some(&["broke_at"])), "broke_at");
    assert!(before.iter().all(|&event| event == i32::MIN));
}

#[test]
fn a_row_has_full_precision() {
    let block = block();
    let stored = block.results().grains(2).expect("a table");
    let row = block.json("row/grains/2/17");
    assert_eq!(row["uy"], stored.numbers("uy").expect("a column")[17]);
    assert_eq!((&row["grain"], &row["step"]), (&17.into(), &2.into()));
    assert_eq!(row["state"], stored.texts("state").expect("words")[17]);
}

#[test]
fn crosses_of_the_window_are_its_measures() {
    let block = block();
    let table = block.table("crosses/1", None);
    let whole = integers(&table, "whole");
    let steps = block.results().steps().expect("a table");
    let sum = |name: &str| {
        let [xx, yy] = ["xx", "yy"].map(|part| steps.numbers(&format!("{name}_{part}")));
        xx.expect("a column")[0] + yy.expect("a column")[0]
    };
    let (major, minor) = (singles(&table, "major"), singles(&table, "minor"));
    let kinds = words(&table, "kind");
    for row in (0..whole.len()).filter(|&row| whole[row] == 1) {
        let trace = sum(&kinds[row]);
        assert!((f64::from(major[row] + minor[row]) - trace).abs() < 1e-5 * trace.abs());
    }
    // A fabric tensor has the trace 1, whatever it is of.
    for row in (0..whole.len()).filter(|&row| kinds[row] == "fabric") {
        assert!((major[row] + minor[row] - 1.0).abs() < 1e-6);
        assert!(major[row] >= minor[row]);
    }
}

#[test]
fn all_load_steps_and_columns_are_embedded_where_they_fit() {
    let block = block();
    let embedded = block.embedded(&StepChoice::Fitting, 10_000_000);
    assert_eq!(embedded.left_out, [] as [String; 0]);
    let run: serde_json::Value =
        serde_json::from_str(element(&embedded.html, "run.json").expect("a record")).expect("JSON");
    assert_eq!(run["recorded"], serde_json::json!([0, 1, 2, 3, 4, 5]));
    assert_eq!(run["embedded"], true);
    for step in 0..6 {
        let table = embedded_table(&embedded.html, &format!("grains/{step}"));
        let served = block.table(&format!("grains/{step}"), None);
        for column in names(&table) {
            assert_eq!(
                table[column.as_str()].as_ref(),
                served[column.as_str()].as_ref()
            );
        }
        // What never changes stands with the first alone.
        assert_eq!(names(&table).contains(&"radius".to_owned()), step == 0);
    }
    assert!(element(&embedded.html, "dual").is_some());
    assert!(element(&embedded.html, "cells/5").is_some());
}

#[test]
fn every_column_of_the_record_is_embedded() {
    let block = block();
    let html = block.embedded(&StepChoice::Fitting, 10_000_000).html;
    let run: serde_json::Value =
        serde_json::from_str(element(&html, "run.json").expect("a record")).expect("JSON");
    let tables = run["tables"].as_object().expect("tables");
    for (table, columns) in tables {
        let first = match table.as_str() {
            "steps" | "events" | "actions" => table.clone(),
            _ => format!("{table}/0"),
        };
        let embedded = names(&embedded_table(&html, &first));
        for column in columns.as_array().expect("columns") {
            let name = column["name"].as_str().expect("a name");
            assert!(embedded.contains(&name.to_owned()), "{table}: {name}");
        }
    }
}

#[test]
fn what_does_not_fit_is_left_out_and_told() {
    let block = block();
    let whole = block.embedded(&StepChoice::Fitting, 10_000_000).html.len();
    let mut shorter = whole;
    for part in 1..40 {
        let budget = whole - whole * part / 40;
        let embedded = block.embedded(&StepChoice::Fitting, budget);
        assert!(
            embedded.html.len() <= budget,
            "{} {budget}",
            embedded.html.len()
        );
        assert!(!embedded.left_out.is_empty(), "{budget}");
        shorter = shorter.min(embedded.html.len());
    }
    assert!(block.embedded(&StepChoice::Fitting, 100).html.is_empty());
    assert!(shorter < whole);
}

#[test]
fn named_load_steps_are_embedded_and_others_are_refused() {
    let block = block();
    let named = StepChoice::Named(vec![StepChoice::LAST, 2]);
    let html = block.embedded(&named, 10_000_000).html;
    assert!(html.contains("\"recorded\":[2,5]"));
    assert!(element(&html, "grains/2").is_some() && element(&html, "grains/5").is_some());
    assert!(element(&html, "grains/3").is_none());
    let error =
        embed(&block.folder, &StepChoice::Named(vec![7]), 10_000_000).expect_err("no step 7");
    assert_eq!(
        error.to_string(),
        "load step 7 is not recorded; those recorded are 0, 1, 2, 3, 4, 5"
    );
}

#[test]
fn the_same_bytes_are_embedded_on_any_number_of_threads() {
    let block = block();
    let on = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
        pool.expect("threads")
            .install(|| block.embedded(&StepChoice::Fitting, 40_000))
    };
    assert_eq!(on(1), on(3));
}

#[test]
fn a_folder_of_something_else_has_no_page() {
    let error = PageFolder::open(Path::new("/")).expect_err("no results");
    assert!(
        error.to_string().contains("is not a results folder"),
        "{error}"
    );
}
