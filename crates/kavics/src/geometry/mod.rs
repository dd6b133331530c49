//! Points, segments, discs, near pairs and the power diagram. Knows nothing of grains or contacts.

mod container;
mod lifted;
mod near_pairs;
mod polygon;
mod power_cell;
mod power_diagram;
mod vector;

pub use container::{Container, HalfPlane};
pub use near_pairs::{Disc, Grid, NearPair};
pub use polygon::Polygon;
pub use power_diagram::{DualEdge, PowerDiagram, SideEdge, power_diagram};
pub use vector::Vector;
