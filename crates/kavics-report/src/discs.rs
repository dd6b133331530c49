//! Discs as a picture: those of one shade are one path with short relative steps.

use std::fmt::Write;

use kavics_results::Columns;

use crate::ReportError;

/// Length of the picture's longer side, in its own units.
const EXTENT: f64 = 10_000.0;

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

pub(crate) fn stroke(width: f64) -> String {
    format!(" stroke-width=\"{width:.1}\"")
}
