//! The packing before loading: sieve curve, packing fraction over the height, coordination, directions of contacts.

use kavics::assembly::{Grain, Partner};
use kavics::geometry::{Container, Vector};
use kavics::ids::{GrainId, Id, PerGrain, SideId};
use kavics::measure::{Coordination, Rose, fabric_of_normals};
use kavics::packing::statistics::{self, Strip};
use kavics::packing::{Mass, SieveCurve};
use kavics_results::{Columns, PackingRecord, ResultsFolder};

use crate::curves::{Figure, LegendEntry, legend};
use crate::number::fixed;
use crate::plot::{Plot, Series, draw};
use crate::{ReportError, bars, rose};

/// What stands above the figures.
pub(crate) const NOTE: &str = "Grains and contacts before loading.";

/// Up to this many different diameters the realised sieve curve has its steps; above, it is drawn at so many.
const DIAMETERS: usize = 240;

/// Straight parts of the wanted sieve curve between two of its diameters.
const BENDS: u32 = 8;

/// Strips of the packing fraction: about a mean diameter high, within limits.
const FEWEST_STRIPS: usize = 10;
const MOST_STRIPS: usize = 40;

/// Classes of direction of the half circle.
const CLASSES: usize = 18;

/// A deviator up to here is rounding, and its direction means nothing.
const ISOTROPIC: f64 = 1e-9;

/// The figures; none of results whose state before loading is not recorded.
pub(crate) fn figures(folder: &ResultsFolder) -> Result<Vec<Figure>, ReportError> {
    if !folder.recorded_steps()?.contains(&0) {
        return Ok(Vec::new());
    }
    let record = folder.record()?.packing.unwrap_or_default();
    let grains = grains(&folder.some_of_grains(0, &["x", "y", "radius"])?)?;
    if grains.is_empty() {
        return Ok(Vec::new());
    }
    let contacts = contacts(&folder.some_of_contacts(0, &["first", "second", "nx", "ny"])?)?;
    let mut figures = vec![sieve(&grains, &record)];
    figures.extend(over_height(&grains, &record));
    figures.push(coordination(grains.len(), &contacts));
    figures.extend(directions(&contacts));
    Ok(figures)
}

fn grains(table: &Columns) -> Result<PerGrain<Grain>, ReportError> {
    let (x, y) = (table.numbers("x")?, table.numbers("y")?);
    let radius = table.numbers("radius")?;
    let grain = |row: usize| Grain {
        centre: Vector::new(x[row], y[row]),
        radius: radius[row],
    };
    Ok((0..table.len()).map(grain).collect())
}

/// A contact of the table, as far as the packing goes.
struct Meeting {
    partners: [Partner; 2],
    normal: Vector,
}

impl Meeting {
    fn between_grains(&self) -> bool {
        matches!(self.partners[1], Partner::Grain(_))
    }
}

fn contacts(table: &Columns) -> Result<Vec<Meeting>, ReportError> {
    let (first, second) = (table.integers("first")?, table.integers("second")?);
    let (nx, ny) = (table.numbers("nx")?, table.numbers("ny")?);
    let meeting = |row: usize| {
        Some(Meeting {
            partners: [partner(first[row]?), partner(second[row]?)],
            normal: Vector::new(nx[row], ny[row]),
        })
    };
    Ok((0..table.len()).filter_map(meeting).collect())
}

/// A partner as it stands in the tables: a grain's id, or −1−k for side k.
fn partner(number: i64) -> Partner {
    match usize::try_from(number) {
        Ok(grain) => Partner::Grain(GrainId::from_index(grain)),
        Err(_) => Partner::Side(SideId::from_index((-1 - number) as usize)),
    }
}

fn line(name: &str, points: Vec<(f64, f64)>, colour: usize) -> Series {
    Series {
        name: name.to_owned(),
        points,
        colour,
        dashed: false,
        marked: false,
    }
}

fn figure(title: &str, plot: &Plot<'_>, note: String) -> Figure {
    Figure {
        title: title.to_owned(),
        svg: draw(plot),
        legend: legend(plot.series),
        note,
    }
}

fn sieve(grains: &PerGrain<Grain>, record: &PackingRecord) -> Figure {
    let wanted = record.wanted_curve.clone().map(SieveCurve::from);
    let mass = wanted.as_ref().map_or(Mass::Disc, |curve| curve.mass);
    let mut series = vec![line("realised", realised(grains, mass), 0)];
    if let Some(curve) = wanted.filter(|curve| !curve.diameter.is_empty()) {
        series.push(Series {
            dashed: true,
            ..line("wanted", wanted_points(&curve), 1)
        });
    }
    let plot = Plot {
        x_label: "diameter",
        y_label: "share of the mass",
        sizes: true,
        heights: 5.0,
        series: &series,
    };
    let grows = match mass {
        Mass::Disc => "d²",
        Mass::Sphere => "d³",
    };
    let note = format!("Share of the mass in grains up to a diameter; mass grows as {grows}.");
    figure("Sieve curve", &plot, note)
}

/// The wanted sieve curve, straight in the logarithm of the diameter, for axes of either kind.
fn wanted_points(curve: &SieveCurve) -> Vec<(f64, f64)> {
    let mut points = vec![(curve.diameter[0], 0.0)];
    for pair in curve.diameter.windows(2) {
        let at = |step: u32| pair[0] * (pair[1] / pair[0]).powf(f64::from(step) / f64::from(BENDS));
        points.extend((0..BENDS).map(|step| (at(step), curve.share_passing(at(step)))));
    }
    points.extend(curve.diameter.last().map(|&d| (d, 1.0)));
    points
}

/// The realised sieve curve, from the share 0 on.
fn realised(grains: &PerGrain<Grain>, mass: Mass) -> Vec<(f64, f64)> {
    let mut diameters: Vec<f64> = grains.values().iter().map(|g| 2.0 * g.radius).collect();
    diameters.sort_unstable_by(f64::total_cmp);
    diameters.dedup();
    let stepped = diameters.len() <= DIAMETERS;
    if !stepped {
        let (low, high) = (diameters[0], diameters[diameters.len() - 1]);
        let between = |k: usize| low * (high / low).powf(k as f64 / DIAMETERS as f64);
        diameters = (0..DIAMETERS).map(between).chain([high]).collect();
    }
    let passing = statistics::sieve_curve(grains, &diameters, mass);
    let mut points = vec![(diameters[0], 0.0)];
    let mut before = 0.0;
    for (diameter, passing) in diameters.into_iter().zip(passing) {
        if stepped {
            points.push((diameter, before));
        }
        points.push((diameter, passing));
        before = passing;
    }
    points
}

/// None where the container is not known.
fn over_height(grains: &PerGrain<Grain>, record: &PackingRecord) -> Option<Figure> {
    if record.container.len() < 3 {
        return None;
    }
    let corner = |&[x, y]: &[f64; 2]| Vector::new(x, y);
    let corners: Vec<Vector> = record.container.iter().map(corner).collect();
    let container = Container::polygon(&corners);
    let whole = statistics::strips(grains, &container, 1)[0];
    let inside = statistics::inner_packing_fraction(grains, &container);
    let mut series = vec![line("in strips", steps(grains, &container, whole), 0)];
    series.extend(inside.map(|inside| Series {
        dashed: true,
        ..line("inside", vec![(inside, whole.from), (inside, whole.to)], 1)
    }));
    let plot = Plot {
        x_label: "packing fraction",
        y_label: "height",
        sizes: false,
        heights: 8.0,
        series: &series,
    };
    let note = fractions(whole.packing_fraction(), inside);
    Some(figure("Packing fraction over the height", &plot, note))
}

/// Strips about as high as a mean diameter, each a step.
fn steps(grains: &PerGrain<Grain>, container: &Container, whole: Strip) -> Vec<(f64, f64)> {
    let radii = grains.values().iter().map(|grain| grain.radius);
    let mean_diameter = 2.0 * radii.sum::<f64>() / grains.len() as f64;
    let diameters = ((whole.to - whole.from) / mean_diameter) as usize;
    let count = diameters.clamp(FEWEST_STRIPS, MOST_STRIPS);
    let step = |strip: &Strip| {
        let fraction = strip.packing_fraction();
        [(fraction, strip.from), (fraction, strip.to)]
    };
    let strips = statistics::strips(grains, container, count);
    strips.iter().flat_map(step).collect()
}

fn fractions(whole: f64, inside: Option<f64>) -> String {
    let margin = statistics::INSIDE;
    let inside = inside.map_or_else(String::new, |inside| {
        format!(
            "; {} inside, {margin} largest radii off sides and surface",
            fixed(inside, 4)
        )
    });
    let whole = fixed(whole, 4);
    format!("{whole} from the floor to the highest grain{inside}.")
}

fn coordination(grains: usize, contacts: &[Meeting]) -> Figure {
    let partners = contacts.iter().map(|contact| contact.partners);
    let coordination = Coordination::new(grains, partners);
    let shown = |value: Option<f64>| fixed(value.unwrap_or(f64::NAN), 3);
    let rattlers = match coordination.rattlers() {
        0 => "every grain has one".to_owned(),
        rattlers => format!(
            "{} without the {rattlers} grains that have none",
            shown(coordination.mean_without_rattlers())
        ),
    };
    let mean = shown(coordination.mean());
    let note = format!("{mean} contacts a grain, those with sides counted; {rattlers}.");
    Figure {
        title: "Coordination".to_owned(),
        svg: bars::draw(&coordination.grains, "contacts of a grain", "grains"),
        legend: Vec::new(),
        note,
    }
}

/// None where no grains meet.
fn directions(contacts: &[Meeting]) -> Option<Figure> {
    let between_grains = contacts.iter().filter(|contact| contact.between_grains());
    let normals = between_grains.map(|contact| contact.normal);
    let fabric = fabric_of_normals(normals.clone())?;
    let rose = Rose::new(normals, CLASSES);
    let [larger, smaller] = fabric.eigenvalues().map(|value| fixed(value, 4));
    let direction = if fabric.deviator() > ISOTROPIC {
        let degrees = fabric.principal_direction().to_degrees();
        format!(" at {}°", fixed(degrees.rem_euclid(180.0), 1))
    } else {
        String::new()
    };
    let note = format!(
        "Between grains, n and −n. Areas of the sectors are as the shares of contacts. Half axes of the ellipse are as \
         the principal values of the fabric tensor, {larger}{direction} and {smaller}.",
    );
    let entry = |name: &str, colour, dashed| LegendEntry {
        name: name.to_owned(),
        colour,
        dashed,
        filled: false,
    };
    Some(Figure {
        title: "Contact normals".to_owned(),
        svg: rose::draw(&rose, fabric),
        legend: vec![
            entry("contact normals", 0, false),
            entry("fabric tensor", 1, false),
            entry("isotropic", 7, true),
        ],
        note,
    })
}
