//! The contact graph as a picture: a line a contact, as wide as its normal force is large.
//!
//! Contacts of one sign and width are one path with short relative steps, so that 10⁵ grains stay small.
//! After Bojtár & Bagi (1989), figure 13.

use std::collections::HashSet;
use std::fmt::Write;

use kavics_results::{Columns, ResultsFolder};

use crate::ReportError;
use crate::axis::round_step;
use crate::number::show;

/// Length of the picture's longer side, in its own units.
pub(crate) const EXTENT: f64 = 10_000.0;

/// Widths of lines.
const WIDTHS: usize = 12;

/// Above this many grains no circles are drawn.
const GRAINS_DRAWN: usize = 20_000;

/// Forces below this share of the largest one are drawn as none.
const NO_FORCE: f64 = 1e-6;

/// Half the width of the smallest cross that is still seen.
const SMALLEST_MARK: i32 = 45;

/// A point of the picture, downwards, whole units.
pub(crate) type Point = [i32; 2];

/// Lines gathered into one path.
#[derive(Debug, Default)]
pub(crate) struct Path {
    text: String,
    pen: Point,
}

impl Path {
    pub(crate) fn line(&mut self, from: Point, to: Point) {
        let command = if self.text.is_empty() { 'M' } else { 'm' };
        let start = [from[0] - self.pen[0], from[1] - self.pen[1]];
        let step = [to[0] - from[0], to[1] - from[1]];
        self.command(command, start);
        self.command('l', step);
        self.pen = to;
    }

    fn command(&mut self, command: char, [x, y]: Point) {
        // The sign of a negative number parts it from the one before.
        let gap = if y < 0 { "" } else { " " };
        let _ = write!(self.text, "{command}{x}{gap}{y}");
    }

    pub(crate) fn circle(&mut self, [x, y]: Point, radius: i32) {
        let command = if self.text.is_empty() { 'M' } else { 'm' };
        self.command(command, [x - radius - self.pen[0], y - self.pen[1]]);
        let (r, d) = (radius, 2 * radius);
        let _ = write!(self.text, "a{r} {r} 0 1 0 {d} 0a{r} {r} 0 1 0-{d} 0");
        self.pen = [x - radius, y];
    }

    pub(crate) fn write(&self, svg: &mut String, class: &str, attributes: &str) {
        if !self.text.is_empty() {
            let _ = write!(
                svg,
                "<path class=\"{class}\"{attributes} d=\"{}\"/>",
                self.text
            );
        }
    }
}

/// From the scene's lengths to the picture.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Map {
    left: f64,
    top: f64,
    scale: f64,
    pub(crate) width: f64,
    pub(crate) height: f64,
    pub(crate) margin: f64,
}

impl Map {
    pub(crate) fn around(grains: &Discs) -> Self {
        let bound = |at: &[f64], sign: f64| {
            let edges = at.iter().zip(&grains.radius).map(|(x, r)| x + sign * r);
            edges.fold(f64::NEG_INFINITY * sign, |a, b| {
                if sign > 0.0 { a.max(b) } else { a.min(b) }
            })
        };
        let (left, right) = (bound(&grains.x, -1.0), bound(&grains.x, 1.0));
        let (bottom, top) = (bound(&grains.y, -1.0), bound(&grains.y, 1.0));
        let extent = (right - left).max(top - bottom);
        let scale = if extent > 0.0 { EXTENT / extent } else { 1.0 };
        Self {
            left,
            top,
            scale,
            width: (right - left) * scale,
            height: (top - bottom) * scale,
            margin: 0.02 * EXTENT,
        }
    }

    pub(crate) fn point(self, x: f64, y: f64) -> Point {
        let across = self.margin + (x - self.left) * self.scale;
        let down = self.margin + (self.top - y) * self.scale;
        [across.round() as i32, down.round() as i32]
    }

    pub(crate) fn length(self, length: f64) -> i32 {
        (length * self.scale).round() as i32
    }
}

/// Centres and radii of the grains, before loading.
#[derive(Debug)]
pub(crate) struct Discs {
    pub(crate) x: Vec<f64>,
    pub(crate) y: Vec<f64>,
    pub(crate) radius: Vec<f64>,
}

impl Discs {
    pub(crate) fn read(table: &Columns) -> Result<Self, ReportError> {
        Ok(Self {
            x: table.numbers("x")?,
            y: table.numbers("y")?,
            radius: table.numbers("radius")?,
        })
    }
}

/// What is drawn of the contacts.
#[derive(Debug)]
struct Lines {
    first: Vec<Option<i64>>,
    second: Vec<Option<i64>>,
    nx: Vec<f64>,
    ny: Vec<f64>,
    length: Vec<f64>,
    force: Vec<f64>,
    /// Neither open nor broken.
    active: Vec<bool>,
}

impl Lines {
    fn read(table: &Columns) -> Result<Self, ReportError> {
        let states = table.texts("state")?;
        let active = states
            .iter()
            .map(|state| !matches!(*state, "open" | "broken"));
        Ok(Self {
            first: table.integers("first")?,
            second: table.integers("second")?,
            nx: table.numbers("nx")?,
            ny: table.numbers("ny")?,
            length: table.numbers("branch_length")?,
            force: table.numbers("normal_force")?,
            active: active.collect(),
        })
    }

    fn ends(&self, row: usize, grains: &Discs) -> Option<[(f64, f64); 2]> {
        let grain = usize::try_from(self.first[row]?).ok()?;
        let (x, y) = (*grains.x.get(grain)?, *grains.y.get(grain)?);
        let length = self.length[row];
        Some([
            (x, y),
            (x + length * self.nx[row], y + length * self.ny[row]),
        ])
    }
}

/// The largest normal force, by size, in a recorded load step.
pub(crate) fn largest_force(folder: &ResultsFolder, step: usize) -> Result<f64, ReportError> {
    let forces = folder
        .some_of_contacts(step, &["normal_force"])?
        .numbers("normal_force")?;
    Ok(forces.into_iter().map(f64::abs).fold(0.0, f64::max))
}

/// Draws the contact graph of a recorded load step; `broken` are the contacts of which a bond has broken,
/// `largest` is the force of the widest line.
pub(crate) fn draw(
    folder: &ResultsFolder,
    step: usize,
    broken: &HashSet<i64>,
    largest: f64,
) -> Result<String, ReportError> {
    let grain_table = folder.grains(step)?;
    let grains = Discs::read(&grain_table)?;
    let lines = Lines::read(&folder.contacts(step)?)?;
    let map = Map::around(&grains);
    let foot = 0.075 * EXTENT;
    let (width, height) = (map.width + 2.0 * map.margin, map.height + 2.0 * map.margin);
    let mut svg = format!(
        "<svg class=\"graph\" viewBox=\"0 0 {width:.0} {:.0}\" role=\"img\" \
         aria-label=\"contact graph at load step {step}\">",
        height + foot
    );
    if grains.x.len() <= GRAINS_DRAWN {
        draw_grains(&mut svg, &grains, &grain_table.texts("state")?, map);
    }
    draw_sides(&mut svg, &grains, &lines, map);
    draw_contacts(
        &mut svg,
        &grains,
        &lines,
        &Marked {
            map,
            broken,
            largest,
        },
    );
    draw_scale_bar(&mut svg, map, height);
    svg.push_str("</svg>");
    Ok(svg)
}

fn draw_grains(svg: &mut String, grains: &Discs, states: &[&str], map: Map) {
    let mut held = Path::default();
    let mut loose = Path::default();
    let mut others = Path::default();
    for (row, state) in states.iter().enumerate() {
        let path = match *state {
            "held" => &mut held,
            "rattler" | "loose" => &mut loose,
            _ => &mut others,
        };
        path.circle(
            map.point(grains.x[row], grains.y[row]),
            map.length(grains.radius[row]),
        );
    }
    others.write(svg, "grain", "");
    held.write(svg, "grain held", "");
    loose.write(svg, "grain loose", "");
}

/// Each side that grains touch, as far as the grains reach.
fn draw_sides(svg: &mut String, grains: &Discs, lines: &Lines, map: Map) {
    let mut drawn = HashSet::new();
    let mut path = Path::default();
    for (row, second) in lines.second.iter().enumerate() {
        let side = second.filter(|id| *id < 0);
        if side.is_none_or(|side| !drawn.insert(side)) {
            continue;
        }
        if let Some([_, foot]) = lines.ends(row, grains) {
            let [from, to] = side_ends(grains, [lines.nx[row], lines.ny[row]], foot);
            path.line(map.point(from.0, from.1), map.point(to.0, to.1));
        }
    }
    path.write(svg, "side", "");
}

/// The side through `foot` with normal `n`, from the first grain along it to the last.
fn side_ends(grains: &Discs, n: [f64; 2], foot: (f64, f64)) -> [(f64, f64); 2] {
    let along = |x: f64, y: f64| n[0] * y - n[1] * x;
    let mut reach = [f64::INFINITY, f64::NEG_INFINITY];
    for grain in 0..grains.x.len() {
        let at = along(grains.x[grain], grains.y[grain]);
        reach[0] = reach[0].min(at - grains.radius[grain]);
        reach[1] = reach[1].max(at + grains.radius[grain]);
    }
    let start = along(foot.0, foot.1);
    reach.map(|at| (foot.0 - (at - start) * n[1], foot.1 + (at - start) * n[0]))
}

struct Marked<'a> {
    map: Map,
    broken: &'a HashSet<i64>,
    largest: f64,
}

fn draw_contacts(svg: &mut String, grains: &Discs, lines: &Lines, marked: &Marked<'_>) {
    let mut pressed: [Path; WIDTHS] = Default::default();
    let mut pulled: [Path; WIDTHS] = Default::default();
    let mut idle = Path::default();
    let mut gone = Path::default();
    let mut crosses = Path::default();
    let typical = typical_length(lines);
    let arm = marked.map.length(0.11 * typical).max(SMALLEST_MARK);
    for row in 0..lines.force.len() {
        let Some([from, to]) = lines.ends(row, grains) else {
            continue;
        };
        let (a, b) = (
            marked.map.point(from.0, from.1),
            marked.map.point(to.0, to.1),
        );
        let share = lines.force[row].abs() / marked.largest;
        let bin = ((share * WIDTHS as f64) as usize).min(WIDTHS - 1);
        let has_broken = marked.broken.contains(&(row as i64));
        if lines.active[row] {
            let path = match lines.force[row] {
                _ if share.is_nan() || share < NO_FORCE => &mut idle,
                force if force < 0.0 => &mut pressed[bin],
                _ => &mut pulled[bin],
            };
            path.line(a, b);
        } else if has_broken {
            gone.line(a, b);
        }
        if has_broken {
            let [x, y] = [i32::midpoint(a[0], b[0]), i32::midpoint(a[1], b[1])];
            crosses.line([x - arm, y - arm], [x + arm, y + arm]);
            crosses.line([x - arm, y + arm], [x + arm, y - arm]);
        }
    }
    let widest = 0.2 * typical * marked.map.scale;
    idle.write(svg, "idle", &stroke(0.03 * typical * marked.map.scale));
    for (bin, (pressed, pulled)) in pressed.iter().zip(&pulled).enumerate() {
        let width = stroke(widest * (bin as f64 + 1.0) / WIDTHS as f64);
        pressed.write(svg, "press", &width);
        pulled.write(svg, "pull", &width);
    }
    let thin = (0.045 * typical * marked.map.scale).max(0.3 * f64::from(SMALLEST_MARK));
    let dash = format!(
        " stroke-dasharray=\"{:.0} {:.0}\"{}",
        3.0 * thin,
        2.5 * thin,
        stroke(thin)
    );
    gone.write(svg, "gone", &dash);
    crosses.write(svg, "gone", &stroke(1.5 * thin));
}

pub(crate) fn stroke(width: f64) -> String {
    format!(" stroke-width=\"{width:.1}\"")
}

/// Mean branch length of the contacts.
fn typical_length(lines: &Lines) -> f64 {
    let count = lines.length.len().max(1) as f64;
    lines.length.iter().sum::<f64>() / count
}

fn draw_scale_bar(svg: &mut String, map: Map, top: f64) {
    let length = round_step(0.12 * map.width / map.scale);
    let drawn = length * map.scale;
    let (x, y) = (map.margin, top + 0.02 * EXTENT);
    let _ = write!(
        svg,
        "<path class=\"bar\" d=\"M{x:.0} {:.0}v120M{x:.0} {:.0}h{drawn:.0}m0-60v120\"/>\
         <text class=\"bar-label\" x=\"{:.0}\" y=\"{:.0}\">{}</text>",
        y - 60.0,
        y,
        x + drawn + 140.0,
        y + 95.0,
        show(length)
    );
}
