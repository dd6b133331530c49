//! Soft discs in a container: each overlap δ pushes both partners apart, with the energy ½·Σ δ².
//!
//! The discs are the grains with all radii times a scale. Where the largest overlap, by the sum of the radii (at a
//! side: by the radius), is o, the grains at scale·(1 − o) do not overlap.

use rayon::prelude::*;

use crate::assembly::Grain;
use crate::geometry::{Container, HalfPlane, Vector};
use crate::packing::target::partners::Partners;

/// Discs that one task looks at; fixed, so that the sums do not depend on the number of threads.
const DISCS_A_TASK: usize = 1024;
/// Gap up to which partners are listed, in mean radii.
const SKIN: f64 = 0.4;

/// Soft discs in a container.
pub(super) struct SoftDiscs<'a> {
    sides: &'a [HalfPlane],
    /// Radii of the grains.
    radii: Vec<f64>,
    scale: f64,
    mean_radius: f64,
    discs: Vec<Grain>,
    velocities: Vec<Vector>,
    /// Push on each by its mass, which is 1 up to the mean radius and grows with the radius above.
    pushes: Vec<Vector>,
    partners: Partners,
}

/// Sums over all discs.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Sums {
    /// Σ push·velocity.
    pub(super) power: f64,
    /// Σ push².
    pub(super) push: f64,
    /// Σ velocity².
    pub(super) velocity: f64,
    /// Σ δ² over the overlaps.
    pub(super) overlap: f64,
    /// Largest overlap by the sum of the radii.
    pub(super) largest: f64,
}

impl Sums {
    fn add(self, other: &Self) -> Self {
        Self {
            power: self.power + other.power,
            push: self.push + other.push,
            velocity: self.velocity + other.velocity,
            overlap: self.overlap + other.overlap,
            largest: self.largest.max(other.largest),
        }
    }
}

impl<'a> SoftDiscs<'a> {
    /// Discs at rest, as large as the grains.
    pub(super) fn new(container: &'a Container, grains: Vec<Grain>) -> Self {
        let radii: Vec<f64> = grains.iter().map(|g| g.radius).collect();
        let mean_radius = radii.iter().sum::<f64>() / radii.len() as f64;
        Self {
            sides: container.sides(),
            partners: Partners::new(&grains, container.sides(), SKIN * mean_radius),
            velocities: vec![Vector::default(); grains.len()],
            pushes: vec![Vector::default(); grains.len()],
            scale: 1.0,
            mean_radius,
            radii,
            discs: grains,
        }
    }

    /// The grains: the discs with their own radii.
    pub(super) fn grains(&self) -> impl Iterator<Item = Grain> {
        let discs = self.discs.iter().zip(&self.radii);
        discs.map(|(d, &radius)| Grain { radius, ..*d })
    }

    /// Radii of the grains.
    pub(super) fn radii(&self) -> &[f64] {
        &self.radii
    }

    /// What the radii of the grains are multiplied by.
    pub(super) fn scale(&self) -> f64 {
        self.scale
    }

    /// Makes all radii `scale` times those of the grains.
    pub(super) fn set_scale(&mut self, scale: f64) {
        self.scale = scale;
        self.resize();
    }

    /// Gives the grains other radii.
    pub(super) fn set_radii(&mut self, radii: Vec<f64>) {
        self.radii = radii;
        self.resize();
    }

    fn resize(&mut self) {
        for (disc, radius) in self.discs.iter_mut().zip(&self.radii) {
            disc.radius = self.scale * radius;
        }
        self.list();
    }

    fn list(&mut self) {
        self.partners = Partners::new(&self.discs, self.sides, SKIN * self.mean_radius);
    }

    /// Finds the push on each disc, and the sums.
    pub(super) fn push(&mut self) -> Sums {
        let mut pushes = std::mem::take(&mut self.pushes);
        let tasks = pushes.par_chunks_mut(DISCS_A_TASK).enumerate();
        let sums: Vec<Sums> = tasks
            .map(|(task, pushes)| self.push_some(task * DISCS_A_TASK, pushes))
            .collect();
        self.pushes = pushes;
        sums.iter().fold(Sums::default(), Sums::add)
    }

    fn push_some(&self, first: usize, pushes: &mut [Vector]) -> Sums {
        let mut sums = Sums::default();
        for (k, push) in (first..).zip(pushes) {
            *push = self.push_on(k, &mut sums);
            sums.power += push.dot(self.velocities[k]);
            sums.push += push.length_squared();
            sums.velocity += self.velocities[k].length_squared();
        }
        sums
    }

    fn push_on(&self, k: usize, sums: &mut Sums) -> Vector {
        let disc = self.discs[k];
        let mut push = Vector::default();
        for &partner in self.partners.of(k) {
            if let Some(other) = self.discs.get(partner as usize) {
                let reach = disc.radius + other.radius;
                let away = disc.centre - other.centre;
                let squared = away.length_squared();
                if squared < reach * reach {
                    let distance = squared.sqrt();
                    let overlap = reach - distance;
                    push = push + away * (overlap / distance.max(f64::MIN_POSITIVE));
                    // Each of two discs counts half.
                    sums.overlap += 0.5 * overlap * overlap;
                    sums.largest = sums.largest.max(overlap / reach);
                }
            } else {
                let side = self.sides[partner as usize - self.discs.len()];
                let overlap = (disc.radius - side.distance(disc.centre)).max(0.0);
                push = push - side.outward * overlap;
                sums.overlap += overlap * overlap;
                sums.largest = sums.largest.max(overlap / disc.radius);
            }
        }
        push * self.mobility(disc.radius)
    }

    /// Inverse mass: a disc among smaller ones has as many more contacts as it is larger.
    fn mobility(&self, radius: f64) -> f64 {
        (self.mean_radius / radius).min(1.0)
    }

    /// Sum of the overlaps of each disc by its mass.
    pub(super) fn squeezes(&self) -> Vec<f64> {
        let squeeze = |k: usize| {
            let overlaps = self.partners.of(k).iter().map(|&p| self.overlap(k, p));
            overlaps.sum::<f64>() * self.mobility(self.discs[k].radius)
        };
        (0..self.discs.len()).into_par_iter().map(squeeze).collect()
    }

    fn overlap(&self, k: usize, partner: u32) -> f64 {
        let disc = self.discs[k];
        let overlap = if let Some(other) = self.discs.get(partner as usize) {
            disc.radius + other.radius - (disc.centre - other.centre).length()
        } else {
            let side = self.sides[partner as usize - self.discs.len()];
            disc.radius - side.distance(disc.centre)
        };
        overlap.max(0.0)
    }

    /// Stops all discs.
    pub(super) fn stop(&mut self) {
        self.velocities.fill(Vector::default());
    }

    /// Accelerates all discs for a time `step`, replaces the share `turn` of their velocities by `ratio` times the
    /// pushes, and moves them.
    pub(super) fn advance(&mut self, step: f64, turn: f64, ratio: f64) {
        let bodies = self.discs.par_iter_mut().zip(&mut self.velocities);
        let bodies = bodies.zip(&self.pushes).with_min_len(DISCS_A_TASK);
        bodies.for_each(|((disc, velocity), &push)| {
            let accelerated = *velocity + push * step;
            *velocity = accelerated * (1.0 - turn) + push * (turn * ratio);
            disc.centre = disc.centre + *velocity * step;
        });
        if self.partners.are_outdated(&self.discs) {
            self.list();
        }
    }
}
