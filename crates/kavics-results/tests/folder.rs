//! What stands in a results folder, and that it reads back.

mod block;

use std::fs;

use kavics::ids::{ContactId, GrainId, Id, PerGrain};
use kavics::measure::Tensor;
use kavics::packing::{Mass, SieveCurve};
use kavics::scene::Scene;
use kavics_results::{
    Columns, Options, Recorded, Results, ResultsError, ResultsFolder, RunState, check_room,
    read_grains, write_grains, write_steps,
};

fn place() -> tempfile::TempDir {
    tempfile::tempdir().expect("a temporary folder")
}

#[test]
fn steps_has_the_columns_of_the_contract_in_their_order() {
    let contract = "step stage load_factor iterations residual cuts contacts broken broken_in_step rattlers \
        coordination_number void_ratio graph_porosity graph_porosity_printed window_area \
        fabric_xx fabric_xy fabric_yy fabric_length_xx fabric_length_xy fabric_length_yy \
        branch_xx branch_xy branch_yy contact_xx contact_xy contact_yy \
        stress_xx stress_xy stress_yx stress_yy \
        shear_stress_xx shear_stress_xy shear_stress_yx shear_stress_yy \
        variation_stress_xx variation_stress_xy variation_stress_yx variation_stress_yy \
        fabric_stress_xx fabric_stress_xy fabric_stress_yx fabric_stress_yy isotropic_stress \
        strain_xx strain_xy strain_yx strain_yy contact_work macroscopic_work boundary_work \
        external_work elastic_energy fracture_energy friction_work nonpotential_work release_energy ledger_error \
        lowest_eigenvalue negative_eigenvalues zero_eigenvalues static_indeterminacy second_order_work \
        modulus_xxxx modulus_xxyy modulus_xxxy modulus_yyxx modulus_yyyy modulus_yyxy modulus_xyxx modulus_xyyy \
        modulus_xyxy voigt_modulus_xxxx voigt_modulus_xxyy voigt_modulus_xxxy voigt_modulus_yyxx voigt_modulus_yyyy \
        voigt_modulus_yyxy voigt_modulus_xyxx voigt_modulus_xyyy voigt_modulus_xyxy \
        bulk_modulus shear_modulus modulus_anisotropy modulus_asymmetry";
    let names: Vec<String> = kavics_results::step_columns()
        .into_iter()
        .map(|column| column.name)
        .collect();
    assert_eq!(names.join(" "), contract);
}

#[test]
fn run_json_keeps_the_container_and_the_wanted_curve() {
    let place = place();
    let folder = place.path().join("block.results");
    let curve = SieveCurve {
        diameter: vec![1.0, 3.0],
        passing: vec![0.0, 1.0],
        mass: Mass::Sphere,
    };
    let scene = Scene {
        wanted_curve: Some(curve.clone()),
        ..block::scene(7, 5)
    };
    block::write(&folder, &scene);
    let record = ResultsFolder::open(&folder).unwrap().record().unwrap();
    let packing = record.packing.unwrap();
    assert_eq!(packing.wanted_curve.map(SieveCurve::from), Some(curve));
    let height = 2.0 + 6.0 * 3f64.sqrt();
    for corner in [[0.0, 0.0], [10.0, 0.0], [10.0, height], [0.0, height]] {
        assert!(packing.container.contains(&corner), "{corner:?}");
    }
}

#[test]
fn tables_of_a_recorded_step_have_the_columns_of_the_contract() {
    let place = place();
    let folder = place.path().join("block.results");
    block::write(&folder, &block::scene(7, 5));
    let results = ResultsFolder::open(&folder).unwrap();
    let names = |table: Columns| table.names().join(" ");
    assert_eq!(
        names(results.grains(0).unwrap()),
        "step grain x y radius ux uy rotation fx fy moment contacts cell_area stress_xx stress_xy stress_yx \
         stress_yy state window"
    );
    assert_eq!(
        names(results.contacts(0).unwrap()),
        "step contact first second nx ny branch_length dual_length dual_length_full opening shear \
         relative_rotation normal_force shear_force bending_moment property law state x y"
    );
    assert_eq!(
        names(results.sides(0).unwrap()),
        "step side name ux uy rotation fx fy moment"
    );
    assert_eq!(
        names(results.events().unwrap()),
        "event step iteration load_factor contact grain kind mode fracture_energy release_energy avalanche displacement force"
    );
}

#[test]
fn modes_are_written_where_they_are_sought() {
    let place = place();
    let (without, with) = (place.path().join("without"), place.path().join("with"));
    let mut scene = block::scene(7, 5);
    block::write(&without, &scene);
    assert!(!without.join("modes").exists());
    scene.settings.modes = 1;
    block::write(&with, &scene);
    let results = ResultsFolder::open(&with).unwrap();
    assert!(results.modes(0).unwrap().is_none(), "before loading");
    let modes = results.modes(5).unwrap().expect("a table");
    assert_eq!(
        modes.names().join(" "),
        "step mode eigenvalue participation grain ux uy rotation"
    );
    assert_eq!(modes.len(), scene.assembly.grains.len());
    assert_eq!(modes.numbers("eigenvalue").unwrap()[0], 0.125);
    let steps = results.steps().unwrap();
    assert_eq!(steps.numbers("lowest_eigenvalue").unwrap(), [0.125; 5]);
    assert_eq!(
        steps.integers("static_indeterminacy").unwrap(),
        [Some(90); 5]
    );
    // K = 40, G = 20: C_xxxx = K + G, C_xxyy = K − G, C_xyxy = G.
    let row = |name: &str| steps.numbers(name).unwrap()[0];
    assert_eq!(
        [
            row("modulus_xxxx"),
            row("modulus_yyxx"),
            row("modulus_xyxy")
        ],
        [60.0, 20.0, 20.0]
    );
    assert_eq!([row("bulk_modulus"), row("shear_modulus")], [40.0, 20.0]);
    // A later run takes the room of the modes, too.
    assert!(check_room(&with, true).is_ok());
}

#[test]
fn what_was_pushed_reads_back() {
    let place = place();
    let folder = place.path().join("block.results");
    let scene = block::scene(7, 5);
    block::write(&folder, &scene);
    let results = ResultsFolder::open(&folder).unwrap();
    let steps = results.steps().unwrap();
    assert_eq!(steps.numbers("load_factor").unwrap(), block::FACTORS[1..]);
    assert_eq!(steps.texts("stage").unwrap(), ["compression"; 5]);
    assert_eq!(steps.integers("broken").unwrap(), [0, 0, 0, 0, 3].map(Some));
    let grains = results.grains(5).unwrap();
    let expected = block::equilibrium(&scene, 5).state;
    let uy = grains.numbers("uy").unwrap();
    assert_eq!(uy[31], expected.displacements.values()[31].y);
    assert_eq!(results.record().unwrap().state, RunState::Done);
    assert_eq!(results.recorded_steps().unwrap(), [0, 1, 2, 3, 4, 5]);
}

#[test]
fn a_recorded_step_is_the_state_that_was_pushed() {
    let place = place();
    let folder = place.path().join("block.results");
    let scene = block::scene(7, 5);
    block::write(&folder, &scene);
    let folder = ResultsFolder::open(&folder).unwrap();
    let recorded = Recorded::read(&folder, 5, &scene).unwrap();
    let pushed = block::equilibrium(&scene, 5).state;
    assert_eq!(recorded.state.contacts, pushed.contacts);
    assert_eq!(recorded.state.displacements, pushed.displacements);
    assert_eq!(folder.step_rows().unwrap()[4].broken, 3);
}

#[test]
fn a_measure_of_an_empty_window_is_null() {
    let place = place();
    let folder = place.path().join("block.results");
    let scene = block::scene(7, 5);
    let stress = PerGrain::filled(Tensor::default(), 32);
    let mut results = Results::create(&folder, &scene, Options::default()).unwrap();
    results
        .push(
            &block::equilibrium(&scene, 1),
            &kavics::measure::Measures::default(),
            &stress,
        )
        .unwrap();
    results.finish(RunState::Done, None).unwrap();
    let steps = ResultsFolder::open(&folder).unwrap().steps().unwrap();
    assert!(steps.numbers("stress_yy").unwrap()[0].is_nan());
}

#[test]
fn the_last_step_is_recorded_whatever_the_interval() {
    let place = place();
    let folder = place.path().join("block.results");
    let mut scene = block::scene(7, 5);
    scene.record_every = 3;
    block::write(&folder, &scene);
    let folder = ResultsFolder::open(&folder).unwrap();
    assert_eq!(folder.recorded_steps().unwrap(), [0, 3, 5]);
}

#[test]
fn void_cells_are_recorded_when_asked_for() {
    let place = place();
    let folder = place.path().join("block.results");
    let mut scene = block::scene(7, 5);
    block::write(&folder, &scene);
    assert!(!folder.join("voids").exists());

    scene.record_voids = true;
    let folder = place.path().join("voids.results");
    block::write(&folder, &scene);
    let folder = ResultsFolder::open(&folder).unwrap();
    // Six strips of 4 + 3 triangles of discs of radius 1.
    assert_eq!(
        folder.voids(0).unwrap().integers("order").unwrap(),
        [Some(3); 42]
    );
    for step in folder.recorded_steps().unwrap() {
        // Contacts that break join cells, and leave their area as it was.
        let voids = folder.voids(step).unwrap();
        let area: f64 = voids.numbers("area").unwrap().iter().sum();
        assert!((area - 42.0 * 3f64.sqrt()).abs() < 1e-11);
        assert_eq!(voids.integers("step").unwrap()[0], Some(step as i64));
    }
    assert!(folder.voids(5).unwrap().len() < 42);
}

#[test]
fn cracks_are_recorded_when_asked_for() {
    let place = place();
    let folder = place.path().join("block.results");
    let mut scene = block::scene(7, 5);
    scene.record_cracks = true;
    block::write(&folder, &scene);
    let folder = ResultsFolder::open(&folder).unwrap();
    assert_eq!(folder.cracks(0).unwrap().unwrap().len(), 0);
    // Every broken contact lies in one crack.
    let cracks = folder.cracks(5).unwrap().unwrap();
    let contacts: i64 = cracks
        .integers("contacts")
        .unwrap()
        .into_iter()
        .flatten()
        .sum();
    let states = folder.contacts(5).unwrap();
    let broken = states.texts("state").unwrap();
    assert_eq!(
        contacts as usize,
        broken.iter().filter(|state| **state == "broken").count()
    );
    assert!(contacts > 0);
}

#[test]
fn two_runs_write_the_same_bytes() {
    let place = place();
    let scene = block::scene(7, 5);
    let [first, second] = ["a", "b"].map(|name| place.path().join(name));
    block::write(&first, &scene);
    block::write(&second, &scene);
    assert_eq!(block::files(&first), block::files(&second));
}

#[test]
fn states_of_grains_and_contacts_have_their_words() {
    let place = place();
    let folder = place.path().join("block.results");
    block::write(&folder, &block::scene(7, 5));
    let folder = ResultsFolder::open(&folder).unwrap();
    let grains = folder.grains(5).unwrap();
    assert_eq!(
        grains.texts("state").unwrap()[..6],
        ["held", "held", "held", "held", "held", "free"]
    );
    let contacts = folder.contacts(5).unwrap();
    let states = contacts.texts("state").unwrap();
    assert_eq!(states.iter().filter(|state| **state == "broken").count(), 3);
    assert_eq!(contacts.integers("second").unwrap().last(), Some(&Some(-3)));
}

#[test]
fn finished_results_are_not_replaced_unasked() {
    let place = place();
    let folder = place.path().join("block.results");
    block::write(&folder, &block::scene(7, 5));
    let before = block::files(&folder);
    assert!(matches!(
        check_room(&folder, false),
        Err(ResultsError::Exists { .. })
    ));
    assert_eq!(block::files(&folder), before);
    assert!(check_room(&folder, true).is_ok());
}

#[test]
fn a_folder_that_holds_something_else_is_never_replaced() {
    let place = place();
    fs::write(place.path().join("thesis.tex"), "all of it").unwrap();
    assert!(matches!(
        check_room(place.path(), true),
        Err(ResultsError::NotResults { .. })
    ));
}

#[test]
fn grains_read_back_as_the_same_bits() {
    let place = place();
    let scene = block::scene(7, 5);
    let path = place.path().join("pack.parquet");
    write_grains(&path, scene.assembly.grains.values()).unwrap();
    let read = read_grains(&path, None).unwrap();
    let grain = scene.assembly.grains[GrainId(31)];
    assert_eq!(read[31], [grain.centre.x, grain.centre.y, grain.radius]);
}

#[test]
fn a_grain_list_without_radii_is_named() {
    let place = place();
    let path = place.path().join("pack.parquet");
    write_steps(&path, &[]).unwrap();
    let message = read_grains(&path, None).unwrap_err();
    assert!(message.ends_with("no column is called \"x\""), "{message}");
}

#[test]
fn only_lists_of_known_endings_are_written() {
    let place = place();
    let path = place.path().join("pack.xlsx");
    assert!(matches!(
        write_grains(&path, &[]),
        Err(ResultsError::UnknownEnding { .. })
    ));
}

#[test]
fn an_event_names_its_contact_and_no_grain() {
    let place = place();
    let folder = place.path().join("block.results");
    let scene = block::scene(7, 5);
    block::write(&folder, &scene);
    let events = ResultsFolder::open(&folder).unwrap().events().unwrap();
    let broken: Vec<i64> = block::equilibrium(&scene, 5)
        .state
        .contacts
        .iter()
        .filter(|(_, state)| state.broken)
        .map(|(id, _): (ContactId, _)| id.index() as i64)
        .collect();
    let contacts = events.integers("contact").unwrap();
    assert_eq!(contacts, broken.into_iter().map(Some).collect::<Vec<_>>());
    assert_eq!(events.integers("grain").unwrap(), [None; 3]);
    assert_eq!(events.texts("mode").unwrap(), ["tension"; 3]);
}

#[test]
fn force_and_displacement_of_a_load_are_conjugate() {
    let place = place();
    let folder = place.path().join("block.results");
    let scene = block::scene(7, 5);
    block::write(&folder, &scene);
    let actions = ResultsFolder::open(&folder).unwrap().actions().unwrap();
    // Five grains carry 60 each; the top row lies at y = 1 + 6√3 and goes down by 0.011·y.
    assert_eq!(actions.numbers("force").unwrap()[1], 300.0);
    let expected = 0.011 * (1.0 + 6.0 * 3f64.sqrt());
    let displacement = actions.numbers("displacement").unwrap()[1];
    assert!((displacement - expected).abs() < 1e-14, "{displacement}");
}

#[test]
fn only_files_of_a_run_are_taken_away() {
    let place = place();
    let folder = place.path().join("block.results");
    let scene = block::scene(3, 3);
    block::write(&folder, &scene);
    let replace = Options {
        threads: 1,
        replace: true,
    };
    fs::write(folder.join("notes.txt"), "all of it").expect("room on the disk");
    assert!(matches!(
        Results::create(&folder, &scene, replace),
        Err(ResultsError::NotOfARun { .. })
    ));
    assert!(folder.join("steps.parquet").is_file());
    fs::remove_file(folder.join("notes.txt")).expect("a file");
    Results::create(&folder, &scene, replace).expect("room");
    assert!(!folder.join("grains/000001.parquet").exists());
}

#[cfg(unix)]
#[test]
fn a_link_stays_and_what_is_no_file_is_not_replaced() {
    use std::os::unix::fs::{FileTypeExt, symlink};
    use std::os::unix::net::UnixListener;

    let place = place();
    let (page, link) = (place.path().join("page.html"), place.path().join("link"));
    symlink("page.html", &link).expect("a link");
    for text in ["one", "two"] {
        kavics_results::publish(&link, text.as_bytes()).expect("a page");
        assert_eq!(fs::read_to_string(&page).expect("a page"), text);
        assert!(fs::symlink_metadata(&link).expect("a link").is_symlink());
    }
    let socket = place.path().join("socket");
    let _listener = UnixListener::bind(&socket).expect("a socket");
    assert!(kavics_results::publish(&socket, b"one").is_err());
    let kind = fs::metadata(&socket).expect("a socket").file_type();
    assert!(kind.is_socket());
}

/// Writes a table again without some of its columns, as a version that did not know them would have.
fn leave_out(path: &std::path::Path, columns: &[&str]) {
    let table = Columns::read(path).expect("a table");
    let fields = table.schema().fields().iter().enumerate();
    let kept: Vec<usize> = fields
        .filter(|(_, field)| !columns.contains(&field.name().as_str()))
        .map(|(index, _)| index)
        .collect();
    let batch = table.batches()[0].project(&kept).expect("columns");
    let file = std::fs::File::create(path).expect("room on the disk");
    let writer = parquet::arrow::ArrowWriter::try_new(file, batch.schema(), None);
    let mut writer = writer.expect("a writer");
    writer.write(&batch).expect("room on the disk");
    writer.close().expect("room on the disk");
}

#[test]
fn tables_that_lack_later_columns_are_read() {
    let place = place();
    let path = place.path().join("block.results");
    block::write(&path, &block::scene(7, 5));
    let folder = ResultsFolder::open(&path).expect("results");
    let later = ["lowest_eigenvalue", "second_order_work", "shear_modulus"];
    leave_out(&path.join("steps.parquet"), &later);
    for table in ["grains/000000.parquet", "grains/000005.parquet"] {
        leave_out(&path.join(table), &["window"]);
    }
    assert_eq!(
        folder.step_rows().expect("rows").len(),
        block::FACTORS.len() - 1
    );
    let grains = folder.grains(5).expect("a table");
    assert!(grains.numbers("ux").is_ok());
    let lacking = grains.integers("window").expect_err("no such column");
    assert!(
        lacking
            .to_string()
            .contains("no column is called \"window\"")
    );
}

#[test]
fn a_column_that_is_needed_and_lacking_is_named_with_its_file() {
    let place = place();
    let path = place.path().join("block.results");
    block::write(&path, &block::scene(7, 5));
    leave_out(&path.join("steps.parquet"), &["load_factor"]);
    let folder = ResultsFolder::open(&path).expect("results");
    let lacking = folder.step_rows().expect_err("no such column").to_string();
    assert!(
        lacking.contains("steps.parquet") && lacking.contains("\"load_factor\""),
        "{lacking}"
    );
}
