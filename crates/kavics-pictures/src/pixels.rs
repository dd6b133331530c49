//! A picture as pixels: PNG.

use kavics::geometry::Vector;
use tiny_skia::{
    Color, FillRule, LineCap, LineJoin, Paint, PathBuilder, Pixmap, Stroke, StrokeDash, Transform,
};

use crate::PictureError;
use crate::font::Font;
use crate::ink::{Ink, Theme};
use crate::picture::{Anchor, Mark, Pen, Picture, Shape, Text};

/// Shapes that are drawn in one go: more take longer than they save.
const SHAPES_AT_ONCE: usize = 256;

/// Width and height of the largest picture, in pixels.
const MOST_PIXELS: u32 = 20_000;

impl Picture {
    /// The picture as a PNG file with so many pixels a millimetre.
    ///
    /// # Errors
    /// A picture with too many pixels, or without any.
    pub fn png(&self, theme: Theme, pixels_a_millimetre: f64) -> Result<Vec<u8>, PictureError> {
        let [width, height] =
            [self.width, self.height].map(|length| (length * pixels_a_millimetre).round() as u32);
        let fits = width.max(height) <= MOST_PIXELS;
        let too_large = || PictureError::TooLarge {
            width,
            height,
            most: MOST_PIXELS,
        };
        let pixmap = fits.then(|| Pixmap::new(width, height)).flatten();
        let mut pixels = Pixels {
            pixmap: pixmap.ok_or_else(too_large)?,
            scale: pixels_a_millimetre as f32,
            theme,
            font: Font::new(),
        };
        pixels.pixmap.fill(pixels.colour(Ink::Paper));
        for mark in &self.marks {
            pixels.draw(mark);
        }
        pixels.pixmap.encode_png().map_err(|_| too_large())
    }
}

struct Pixels {
    pixmap: Pixmap,
    scale: f32,
    theme: Theme,
    font: Font,
}

impl Pixels {
    fn colour(&self, ink: Ink) -> Color {
        let [red, green, blue] = self.theme.colour(ink);
        Color::from_rgba8(red, green, blue, 255)
    }

    fn paint(&self, ink: Ink) -> Paint<'static> {
        let mut paint = Paint {
            anti_alias: true,
            ..Paint::default()
        };
        paint.set_color(self.colour(ink));
        paint
    }

    fn draw(&mut self, mark: &Mark) {
        let to_pixels = Transform::from_scale(self.scale, self.scale);
        match mark {
            Mark::Fill(shapes, ink) => {
                let paint = self.paint(*ink);
                for path in shapes.chunks(SHAPES_AT_ONCE).filter_map(path) {
                    let map = self.pixmap.as_mut();
                    fill(map, &path, &paint, to_pixels);
                }
            }
            Mark::Stroke(shapes, ink, pen) => {
                let (paint, stroke) = (self.paint(*ink), stroke(*pen));
                for path in shapes.chunks(SHAPES_AT_ONCE).filter_map(path) {
                    let mut map = self.pixmap.as_mut();
                    map.stroke_path(&path, &paint, &stroke, to_pixels, None);
                }
            }
            Mark::Text(text) => self.write(text),
        }
    }

    fn write(&mut self, text: &Text) {
        let Some(path) = self.font.outlines(&text.words) else {
            return;
        };
        let back = self.font.width(&text.words, 1.0)
            * match text.anchor {
                Anchor::Start => 0.0,
                Anchor::Middle => 0.5,
                Anchor::End => 1.0,
            };
        let turn = if text.upwards { -90.0 } else { 0.0 };
        let size = text.size as f32;
        let place = Transform::from_translate(-back as f32, 0.0)
            .post_scale(size, size)
            .post_rotate(turn)
            .post_translate(text.at.x as f32, text.at.y as f32)
            .post_scale(self.scale, self.scale);
        let paint = self.paint(text.ink);
        fill(self.pixmap.as_mut(), &path, &paint, place);
    }
}

fn fill(
    mut map: tiny_skia::PixmapMut<'_>,
    path: &tiny_skia::Path,
    paint: &Paint<'_>,
    transform: Transform,
) {
    map.fill_path(path, paint, FillRule::Winding, transform, None);
}

fn stroke(pen: Pen) -> Stroke {
    Stroke {
        width: pen.width as f32,
        line_cap: if pen.round {
            LineCap::Round
        } else {
            LineCap::Butt
        },
        line_join: if pen.round {
            LineJoin::Round
        } else {
            LineJoin::Miter
        },
        dash: pen
            .dash
            .and_then(|dash| StrokeDash::new(dash.map(|part| part as f32).to_vec(), 0.0)),
        ..Stroke::default()
    }
}

fn path(shapes: &[Shape]) -> Option<tiny_skia::Path> {
    let mut path = PathBuilder::new();
    for shape in shapes {
        match shape {
            Shape::Line(ends) => add(&mut path, ends),
            Shape::Circle(centre, radius) => {
                path.push_circle(centre.x as f32, centre.y as f32, *radius as f32);
            }
            Shape::Polyline(points) => add(&mut path, points),
            Shape::Polygon(points) => {
                add(&mut path, points);
                path.close();
            }
        }
    }
    path.finish()
}

fn add(path: &mut PathBuilder, points: &[Vector]) {
    for (number, point) in points.iter().enumerate() {
        let (x, y) = (point.x as f32, point.y as f32);
        if number == 0 {
            path.move_to(x, y);
        } else {
            path.line_to(x, y);
        }
    }
}
