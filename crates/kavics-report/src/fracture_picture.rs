//! The assembly with its broken contacts, each a line along its dual edge in the colour of its place in the order of breaks.

use std::collections::HashMap;
use std::fmt::Write;

use kavics_results::{Columns, ResultsFolder};

use crate::ReportError;
use crate::graph::{Discs, EXTENT, Map, Path, stroke};

/// Shades from the first break to the last.
const SHADES: usize = 8;

/// Broken and intact contacts drawn, about at most.
const BROKEN_DRAWN: usize = 100_000;
const INTACT_DRAWN: usize = 50_000;

/// Width of a broken contact in mean branch lengths, and the least that is seen.
const WIDTH: f64 = 0.24;
const LEAST_WIDTH: f64 = 0.004 * EXTENT;

/// What is drawn of the contacts.
struct Lines {
    /// Centre of the first partner.
    from: Vec<(f64, f64)>,
    nx: Vec<f64>,
    ny: Vec<f64>,
    x: Vec<f64>,
    y: Vec<f64>,
    branch: Vec<f64>,
    dual: Vec<f64>,
}

impl Lines {
    fn read(table: &Columns, grains: &Discs) -> Result<Self, ReportError> {
        let centre = |grain: Option<i64>| {
            let grain = usize::try_from(grain?).ok()?;
            Some((*grains.x.get(grain)?, *grains.y.get(grain)?))
        };
        let first = table.integers("first")?.into_iter();
        Ok(Self {
            from: first
                .map(|grain| centre(grain).unwrap_or_default())
                .collect(),
            nx: table.numbers("nx")?,
            ny: table.numbers("ny")?,
            x: table.numbers("x")?,
            y: table.numbers("y")?,
            branch: table.numbers("branch_length")?,
            dual: table.numbers("dual_length_full")?,
        })
    }

    fn branch(&self, path: &mut Path, map: Map, row: usize) {
        let ((x, y), length) = (self.from[row], self.branch[row]);
        let end = (x + length * self.nx[row], y + length * self.ny[row]);
        path.line(map.point(x, y), map.point(end.0, end.1));
    }

    /// A dual edge at the rim of the assembly can be long; more than the branch would hide its neighbours.
    fn dual_edge(&self, path: &mut Path, map: Map, row: usize) {
        let half = 0.5 * self.dual[row].min(self.branch[row]);
        let (x, y) = (-half * self.ny[row], half * self.nx[row]);
        let end = |sign: f64| map.point(self.x[row] + sign * x, self.y[row] + sign * y);
        path.line(end(-1.0), end(1.0));
    }
}

/// Draws the contacts in the order in which they broke, at a recorded load step.
pub(crate) fn draw(
    folder: &ResultsFolder,
    step: usize,
    broken: &[i64],
) -> Result<String, ReportError> {
    let grains = Discs::read(&folder.grains(step)?)?;
    let map = Map::around(&grains);
    let lines = Lines::read(&folder.contacts(step)?, &grains)?;
    let order = order(broken);
    let branches = lines.branch.iter().sum::<f64>() / lines.branch.len().max(1) as f64;
    let typical = f64::from(map.length(branches));
    let foot = 0.075 * EXTENT;
    let (width, height) = (map.width + 2.0 * map.margin, map.height + 2.0 * map.margin);
    let mut svg = format!(
        "<svg class=\"graph\" viewBox=\"0 0 {width:.0} {:.0}\" role=\"img\" \
         aria-label=\"order of breaks at load step {step}\">",
        height + foot
    );
    draw_intact(&mut svg, &lines, map, &order, 0.08 * typical);
    draw_broken(
        &mut svg,
        &lines,
        map,
        broken,
        (WIDTH * typical).max(LEAST_WIDTH),
    );
    draw_scale(&mut svg, [map.margin, height + 0.02 * EXTENT], broken.len());
    svg.push_str("</svg>");
    Ok(svg)
}

/// The number of a contact's first break.
fn order(broken: &[i64]) -> HashMap<i64, usize> {
    let mut order = HashMap::new();
    for (number, contact) in broken.iter().enumerate() {
        order.entry(*contact).or_insert(number);
    }
    order
}

fn draw_intact(svg: &mut String, lines: &Lines, map: Map, order: &HashMap<i64, usize>, width: f64) {
    let mut path = Path::default();
    let count = lines.x.len();
    for row in (0..count).step_by(count.div_ceil(INTACT_DRAWN).max(1)) {
        if !order.contains_key(&(row as i64)) {
            lines.branch(&mut path, map, row);
        }
    }
    path.write(svg, "intact", &stroke(width));
}

/// The last break of a shade is drawn over the first one; later shades over earlier ones.
fn draw_broken(svg: &mut String, lines: &Lines, map: Map, broken: &[i64], width: f64) {
    let mut shades: [Path; SHADES] = Default::default();
    let count = broken.len();
    for number in (0..count).step_by(count.div_ceil(BROKEN_DRAWN).max(1)) {
        let row = usize::try_from(broken[number]).ok();
        if let Some(row) = row.filter(|&row| row < lines.x.len()) {
            lines.dual_edge(&mut shades[number * SHADES / count], map, row);
        }
    }
    for (shade, path) in shades.iter().enumerate() {
        path.write(svg, &format!("break e{shade}"), &stroke(width));
    }
}

/// The shades from the first break to the last.
fn draw_scale(svg: &mut String, [x, y]: [f64; 2], count: usize) {
    let _ = write!(
        svg,
        "<text class=\"bar-label\" x=\"{x:.0}\" y=\"{:.0}\">break 1</text>",
        y + 95.0
    );
    let (start, cell) = (x + 1250.0, 260.0);
    for shade in 0..SHADES {
        let left = start + cell * shade as f64;
        let _ = write!(
            svg,
            "<path class=\"break e{shade}\" stroke-width=\"220\" d=\"M{left:.0} {y:.0}h{cell:.0}\"/>"
        );
    }
    let _ = write!(
        svg,
        "<text class=\"bar-label\" x=\"{:.0}\" y=\"{:.0}\">{count}</text>",
        start + cell * SHADES as f64 + 140.0,
        y + 95.0
    );
}
