//! Quasi-static mechanics of granular and cemented assemblies.
//!
//! One way through, from the scene file to the measures:
//! [`scene`] → [`assembly`] → [`loading`] and [`equilibrium`] → [`measure`].

pub mod assembly;
pub mod contact_law;
pub mod equilibrium;
pub mod geometry;
pub mod ids;
pub mod loading;
pub mod measure;
pub mod packing;
pub mod scene;
