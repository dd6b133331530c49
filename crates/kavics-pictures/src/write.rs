//! A picture as a file.

use std::path::Path;

use kavics_results::{ResultsError, publish};

use crate::PictureError;
use crate::ink::Theme;
use crate::picture::Picture;

/// Format of a picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Format {
    /// Vector graphics.
    Svg,
    /// Pixels.
    Png,
}

impl Format {
    /// The format of the file at `path`, by its ending.
    ///
    /// # Errors
    /// Another ending.
    pub fn of(path: &Path) -> Result<Self, PictureError> {
        let ending = path.extension().unwrap_or_default();
        if ending.eq_ignore_ascii_case("svg") {
            Ok(Self::Svg)
        } else if ending.eq_ignore_ascii_case("png") {
            Ok(Self::Png)
        } else {
            Err(PictureError::Results(ResultsError::UnknownEnding {
                path: path.to_owned(),
                expected: ".svg or .png",
            }))
        }
    }
}

/// Writes a picture whole, in the format of the file's ending; pixels so many a millimetre.
///
/// # Errors
/// Another ending; a picture with too many pixels; a file that cannot be written.
pub fn write(
    path: &Path,
    picture: &Picture,
    theme: Theme,
    pixels_a_millimetre: f64,
) -> Result<(), PictureError> {
    let bytes = match Format::of(path)? {
        Format::Svg => picture.svg(theme).into_bytes(),
        Format::Png => picture.png(theme, pixels_a_millimetre)?,
    };
    Ok(publish(path, &bytes)?)
}
