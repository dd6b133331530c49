//! A picture as an element of a page, whose style sheet gives the inks their colours.

use std::fmt::Write;

use crate::ink::{ColourMap, Ink, SHADES};
use crate::picture::{Mark, Picture};
use crate::svg::{attributes, escape, outline, text_attributes, units};

/// Steps of a colour map that a page tells apart.
const STEPS: u8 = 8;

impl Picture {
    /// The picture as an `svg` element of class `picture`; what is filled has the class `fill` and that of its ink, lines
    /// have the class `line` and that of their ink.
    ///
    /// Inks are called `paper`, `text`, `side`, `grid`, `rim`, `grain`, `held`, `idle`, `contact`, `press`, `pull`,
    /// `broken`, `s0` to `s7`, and `rising0` to `rising7`, so too `signed`, `order` and `depth`, along colour maps.
    pub fn element(&self) -> String {
        let [width, height] = [self.width, self.height].map(units);
        let mut svg = format!(
            "<svg class=\"picture\" viewBox=\"0 0 {width} {height}\" role=\"img\" aria-label=\"{}\">",
            escape(&self.title)
        );
        for mark in &self.marks {
            let _ = match mark {
                Mark::Fill(shapes, ink) => {
                    write!(
                        svg,
                        "<path class=\"fill {}\" d=\"{}\"/>",
                        name(*ink),
                        outline(shapes)
                    )
                }
                Mark::Stroke(shapes, ink, pen) => {
                    let (pen, path) = (attributes(*pen), outline(shapes));
                    write!(
                        svg,
                        "<path class=\"line {}\"{pen} d=\"{path}\"/>",
                        name(*ink)
                    )
                }
                Mark::Text(text) => {
                    let (place, words) = (text_attributes(text), escape(&text.words));
                    write!(
                        svg,
                        "<text class=\"fill {}\"{place}>{words}</text>",
                        name(text.ink)
                    )
                }
            };
        }
        svg.push_str("</svg>");
        svg
    }
}

/// The class of an ink.
fn name(ink: Ink) -> String {
    match ink {
        Ink::Paper => "paper",
        Ink::Text => "text",
        Ink::Side => "side",
        Ink::Grid => "grid",
        Ink::Rim => "rim",
        Ink::Grain => "grain",
        Ink::Held => "held",
        Ink::Idle => "idle",
        Ink::Contact => "contact",
        Ink::Compression => "press",
        Ink::Tension => "pull",
        Ink::Broken => "broken",
        Ink::Series(number) => return format!("s{}", number % 8),
        Ink::Shade(map, shade) => return format!("{}{}", map_name(map), shade / (SHADES / STEPS)),
    }
    .to_owned()
}

fn map_name(map: ColourMap) -> &'static str {
    match map {
        ColourMap::Rising => "rising",
        ColourMap::Signed => "signed",
        ColourMap::Order => "order",
        ColourMap::Depth => "depth",
    }
}
