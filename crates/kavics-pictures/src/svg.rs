//! A picture as vector graphics: SVG with whole numbers of hundredths of a millimetre and relative steps, so that 10⁵
//! grains stay small.

use std::fmt::Write;

use kavics::geometry::Vector;

use crate::ink::{Ink, Theme};
use crate::picture::{Anchor, Mark, Pen, Picture, Shape, Text};

/// Units of the drawing in a millimetre.
const UNITS: f64 = 100.0;

/// Fonts with the widths of the one that pixels are drawn with.
const FONTS: &str = "DejaVu Sans, Verdana, Bitstream Vera Sans, sans-serif";

impl Picture {
    /// The picture as a text of SVG 1.1.
    pub fn svg(&self, theme: Theme) -> String {
        let [width, height] = [self.width, self.height].map(units);
        let mut svg = format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{}mm\" height=\"{}mm\" \
             viewBox=\"0 0 {width} {height}\" font-family=\"{FONTS}\" role=\"img\">\n\
             <title>{}</title>\n<rect width=\"{width}\" height=\"{height}\" fill=\"{}\"/>\n",
            short(self.width),
            short(self.height),
            escape(&self.title),
            hexadecimal(Ink::Paper, theme)
        );
        for mark in &self.marks {
            write_mark(&mut svg, mark, theme);
        }
        svg.push_str("</svg>\n");
        svg
    }
}

fn write_mark(svg: &mut String, mark: &Mark, theme: Theme) {
    let _ = match mark {
        Mark::Fill(shapes, ink) => {
            let colour = hexadecimal(*ink, theme);
            writeln!(svg, "<path fill=\"{colour}\" d=\"{}\"/>", outline(shapes))
        }
        Mark::Stroke(shapes, ink, pen) => {
            let colour = hexadecimal(*ink, theme);
            let (pen, path) = (attributes(*pen), outline(shapes));
            writeln!(
                svg,
                "<path fill=\"none\" stroke=\"{colour}\"{pen} d=\"{path}\"/>"
            )
        }
        Mark::Text(text) => write_text(svg, text, theme),
    };
}

fn write_text(svg: &mut String, text: &Text, theme: Theme) -> std::fmt::Result {
    let (place, colour) = (text_attributes(text), hexadecimal(text.ink, theme));
    let words = escape(&text.words);
    writeln!(svg, "<text{place} fill=\"{colour}\">{words}</text>")
}

/// Where words stand and how large they are.
pub(crate) fn text_attributes(text: &Text) -> String {
    let anchor = match text.anchor {
        Anchor::Start => "",
        Anchor::Middle => " text-anchor=\"middle\"",
        Anchor::End => " text-anchor=\"end\"",
    };
    let [x, y] = [text.at.x, text.at.y].map(units);
    let turn = if text.upwards {
        format!(" transform=\"rotate(-90 {x} {y})\"")
    } else {
        String::new()
    };
    let size = units(text.size);
    format!(" x=\"{x}\" y=\"{y}\" font-size=\"{size}\"{anchor}{turn}")
}

pub(crate) fn attributes(pen: Pen) -> String {
    let mut text = format!(" stroke-width=\"{}\"", short(pen.width * UNITS));
    if let Some([dash, gap]) = pen.dash {
        let _ = write!(text, " stroke-dasharray=\"{} {}\"", units(dash), units(gap));
    }
    if pen.round {
        text.push_str(" stroke-linecap=\"round\" stroke-linejoin=\"round\"");
    }
    text
}

/// Whole units.
pub(crate) fn units(millimetres: f64) -> i32 {
    (millimetres * UNITS).round() as i32
}

/// At most two decimals.
fn short(value: f64) -> String {
    let text = format!("{value:.2}");
    text.trim_end_matches('0').trim_end_matches('.').to_owned()
}

fn hexadecimal(ink: Ink, theme: Theme) -> String {
    let [red, green, blue] = theme.colour(ink);
    format!("#{red:02x}{green:02x}{blue:02x}")
}

pub(crate) fn outline(shapes: &[Shape]) -> String {
    let mut path = Outline::default();
    for shape in shapes {
        match shape {
            Shape::Line([from, to]) => {
                path.start(*from);
                path.go(*to);
            }
            Shape::Circle(centre, radius) => path.circle(*centre, *radius),
            Shape::Polyline(points) => path.points(points, ""),
            Shape::Polygon(points) => path.points(points, "z"),
        }
    }
    path.text
}

/// The commands of a path with relative steps.
#[derive(Default)]
struct Outline {
    text: String,
    pen: [i32; 2],
    /// Where the line began.
    begin: [i32; 2],
}

impl Outline {
    fn start(&mut self, to: Vector) {
        self.command(if self.text.is_empty() { 'M' } else { 'm' }, to);
        self.begin = self.pen;
    }

    fn go(&mut self, to: Vector) {
        self.command('l', to);
    }

    fn command(&mut self, command: char, to: Vector) {
        let to = [units(to.x), units(to.y)];
        let [x, y] = [to[0] - self.pen[0], to[1] - self.pen[1]];
        // The sign of a negative number parts it from the one before.
        let gap = if y < 0 { "" } else { " " };
        let _ = write!(self.text, "{command}{x}{gap}{y}");
        self.pen = to;
    }

    fn circle(&mut self, centre: Vector, radius: f64) {
        let radius = f64::from(units(radius).max(1)) / UNITS;
        self.start(centre - Vector::new(radius, 0.0));
        let (r, d) = (units(radius), 2 * units(radius));
        let _ = write!(self.text, "a{r} {r} 0 1 0 {d} 0a{r} {r} 0 1 0-{d} 0z");
    }

    fn points(&mut self, points: &[Vector], end: &str) {
        let Some((first, rest)) = points.split_first() else {
            return;
        };
        self.start(*first);
        for point in rest {
            self.go(*point);
        }
        self.text.push_str(end);
        if !end.is_empty() {
            self.pen = self.begin;
        }
    }
}

/// Text that may stand in XML.
pub(crate) fn escape(text: &str) -> String {
    // XML has no place for other control characters.
    let text = text.replace(
        |c: char| c.is_control() && !"\t\n\r".contains(c),
        "\u{fffd}",
    );
    let text = text.replace('&', "&amp;").replace('<', "&lt;");
    text.replace('>', "&gt;").replace('"', "&quot;")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn steps_are_relative_and_whole() {
        let point = Vector::new;
        let shapes = [
            Shape::Line([point(1.0, 2.0), point(1.5, 1.5)]),
            Shape::Polygon(vec![point(0.0, 0.0), point(1.0, 0.0), point(0.0, 1.0)]),
            Shape::Line([point(0.0, 0.0), point(0.004, 0.0)]),
        ];
        assert_eq!(
            outline(&shapes),
            "M100 200l50-50m-150-150l100 0l-100 100zm0 0l0 0"
        );
        let circle = [Shape::Circle(point(3.0, 3.0), 1.0)];
        assert_eq!(
            outline(&circle),
            "M200 300a100 100 0 1 0 200 0a100 100 0 1 0-200 0z"
        );
    }

    #[test]
    fn words_are_escaped() {
        assert_eq!(escape("a < b & \"c\""), "a &lt; b &amp; &quot;c&quot;");
    }
}
