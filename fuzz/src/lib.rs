//! What the fuzz targets try, and what must hold of it.
//!
//! Each target takes bytes, hands them to the library as a user's file or numbers, and panics where the library does, or
//! where a result breaks what its documentation says.

mod broken;
mod lists;
mod numbers;
mod packs;
mod patience;
mod quiet;
mod scenes;

pub use broken::Broken;
pub use lists::list_of_grains;
pub use numbers::Numbers;
pub use packs::pack;
pub use quiet::let_guarded_panics_pass;
pub use scenes::{MOST_PLACED, as_grains, as_power_diagram, first_load_steps};
