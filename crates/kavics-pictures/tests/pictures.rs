//! Pictures show what stands in the tables.

mod runs;

use kavics::ids::Id;
use kavics_pictures::{
    CurveRequest, Ink, Mark, Picture, Request, Shape, Theme, Units, What, breaks, draw,
    draw_curves, write,
};
use runs::{Run, run};
use tiny_skia::Pixmap;

const ALL: [What; 5] = [
    What::Forces,
    What::Graph,
    What::Dual,
    What::Voids,
    What::Damage,
];

fn block() -> Run {
    run("block-32.toml", "")
}

fn picture(run: &Run, request: &Request) -> Picture {
    draw(&run.folder, request).expect("a picture")
}

fn of(what: What) -> Request {
    Request {
        what,
        ..Request::default()
    }
}

/// Shapes drawn with an ink, those of the legend left out.
fn drawn(picture: &Picture, ink: Ink) -> Vec<Shape> {
    let shapes = picture.marks.iter().filter_map(|mark| match mark {
        Mark::Fill(shapes, used) | Mark::Stroke(shapes, used, _) if *used == ink => Some(shapes),
        _ => None,
    });
    let legend = picture.height - 12.0;
    let is_above = |shape: &Shape| match shape {
        Shape::Line(ends) => ends[0].y < legend,
        Shape::Circle(centre, _) => centre.y < legend,
        Shape::Polyline(points) | Shape::Polygon(points) => points[0].y < legend,
    };
    shapes.flatten().filter(|s| is_above(s)).cloned().collect()
}

fn words(picture: &Picture) -> Vec<&str> {
    let words = picture.marks.iter().filter_map(|mark| match mark {
        Mark::Text(text) => Some(text.words.as_str()),
        _ => None,
    });
    words.collect()
}

#[test]
fn a_force_has_a_line_in_the_colour_of_its_sign() {
    let run = block();
    for step in [1, 5] {
        let request = Request {
            step: Some(step),
            ..of(What::Forces)
        };
        let picture = picture(&run, &request);
        let table = run.folder.contacts(step).expect("contacts");
        let (forces, states) = (table.numbers("normal_force"), table.texts("state"));
        let (forces, states) = (forces.expect("forces"), states.expect("states"));
        let carrying = forces
            .iter()
            .zip(states)
            .filter(|(_, state)| *state != "broken");
        let (pulled, pressed): (Vec<_>, Vec<_>) = carrying.partition(|(force, _)| **force > 0.0);
        assert_eq!(drawn(&picture, Ink::Tension).len(), pulled.len());
        assert_eq!(drawn(&picture, Ink::Compression).len(), pressed.len());
    }
}

#[test]
fn what_broke_is_drawn_once_and_in_order() {
    let run = block();
    let broken = breaks(&run.folder, 5).expect("events");
    assert!(!broken.is_empty());
    let picture = picture(&run, &of(What::Damage));
    let lines = picture.marks.iter().filter_map(|mark| match mark {
        Mark::Stroke(shapes, Ink::Shade(_, shade), _) => Some((*shade, shapes.len())),
        _ => None,
    });
    let lines: Vec<(u8, usize)> = lines.collect();
    assert_eq!(lines.iter().map(|line| line.1).sum::<usize>(), broken.len());
    assert!(lines.is_sorted());
}

#[test]
fn void_cells_are_as_many_as_the_graph_has() {
    let run = run("block-32.toml", "\n[record]\nvoids = true\n");
    let picture = picture(&run, &of(What::Voids));
    let cells = picture.marks.iter().map(|mark| match mark {
        Mark::Fill(shapes, Ink::Shade(..)) => {
            let polygons = shapes.iter().filter(|shape| match shape {
                // Samples of the legend have four corners and lie below.
                Shape::Polygon(points) => points[0].y < picture.height - 12.0,
                _ => false,
            });
            polygons.count()
        }
        _ => 0,
    });
    assert_eq!(
        cells.sum::<usize>(),
        run.folder.voids(5).expect("void cells").len()
    );
}

#[test]
fn the_scale_bar_is_as_long_as_it_says() {
    let run = block();
    let request = Request {
        units: Units {
            length: "mm".to_owned(),
            force: "N".to_owned(),
        },
        ..of(What::Graph)
    };
    let picture = picture(&run, &request);
    // Five grains of radius 1 lie side by side between two borders of 2 mm.
    let scale = (picture.width - 4.0) / 10.0;
    assert!(words(&picture).contains(&"2 mm"));
    let bar = picture.marks.iter().find_map(|mark| match mark {
        Mark::Stroke(shapes, Ink::Text, _) => shapes.first(),
        _ => None,
    });
    let Some(Shape::Line([from, to])) = bar else {
        panic!("a bar");
    };
    assert!((to.x - from.x - 2.0 * scale).abs() < 1e-9);
}

#[test]
fn displacements_are_drawn_as_large_as_wanted() {
    let run = block();
    let centres = |deformation: f64| -> Vec<f64> {
        let request = Request {
            deformation,
            ..of(What::Graph)
        };
        let discs = drawn(&picture(&run, &request), Ink::Contact).into_iter();
        let centre = |shape| match shape {
            Shape::Circle(centre, _) => Some(centre.y),
            _ => None,
        };
        discs.filter_map(centre).collect()
    };
    let (before, after) = (centres(0.0), centres(300.0));
    assert_eq!(before.len(), run.scene.assembly.grains.len());
    // The block is pressed together: it has less height for its width.
    let height = |y: &[f64]| y[0] - y[y.len() - 1];
    assert!(height(&after) < height(&before));
}

#[test]
fn every_picture_is_written_in_both_formats_and_themes() {
    let run = block();
    let place = tempfile::tempdir().expect("a temporary folder");
    for what in ALL {
        let picture = picture(&run, &of(what));
        for theme in [Theme::Light, Theme::Dark] {
            let svg = picture.svg(theme);
            assert!(svg.starts_with("<svg ") && svg.ends_with("</svg>\n"));
            assert!(svg.contains(" at load step 5</title>"));
            assert!(!svg.contains("NaN") && !svg.contains("inf"));
            assert_eq!(svg, picture.svg(theme));
        }
        let path = place.path().join("picture.png");
        write(&path, &picture, Theme::Light, 4.0).expect("room on the disk");
        let pixels = Pixmap::load_png(&path).expect("a PNG");
        assert_eq!(pixels.width(), 560);
        let paper = pixels.pixel(0, 0).expect("a pixel");
        assert_eq!([paper.red(), paper.green(), paper.blue()], [255; 3]);
        assert!(pixels.pixels().iter().any(|pixel| pixel.red() < 60));
    }
}

#[test]
fn columns_give_colours() {
    let run = block();
    let request = Request {
        colour: Some("shear_force".to_owned()),
        grains: Some("state".to_owned()),
        ..of(What::Forces)
    };
    let words = words(&picture(&run, &request)).join(" ");
    assert!(
        words.contains("shear force") && words.contains("state: free held"),
        "{words}"
    );
}

#[test]
fn what_is_not_there_is_named() {
    let run = block();
    let message = |request: &Request| {
        let error = draw(&run.folder, request).expect_err("wrong");
        assert!(error.is_wrong_usage());
        error.to_string()
    };
    let step = Request {
        step: Some(9),
        ..Request::default()
    };
    assert_eq!(
        message(&step),
        "load step 9 is not recorded; recorded are 0, 1, 2, 3, 4, 5"
    );
    let grains = Request {
        grains: Some("rotatoin".to_owned()),
        ..Request::default()
    };
    assert_eq!(
        message(&grains),
        "grains has no column \"rotatoin\"; did you mean \"rotation\"?"
    );
    for what in ALL {
        let colour = Request {
            colour: Some("hue".to_owned()),
            ..of(what)
        };
        assert!(message(&colour).contains("has no column \"hue\"; there are "));
    }
}

fn curves(curves: &[&str], against: &str) -> CurveRequest {
    CurveRequest {
        curves: curves.iter().map(ToString::to_string).collect(),
        against: against.to_owned(),
        width: 90.0,
        units: Units::default(),
    }
}

#[test]
fn a_curve_has_a_point_for_each_load_step() {
    let run = block();
    let marks = |request: &CurveRequest| {
        let picture = draw_curves(&run.folder, request).expect("a picture");
        picture.marks.into_iter().find_map(|mark| match mark {
            Mark::Fill(shapes, Ink::Series(0)) => Some(shapes.len()),
            _ => None,
        })
    };
    assert_eq!(marks(&curves(&["stress_yy"], "strain_yy")), Some(5));
    // Loads and moves have a row before loading too.
    let force = curves(&["compression.force"], "compression.displacement");
    assert_eq!(marks(&force), Some(6));
    assert_eq!(
        marks(&curves(&["compression.force"], "load_factor")),
        Some(5)
    );
}

#[test]
fn axes_say_what_they_show() {
    let run = block();
    let picture = draw_curves(
        &run.folder,
        &curves(&["stress_yy", "stress_xx"], "strain_yy"),
    );
    let picture = picture.expect("a picture");
    let words = words(&picture);
    for expected in [
        "strain yy × 10⁻⁴",
        "force/length²",
        "stress yy",
        "stress xx",
    ] {
        assert!(words.contains(&expected), "{expected} in {words:?}");
    }
}

#[test]
fn a_curve_that_is_not_there_is_named() {
    let run = block();
    let message = |request: &CurveRequest| {
        draw_curves(&run.folder, request)
            .expect_err("wrong")
            .to_string()
    };
    let steps = curves(&["stress_yz"], "step");
    assert_eq!(
        message(&steps),
        "steps has no column \"stress_yz\"; did you mean \"stress_yy\"?"
    );
    let action = curves(&["compresion.force"], "step");
    assert_eq!(
        message(&action),
        "no load or move is called \"compresion\"; did you mean \"compression\"?"
    );
    let without_values = message(&curves(&["bulk_modulus"], "step"));
    assert!(
        without_values.starts_with("\"bulk_modulus\" has no value at any load step"),
        "{without_values}"
    );
}

#[test]
fn forces_of_the_size_of_rounding_are_none() {
    let run = block();
    let none = kavics_pictures::no_force(&run.folder).expect("tables");
    let table = run.folder.actions().expect("actions");
    let largest = table
        .numbers("force")
        .expect("forces")
        .into_iter()
        .fold(0.0, f64::max);
    assert_eq!(none, 1e-9 * largest);
    let before = Request {
        step: Some(0),
        ..of(What::Forces)
    };
    let picture = picture(&run, &before);
    assert!(words(&picture).contains(&"no contact carries a force"));
    let idle = drawn(&picture, Ink::Idle).len();
    assert_eq!(
        idle,
        run.scene.assembly.contacts.ids().map(Id::index).count()
    );
}
