//! Scenes, their first load steps, and power diagrams.

use std::path::Path;

use kavics::assembly::{Between, Grain, box_sides, contact_graph};
use kavics::geometry::{Container, Vector, power_diagram};
use kavics::ids::{PerGrain, PerSide};
use kavics::measure::{Snapshot, Window, cracks, measures, void_cells};
use kavics::scene::Scene;

use crate::patience::stop;

/// More grains take too long to place, again and again.
pub const MOST_PLACED: f64 = 300.0;
/// More grains take too long to be loaded.
const MOST_LOADED: usize = 40;

/// Finds two equilibria of a small scene and measures them.
pub fn first_load_steps(scene: &Scene) {
    let assembly = &scene.assembly;
    if assembly.grains.len() > MOST_LOADED {
        return;
    }
    let window = Window::new(scene.window.clone(), assembly.grains.len());
    for equilibrium in scene.load_path().stopped_by(stop()).take(2) {
        let Ok(equilibrium) = equilibrium else {
            return;
        };
        let displacements = equilibrium.state.displacements.values();
        assert!(
            displacements
                .iter()
                .all(|u| u.x.is_finite() && u.y.is_finite() && u.rotation.is_finite())
        );
        let snapshot = Snapshot::new(assembly, &equilibrium);
        measures(&snapshot, &window);
        void_cells(&snapshot);
        cracks(&snapshot);
    }
}

/// Places grains at given rows of (x, y, radius) in a scene, holds the lowest and pushes the sides.
pub fn as_grains(width: f64, height: f64, rows: &[[f64; 3]]) {
    let between = if rows.len().is_multiple_of(2) {
        "touching"
    } else {
        "neighbours"
    };
    let text = format!(
        "[box]\nwidth = {width:?}\nheight = {height:?}\n\
         [grains.listed]\nfile = 'rows.xyz'\n\
         [contact.cement.cemented]\nstiffness.layer = {{ normal = 1.0, shear = 0.5 }}\n\
         [[zone]]\ncontact = 'cement'\nbetween = '{between}'\n\
         [side.bottom]\ncontact = 'cement'\nreach = 1.0\n\
         [side.top]\ncontact = 'cement'\nreach = 1.0\n\
         [[move]]\nname = 'press'\nside = 'top'\ny = -0.001\n\
         [[stage]]\nfactors = [1.0]\n"
    );
    let list = |_: &Path, _| Ok(rows.to_vec());
    match Scene::parse(&text, "fuzz.toml", Path::new("/nowhere"), &list) {
        Ok(scene) => {
            let grains = scene.assembly.grains.values();
            assert_apart(grains, 1e-6);
            if grains.iter().all(is_usual) && width <= 1e3 && height <= 1e3 {
                assert_covered(scene.assembly.cell_area.values(), width * height);
            }
            first_load_steps(&scene);
        }
        Err(error) => assert!(error.to_string().contains("fuzz.toml"), "{error}"),
    }
}

/// The power diagram and the contact graph of discs that may overlap or leave the box.
///
/// The cells of discs of like sizes whose centres are apart cover the box.
pub fn as_power_diagram(width: f64, height: f64, rows: &[[f64; 3]]) {
    let usual = |length: f64| {
        if (1e-3..=1e3).contains(&length) {
            length
        } else {
            10.0
        }
    };
    let [width, height] = [usual(width), usual(height)];
    let grains: PerGrain<Grain> = rows
        .iter()
        .filter(|row| row.iter().all(|number| number.abs() <= 1e30) && row[2] > 1e-30)
        .map(|&[x, y, radius]| Grain {
            centre: Vector::new(x, y),
            radius,
        })
        .collect::<Vec<_>>()
        .into();
    let sides = box_sides(width, height, [true; 4]);
    let reach = PerSide::filled(0.1, sides.len());
    for between in [Between::Touching, Between::Neighbours] {
        contact_graph(&grains, &sides, between, &reach, 1e-7);
    }
    let corners = [(0.0, 0.0), (width, 0.0), (width, height), (0.0, height)];
    let container = Container::polygon(&corners.map(|(x, y)| Vector::new(x, y)));
    let centres: Vec<Vector> = grains.values().iter().map(|grain| grain.centre).collect();
    let radii: Vec<f64> = grains.values().iter().map(|grain| grain.radius).collect();
    let diagram = power_diagram(&centres, &radii, &container, &[]);
    if grains.values().iter().all(is_usual) && are_apart(&centres) {
        assert_covered(&diagram.cell_area, container.area());
    }
}

fn is_usual(grain: &Grain) -> bool {
    let [x, y] = [grain.centre.x, grain.centre.y];
    (1e-3..=1e3).contains(&grain.radius) && x.abs() <= 1e3 && y.abs() <= 1e3
}

fn are_apart(centres: &[Vector]) -> bool {
    let apart = |a: &Vector, b: &Vector| (*a - *b).length() > 1e-6;
    (1..centres.len()).all(|k| centres[..k].iter().all(|other| apart(&centres[k], other)))
}

fn assert_covered(cells: &[f64], area: f64) {
    let covered: f64 = cells.iter().sum();
    assert!(
        cells.is_empty() || (covered - area).abs() < 1e-6 * area,
        "{covered} of {area}"
    );
}

/// Grains lie no deeper in each other than this share of the smaller radius, or of the mean one.
pub fn assert_apart(grains: &[Grain], tolerance: f64) {
    let mean = grains.iter().map(|grain| grain.radius).sum::<f64>() / grains.len().max(1) as f64;
    for (number, one) in grains.iter().enumerate() {
        assert!(one.radius > 0.0 && one.radius.is_finite());
        for other in &grains[..number] {
            let distance = (one.centre - other.centre).length();
            let depth = one.radius + other.radius - distance;
            // Rounding of the coordinates themselves.
            let rounding = 1e-12 * (distance + one.centre.length() + other.centre.length());
            assert!(
                depth <= tolerance * mean + rounding,
                "{one:?} and {other:?} overlap"
            );
        }
    }
}
