//! Relaxation of soft discs by FIRE (Bitzek, Koskinen, Gähler, Moseler & Gumbsch, 2006).
//!
//! The discs move after Newton's law; where they move uphill, all stop. On the way down the time step grows and the
//! velocities turn towards the pushes.

use crate::packing::target::soft_discs::{SoftDiscs, Sums};

/// Time steps, where overlap is the push and a small grain has the mass 1: longest, first, shortest.
const STEPS: [f64; 3] = [0.5, 0.1, 0.02];
/// Share of the velocity that is turned into the push after a stop, and what remains of it after each iteration.
const TURN: [f64; 2] = [0.25, 0.99];
/// Iterations downhill before the time step grows.
const DELAY: usize = 20;

/// How fast the discs move.
pub(super) struct Relaxation {
    step: f64,
    turn: f64,
    downhill: usize,
}

impl Relaxation {
    /// Discs at rest.
    pub(super) fn new() -> Self {
        Self {
            step: STEPS[1],
            turn: TURN[0],
            downhill: 0,
        }
    }

    /// Moves the discs until no overlap is above `enough`, by the sum of the radii, or for `most` iterations.
    pub(super) fn run(&mut self, soft: &mut SoftDiscs<'_>, enough: f64, most: usize) -> Sums {
        for _ in 0..most {
            let sums = soft.push();
            if sums.largest <= enough {
                return sums;
            }
            self.adapt(soft, &sums);
            let ratio = if sums.push > 0.0 {
                (sums.velocity / sums.push).sqrt()
            } else {
                0.0
            };
            soft.advance(self.step, self.turn, ratio);
        }
        soft.push()
    }

    fn adapt(&mut self, soft: &mut SoftDiscs<'_>, sums: &Sums) {
        if sums.power > 0.0 || sums.velocity == 0.0 {
            self.downhill += 1;
            if self.downhill > DELAY {
                self.step = (1.1 * self.step).min(STEPS[0]);
                self.turn *= TURN[1];
            }
        } else {
            self.downhill = 0;
            self.step = (0.5 * self.step).max(STEPS[2]);
            self.turn = TURN[0];
            soft.stop();
        }
    }
}
