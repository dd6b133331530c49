//! A window on a search under way, for who waits for it. What is read here has no part in the arithmetic.

use std::sync::atomic::{AtomicU64, AtomicUsize, Ordering};

/// How far the present load step has come, to be read from another thread while it is sought.
#[derive(Debug, Default)]
pub struct Watch {
    step: AtomicUsize,
    iterations: AtomicUsize,
    broken: AtomicUsize,
    load_factor: AtomicU64,
    residual: AtomicU64,
}

/// What a [`Watch`] shows at one moment; its parts may be of neighbouring moments.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Glance {
    /// The load step that is sought, from 1.
    pub step: usize,
    /// Linear solves in it.
    pub iterations: usize,
    /// Bonds broken in it.
    pub broken: usize,
    /// The stage's load factor at the last equilibrium.
    pub load_factor: f64,
    /// The last residual.
    pub residual: f64,
}

impl Watch {
    /// How far the search has come.
    pub fn glance(&self) -> Glance {
        let count = |counter: &AtomicUsize| counter.load(Ordering::Relaxed);
        let number = |bits: &AtomicU64| f64::from_bits(bits.load(Ordering::Relaxed));
        Glance {
            step: count(&self.step),
            iterations: count(&self.iterations),
            broken: count(&self.broken),
            load_factor: number(&self.load_factor),
            residual: number(&self.residual),
        }
    }

    /// A load step begins, or goes on.
    pub(crate) fn begin(&self, step: usize) {
        if self.step.swap(step, Ordering::Relaxed) != step {
            self.iterations.store(0, Ordering::Relaxed);
            self.broken.store(0, Ordering::Relaxed);
        }
    }

    /// A balance of forces was looked at.
    pub(crate) fn note_iteration(&self, iterations: usize, residual: f64) {
        self.iterations.store(iterations, Ordering::Relaxed);
        self.residual.store(residual.to_bits(), Ordering::Relaxed);
    }

    /// Bonds broke.
    pub(crate) fn note_broken(&self, count: usize) {
        self.broken.fetch_add(count, Ordering::Relaxed);
    }

    /// The path came to a load factor.
    pub(crate) fn note_load_factor(&self, load_factor: f64) {
        self.load_factor
            .store(load_factor.to_bits(), Ordering::Relaxed);
    }
}
