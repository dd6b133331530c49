//! Translating, rotating, scaling and renumbering an assembly changes its results only as it must.
//!
//! Sides of a polygon go with the grains, so that power cells are cut by what goes with them. Nothing here is free in one
//! direction only: freedoms are held along x and y, so an assembly on rollers does not turn with its rollers.

mod breakage;
mod change;
mod equilibrium;
mod geometry;
mod measures;
mod pile;
mod scene;
mod twins;
