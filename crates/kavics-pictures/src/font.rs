//! The outlines of letters, for pictures of pixels, and how wide words are.

use tiny_skia::PathBuilder;
use ttf_parser::{Face, OutlineBuilder};

/// Letters of DejaVu Sans that scenes and columns use.
static LETTERS: &[u8] = include_bytes!("../font/DejaVuSans-subset.ttf");

/// A font.
pub(crate) struct Font {
    face: Option<Face<'static>>,
}

/// Width of a letter that the font does not have, in sizes of the type.
const UNKNOWN: f64 = 0.6;

impl Font {
    pub(crate) fn new() -> Self {
        Self {
            face: Face::parse(LETTERS, 0).ok(),
        }
    }

    /// Width of words in type of a size, in the unit of the size.
    pub(crate) fn width(&self, words: &str, size: f64) -> f64 {
        words
            .chars()
            .map(|letter| self.advance(letter))
            .sum::<f64>()
            * size
    }

    fn advance(&self, letter: char) -> f64 {
        let advance = self.face.as_ref().and_then(|face| {
            let glyph = face.glyph_index(letter)?;
            Some(f64::from(face.glyph_hor_advance(glyph)?) / f64::from(face.units_per_em()))
        });
        advance.unwrap_or(UNKNOWN)
    }

    /// The outlines of words that start at the origin, y downwards, in type of size 1.
    pub(crate) fn outlines(&self, words: &str) -> Option<tiny_skia::Path> {
        let face = self.face.as_ref()?;
        let mut drawn = Drawn {
            path: PathBuilder::new(),
            scale: 1.0 / f32::from(face.units_per_em()),
            left: 0.0,
        };
        for letter in words.chars() {
            if let Some(glyph) = face.glyph_index(letter) {
                face.outline_glyph(glyph, &mut drawn);
            }
            drawn.left += self.advance(letter) as f32;
        }
        drawn.path.finish()
    }
}

/// Takes the outline of a letter, whose y runs upwards.
struct Drawn {
    path: PathBuilder,
    scale: f32,
    left: f32,
}

impl Drawn {
    fn point(&self, x: f32, y: f32) -> (f32, f32) {
        (self.left + x * self.scale, -y * self.scale)
    }
}

impl OutlineBuilder for Drawn {
    fn move_to(&mut self, x: f32, y: f32) {
        let (x, y) = self.point(x, y);
        self.path.move_to(x, y);
    }

    fn line_to(&mut self, x: f32, y: f32) {
        let (x, y) = self.point(x, y);
        self.path.line_to(x, y);
    }

    fn quad_to(&mut self, x1: f32, y1: f32, x: f32, y: f32) {
        let ((x1, y1), (x, y)) = (self.point(x1, y1), self.point(x, y));
        self.path.quad_to(x1, y1, x, y);
    }

    fn curve_to(&mut self, x1: f32, y1: f32, x2: f32, y2: f32, x: f32, y: f32) {
        let ((x1, y1), (x2, y2)) = (self.point(x1, y1), self.point(x2, y2));
        let (x, y) = self.point(x, y);
        self.path.cubic_to(x1, y1, x2, y2, x, y);
    }

    fn close(&mut self) {
        self.path.close();
    }
}

#[cfg(test)]
mod tests {
    use super::Font;

    #[test]
    fn the_font_has_what_pictures_say() {
        let font = Font::new();
        let face = font.face.as_ref().expect("a font");
        for letter in "áőűŁ αβσελ −–·×² ⁻³₀ ° √ ∂ Az09 /^_()".chars() {
            assert!(face.glyph_index(letter).is_some(), "{letter}");
        }
        assert!((font.width("00", 10.0) - 2.0 * font.width("0", 10.0)).abs() < 1e-12);
        assert!(font.outlines("kavics").is_some());
    }
}
