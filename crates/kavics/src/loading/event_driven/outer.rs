//! What acts from outside at one factor, with its displacements: work is that of the straight way between two.

use super::network::Network;
use crate::equilibrium::system::System;
use crate::equilibrium::{Displacement, Drive, Load};
use crate::ids::{BodyId, Id};

/// Loads and reactions with the displacements on which they work.
#[derive(Clone, Debug, Default)]
pub struct Outer {
    pub(super) loads: Vec<(Load, Displacement)>,
    /// Reaction and value of each moved freedom.
    pub(super) moved: Vec<[f64; 2]>,
}

/// Where something acts from outside.
#[derive(Clone, Debug, Default)]
pub struct OuterPlaces {
    /// Bodies with a load.
    loaded: Vec<usize>,
    /// Bodies with a moved freedom.
    moved: Vec<BodyId>,
    /// Contacts of these.
    contacts: Vec<usize>,
}

impl Outer {
    /// ½·Σ(f₀ + f₁)·(u₁ − u₀) from here to `next`, reactions of moved freedoms included.
    pub fn work_to(&self, next: &Self) -> f64 {
        let mut work = 0.0;
        for ((f, u), (next_f, next_u)) in self.loads.iter().zip(&next.loads) {
            let step = *next_u - *u;
            work += 0.5 * (f.work(step) + next_f.work(step));
        }
        for ([r, m], [next_r, next_m]) in self.moved.iter().zip(&next.moved) {
            work += 0.5 * (r + next_r) * (next_m - m);
        }
        work
    }
}

impl OuterPlaces {
    /// How far what drives the load path has gone where `outer` acts.
    pub fn drive(&self, network: &Network, outer: &Outer, x: f64) -> Option<Drive> {
        let loaded = self.loaded.iter().zip(&outer.loads);
        let displacements = loaded.map(|(&body, (_, u))| (BodyId::from_index(body), *u));
        let reactions = outer.moved.iter().map(|[reaction, _]| *reaction);
        network.acting.drive(x, displacements, reactions)
    }

    /// Where a network is loaded and moved.
    pub fn new(system: &System<'_>, network: &Network) -> Self {
        let acting = &network.acting;
        let none = [Load::default(); 2];
        let loaded = (0..acting.loads.len()).filter(|&body| acting.loads[body] != none);
        let mut moved: Vec<BodyId> = acting.moved.iter().map(|moved| moved.0).collect();
        moved.sort_unstable();
        moved.dedup();
        let is_moved = |body| moved.binary_search(&body).is_ok();
        let contacts = system.frames.iter().enumerate();
        let contacts = contacts.filter(|(_, f)| is_moved(f.first) || is_moved(f.second));
        Self {
            loaded: loaded.collect(),
            contacts: contacts.map(|(contact, _)| contact).collect(),
            moved,
        }
    }

    /// What acts at x.
    pub fn at(&self, system: &System<'_>, network: &Network, x: f64) -> Outer {
        let acting = &network.acting;
        let loads = self.loaded.iter().map(|&body| {
            let [constant, rate] = acting.loads[body];
            let mut load = constant;
            load += rate * x;
            (load, network.displacement_at(body, x))
        });
        let taken = self.taken(system, network, x);
        let moved = acting.moved.iter().map(|(body, freedom, value)| {
            let place = self.moved.binary_search(body).unwrap_or_default();
            let reaction = -taken[place].components()[freedom.index()];
            [reaction, value[0] + x * value[1]]
        });
        Outer {
            loads: loads.collect(),
            moved: moved.collect(),
        }
    }

    /// Loads and contact forces on the moved bodies.
    fn taken(&self, system: &System<'_>, network: &Network, x: f64) -> Vec<Load> {
        let loads = self.moved.iter().map(|body| {
            let [constant, rate] = network.acting.loads[body.index()];
            let mut load = constant;
            load += rate * x;
            load
        });
        let mut taken: Vec<Load> = loads.collect();
        for &contact in &self.contacts {
            let frame = &system.frames[contact];
            let force = network.force_at(system, contact, x);
            for (body, load) in [frame.first, frame.second]
                .into_iter()
                .zip(frame.loads(force))
            {
                if let Ok(place) = self.moved.binary_search(&body) {
                    taken[place] += load;
                }
            }
        }
        taken
    }
}
