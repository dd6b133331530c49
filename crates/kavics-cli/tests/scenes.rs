//! Every scene of `scenes/`, run by the command, shows what it is for.

mod support;

use assert_cmd::Command;
use support::{Run, Tables, workspace};

fn done(name: &str) -> Run {
    let run = Run::scene(name);
    assert_eq!(run.status, 0, "{}", run.stderr);
    run
}

/// Force on a side in each load step.
fn side_force(run: &Run, side: usize, component: fn((f64, f64)) -> f64) -> Vec<f64> {
    (1..=run.last_step())
        .map(|step| {
            let force = Tables::read(run, step).sides[side].0;
            component((force.0, force.1))
        })
        .collect()
}

const LEFT: usize = 0;
const TOP: usize = 3;

fn largest(values: &[f64]) -> f64 {
    values.iter().fold(0.0, |a, b| b.abs().max(a))
}

/// Two straight segments through the origin: before and after the lower contact breaks.
#[test]
fn three_discs_weaken_once_and_return_to_the_origin() {
    let run = done("three-discs.toml");
    let factors = run.steps("load_factor");
    let compliance: Vec<f64> = (1..=7)
        .map(|step| Tables::read(&run, step).grains[2].translation.1 / factors[step - 1])
        .collect();
    let same = |a: usize, b: usize| (compliance[a] / compliance[b] - 1.0).abs() < 1e-12;
    assert!(same(0, 1) && same(2, 3) && same(2, 4) && same(2, 6));
    assert!(compliance[2] < 2.0 * compliance[1]);
    assert_eq!(run.steps("broken"), [0.0, 0.0, 1.0, 1.0, 1.0, 1.0, 1.0]);
    let unloaded = &Tables::read(&run, 6).grains[2];
    assert!(unloaded.translation.length() < 1e-14);
}

/// Statics fixes the mean vertical stress, whatever breaks.
#[test]
fn block_32_keeps_its_vertical_stress_and_its_symmetry() {
    let run = done("block-32.toml");
    let (factors, stress) = (run.steps("load_factor"), run.steps("stress_yy"));
    for (factor, stress_yy) in factors.iter().zip(&stress) {
        assert!((stress_yy / factor / stress[0] - 1.0).abs() < 1e-9);
    }
    let last = Tables::read(&run, 5);
    let mirrored = |x: f64, y: f64| {
        let at = |c: &&support::ContactRow| (c.point.0 - (10.0 - x)).hypot(c.point.1 - y) < 1e-9;
        last.contacts.iter().find(at).expect("a mirror image")
    };
    for contact in &last.contacts {
        let image = mirrored(contact.point.0, contact.point.1);
        assert_eq!(contact.state, image.state);
        assert!((contact.normal_force - image.normal_force).abs() < 1e-8 * last.largest_force());
    }
    let largest_motion = last.grains.iter().map(|g| g.translation.length());
    assert!(largest_motion.fold(0.0, f64::max) < 0.01);
    let events = run.table("events", 0).expect("events");
    let iterations = events.numbers("iteration").expect("iterations");
    assert_eq!(iterations.len(), 2);
    assert_eq!(iterations[0], iterations[1], "no cascade");
    assert!(run.stderr.contains("reconstruction"));
}

#[test]
fn cantilever_breaks_at_the_root() {
    let run = done("cantilever.toml");
    assert_eq!(run.steps("broken").last(), Some(&1.0));
    assert_eq!(
        Tables::read(&run, run.last_step()).contacts[0].state,
        "closed"
    );
}

#[test]
fn brazilian_disc_splits_along_the_loaded_line() {
    let run = done("brazilian.toml");
    let first = run.steps("broken").iter().position(|broken| *broken > 0.0);
    let events = run.table("events", 0).expect("events");
    let mode = events.texts("mode").expect("modes");
    assert!(first.is_some() && mode[0] == "tension");
    let last = Tables::read(&run, run.last_step());
    let broken: Vec<f64> = last
        .contacts
        .iter()
        .filter(|c| c.state == "broken")
        .map(|c| (c.point.0 - 29.0).abs())
        .collect();
    let near = broken.iter().filter(|distance| **distance < 10.0).count();
    assert!(2 * near > broken.len(), "{near} of {}", broken.len());
}

#[test]
fn tension_ends_with_two_pieces() {
    let run = done("tension.toml");
    let force = side_force(&run, TOP, |f| f.1);
    assert!(largest(&force) > 0.0);
    assert!(force.last().unwrap().abs() < 1e-6 * largest(&force));
    let events = run.table("events", 0).expect("events");
    assert!(events.texts("kind").expect("kinds").contains(&"broke"));
}

/// A narrower block than the scene's, for the time it takes.
#[test]
fn softening_goes_past_its_peak_to_separation() {
    let scene = workspace().join("scenes/softening.toml");
    let narrower = ["box.width=12.0", "grains.dropped.count=160"];
    let run = Run::of("run", &scene, &["--set", narrower[0], "--set", narrower[1]]);
    assert_eq!(run.status, 0, "{}", run.stderr);
    assert!(run.stderr.contains("separated"), "{}", run.stderr);
    let (factor, error) = (run.steps("load_factor"), run.steps("ledger_error"));
    let work = largest(&run.steps("external_work"));
    assert!(factor.last() == Some(&0.0) && largest(&factor) > 1.0);
    assert!(largest(&error) < 1e-3 * work, "{} {work}", largest(&error));
}

#[test]
fn shear_breaks_contacts_under_a_constant_weight() {
    let run = done("shear.toml");
    assert!(*run.steps("broken").last().unwrap() > 5.0);
    let vertical = side_force(&run, TOP, |f| f.1);
    assert!(vertical.iter().all(|force| (force + 10.0).abs() < 1e-6));
    let drag = side_force(&run, TOP, |f| f.0);
    assert!(largest(&drag) > 1.0);
}

#[test]
fn biaxial_compression_passes_its_peak_under_constant_cell_pressure() {
    let run = done("biaxial.toml");
    let cell = side_force(&run, LEFT, |f| f.0);
    assert!(cell.iter().all(|force| (force - 30.0).abs() < 1e-6));
    let lid = side_force(&run, TOP, |f| f.1);
    assert!(lid.last().unwrap().abs() < 0.75 * largest(&lid));
}

/// A smaller block than the scene has. Its upper piece goes on as a rigid body, with the rounding of its motion alone.
#[test]
fn a_disordered_block_comes_apart_bond_by_bond() {
    let scene = workspace().join("scenes/disordered-block.toml");
    let smaller = [
        "--set",
        "box.width=60.0",
        "--set",
        "grains.dropped.count=3000",
        "--set",
        "seed=2",
        "--set",
        "record.every=1",
    ];
    let run = Run::of("run", &scene, &smaller);
    assert_eq!(run.status, 0, "{}", run.stderr);
    let force = side_force(&run, TOP, |f| f.1);
    assert!(force.last().unwrap().abs() < 1e-9 * largest(&force));
    let events = run.table("events", 0).expect("events");
    let factors = events.numbers("load_factor").expect("factors");
    assert!(factors.windows(2).any(|pair| pair[1] < 0.8 * pair[0]));
    // The longest crack crosses the block.
    let cracks = run.table("cracks", run.last_step()).expect("cracks");
    assert!(cracks.numbers("extent").expect("extents")[0] > 0.5 * 60.0);
}

/// Hemmer & Hansen (1992): the bundle bears 1/4 a fibre, but for 1/√N.
#[test]
fn a_fibre_bundle_breaks_fibre_by_fibre() {
    let run = Run::scene("fibre-bundle.toml");
    assert_eq!(run.status, 3, "{}", run.stderr);
    let events = run.table("events", 0).expect("events");
    let factors = events.numbers("load_factor").expect("factors");
    // With the last fibre the load would have nothing to bear it.
    assert_eq!(factors.len(), 999);
    assert!((largest(&factors) - 0.25).abs() < 1.0 / 1000f64.sqrt());
}

/// The stress at rest: sides that do not yield carry less than the lid.
#[test]
fn oedometer_presses_on_its_sides() {
    let run = done("oedometer.toml");
    let (xx, yy) = (run.steps("stress_xx"), run.steps("stress_yy"));
    for (xx, yy) in xx.iter().zip(yy) {
        assert!(yy < 0.0 && *xx < 0.0 && xx / yy < 1.0);
    }
}

#[test]
fn patch_is_in_balance_in_an_affine_motion() {
    let run = done("patch.toml");
    let residual = run.steps("residual");
    assert!(residual.iter().all(|residual| *residual < 1e-11));
    let free = Tables::read(&run, 1);
    let free = free.grains.iter().filter(|grain| grain.state == "free");
    assert!(free.count() > 50);
}

#[test]
fn dropped_1000_crumbles() {
    let arguments = ["--set", "record.every=1"];
    let scene = workspace().join("scenes/dropped-1000.toml");
    let run = Run::of("run", &scene, &arguments);
    assert_eq!(run.status, 0, "{}", run.stderr);
    let broken = run.steps("broken");
    assert_eq!(broken.len(), 60);
    assert!(broken[59] >= 100.0, "{} contacts broke", broken[59]);
    let first = broken.iter().position(|count| *count > 0.0).unwrap() + 1;
    assert!(
        (15..=60).contains(&(60 / first)),
        "first break at step {first}"
    );
    let force = side_force(&run, 1, |f| f.0);
    assert!(force[59].abs() < 0.5 * largest(&force));
    assert!(broken[59] > broken[first]);
    let last = Tables::read(&run, 60);
    let at_sides = last.contacts.iter().filter(|c| c.second.is_none());
    assert!(at_sides.clone().count() > 50);
    assert!(at_sides.clone().all(|c| c.state == "intact"));
}

#[test]
fn sandbox_opens_and_slides() {
    let run = done("sandbox.toml");
    let last = Tables::read(&run, 10);
    let count = |state: &str| last.contacts.iter().filter(|c| c.state == state).count();
    assert!(count("open") >= 15, "{} open", count("open"));
    assert!(count("sliding") >= 1);
    let weight: f64 = last.grains.iter().map(|g| -g.force.1).sum();
    let floor = last.sides[2].0.1 + last.sides[0].0.1 + last.sides[1].0.1;
    assert!((weight / (114.0 * std::f64::consts::PI) - 1.0).abs() < 1e-9);
    assert!((floor + weight).abs() < 1e-6 * weight || (floor - weight).abs() < 1e-6 * weight);
}

/// Ten times stiffer in shear: an equilibrium, or a clear word that there is none.
#[test]
fn a_stiffer_sandbox_is_honest() {
    let scene = workspace().join("scenes/sandbox.toml");
    for shear in ["100.0", "500.0"] {
        let set = format!("contact.sand.cohesionless.stiffness.direct.shear={shear}");
        let run = Run::of("run", &scene, &["--set", &set]);
        match run.status {
            0 => assert_eq!(run.steps("load_factor").last(), Some(&1.0)),
            3 => assert!(run.stderr.contains("beyond load factor"), "{}", run.stderr),
            other => panic!("{shear}: status {other}\n{}", run.stderr),
        }
    }
}

#[test]
fn sandbox_dropped_says_why_it_ends() {
    let run = Run::scene("sandbox-dropped.toml");
    assert_eq!(run.status, 3, "{}", run.stderr);
    assert!(run.stderr.contains("beyond load factor"));
    assert!(run.stderr.contains("no friction"));
    assert!(run.last_step() >= 2);
}

/// By the divergence theorem the mean stress of the whole container is the pressure on its sides.
#[test]
fn a_hexagon_under_pressure_has_that_stress_in_every_direction() {
    let run = done("polygon.toml");
    let factors = run.steps("load_factor");
    let tensor = ["stress_xx", "stress_yy", "stress_xy", "stress_yx"].map(|c| run.steps(c));
    for (step, factor) in factors.iter().enumerate() {
        // The plates still hold a millionth sideways.
        assert!((tensor[0][step] + factor).abs() < 1e-8 * factor);
        assert!((tensor[1][step] + factor).abs() < 1e-8 * factor);
        assert!(tensor[2][step].abs() + tensor[3][step].abs() < 1e-12);
    }
    let last = Tables::read(&run, run.last_step());
    assert_eq!(last.sides.len(), 6);
    assert!((last.sides[0].0.1 - 2.0 * 3.577_350_269_189_626).abs() < 1e-9);
}

/// Every grain of a front but the first two touches two before it, and the front knows no direction.
#[test]
fn an_advancing_front_squeezed_evenly_has_an_even_stress() {
    let run = done("advancing-front.toml");
    let last = Tables::read(&run, 2);
    assert!(last.contacts.len() >= 2 * last.grains.len() - 3);
    let (xx, yy) = (run.steps("stress_xx")[1], run.steps("stress_yy")[1]);
    assert!(xx < 0.0 && (xx - yy).abs() < 0.1 * xx.abs(), "{xx} {yy}");
}

/// Every neighbour is cemented, so each triangle is a void cell, and the squeezed pack knows no direction.
#[test]
fn a_pack_of_wanted_density_is_as_dense_and_squeezed_evenly() {
    let run = done("target.toml");
    let grains = run.table("grains", 0).expect("grains");
    let radii = grains.numbers("radius").expect("radii");
    let solid: f64 = radii.iter().map(|r| std::f64::consts::PI * r * r).sum();
    // To half the largest grain.
    assert!((solid - 0.82 * 900.0).abs() < 0.5 * std::f64::consts::PI * 2.25);
    let (xx, yy) = (run.steps("stress_xx")[0], run.steps("stress_yy")[0]);
    assert!(xx < 0.0 && (xx - yy).abs() < 0.1 * xx.abs(), "{xx} {yy}");
    let voids = run.table("voids", 1).expect("voids");
    let orders = voids.numbers("order").expect("orders");
    assert!(orders.iter().all(|order| *order == 3.0));
}

#[test]
fn a_hopper_carries_the_weight_of_its_grains() {
    let run = done("hopper.toml");
    let last = Tables::read(&run, 2);
    let weight: f64 = last.grains.iter().map(|g| g.force.1).sum();
    let walls: f64 = last.sides.iter().map(|side| side.0.1).sum();
    assert!(last.sides[1].0.1 > 0.0 && last.sides[3].0.1 > 0.0);
    assert!(
        weight < -50.0 && (walls + weight).abs() < 1e-9 * walls,
        "{walls} {weight}"
    );
}

#[test]
fn layers_keep_their_sizes_and_carry_the_lid() {
    let run = done("layers.toml");
    let grains = run.table("grains", 0).expect("grains");
    let radii = grains.numbers("radius").expect("radii");
    assert!(radii[..60].iter().all(|radius| *radius >= 0.8));
    assert!(radii[60..].iter().all(|radius| *radius <= 0.5));
    let (lid, floor) = (side_force(&run, TOP, |f| f.1), side_force(&run, 2, |f| f.1));
    assert!(lid[4] < 0.0 && floor[4] > 0.0);
}

/// What a results folder holds places the same grains again: rows of a list stand for a listed layer.
#[test]
fn a_listed_layer_is_found_again_in_the_results() {
    let place = tempfile::tempdir().expect("a folder");
    let at = |name: &str| place.path().join(name);
    let kavics = |arguments: &[&str]| {
        let mut command = Command::cargo_bin("kavics").expect("the command");
        let output = command.current_dir(place.path()).args(arguments).output();
        let output = output.expect("a run");
        assert!(
            output.status.success(),
            "{}",
            String::from_utf8_lossy(&output.stderr)
        );
        String::from_utf8(output.stdout).expect("text")
    };
    let dump = "ITEM: TIMESTEP\n0\nITEM: NUMBER OF ATOMS\n2\nITEM: BOX BOUNDS ff ff ff\n0 4\n0 4\n0 1\n\
                ITEM: ATOMS id x y radius\n2 3 3 1\n1 1 3 1\n";
    std::fs::write(at("upper.dump"), dump).expect("a list");
    let scene = "[box]\nwidth = 4\nheight = \"fit\"\n[[layer]]\nsquare = { radius = 1, rows = [2] }\n\
                 [[layer]]\n[layer.listed]\nfile = \"upper.dump\"\n\
                 [contact.a.cemented]\nstiffness.layer = { normal = 1, shear = 1 }\n\
                 [side.bottom]\ncontact = \"a\"\n[[load]]\nname = \"press\"\nedge = \"top\"\nnormal = [-1, -1]\n\
                 [[stage]]\nfactors = [1]\n[measure]\nwindow = \"all\"\n";
    std::fs::write(at("scene.toml"), scene).expect("a scene");
    kavics(&["run", "scene.toml"]);
    std::fs::remove_file(at("upper.dump")).expect("it is there");
    let text = std::fs::read_to_string(at("scene.results/scene.toml")).expect("the scene");
    assert!(text.contains("rows = [2, 3]"), "{text}");
    let steps = std::fs::read(at("scene.results/steps.parquet")).expect("steps");
    let measured = kavics(&["measure", "scene.results"]);
    assert!(
        steps.len() > 1000 && measured.lines().count() == 2,
        "{measured}"
    );
    let packed = kavics(&["pack", "scene.results/scene.toml"]);
    assert_eq!(
        packed,
        "x,y,radius\n1.0,1.0,1.0\n3.0,1.0,1.0\n1.0,3.0,1.0\n3.0,3.0,1.0\n"
    );
}

/// Every bond that breaks takes three force components and stiffness; in the end a part of the pack hangs by a few bonds.
#[test]
fn stability_and_moduli_fall_with_the_bonds_that_break() {
    let run = done("stability.toml");
    let (broken, bulk) = (run.steps("broken"), run.steps("bulk_modulus"));
    let indeterminacy = run.steps("static_indeterminacy");
    let (eigenvalue, voigt) = (
        run.steps("lowest_eigenvalue"),
        run.steps("voigt_modulus_xxxx"),
    );
    let modulus = run.steps("modulus_xxxx");
    let last = broken.len() - 1;
    assert!(broken[last] > 20.0 && run.steps("zero_eigenvalues")[last] == 0.0);
    for step in 1..=last {
        let fewer = 3.0 * (broken[step] - broken[step - 1]);
        assert_eq!(indeterminacy[step - 1] - indeterminacy[step], fewer);
        // Rounding moves the moduli where nothing breaks.
        assert!(bulk[step] < bulk[step - 1] * (1.0 + 1e-12));
        assert!(modulus[step] < voigt[step]);
        assert!(eigenvalue[step] < eigenvalue[step - 1] * (1.0 + 1e-9));
    }
    assert!(eigenvalue[last] < 0.05 * eigenvalue[0]);
    let second_order = run.steps("second_order_work");
    assert!(second_order[0] > 0.0 && second_order.iter().any(|work| *work < 0.0));
}

/// Timed by hand; here with few grains, where their number can be set.
#[test]
fn the_benchmarks_are_right_scenes() {
    let few = "grains.dropped.count=2000";
    for (name, arguments) in [
        ("bench/hexagonal-100k.toml", vec![]),
        ("bench/wide-1m.toml", vec!["--set", few]),
        ("million.toml", vec!["--set", few]),
    ] {
        let mut command = Command::cargo_bin("kavics").expect("the command");
        let scene = workspace().join("scenes").join(name);
        let command = command.arg("check").arg(scene).args(arguments);
        command.assert().success();
    }
}
