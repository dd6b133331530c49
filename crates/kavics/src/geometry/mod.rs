//! Points, segments, discs, near pairs and the power diagram. Knows nothing of grains or contacts.

mod container;
mod cutting;
mod embedding;
mod faces;
mod lifted;
mod near_pairs;
mod outer_triangles;
mod pieces;
mod polygon;
mod power_cell;
mod power_diagram;
mod vector;

pub use container::{Container, HalfPlane};
pub use embedding::{Embedding, HalfEdge};
pub use faces::lowest_first;
pub use near_pairs::{Disc, Grid, NearPair, spatial_order};
pub use pieces::Pieces;
pub use polygon::Polygon;
pub use power_diagram::{DualEdge, Edges, PowerDiagram, SideEdge, power_diagram, power_diagram_of};
pub use vector::Vector;
