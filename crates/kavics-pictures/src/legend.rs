//! What stands under a picture: scale bar, and what lines and colours mean.

use kavics::geometry::Vector;

use crate::axis::round_step;
use crate::colouring::{Colouring, Key};
use crate::font::Font;
use crate::ink::{ColourMap, Ink, SHADES};
use crate::number::show;
use crate::picture::{Anchor, Pen, Picture, Shape, TYPE_SIZE};
use crate::view::{MARGIN, View};

/// Height of a row, mm.
const ROW: f64 = 4.4;
/// Empty room after an entry, mm.
const GAP: f64 = 5.0;
/// Length of a sample of a line or colour, mm.
const SAMPLE: f64 = 6.0;
/// Room between a sample and its words, mm.
const APART: f64 = 1.4;
/// Length of a colour map, mm.
const MAP: f64 = 30.0;
/// Length of the scale bar as a share of the width, about.
const BAR: f64 = 0.12;

/// Words for units; empty where the user gave none.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Units {
    /// Of length.
    pub length: String,
    /// Of force.
    pub force: String,
}

impl Units {
    /// A number with its unit.
    pub(crate) fn with(unit: &str, value: f64) -> String {
        if unit.is_empty() {
            show(value)
        } else {
            format!("{} {unit}", show(value))
        }
    }
}

/// Something that the legend explains.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Entry {
    /// A length.
    Bar(f64, String),
    /// A line.
    Line(Ink, Pen, String),
    /// A disc.
    Disc(Ink, String),
    /// A surface.
    Surface(Ink, String),
    /// A cross.
    Cross(String),
    /// A colour map from one number to another, and what it shows.
    Map(ColourMap, [String; 2], String),
    /// Words alone.
    Words(String),
}

impl Entry {
    /// The scale bar of a view.
    pub fn bar(view: &View, units: &Units) -> Self {
        let length = round_step(BAR * view.width());
        Self::Bar(view.length(length), Units::with(&units.length, length))
    }

    /// The entries of a colouring.
    pub fn of(colouring: &Colouring) -> Vec<Self> {
        match &colouring.key {
            Key::Range(map, range) => {
                let ends = [*range.start(), *range.end()].map(show);
                vec![Self::Map(*map, ends, colouring.title.clone())]
            }
            Key::Words(words) => {
                let title = Self::Words(format!("{}:", colouring.title));
                let words = words.iter();
                let words = words.map(|(ink, word)| Self::Surface(*ink, word.clone()));
                std::iter::once(title).chain(words).collect()
            }
        }
    }

    fn width(&self, font: &Font) -> f64 {
        let words = |words: &str| font.width(words, TYPE_SIZE);
        match self {
            Self::Bar(length, label) => length + APART + words(label),
            Self::Line(_, _, label) | Self::Cross(label) => SAMPLE + APART + words(label),
            Self::Disc(_, label) => 0.5 * SAMPLE + APART + words(label),
            // Surfaces belong to one column and stand closer.
            Self::Surface(_, label) => 0.5 * SAMPLE + APART + words(label) - 0.4 * GAP,
            Self::Map(_, [low, high], title) => {
                let title = if title.is_empty() {
                    0.0
                } else {
                    words(title) + 2.0 * APART
                };
                title + words(low) + words(high) + MAP + 2.0 * APART
            }
            Self::Words(label) => words(label) - 0.5 * GAP,
        }
    }

    /// Draws it with its left end at a point of the middle line of its row.
    fn draw(&self, picture: &mut Picture, font: &Font, at: Vector) {
        let right = |x: f64| at + Vector::new(x, 0.0);
        match self {
            Self::Bar(length, label) => {
                let tick = |x: f64| {
                    let half = Vector::new(0.0, 0.8);
                    Shape::Line([right(x) - half, right(x) + half])
                };
                let bar = vec![Shape::Line([at, right(*length)]), tick(0.0), tick(*length)];
                picture.stroke(bar, Ink::Text, Pen::of(0.35));
                word(picture, right(length + APART), label);
            }
            Self::Line(ink, pen, label) => {
                let line = Shape::Line([at, right(SAMPLE)]);
                picture.stroke(vec![line], *ink, *pen);
                word(picture, right(SAMPLE + APART), label);
            }
            Self::Disc(ink, label) => {
                let disc = || vec![Shape::Circle(right(0.25 * SAMPLE), 0.21 * SAMPLE)];
                picture.fill(disc(), *ink);
                picture.stroke(disc(), Ink::Rim, Pen::of(0.15));
                word(picture, right(0.5 * SAMPLE + APART), label);
            }
            Self::Surface(ink, label) => {
                picture.fill(vec![rectangle(at, 0.5 * SAMPLE, 2.4)], *ink);
                word(picture, right(0.5 * SAMPLE + APART), label);
            }
            Self::Cross(label) => {
                picture.stroke(cross(right(0.5 * SAMPLE), 0.9), Ink::Broken, Pen::of(0.3));
                word(picture, right(SAMPLE + APART), label);
            }
            Self::Map(map, [low, high], title) => {
                let mut x = 0.0;
                if !title.is_empty() {
                    word(picture, at, title);
                    x = font.width(title, TYPE_SIZE) + 2.0 * APART;
                }
                word(picture, right(x), low);
                x += font.width(low, TYPE_SIZE) + APART;
                draw_map(picture, *map, right(x));
                word(picture, right(x + MAP + APART), high);
            }
            Self::Words(label) => word(picture, at, label),
        }
    }
}

/// A saltire with arms so long.
pub(crate) fn cross(centre: Vector, arm: f64) -> Vec<Shape> {
    let (down, up) = (Vector::new(arm, arm), Vector::new(arm, -arm));
    vec![
        Shape::Line([centre - down, centre + down]),
        Shape::Line([centre - up, centre + up]),
    ]
}

fn word(picture: &mut Picture, at: Vector, words: &str) {
    // Digits and capitals stand about the middle line.
    picture.text(
        at + Vector::new(0.0, 0.36 * TYPE_SIZE),
        words,
        Anchor::Start,
    );
}

/// A rectangle from a point of the middle of its left side.
fn rectangle(at: Vector, width: f64, height: f64) -> Shape {
    let (w, h) = (Vector::new(width, 0.0), Vector::new(0.0, 0.5 * height));
    Shape::Polygon(vec![at - h, at + w - h, at + w + h, at + h])
}

fn draw_map(picture: &mut Picture, map: ColourMap, at: Vector) {
    let width = MAP / f64::from(SHADES);
    for shade in 0..SHADES {
        let left = at + Vector::new(f64::from(shade) * width, 0.0);
        // Neighbours overlap, so that no seam is seen between them.
        let overlap = if shade + 1 < SHADES { 0.2 } else { 0.0 };
        picture.fill(
            vec![rectangle(left, width + overlap, 2.4)],
            Ink::Shade(map, shade),
        );
    }
}

/// Draws entries row by row from a height downwards, and ends the picture under them.
pub(crate) fn finish(picture: &mut Picture, top: f64, entries: &[Entry]) {
    let font = Font::new();
    let mut at = Vector::new(MARGIN, top + 0.5 * ROW);
    for entry in entries {
        let width = entry.width(&font);
        if at.x > MARGIN && at.x + width > picture.width - MARGIN {
            at = Vector::new(MARGIN, at.y + ROW);
        }
        entry.draw(picture, &font, at);
        at.x += width + GAP;
    }
    picture.height = at.y + 0.5 * ROW + 0.5 * MARGIN;
}
