//! Inks: what a colour says, and the colours of light and dark sheets.
//!
//! All pairs that stand beside each other can be told apart with any kind of colour vision.

// Colours are written as everywhere: two digits each of red, green and blue.
#![allow(clippy::unreadable_literal)]

/// What a colour says.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Ink {
    /// The sheet.
    Paper,
    /// Words, axes, scale bars.
    Text,
    /// Sides of the container.
    Side,
    /// Lines that help to read.
    Grid,
    /// Outline of a grain.
    Rim,
    /// The inside of a grain.
    Grain,
    /// The inside of a grain with a support.
    Held,
    /// A contact that carries nothing, or is only there as a background.
    Idle,
    /// A contact of the contact graph, or a dual edge.
    Contact,
    /// Compression.
    Compression,
    /// Tension.
    Tension,
    /// A broken contact.
    Broken,
    /// One of eight that stand beside each other.
    Series(u8),
    /// A place on a colour map.
    Shade(ColourMap, u8),
}

/// Colour maps with [`SHADES`] places.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ColourMap {
    /// From small to large (cividis).
    Rising,
    /// From negative over nothing to positive (blue, white, orange).
    Signed,
    /// From first to last (plasma, without its lightest part).
    Order,
    /// From the background to what stands out of it (blues).
    Depth,
}

/// Places on a colour map.
pub const SHADES: u8 = 64;

/// The colours of a sheet.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Theme {
    /// Dark on white.
    #[default]
    Light,
    /// Light on nearly black.
    Dark,
}

/// Red, green, blue.
pub(crate) type Colour = [u8; 3];

const SERIES: [[u32; 2]; 8] = [
    [0x0072b2, 0x58b0f0],
    [0xd55e00, 0xff9350],
    [0x009e73, 0x35c79b],
    [0xa6568c, 0xdd8fc0],
    [0x1b1f23, 0xe8eaec],
    [0xc98a00, 0xf0bd3d],
    [0x3c9ccf, 0x9ad3f5],
    [0x6b7480, 0xa2abb4],
];

/// Cividis, after Nuñez, Anderton & Renslow (2018).
const RISING: [u32; 9] = [
    0x00224e, 0x123570, 0x3b496c, 0x575d6d, 0x707173, 0x8a8678, 0xa59c74, 0xc3b369, 0xfee838,
];
const SIGNED: [u32; 9] = [
    0x053e73, 0x1f6cae, 0x66a0d0, 0xb4d0e7, 0xf2f2f0, 0xf7cfa8, 0xec9a58, 0xcb6216, 0x843606,
];
const SIGNED_ON_DARK: [u32; 9] = [
    0x9ad3f5, 0x58b0f0, 0x2f78b5, 0x234a6c, 0x2b3136, 0x6b4424, 0xb0652a, 0xff9350, 0xffc9a4,
];
const DEPTH: [u32; 6] = [0xe9eef3, 0xbcd0e2, 0x86adcf, 0x4d86b8, 0x245b92, 0x0f2f5c];
const DEPTH_ON_DARK: [u32; 6] = [0x232a31, 0x27445d, 0x2f668f, 0x4a8dc0, 0x82b8e2, 0xd0e7fa];
/// Plasma, after Smith & van der Walt (2015).
const ORDER: [u32; 8] = [
    0x0d0887, 0x41049d, 0x6a00a8, 0x8f0da4, 0xb12a90, 0xcc4778, 0xe16462, 0xf2844b,
];
const ORDER_ON_DARK: [u32; 8] = [
    0x8f0da4, 0xb12a90, 0xcc4778, 0xe16462, 0xf2844b, 0xfca636, 0xfcce25, 0xf0f921,
];

impl Theme {
    /// The colour of an ink on this sheet.
    pub(crate) fn colour(self, ink: Ink) -> Colour {
        let [light, dark] = match ink {
            Ink::Paper => [0xffffff, 0x14171a],
            Ink::Text | Ink::Broken => [0x1b1f23, 0xe8eaec],
            Ink::Side => [0x5a636d, 0x9fa8b1],
            Ink::Grid => [0xd5d9dd, 0x343a40],
            Ink::Rim => [0xa3abb3, 0x626b74],
            Ink::Grain => [0xf2f3f5, 0x1f2428],
            Ink::Held => [0xd3d8dd, 0x343b42],
            Ink::Idle => [0xb4bbc2, 0x4d555d],
            Ink::Contact => [0x2f3a45, 0xc4ccd4],
            Ink::Compression => [0x0b62a8, 0x58b0f0],
            Ink::Tension => [0xd5530b, 0xff9350],
            Ink::Series(number) => SERIES[usize::from(number) % SERIES.len()],
            Ink::Shade(map, shade) => return self.shade(map, shade),
        };
        components(match self {
            Self::Light => light,
            Self::Dark => dark,
        })
    }

    fn shade(self, map: ColourMap, shade: u8) -> Colour {
        let stops: &[u32] = match (map, self) {
            (ColourMap::Rising, _) => &RISING,
            (ColourMap::Signed, Self::Light) => &SIGNED,
            (ColourMap::Signed, Self::Dark) => &SIGNED_ON_DARK,
            (ColourMap::Depth, Self::Light) => &DEPTH,
            (ColourMap::Depth, Self::Dark) => &DEPTH_ON_DARK,
            (ColourMap::Order, Self::Light) => &ORDER,
            (ColourMap::Order, Self::Dark) => &ORDER_ON_DARK,
        };
        let place = f64::from(shade.min(SHADES - 1)) / f64::from(SHADES - 1);
        let along = place * (stops.len() - 1) as f64;
        let before = (along as usize).min(stops.len() - 2);
        let share = along - before as f64;
        let [from, to] = [stops[before], stops[before + 1]].map(components);
        std::array::from_fn(|k| {
            (f64::from(from[k]) * (1.0 - share) + f64::from(to[k]) * share).round() as u8
        })
    }
}

fn components(colour: u32) -> Colour {
    let [_, red, green, blue] = colour.to_be_bytes();
    [red, green, blue]
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Relative luminance, WCAG 2.1.
    fn luminance(colour: Colour) -> f64 {
        let linear = colour.map(|c| {
            let c = f64::from(c) / 255.0;
            if c <= 0.03928 {
                c / 12.92
            } else {
                ((c + 0.055) / 1.055).powf(2.4)
            }
        });
        0.2126 * linear[0] + 0.7152 * linear[1] + 0.0722 * linear[2]
    }

    fn contrast(a: Colour, b: Colour) -> f64 {
        let (a, b) = (luminance(a), luminance(b));
        (a.max(b) + 0.05) / (a.min(b) + 0.05)
    }

    #[test]
    fn words_and_forces_stand_out_from_the_sheet() {
        for theme in [Theme::Light, Theme::Dark] {
            let paper = theme.colour(Ink::Paper);
            assert!(contrast(theme.colour(Ink::Text), paper) >= 7.0);
            for ink in [Ink::Compression, Ink::Tension, Ink::Side, Ink::Contact] {
                assert!(
                    contrast(theme.colour(ink), paper) >= 3.0,
                    "{ink:?} on {theme:?}"
                );
            }
        }
    }

    #[test]
    fn rising_shades_grow_lighter() {
        let shades: Vec<f64> = (0..SHADES)
            .map(|shade| luminance(Theme::Light.colour(Ink::Shade(ColourMap::Rising, shade))))
            .collect();
        assert!(shades.is_sorted());
    }

    #[test]
    fn a_map_starts_and_ends_with_its_stops() {
        let colour = |shade| Theme::Light.colour(Ink::Shade(ColourMap::Order, shade));
        assert_eq!(colour(0), components(ORDER[0]));
        assert_eq!(colour(SHADES - 1), components(ORDER[7]));
    }
}
