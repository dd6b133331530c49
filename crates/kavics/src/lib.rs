//! Quasi-static mechanics of granular and cemented assemblies.
//!
//! One way through, from the scene file to the measures:
//! [`scene`] → [`assembly`] → [`loading`] and [`equilibrium`] → [`measure`].
//!
//! ```
//! use std::path::Path;
//! use kavics::measure::{Snapshot, Window, stress_partition};
//! use kavics::scene::Scene;
//!
//! let text = r#"
//! [box]
//! width = 4.0
//! height = "fit"
//! [grains.hexagonal]
//! radius = 1.0
//! rows = [2, 1]
//! [contact.mortar.cemented]
//! stiffness.layer = { normal = 100.0, shear = 50.0 }
//! [[support]]
//! grains = { edge = "bottom" }
//! fix = ["x", "y"]
//! [[load]]
//! name = "press"
//! grains = { ids = [2] }
//! force = { y = -1.0 }
//! [[stage]]
//! factors = [0.5, 1.0]
//! [measure]
//! window = "all"
//! "#;
//! let lists = |_: &Path, _: Option<usize>| Err("no grain lists here".to_owned());
//! let scene = Scene::parse(text, "press.toml", Path::new("."), &lists)?;
//! for equilibrium in scene.load_path() {
//!     let equilibrium = equilibrium?;
//!     let window = Window::new(scene.window.clone(), scene.assembly.grains.len());
//!     let parts = stress_partition(&Snapshot::new(&scene.assembly, &equilibrium), &window).unwrap();
//!     let sum = parts.shear.yy + parts.variation.yy + parts.fabric.yy + parts.isotropic;
//!     assert!((sum - parts.total.yy).abs() < 1e-15);
//! }
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

pub mod assembly;
pub mod contact_law;
pub mod equilibrium;
pub mod geometry;
pub mod ids;
pub mod loading;
pub mod measure;
pub mod packing;
pub mod scene;
pub mod solver;
pub mod warning;
