//! A picture as plain data: shapes on a sheet of paper, in the order in which they are drawn.

use kavics::geometry::Vector;

use crate::ink::Ink;

/// Shapes and words on a sheet. Lengths in millimetres, x to the right, y downwards from the upper left corner.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Picture {
    /// Width, mm.
    pub width: f64,
    /// Height, mm.
    pub height: f64,
    /// What it shows, for those who cannot see it.
    pub title: String,
    /// What is drawn, what comes later on top.
    pub marks: Vec<Mark>,
}

/// Something that is drawn.
#[derive(Clone, Debug, PartialEq)]
pub enum Mark {
    /// Shapes filled with ink.
    Fill(Vec<Shape>, Ink),
    /// Lines along shapes.
    Stroke(Vec<Shape>, Ink, Pen),
    /// Words.
    Text(Text),
}

/// A shape on the sheet.
#[derive(Clone, Debug, PartialEq)]
pub enum Shape {
    /// A straight line.
    Line([Vector; 2]),
    /// A circle with centre and radius.
    Circle(Vector, f64),
    /// Straight lines from point to point.
    Polyline(Vec<Vector>),
    /// The same, closed.
    Polygon(Vec<Vector>),
}

/// A pen.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Pen {
    /// Width, mm.
    pub width: f64,
    /// Length of dashes and of gaps between them, mm; none: a whole line.
    pub dash: Option<[f64; 2]>,
    /// Whether lines end in half circles.
    pub round: bool,
}

impl Pen {
    /// A pen for whole lines that end bluntly.
    pub fn of(width: f64) -> Self {
        Self {
            width,
            ..Self::default()
        }
    }
}

/// Which point of a text stands at its place.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Anchor {
    /// Its start.
    #[default]
    Start,
    /// Its middle.
    Middle,
    /// Its end.
    End,
}

/// Words on the sheet.
#[derive(Clone, Debug, PartialEq)]
pub struct Text {
    /// Where the anchor stands on the base line.
    pub at: Vector,
    /// The words.
    pub words: String,
    /// Size of the type, mm.
    pub size: f64,
    /// Which point stands at the place.
    pub anchor: Anchor,
    /// Whether it is turned by a quarter turn, to be read from below upwards.
    pub upwards: bool,
    /// Colour.
    pub ink: Ink,
}

impl Picture {
    /// Fills shapes, if there are some.
    pub(crate) fn fill(&mut self, shapes: Vec<Shape>, ink: Ink) {
        if !shapes.is_empty() {
            self.marks.push(Mark::Fill(shapes, ink));
        }
    }

    /// Draws along shapes, if there are some.
    pub(crate) fn stroke(&mut self, shapes: Vec<Shape>, ink: Ink, pen: Pen) {
        if !shapes.is_empty() {
            self.marks.push(Mark::Stroke(shapes, ink, pen));
        }
    }

    /// Writes words with their anchor at a place.
    pub(crate) fn text(&mut self, at: Vector, words: &str, anchor: Anchor) {
        self.marks.push(Mark::Text(Text {
            at,
            words: words.to_owned(),
            size: TYPE_SIZE,
            anchor,
            upwards: false,
            ink: Ink::Text,
        }));
    }
}

/// Size of the type in all pictures, mm; 7 points.
pub(crate) const TYPE_SIZE: f64 = 7.0 * 25.4 / 72.0;
