//! Scenes that are right, and what is built from them.

use std::path::Path;

use kavics::assembly::Partner;
use kavics::contact_law::{Law, StiffnessRule};
use kavics::equilibrium::Freedom;
use kavics::ids::{GrainId, Id, PropertyId};
use kavics::scene::{Scene, SceneError};

fn parse(text: &str) -> Scene {
    read(text).unwrap_or_else(|error| panic!("{error}"))
}

fn read(text: &str) -> Result<Scene, SceneError> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/scenes_wrong");
    Scene::parse(text, "scene.toml", &folder, &|_, _| {
        Err("no reader for this file".to_owned())
    })
}

const THREE: &str = r#"
[box]
width = 4.0
height = "fit"
[grains.hexagonal]
radius = 1.0
rows = [2, 1]
[contact.cement.cemented]
stiffness.layer = { normal = 1.0, shear = 0.5 }
"#;

const HELD: &str = r#"
[[support]]
grains = { ids = [0] }
fix = ["x", "y"]
[[support]]
grains = { ids = [1] }
fix = ["y"]
"#;

const PRESSED: &str = r#"
[[load]]
name = "press"
grains = { ids = [2] }
force = { y = -1.0 }
[[stage]]
factors = [1.0, 2.0]
"#;

fn three(more: &str) -> Scene {
    parse(&format!("{THREE}{HELD}{PRESSED}{more}"))
}

#[test]
fn three_discs_are_built() {
    let scene = three("");
    assert_eq!(scene.assembly.grains.len(), 3);
    assert_eq!(scene.assembly.contacts.len(), 3);
    assert_eq!(scene.program.held.len(), 3);
    assert_eq!(scene.program.loads.len(), 1);
    assert_eq!(scene.program.loads[0].load.y, -1.0);
    assert_eq!(scene.program.stages[0].factors, [1.0, 2.0]);
    let height = scene.assembly.sides.values()[0].length();
    assert!((height - (2.0 + 3_f64.sqrt())).abs() < 1e-14);
    assert!(
        scene
            .assembly
            .sides
            .values()
            .iter()
            .all(|side| !side.present)
    );
    // Every grain is held or loaded.
    assert!(scene.window.is_empty());
    assert_eq!(scene.warnings.len(), 2, "{:?}", scene.warnings);
}

#[test]
fn the_block_of_32_discs_is_built() {
    let scene = parse(&std::fs::read_to_string("tests/scenes_right/full.toml").unwrap());
    assert_eq!(scene.assembly.grains.len(), 32);
    let of_grains = scene.assembly.contacts.values().iter();
    assert_eq!(of_grains.filter(|c| !c.touches_side()).count(), 73);
    assert_eq!(
        scene.title,
        "Cemented block of 32 discs, vertical compression"
    );
    let names: Vec<&str> = scene
        .properties
        .values()
        .iter()
        .map(|p| p.name.as_str())
        .collect();
    assert_eq!(names, ["mortar", "strong", "grit"]);
    assert_eq!(scene.program.stages.len(), 3);
    assert_eq!(scene.program.stages[1].factors.len(), 6);
    assert_eq!(scene.program.stages[1].factors[5], 3.0);
}

#[test]
fn a_zone_for_all_contacts_may_find_none_between_grains() {
    let scene = parse(
        "[box]\nwidth = 2.0\nheight = 2.0\n[grains.hexagonal]\nradius = 1.0\nrows = [1]\n\
         [contact.cement.cemented]\nstiffness.layer = { normal = 1.0, shear = 0.5 }\n\
         [[zone]]\ncontact = \"cement\"\n[side.bottom]\ncontact = \"cement\"\n\
         [[load]]\nname = \"press\"\ngrains = { ids = [0] }\nforce = { y = -1.0 }\n\
         [[stage]]\nfactors = [1.0]\n",
    );
    assert_eq!(scene.assembly.contacts.len(), 1);
    assert!(scene.warnings[0].starts_with("the zone of `cement`"));
}

#[test]
fn properties_stand_in_the_order_of_the_file() {
    let scene = three(
        "[contact.a.cohesionless]\nstiffness.direct = { normal = 3, shear = 2 }\nfriction = 0.5\n\
         [[zone]]\ncontact = \"cement\"\n",
    );
    assert_eq!(scene.properties.values()[1].name, "a");
    let Law::Cohesionless(law) = &scene.properties.values()[1].law else {
        panic!("a cohesionless law");
    };
    assert_eq!(
        law.stiffness,
        StiffnessRule::Direct {
            normal: 3.0,
            shear: 2.0,
            moment: 0.0
        }
    );
}

#[test]
fn units_and_plain_numbers_may_mix() {
    let text = THREE.replace("1.0, shear = 0.5", "\"1 GPa/m\", shear = 2e8");
    let scene = parse(&format!("{text}{HELD}{PRESSED}"));
    let Law::Cemented(law) = &scene.properties[PropertyId(0)].law else {
        panic!("a cemented law");
    };
    assert_eq!(
        law.stiffness,
        StiffnessRule::Layer {
            normal: 1e9,
            shear: 2e8
        }
    );
}

#[test]
fn a_later_zone_wins() {
    let scene = three(
        "[contact.weak.cemented]\nstiffness.layer = { normal = 1.0, shear = 0.5 }\n\
         [[zone]]\ncontact = \"cement\"\n[[zone]]\ncontact = \"weak\"\nstrip = { y = [0.5, 1.2] }\n",
    );
    let weak: Vec<bool> = scene
        .assembly
        .contacts
        .values()
        .iter()
        .map(|c| c.property == PropertyId(1))
        .collect();
    assert_eq!(weak, [true, false, false]);
}

#[test]
fn strengths_do_not_depend_on_zones() {
    let cement = "[contact.a.cemented]\nstiffness.layer = { normal = 1.0, shear = 0.5 }\n\
                  strength.stress = { tension = 1.0 }\nstrength.scatter.weibull = { shape = 5.0 }\n";
    let rest = "[box]\nwidth = 20\nheight = 20\n[grains.square]\nradius = 1\nrows = { count = 9, longest = 9 }\n\
                [[support]]\ngrains = { edge = \"bottom\" }\nfix = [\"x\", \"y\"]\n";
    let factors = |zones: &str| -> Vec<f64> {
        let second = cement.replace("contact.a", "contact.b");
        let scene = parse(&format!(
            "{rest}{cement}{second}[[zone]]\ncontact = \"a\"\n{zones}"
        ));
        let contacts = scene.assembly.contacts.values();
        contacts.iter().map(|c| c.strength_factor).collect()
    };
    let one = factors("");
    assert!(one.iter().any(|f| *f != one[0]));
    assert_eq!(one, factors("[[zone]]\ncontact = \"b\"\nshare = 0.4\n"));
}

#[test]
fn a_share_is_met_and_repeats() {
    let text = "seed = 3\n[box]\nwidth = 100\nheight = 100\n[grains.square]\nradius = 1\n\
                rows = { count = 50, longest = 50 }\n[contact.a.cemented]\nstiffness.layer = { normal = 1, shear = 1 }\n\
                [contact.b.cemented]\nstiffness.layer = { normal = 1, shear = 1 }\n[[zone]]\ncontact = \"a\"\n\
                [[zone]]\ncontact = \"b\"\nshare = 0.3\n[[support]]\ngrains = { edge = \"bottom\" }\nfix = [\"x\", \"y\"]\n";
    let scene = parse(text);
    let contacts = scene.assembly.contacts.values();
    let chosen = contacts
        .iter()
        .filter(|c| c.property == PropertyId(1))
        .count();
    // Four standard deviations of a binomial.
    let expected = 0.3 * contacts.len() as f64;
    let deviation = (0.21 * contacts.len() as f64).sqrt();
    assert!((chosen as f64 - expected).abs() < 4.0 * deviation);
    assert_eq!(parse(text).assembly.contacts, scene.assembly.contacts);
}

#[test]
fn sides_are_held_but_for_what_is_free_or_moves() {
    let scene = parse(&format!(
        "{THREE}[side.bottom]\ncontact = \"cement\"\n[side.top]\ncontact = \"cement\"\nfree = [\"y\"]\n\
         [side.left]\ncontact = \"cement\"\n[[move]]\nname = \"push\"\nside = \"left\"\nx = 0.1\n\
         [[load]]\nname = \"jack\"\nside = \"top\"\nforce = {{ y = -2 }}\n[[stage]]\nfactors = [1]\n"
    ));
    let body = |side: usize| {
        scene
            .assembly
            .body(Partner::Side(kavics::ids::SideId::from_index(side)))
    };
    let held = |side: usize| {
        scene
            .program
            .held
            .iter()
            .filter(|h| h.body == body(side))
            .count()
    };
    assert_eq!([held(0), held(1), held(2), held(3)], [2, 0, 3, 2]);
    assert_eq!(scene.program.prescribed.len(), 1);
    assert_eq!(scene.program.prescribed[0].freedom, Freedom::X);
    assert_eq!(scene.program.loads[0].body, body(3));
}

#[test]
fn a_strain_turns_by_half_the_difference_of_its_shears() {
    let scene = parse(&format!(
        "{THREE}[[move]]\nname = \"shear\"\ngrains = {{ ids = [0, 1, 2] }}\nstrain = {{ xx = 0.5, xy = 0.2 }}\n\
         [[stage]]\nfactors = [1]\n"
    ));
    let amplitudes: Vec<f64> = scene
        .program
        .prescribed
        .iter()
        .map(|p| p.amplitude)
        .collect();
    // Grain 0 lies one length left of the middle of the box.
    assert_eq!(amplitudes[..3], [-0.5, -0.2, 0.1]);
    assert!(scene.program.held.is_empty());
}

#[test]
fn the_boundary_is_where_triangles_do_not_close() {
    let scene = parse(
        "[box]\nwidth = 10\nheight = \"fit\"\n[grains.hexagonal]\nradius = 1\nrows = [4, 5, 4]\n\
         [contact.a.cemented]\nstiffness.layer = { normal = 1, shear = 1 }\n\
         [[support]]\ngrains = { boundary = true }\nfix = [\"x\", \"y\"]\n",
    );
    let mut held: Vec<u32> = scene.program.held.iter().map(|h| h.body.0).collect();
    held.dedup();
    assert_eq!(held, [0, 1, 2, 3, 4, 8, 9, 10, 11, 12]);
    assert_eq!(scene.window, [5, 6, 7].map(GrainId));
}

#[test]
fn weight_does_not_count_for_the_window() {
    let text = "thickness = 0.5\n[box]\nwidth = 10\nheight = \"fit\"\n[grains.hexagonal]\nradius = 1\nrows = [4, 5, 4]\n\
         [contact.a.cemented]\nstiffness.layer = { normal = 1, shear = 1 }\n[weight]\ndensity = 2.0\n\
         [[support]]\ngrains = { edge = \"bottom\" }\nfix = [\"x\", \"y\"]\n[[stage]]\napply = [\"weight\"]\nfactors = [1]\n";
    let scene = parse(text);
    assert_eq!(scene.window.len(), 9);
    let weight = 2.0 * 9.81 * 0.5 * std::f64::consts::PI;
    assert!((scene.program.loads[0].load.y + weight).abs() < 1e-12);
}

#[test]
fn an_edge_load_says_what_it_does_not_meet() {
    let load = "[[load]]\nname = \"traffic\"\nedge = \"top\"\nnormal = [-1, -1]\n[[stage]]\nfactors = [1]\n";
    let scene = parse(&format!("{THREE}{HELD}{load}"));
    let total: f64 = scene.program.loads.iter().map(|l| l.load.y).sum();
    assert!((total + 4.0).abs() < 1e-12);
    let wide = THREE.replace("4.0", "6.0");
    let scene = parse(&format!("{wide}{HELD}{load}"));
    let total: f64 = scene.program.loads.iter().map(|l| l.load.y).sum();
    assert!((total + 4.0).abs() < 1e-12);
    assert!(
        scene.warnings[1].contains("over 2 of the 6"),
        "{:?}",
        scene.warnings
    );
}

#[test]
fn steps_start_from_the_last_factor() {
    let scene = three("[[stage]]\nfactors = { to = 0.0, steps = 4 }\n");
    assert_eq!(scene.program.stages[1].factors, [1.5, 1.0, 0.5, 0.0]);
}

#[test]
fn grains_may_come_from_a_csv_file() {
    let text = THREE.replace(
        "hexagonal]\nradius = 1.0\nrows = [2, 1]",
        "listed]\nfile = \"three.csv\"",
    );
    let scene = parse(&format!("{text}{HELD}{PRESSED}"));
    assert_eq!(scene.assembly.contacts.len(), 3);
}

#[test]
fn grains_may_come_from_a_reader_of_the_callers() {
    let text = THREE.replace(
        "hexagonal]\nradius = 1.0\nrows = [2, 1]",
        "listed]\nfile = \"Cargo.toml\"",
    );
    let folder = Path::new(env!("CARGO_MANIFEST_DIR"));
    let pack = Scene::place_grains(&text, "scene.toml", folder, &|_, _| {
        Ok(vec![[1.0, 1.0, 1.0], [3.0, 1.0, 1.0]])
    })
    .unwrap();
    assert_eq!(pack.grains.len(), 2);
    assert_eq!(pack.wanted_curve, None);
}

#[test]
fn dropped_grains_are_placed_alone() {
    let text = "seed = 4\n[box]\nwidth = 20\nheight = \"fit\"\n[grains.dropped]\ncount = 50\nradius = { from = 0.5, to = 1.5 }\n";
    let place = || {
        Scene::place_grains(
            text,
            "scene.toml",
            Path::new(""),
            &|_, _| Err(String::new()),
        )
        .unwrap()
    };
    assert_eq!(place().grains.len(), 50);
    assert_eq!(place().grains, place().grains);
    let wanted = place().wanted_curve.expect("radii are given");
    assert_eq!((wanted.diameter[0], wanted.diameter[10]), (1.0, 3.0));
}

#[test]
fn without_friction_a_scene_warns() {
    let scene = parse(&format!(
        "{}{HELD}{PRESSED}",
        THREE.replace("cemented", "cohesionless")
    ));
    assert!(scene.warnings[0].contains("jumps"), "{:?}", scene.warnings);
}

#[cfg(feature = "schema")]
#[test]
fn the_schema_names_every_table() {
    let schema = kavics::scene::schema();
    for table in [
        "box",
        "polygon",
        "grains",
        "layer",
        "advancing-front",
        "target",
        "contact",
        "zone",
        "support",
        "move",
        "load",
        "stage",
    ] {
        assert!(schema.contains(&format!("\"{table}\"")), "{table}");
    }
}

#[test]
fn what_no_stage_applies_is_a_warning() {
    let idle = "[[load]]\nname = \"idle\"\ngrains = { ids = [2] }\nforce = { x = 1 }\n";
    let scene = parse(&format!(
        "{THREE}{HELD}{}{idle}",
        PRESSED.replace("factors", "apply = [\"press\"]\nfactors")
    ));
    assert!(
        scene
            .warnings
            .iter()
            .any(|w| w.contains("no stage applies `idle`"))
    );
}

#[test]
fn grains_that_nothing_holds_and_nothing_loads_are_counted() {
    let text = THREE.replace("width = 4.0", "width = 9.0").replace(
        "hexagonal]\nradius = 1.0\nrows = [2, 1]",
        "listed]\nfile = \"apart.csv\"",
    );
    let scene = parse(&format!("{text}{HELD}{PRESSED}"));
    assert!(
        scene
            .warnings
            .iter()
            .any(|w| w.starts_with("1 grain is neither held nor loaded"))
    );
}

#[test]
fn void_cells_are_recorded_only_when_asked_for() {
    assert!(!three("").record_voids);
    assert!(!three("[record]\nevery = 2\n").record_voids);
    assert!(three("[record]\nvoids = true\n").record_voids);
}
