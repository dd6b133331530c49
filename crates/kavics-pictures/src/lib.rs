//! Pictures of a run: what is drawn of an assembly, and how.
//!
//! In: a results folder. Out: the drawn geometry (container, contacts, dual edges, void cells, breaks); pictures of the
//! assembly and of curves as plain data; these as vector graphics or pixels. No mechanics is computed here.

pub mod axis;
mod breaks;
mod colouring;
mod curves;
mod damage;
mod draw;
mod dual;
mod element;
mod error;
mod font;
mod forces;
mod graph;
mod ground;
mod groups;
mod ink;
mod layout;
mod legend;
pub mod number;
mod picture;
mod pixels;
mod scenery;
mod sides;
mod svg;
mod view;
mod void_triangles;
mod voids;
mod write;

pub use breaks::{Break, breaks};
pub use curves::{CurveRequest, draw_curves};
pub use draw::{Request, What, draw, draw_on, recorded_step};
pub use error::PictureError;
pub use forces::{largest_force, no_force};
pub use ink::{ColourMap, Ink, SHADES, Theme};
pub use layout::{Layout, container};
pub use legend::Units;
pub use picture::{Anchor, Mark, Pen, Picture, Shape, Text};
pub use void_triangles::VoidTriangle;
pub use write::{Format, write};
