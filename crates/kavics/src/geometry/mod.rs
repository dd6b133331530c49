//! Points, segments, discs, near pairs and the power diagram. Knows nothing of grains or contacts.

mod container;
mod cutting;
mod dual_graph;
mod embedding;
mod face;
mod faces;
mod lifted;
mod near_pairs;
mod outer_triangles;
mod pieces;
mod polygon;
mod power_cell;
mod power_diagram;
mod spatial_order;
mod vector;

pub use container::{Container, HalfPlane};
pub(crate) use dual_graph::{DualGraph, Edges, Near};
pub use embedding::{Embedding, HalfEdge};
pub use faces::lowest_first;
pub use near_pairs::{Disc, Grid, NearPair};
pub use pieces::Pieces;
pub use polygon::Polygon;
pub use power_diagram::{DualEdge, PowerDiagram, SideEdge, power_diagram};
pub use spatial_order::spatial_order;
pub use vector::Vector;
