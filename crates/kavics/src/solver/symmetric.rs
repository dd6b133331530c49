//! LDLᵀ of a symmetric matrix.
//!
//! Rows and columns are scaled by the square root of the diagonal, so that a pivot near zero means a floppy mode
//! whatever the units are. Everything that is right-hand side or change of the matrix is scaled on the way in and out.

use faer::Par;
use faer::dyn_stack::{MemBuffer, MemStack};
use faer::linalg::cholesky::ldlt::factor::LdltRegularization;
use faer::sparse::SparseColMatRef;
use faer::sparse::linalg::cholesky::supernodal::{
    SymbolicSupernodalCholesky, factorize_supernodal_numeric_ldlt,
    factorize_supernodal_numeric_ldlt_scratch,
};

use super::Singular;
use super::analysis::{Permuted, analyse};
use super::downdate::Change;
use super::inertia::{FLOPPY, HELD_PIVOT, Inertia};
use super::panels::{Panels, Paths};
use super::pattern::Pattern;
use super::sweeps::{backward_all, fetch, forward, forward_all, gather, scatter};

/// LDLᵀ of a symmetric matrix, given by its lower triangle.
///
/// The factor is that of the last [`factorise`](Self::factorise) and of what was added and removed since. Before the
/// first, and after one or a change that failed, there is none: every solution is then not a number.
pub struct SymmetricSolver {
    /// Old number of each unknown, in the order of elimination.
    order: Vec<usize>,
    /// New number of each unknown.
    inverse: Vec<usize>,
    permuted: Permuted,
    symbolic: SymbolicSupernodalCholesky<usize>,
    panels: Panels,
    memory: MemBuffer,
    /// Scaled values, permuted.
    values: Vec<f64>,
    factor: Vec<f64>,
    /// Scale of each unknown, old numbers.
    scale: Vec<f64>,
    inertia: Inertia,
    /// Whether there is a factor.
    ready: bool,
    /// Vectors of the whole length, in the order of elimination.
    full: Vec<f64>,
    /// The same with few entries, zero between calls.
    sparse: Vec<f64>,
    /// Rows of a panel of such vectors.
    local: Vec<f64>,
    paths: Paths,
}

impl SymmetricSolver {
    /// Analyses the pattern. `order`: the unknowns in the order of elimination, along a postorder of the elimination tree
    /// (other orders are right too, but slow).
    ///
    /// # Errors
    /// Where memory does not suffice.
    ///
    /// # Panics
    /// Where `order` is no permutation of the unknowns.
    pub fn new(pattern: &Pattern, order: &[usize]) -> Result<Self, Singular> {
        let inverse = inverse(order);
        let (permuted, symbolic) = analyse(pattern, &inverse)?;
        let scratch = factorize_supernodal_numeric_ldlt_scratch::<usize, f64>(
            &symbolic,
            Par::Seq,
            faer::Spec::default(),
        );
        Ok(Self {
            order: order.to_vec(),
            inverse,
            panels: Panels::new(&symbolic),
            memory: MemBuffer::try_new(scratch).map_err(|_| Singular)?,
            values: vec![0.0; permuted.source.len()],
            factor: vec![0.0; symbolic.len_val()],
            scale: vec![1.0; order.len()],
            permuted,
            symbolic,
            inertia: Inertia::default(),
            ready: false,
            full: Vec::new(),
            sparse: Vec::new(),
            local: Vec::new(),
            paths: Paths::default(),
        })
    }

    /// Factorises; answers the signs of the pivots.
    ///
    /// # Errors
    /// Where a factor is not finite; there is no factor then.
    pub fn factorise(&mut self, pattern: &Pattern, values: &[f64]) -> Result<Inertia, Singular> {
        self.ready = false;
        self.scale(pattern, values);
        let regularisation = LdltRegularization {
            dynamic_regularization_signs: None,
            dynamic_regularization_delta: HELD_PIVOT,
            dynamic_regularization_epsilon: FLOPPY,
        };
        factorize_supernodal_numeric_ldlt(
            &mut self.factor,
            SparseColMatRef::new(self.permuted.pattern.as_ref(), &self.values),
            regularisation,
            &self.symbolic,
            Par::Seq,
            MemStack::new(&mut self.memory),
            faer::Spec::default(),
        )
        .map_err(|_| Singular)?;
        self.inertia = Inertia::of(self.panels.pivots(&self.factor));
        self.ready = true;
        Ok(self.inertia)
    }

    fn scale(&mut self, pattern: &Pattern, values: &[f64]) {
        pattern.scales(values, &mut self.scale);
        let (_, _, start, _, row) = self.permuted.pattern.parts();
        for (column, &old) in self.order.iter().enumerate() {
            let scale = self.scale[old];
            for entry in start[column]..start[column + 1] {
                let value = values[self.permuted.source[entry] as usize];
                self.values[entry] = value * (scale * self.scale[self.order[row[entry]]]);
            }
        }
    }

    /// Signs of the pivots of the last factorisation; what is added and removed keeps them.
    pub fn inertia(&self) -> Inertia {
        self.inertia
    }

    /// Solves in place.
    pub fn solve(&mut self, x: &mut [f64]) {
        self.solve_full::<1>(x.as_chunks_mut::<1>().0);
    }

    /// Solves in place for R right-hand sides, in one sweep over the factor.
    pub fn solve_many<const R: usize>(&mut self, x: &mut [[f64; R]]) {
        self.solve_full(x);
    }

    fn solve_full<const R: usize>(&mut self, x: &mut [[f64; R]]) {
        if !self.is_usable(x) {
            return;
        }
        let order = self.order.len();
        self.make_room::<R>();
        for (r, full) in self.full.chunks_exact_mut(order).take(R).enumerate() {
            for (full, &old) in full.iter_mut().zip(&self.order) {
                *full = x[old][r] * self.scale[old];
            }
        }
        let full = &mut self.full[..R * order];
        forward_all::<R>(&self.panels, &self.factor, full, &mut self.local);
        self.finish(x);
    }

    /// Solves for a right-hand side with few entries, `(number of the unknown, values)`: the sweep forward takes their
    /// paths in the elimination tree alone. `x` is overwritten.
    pub fn solve_sparse<const R: usize>(
        &mut self,
        entries: &[(usize, [f64; R])],
        x: &mut [[f64; R]],
    ) {
        if !self.is_usable(x) {
            return;
        }
        let order = self.order.len();
        self.make_room::<R>();
        self.full[..R * order].fill(0.0);
        self.along_paths(entries, |panel, _, local, full| {
            let parts = local.chunks_exact(panel.rows).take(R);
            for (full, local) in full.chunks_exact_mut(order).zip(parts) {
                full[panel.own()].copy_from_slice(&local[..panel.columns]);
            }
        });
        self.finish(x);
    }

    /// Flexibility WᵀK⁻¹W, from the paths in the elimination tree alone.
    ///
    /// `entries`: the rows of W that are not zero, `(number of the unknown, values)`.
    pub fn flexibility<const R: usize>(&mut self, entries: &[(usize, [f64; R])]) -> [[f64; R]; R] {
        if !self.ready {
            return [[f64::NAN; R]; R];
        }
        let mut flexibility = [[0.0; R]; R];
        self.make_room::<R>();
        self.along_paths(entries, |panel, values, local, _| {
            for column in 0..panel.columns {
                let pivot = values[column * (panel.rows + 1)];
                let y: [f64; R] = std::array::from_fn(|r| local[r * panel.rows + column]);
                for (row, &a) in flexibility.iter_mut().zip(&y) {
                    for (sum, &b) in row.iter_mut().zip(&y) {
                        *sum += a * b / pivot;
                    }
                }
            }
        });
        flexibility
    }

    /// Changes the factor of K into that of K − WWᵀ, in place. The pattern must have an entry for every two rows of a
    /// column of W, as it has for those of a contact's stiffness.
    ///
    /// # Errors
    /// Where a pivot would vanish or change its sign, or modes are held; there is no factor then. Where K is positive
    /// definite, K − WWᵀ is so too if and only if all eigenvalues of [`flexibility`](Self::flexibility) are below 1.
    pub fn remove<const R: usize>(
        &mut self,
        entries: &[(usize, [f64; R])],
    ) -> Result<(), Singular> {
        self.change(entries, Change::remove())
    }

    /// Changes the factor of K into that of K + WWᵀ, in place, as [`remove`](Self::remove) does.
    ///
    /// # Errors
    /// As there; not where K is positive definite.
    pub fn add<const R: usize>(&mut self, entries: &[(usize, [f64; R])]) -> Result<(), Singular> {
        self.change(entries, Change::add())
    }

    fn change<const R: usize>(
        &mut self,
        entries: &[(usize, [f64; R])],
        mut change: Change<R>,
    ) -> Result<(), Singular> {
        if !self.ready || self.inertia.held > 0 {
            self.ready = false;
            return Err(Singular);
        }
        self.make_room::<R>();
        self.enter(entries);
        while let Some(panel) = self.paths.next(&self.panels) {
            self.fetch_next();
            let panel = &self.panels.list[panel];
            let order = self.order.len();
            let local = &mut self.local[..R * panel.rows];
            gather::<R>(&self.panels, panel, order, &self.sparse, local);
            let changed = change.panel(panel, &mut self.factor[panel.values()], local);
            if changed.is_err() {
                self.ready = false;
                self.sparse.fill(0.0);
                self.paths.clear();
                return changed;
            }
            scatter::<R>(&self.panels, panel, order, local, &mut self.sparse);
        }
        Ok(())
    }

    /// Eliminates vectors with few entries, panel by panel along their paths; `seen` gets each panel, its values, what
    /// it has of L⁻¹W, and the full vectors.
    fn along_paths<const R: usize>(
        &mut self,
        entries: &[(usize, [f64; R])],
        mut seen: impl FnMut(&super::panels::Panel, &[f64], &[f64], &mut [f64]),
    ) {
        self.enter(entries);
        let order = self.order.len();
        while let Some(panel) = self.paths.next(&self.panels) {
            self.fetch_next();
            let panel = &self.panels.list[panel];
            let values = &self.factor[panel.values()];
            let local = &mut self.local[..R * panel.rows];
            gather::<R>(&self.panels, panel, order, &self.sparse, local);
            forward::<R>(panel, values, local);
            seen(panel, values, local, &mut self.full);
            for local in local.chunks_exact_mut(panel.rows) {
                local[..panel.columns].fill(0.0);
            }
            scatter::<R>(&self.panels, panel, order, local, &mut self.sparse);
        }
    }

    fn fetch_next(&self) {
        if let Some(next) = self.paths.head() {
            fetch(&self.factor[self.panels.list[next].values()]);
        }
    }

    /// Enters few entries, scaled, and starts their paths.
    fn enter<const R: usize>(&mut self, entries: &[(usize, [f64; R])]) {
        let order = self.order.len();
        for (old, values) in entries {
            let new = self.inverse[*old];
            for (r, value) in values.iter().enumerate() {
                self.sparse[r * order + new] += value * self.scale[*old];
            }
            self.paths.start(&self.panels, new);
        }
    }

    /// The sweep back, and the solution out of it.
    fn finish<const R: usize>(&mut self, x: &mut [[f64; R]]) {
        let order = self.order.len();
        let full = &mut self.full[..R * order];
        backward_all::<R>(&self.panels, &self.factor, full, &mut self.local);
        for (r, full) in self.full.chunks_exact(order).take(R).enumerate() {
            for (full, &old) in full.iter().zip(&self.order) {
                x[old][r] = full * self.scale[old];
            }
        }
    }

    /// Whether there is something to solve and something to solve it with.
    fn is_usable<const R: usize>(&self, x: &mut [[f64; R]]) -> bool {
        if !self.ready {
            x.fill([f64::NAN; R]);
        }
        self.ready && !x.is_empty()
    }

    /// Room for R vectors, taken at the first call that needs it.
    fn make_room<const R: usize>(&mut self) {
        let (whole, local) = (R * self.order.len(), R * self.panels.most_rows);
        self.full.resize(self.full.len().max(whole), 0.0);
        self.sparse.resize(self.sparse.len().max(whole), 0.0);
        self.local.resize(self.local.len().max(local), 0.0);
    }
}

fn inverse(order: &[usize]) -> Vec<usize> {
    let mut inverse = vec![usize::MAX; order.len()];
    for (new, &old) in order.iter().enumerate() {
        assert_eq!(inverse[old], usize::MAX, "the order is no permutation");
        inverse[old] = new;
    }
    inverse
}
