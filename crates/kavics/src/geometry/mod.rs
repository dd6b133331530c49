//! Points, segments, discs, near pairs and the power diagram. Knows nothing of grains or contacts.

mod vector;

pub use vector::Vector;
