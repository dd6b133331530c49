//! State variables of an equilibrium, in a window: fabric, graph porosity, stress and its parts, strain, work.
//!
//! In: a [`Snapshot`] and a [`Window`]. Out: one small value a measure. Sums run over contacts in the order of their
//! ids. Bojtár & Bagi (1989), eqs. 1–13.
//!
//! What tells of contacts alone, before there is an equilibrium, takes their partners or normals instead:
//! [`Coordination`], [`Rose`], [`fabric_of_normals`].

mod angle;
mod coordination;
mod cracks;
mod elasticity;
mod enclosure;
mod fabric;
mod face_walk;
mod graph_porosity;
mod half_contact;
mod moduli;
mod rose;
mod rows;
mod strain;
mod stress;
mod tensor;
mod void_cells;
mod window;
mod work;

pub use coordination::Coordination;
pub use cracks::{Crack, cracks};
pub use elasticity::ElasticityTensor;
pub use fabric::{
    branch_tensor, contact_tensor, fabric_length_tensor, fabric_of_normals, fabric_tensor,
};
pub use graph_porosity::{GraphPorosity, graph_porosity};
pub use moduli::{Moduli, inside, moduli, uniform_strains};
pub use rose::{Rose, first_harmonic};
pub use strain::strain;
pub use stress::{
    StressPartition, average_stress, bending_stress, grain_stress, moment_asymmetry,
    stress_partition,
};
pub use tensor::{SymmetricTensor, Tensor};
pub use void_cells::{VoidCell, VoidCells, loop_orders, void_cells};
pub use window::{Window, coordination_number, void_ratio, window_area};
pub use work::{boundary_work, contact_mean_work, contact_work, macroscopic_work};

use crate::assembly::{Assembly, Contact, Partner};
use crate::equilibrium::{self, Equilibrium, Load, Place, State};
use crate::geometry::Vector;
use crate::ids::{GrainId, PerBody};
use crate::measure::half_contact::{HalfContact, each_half_contact};

/// All that a measure may read.
#[derive(Clone, Copy, Debug)]
pub struct Snapshot<'a> {
    /// The undeformed assembly.
    pub assembly: &'a Assembly,
    /// Displacements and contacts.
    pub state: &'a State,
    /// External load on each body.
    pub loads: &'a PerBody<Load>,
    /// Reaction at held and moved freedoms.
    pub reactions: &'a PerBody<Load>,
}

impl<'a> Snapshot<'a> {
    /// The snapshot of an equilibrium.
    pub fn new(assembly: &'a Assembly, equilibrium: &'a Equilibrium) -> Self {
        Self {
            assembly,
            state: &equilibrium.state,
            loads: &equilibrium.loads,
            reactions: &equilibrium.reactions,
        }
    }

    /// Where a grain's centre is in this state.
    fn centre(&self, grain: GrainId) -> Vector {
        let displacement = self.state.displacements[self.assembly.body(Partner::Grain(grain))];
        equilibrium::centre(&self.assembly.grains[grain], displacement)
    }

    /// Where a contact is in this state.
    fn place(&self, contact: &Contact) -> Place {
        let displacements = &self.state.displacements;
        let [first, second] = [contact.first, contact.second]
            .map(|partner| displacements[self.assembly.body(partner)]);
        equilibrium::contact_place(contact, first, second)
    }

    /// Displacement of a grain's centre.
    fn translation(&self, grain: GrainId) -> Vector {
        let moved = self.state.displacements[self.assembly.body(Partner::Grain(grain))];
        Vector::new(moved.x, moved.y)
    }

    /// External load and reaction on a grain.
    fn external(&self, grain: GrainId) -> Load {
        let body = self.assembly.body(Partner::Grain(grain));
        let (load, reaction) = (self.loads[body], self.reactions[body]);
        Load {
            x: load.x + reaction.x,
            y: load.y + reaction.y,
            moment: load.moment + reaction.moment,
        }
    }
}

/// Every measure of one window at one state; what does not exist is none.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Measures {
    /// Area of the window: its grains' power cells, `[length²]`.
    pub window_area: f64,
    /// Active contacts a grain, rattlers counted.
    pub coordination_number: Option<f64>,
    /// Void area over solid area.
    pub void_ratio: Option<f64>,
    /// Share of the window that the contact graph covers, each contact once.
    pub graph_porosity: Option<f64>,
    /// The same by eqs. 4–5 as printed.
    pub graph_porosity_printed: Option<f64>,
    /// Fabric tensor φ.
    pub fabric: Option<SymmetricTensor>,
    /// Fabric tensor read with the branch vectors: Σ l_i·l_j / Σ l².
    pub fabric_length: Option<SymmetricTensor>,
    /// Branch tensor B.
    pub branch: Option<SymmetricTensor>,
    /// Contact tensor C.
    pub contact: Option<SymmetricTensor>,
    /// Average stress and its parts.
    pub stress: Option<StressPartition>,
    /// Average displacement gradient ∂_i u_j.
    pub strain: Option<Tensor>,
    /// Σ F·Δu over the contacts within the window, `[force·length]`.
    pub contact_work: Option<f64>,
    /// Area times stress times strain, `[force·length]`.
    pub macroscopic_work: Option<f64>,
    /// Hill's boundary term: contact work less macroscopic work, from the forces on the window's grains, `[force·length]`.
    pub boundary_work: Option<f64>,
    /// Tangent moduli; [`measures`] leaves them out, as they need the tangents of the contacts.
    pub moduli: Option<Moduli>,
}

/// Every measure of a window at a state.
pub fn measures(snapshot: &Snapshot<'_>, window: &Window) -> Measures {
    if window.grains().is_empty() {
        return Measures::default();
    }
    let strain = strain(snapshot, window);
    let mut graph = GraphSums::default();
    let mut stress = stress::StressSums::new(snapshot.assembly.grains.len());
    let (mut contact_work, mut work_across) = (0.0, 0.0);
    each_half_contact(snapshot, window, |contact| {
        graph.add(contact);
        stress.add(contact);
        contact_work += work::half_of_work(snapshot, window, contact);
        if let Some(e) = strain {
            work_across += work::work_across(snapshot, window, e, contact);
        }
    });
    let stress = stress.over(window_area(snapshot, window) * snapshot.assembly.thickness);
    Measures {
        stress,
        strain,
        contact_work: Some(contact_work),
        macroscopic_work: stress
            .zip(strain)
            .map(|(stress, e)| macroscopic_work(snapshot, window, stress.total, e)),
        boundary_work: strain.map(|e| work::work_of_loads(snapshot, window, e) + work_across),
        ..graph.measures(snapshot, window)
    }
}

/// Those measures of a window that need no forces and displacements: area, coordination number, void ratio, graph
/// porosity and the fabric tensors. The others are none.
pub fn geometric_measures(snapshot: &Snapshot<'_>, window: &Window) -> Measures {
    if window.grains().is_empty() {
        return Measures::default();
    }
    let mut graph = GraphSums::default();
    each_half_contact(snapshot, window, |contact| graph.add(contact));
    graph.measures(snapshot, window)
}

/// The sums of the geometric measures, so that one pass over the contacts gives them.
#[derive(Default)]
struct GraphSums {
    contacts: usize,
    fabric: fabric::FabricSums,
    porosity: graph_porosity::PorositySums,
}

impl GraphSums {
    fn add(&mut self, contact: &HalfContact) {
        self.contacts += 1;
        self.fabric.add(contact);
        self.porosity.add(contact);
    }

    fn measures(self, snapshot: &Snapshot<'_>, window: &Window) -> Measures {
        let area = window_area(snapshot, window);
        let porosity = self.porosity.over(area);
        let directions = self.fabric.tensors();
        Measures {
            window_area: area,
            coordination_number: window::contacts_a_grain(self.contacts, window),
            void_ratio: void_ratio(snapshot, window),
            graph_porosity: porosity.map(|p| p.once),
            graph_porosity_printed: porosity.map(|p| p.printed),
            fabric: directions.fabric,
            fabric_length: directions.fabric_length,
            branch: directions.branch,
            contact: directions.contact,
            ..Measures::default()
        }
    }
}
