//! What stands on the page.

#[path = "../../kavics-results/tests/block/mod.rs"]
mod block;

use std::fs;
use std::path::{Path, PathBuf};

use kavics::packing::{Mass, SieveCurve};
use kavics::scene::Scene;
use kavics_report::{Comparison, StepChoice};
use kavics_results::ResultsFolder;

fn page_of(place: &Path, scene: &Scene) -> String {
    let folder = place.join("block.results");
    block::write(&folder, scene);
    let path = kavics_report::write(&folder, None).expect("a report");
    fs::read_to_string(path).expect("a page")
}

fn place() -> tempfile::TempDir {
    tempfile::tempdir().expect("a temporary folder")
}

fn with_table(place: &Path, text: &str) -> Scene {
    let path: PathBuf = place.join("table.csv");
    fs::write(&path, text).expect("room on the disk");
    Scene {
        compare: Some(path),
        ..block::scene(7, 5)
    }
}

/// The only script that runs, and the page without it.
fn parted(page: &str) -> (String, String) {
    assert_eq!(page.matches("<script>").count(), 1);
    let (before, rest) = page.split_once("<script>").expect("a script");
    let (script, after) = rest.split_once("</script>").expect("its end");
    (script.to_owned(), format!("{before}{after}"))
}

#[test]
fn the_page_has_the_script_of_the_viewer_alone_and_no_network() {
    let place = place();
    let page = page_of(place.path(), &block::scene(7, 5));
    let (script, rest) = parted(&page);
    let policy = format!(
        "content=\"default-src 'none'; script-src {};",
        kavics_viewer::admitted(&script)
    );
    assert!(rest.contains(&policy), "{policy}");
    for foreign in [
        "http://", "https://", "url(", "@import", "<link", "<img", " src=", "<iframe", "onclick",
    ] {
        assert!(!rest.contains(foreign), "{foreign}");
    }
}

#[test]
fn the_viewer_has_the_data_of_its_load_steps() {
    let place = place();
    let page = page_of(place.path(), &block::scene(7, 5));
    for part in ["run.json", "steps", "events", "grains/0", "contacts/5"] {
        assert!(page.contains(&format!("data-name=\"{part}\"")), "{part}");
    }
    let path = place.path().join("two.html");
    let two = StepChoice::Named(vec![3, StepChoice::LAST]);
    let folder = place.path().join("block.results");
    kavics_report::write_steps(&folder, Some(&path), &two).expect("a report");
    let page = fs::read_to_string(path).expect("a page");
    assert!(page.contains("data-name=\"grains/3\"") && !page.contains("data-name=\"grains/0\""));
}

#[test]
fn the_scene_stands_in_the_page_as_text() {
    let place = place();
    let mut scene = block::scene(7, 5);
    scene.text = "title = \"a <b>\"".to_owned();
    let (_, rest) = parted(&page_of(place.path(), &scene));
    let shown = rest.split_once("<pre class=\"scene\">").expect("a scene").1;
    assert!(shown.contains("a &lt;b&gt;"), "{shown}");
    assert!(!rest.contains("a <b>"));
}

#[test]
fn the_stress_parts_stand_as_in_the_printed_table() {
    let place = place();
    let page = page_of(place.path(), &block::scene(7, 5));
    // Bojtár & Bagi (1989), section 5, load steps 1 and 5.
    for printed in [
        "1. (1.00)",
        "5.305",
        "−5.305",
        "−15.180",
        "10.363",
        "2.784",
        "−27.333",
        "0.759",
    ] {
        assert!(page.contains(printed), "{printed}");
    }
}

#[test]
fn steps_around_the_first_breakage_are_drawn() {
    let place = place();
    let page = page_of(place.path(), &block::scene(7, 5));
    assert!(page.contains("Load step 4<"));
    assert!(page.contains("Load step 5<small>load factor 1.8 · 3 broken"));
}

#[test]
fn the_packing_stands_before_the_curves() {
    let place = place();
    let scene = Scene {
        wanted_curve: Some(SieveCurve {
            diameter: vec![1.0, 3.0],
            passing: vec![0.0, 1.0],
            mass: Mass::Sphere,
        }),
        ..block::scene(7, 5)
    };
    let page = page_of(place.path(), &scene);
    let packing = page.find("<h2>Packing</h2>").expect("a section");
    assert!(
        packing
            < page
                .find("<h2>Load and displacement</h2>")
                .expect("another")
    );
    for part in [
        "<figcaption>Sieve curve",
        "wanted</li>",
        "mass grows as d³",
        "<figcaption>Packing fraction over the height",
        "<figcaption>Coordination",
        "<figcaption>Contact normals",
        "<ellipse",
    ] {
        assert!(page.contains(part), "{part}");
    }
    // A hexagonal lattice has six directions; 32 unit discs stand in a box of 10 by 2 + 6·√3: 0.8112.
    assert_eq!(page.matches("filled sector").count(), 6);
    assert!(page.contains("0.8112 from the floor to the highest grain"));
}

#[test]
fn results_that_do_not_know_their_container_have_no_packing_fraction() {
    let place = place();
    page_of(place.path(), &block::scene(7, 5));
    let folder = place.path().join("block.results");
    let path = folder.join("run.json");
    let text = fs::read_to_string(&path).expect("a record");
    let start = text.find(",\n  \"packing\"").expect("the last key");
    fs::write(&path, format!("{}}}", &text[..start])).expect("room on the disk");
    let path = kavics_report::write(&folder, None).expect("a report");
    let page = fs::read_to_string(path).expect("a page");
    assert!(page.contains("<figcaption>Sieve curve"));
    assert!(!page.contains("over the height"));
}

#[test]
fn modes_are_drawn_and_moduli_stand_beside_their_bound() {
    let place = place();
    let mut scene = block::scene(7, 5);
    let page = page_of(place.path(), &scene);
    assert!(!page.contains("<h2>Lowest modes</h2>"));
    scene.settings.modes = 1;
    let other = place.path().join("other");
    fs::create_dir(&other).expect("room on the disk");
    let page = page_of(&other, &scene);
    for part in [
        "Mode 1<small>eigenvalue 0.125 · participation 20",
        "class=\"moved\"",
        "<figcaption>Lowest eigenvalue",
        "<figcaption>Static indeterminacy",
        "<figcaption>Bulk and shear modulus",
    ] {
        assert!(page.contains(part), "{part}");
    }
    // The grains of the uppermost row move most.
    assert!(page.contains("Most of all move the grains 27, 28, 29, 30, 31."));
    // K = 40 of 50, G = 20 of 40, ν = (K − G)/(K + G).
    assert!(page.contains(
        "<td>40</td><td>0.800</td><td>20</td><td>0.500</td><td>0.333</td><td>0.000</td>"
    ));
}

#[test]
fn broken_bonds_stand_in_the_order_of_their_breaks() {
    let place = place();
    let mut scene = block::scene(7, 5);
    scene.record_cracks = true;
    let page = page_of(place.path(), &scene);
    for part in [
        "<h2>Fracture</h2>",
        "<p>3 bonds broke, the first at load factor 1.8, none above 1.8.</p>",
        "<figcaption>Load factor from break to break",
        "<figcaption>Energy taken and set free so far",
        ">order of breaking</text>",
        "<small>chains of broken contacts</small>",
    ] {
        assert!(page.contains(part), "{part}");
    }
    // The first, second and third of three breaks, as lines; the shades of the legend are filled.
    for step in [0, 4, 7] {
        let class = format!("class=\"line order{step}\"");
        assert_eq!(page.matches(&class).count(), 1, "{step}");
    }
}

#[test]
fn where_nothing_breaks_there_is_no_fracture() {
    let place = place();
    let folder = place.path().join("block.results");
    let scene = block::scene(7, 5);
    let results =
        kavics_results::Results::create(&folder, &scene, kavics_results::Options::default());
    results
        .expect("an empty place")
        .finish(kavics_results::RunState::Done, None)
        .expect("room on the disk");
    let path = kavics_report::write(&folder, None).expect("a report");
    let page = fs::read_to_string(path).expect("a page");
    assert!(!page.contains("<h2>Fracture</h2>"));
}

#[test]
fn a_title_is_text_and_no_markup() {
    let place = place();
    let mut scene = block::scene(7, 5);
    scene.title = "a <b> & c".to_owned();
    let page = page_of(place.path(), &scene);
    assert!(page.contains("<h1>a &lt;b&gt; &amp; c</h1>"));
}

#[test]
fn a_compared_table_shows_its_notes_and_the_differences() {
    let place = place();
    let table =
        "# the geometry is a reconstruction\nload_factor,shear_stress_xx\n1.0,5.0\n1.8,10.0\n";
    let scene = with_table(place.path(), table);
    let page = page_of(place.path(), &scene);
    assert!(page.contains("the geometry is a reconstruction"));
    assert!(page.contains("<td>5.305</td><td>5</td><td>0.305</td>"));
}

#[test]
fn a_table_is_matched_by_load_factor() {
    let place = place();
    let scene = with_table(
        place.path(),
        "load_factor,stress_yy\n1.4,-42.1\n1.8,-54.13\n",
    );
    let folder = place.path().join("block.results");
    block::write(&folder, &scene);
    let comparison = Comparison::read(&ResultsFolder::open(&folder).expect("results"))
        .expect("a table")
        .expect("one is named");
    assert_eq!(comparison.matched_by, "load_factor");
    let labels: Vec<&str> = comparison.columns[0]
        .rows
        .iter()
        .map(|row| row.label.as_str())
        .collect();
    assert_eq!(labels, ["1.4", "1.8"]);
}

#[test]
fn a_table_without_a_known_column_is_refused() {
    let place = place();
    let scene = with_table(place.path(), "pressure\n1.0\n");
    let folder = place.path().join("block.results");
    block::write(&folder, &scene);
    let message = kavics_report::write(&folder, None)
        .expect_err("nothing to compare")
        .to_string();
    assert_eq!(
        message,
        "compare.csv: no column has the name of a column of steps"
    );
}

#[test]
fn results_without_a_load_step_have_a_page() {
    let place = place();
    let folder = place.path().join("block.results");
    let scene = block::scene(7, 5);
    let results =
        kavics_results::Results::create(&folder, &scene, kavics_results::Options::default());
    let failure = Some("load step 1: mechanism".to_owned());
    results
        .expect("an empty place")
        .finish(kavics_results::RunState::NoEquilibrium, failure)
        .expect("room on the disk");
    let path = kavics_report::write(&folder, None).expect("a report");
    let page = fs::read_to_string(path).expect("a page");
    assert!(page.contains("load step 1: mechanism"));
}

#[test]
fn a_large_assembly_stays_below_thirty_megabytes_and_says_what_is_left_out() {
    let place = place();
    let page = page_of(place.path(), &block::scene(317, 316));
    assert!(page.len() < 30_000_000, "{}", page.len());
    assert!(page.contains("<h2>Viewer</h2>"));
    assert!(page.contains("<code>kavics view</code> shows all that is recorded."));
    // Outlines of grains would be long; that of a grain in the legend is short.
    let rims = page.split("class=\"line rim\"").skip(1);
    assert!(
        rims.map(|rim| rim.find('>').unwrap_or(0))
            .all(|length| length < 200)
    );
}
