//! Placing grains: sieve curves, dropping, regular rows.
//!
//! In: radii and a box. Out: grains that do not overlap.
