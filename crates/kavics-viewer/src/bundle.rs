//! The files of the page, as they are built from `viewer/`.

/// The script of the page.
pub const SCRIPT: &str = include_str!("../../../viewer/dist/viewer.js");

/// The style of the page.
pub const STYLE: &str = include_str!("../../../viewer/dist/viewer.css");

/// The served page.
pub const PAGE: &str = include_str!("../../../viewer/dist/index.html");
