//! The dual graph and the void cells as tables, from the undeformed assembly.

use std::fs;
use std::path::Path;
use std::sync::{Arc, Mutex, PoisonError};
use std::time::SystemTime;

use kavics::ids::Id;
use kavics_pictures::Layout;
use kavics_results::ResultsFolder;

use crate::PageError;
use crate::column::{PageColumn, Values};

/// When a file was written, and how long it is.
type Stamp = (Option<SystemTime>, u64);

/// An assembly, and what its table of grains was like.
type Stamped = (Stamp, Arc<Layout>);

/// The undeformed assembly, kept as it is the same at all load steps.
#[derive(Clone, Debug, Default)]
pub(crate) struct KeptLayout(Arc<Mutex<Option<Stamped>>>);

impl KeptLayout {
    /// The assembly of the run in `folder`; `grains` is its table before loading, by which another run is told.
    pub(crate) fn of(
        &self,
        folder: &ResultsFolder,
        grains: &Path,
    ) -> Result<Arc<Layout>, PageError> {
        let stamp = stamp(grains);
        // Who waits for the assembly finds it here afterwards.
        let mut kept = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some((of, layout)) = kept.as_ref()
            && *of == stamp
        {
            return Ok(Arc::clone(layout));
        }
        let layout = Arc::new(Layout::read(folder)?);
        *kept = Some((stamp, Arc::clone(&layout)));
        Ok(layout)
    }
}

fn stamp(path: &Path) -> Stamp {
    let found = fs::metadata(path).ok();
    let length = found.as_ref().map_or(0, fs::Metadata::len);
    (found.and_then(|found| found.modified().ok()), length)
}

/// The dual edges of the contacts.
pub(crate) fn dual(layout: &Layout) -> (Vec<PageColumn>, usize) {
    let edges = layout.dual_edges();
    let edges = edges.values();
    let end = |name, value: fn(&[kavics::geometry::Vector; 2]) -> f64| {
        let values = edges.iter().map(|edge| value(edge) as f32);
        PageColumn::new(name, "length", Values::Single(values.collect()))
    };
    let contacts = (0..edges.len() as i32).collect();
    let columns = vec![
        PageColumn::new("contact", "", Values::Integers(contacts)),
        end("x1", |[from, _]| from.x),
        end("y1", |[from, _]| from.y),
        end("x2", |[_, to]| to.x),
        end("y2", |[_, to]| to.y),
    ];
    (columns, edges.len())
}

/// The triangles of the void cells at a load step.
pub(crate) fn cells(layout: &Layout, step: usize) -> Result<(Vec<PageColumn>, usize), PageError> {
    let state = layout.state(step)?;
    let triangles = layout.void_triangles(&state, &layout.void_cells(&state));
    let column = |name, value: &dyn Fn(&kavics_pictures::VoidTriangle) -> usize| {
        let values = triangles.iter().map(|triangle| value(triangle) as i32);
        PageColumn::new(name, "", Values::Integers(values.collect()))
    };
    let corner = |number: usize| {
        move |triangle: &kavics_pictures::VoidTriangle| triangle.corners[number].index()
    };
    let columns = vec![
        column("void", &|triangle| triangle.void),
        column("first", &corner(0)),
        column("second", &corner(1)),
        column("third", &corner(2)),
    ];
    Ok((columns, triangles.len()))
}
