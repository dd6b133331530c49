//! The undeformed assembly as it is drawn, made again from the tables of the state before loading.

use kavics::assembly::{self, Assembly, Bodies, Contact, Grain, Partner, Shaping, Side, Site};
use kavics::contact_law::{ContactForce, Phase, RelativeDisplacement};
use kavics::equilibrium::{ContactState, Displacement, State};
use kavics::geometry::{DualEdge, NearPair, PowerDiagram, SideEdge, Vector, power_diagram};
use kavics::ids::{GrainId, Id, PerBody, PerContact, PerGrain, PerSide, PropertyId, SideId};
use kavics::measure::{Snapshot, VoidCells, void_cells};
use kavics_results::{Columns, ResultsError, ResultsFolder};

use crate::PictureError;
use crate::sides::{Touched, sides};

/// The corners of the container, counter-clockwise, `[length]`.
///
/// # Errors
/// A `run.json` that cannot be read or does not tell them.
pub fn container(folder: &ResultsFolder) -> Result<Vec<Vector>, PictureError> {
    let corners = folder.record()?.packing.map(|packing| packing.container);
    let corners = corners.filter(|corners| corners.len() > 2);
    let corners = corners.ok_or_else(|| PictureError::NoContainer {
        folder: folder.path().to_owned(),
    })?;
    Ok(corners.iter().map(|&[x, y]| Vector::new(x, y)).collect())
}

/// The undeformed assembly of a run: grains, sides, contacts and the power diagram.
///
/// Contacts have their dual edges in full, whatever part of them the stiffness uses; their property is not kept.
#[derive(Clone, Debug)]
pub struct Layout {
    /// Grains, sides, contacts and triangles.
    pub assembly: Assembly,
    /// Edges between power cells by (first, second), those without a contact too.
    pub edges: Vec<DualEdge>,
    pub(crate) folder: ResultsFolder,
}

impl Layout {
    /// Reads the state before loading and makes its power diagram; O(N).
    ///
    /// # Errors
    /// Tables that cannot be read or do not fit together.
    pub fn read(folder: &ResultsFolder) -> Result<Self, PictureError> {
        let grains = grains(folder)?;
        let table = folder.some_of_contacts(
            0,
            &[
                "first",
                "second",
                "nx",
                "ny",
                "branch_length",
                "dual_length_full",
            ],
        )?;
        let names = folder.sides(0)?;
        let partners = partners(folder, &table, grains.len())?;
        let touched = touched(&table, &partners)?;
        let sides = sides(&container(folder)?, &names.texts("name")?, &touched);
        let diagram = diagram(&grains, &sides, &table, &partners)?;
        let contacts = partners
            .iter()
            .map(|&pair| contact(pair, &grains, &sides, &diagram));
        let triangles = diagram.triangles.iter().chain(&diagram.outer_triangles);
        let assembly = Assembly {
            contacts: contacts.collect(),
            cell_area: diagram.cell_area.into(),
            triangles: triangles.map(|corners| corners.map(GrainId)).collect(),
            thickness: 1.0,
            grains,
            sides,
        };
        Ok(Self {
            assembly,
            edges: diagram.edges,
            folder: folder.clone(),
        })
    }

    /// The dual edge of each contact from its end on the side of −t to that of +t, undeformed, `[length]`.
    ///
    /// It is the common edge of two power cells, or of a cell with a side; n runs from the first partner to the
    /// second, t is n turned by a quarter turn counter-clockwise.
    pub fn dual_edges(&self) -> PerContact<[Vector; 2]> {
        self.assembly.contacts.map(ends_of_dual)
    }

    /// The edges between power cells of grains that have no contact, `[length]`.
    pub fn other_edges(&self) -> Vec<[Vector; 2]> {
        let Assembly {
            grains,
            sides,
            contacts,
            ..
        } = &self.assembly;
        let of_grains = contacts.values().iter().map(|c| (c.first, c.second));
        let of_grains: std::collections::HashSet<(Partner, Partner)> = of_grains.collect();
        let site = |edge: &DualEdge| Site {
            first: Partner::Grain(GrainId(edge.first)),
            second: Partner::Grain(GrainId(edge.second)),
            edge_parts: edge.parts,
        };
        let others = self.edges.iter().map(site);
        let others = others.filter(|site| !of_grains.contains(&(site.first, site.second)));
        others
            .map(|site| ends_of_dual(&made(&site, Bodies { grains, sides })))
            .collect()
    }

    /// Displacements and active contacts at a recorded load step; forces are not read, and contacts that are active
    /// have no property of their own.
    ///
    /// # Errors
    /// Tables that cannot be read or do not fit together.
    pub fn state(&self, step: usize) -> Result<State, ResultsError> {
        let mut displacements =
            PerBody::filled(Displacement::default(), self.assembly.body_count());
        let grains = self
            .folder
            .some_of_grains(step, &["grain", "ux", "uy", "rotation"])?;
        let last = self.assembly.grains.len();
        take(&mut displacements.values_mut()[..last], &grains, "grain")?;
        take(
            &mut displacements.values_mut()[last..],
            &self.folder.sides(step)?,
            "side",
        )?;
        let table = self.folder.some_of_contacts(step, &["state"])?;
        let contacts = table.texts("state")?.into_iter().map(contact_state);
        Ok(State {
            displacements,
            contacts: contacts.collect(),
        })
    }

    /// How far a partner has gone in a state; of a side, a point of it, `[length]`.
    pub fn way(&self, state: &State, partner: Partner, at: Vector) -> Vector {
        let Displacement { x, y, rotation } = state.displacements[self.assembly.body(partner)];
        let arm = match partner {
            Partner::Grain(_) => Vector::default(),
            Partner::Side(_) => at - self.assembly.reference_point(partner),
        };
        Vector::new(x, y) + arm.quarter_turn() * rotation
    }

    /// Where a partner of a contact is, with displacements so many times as large: a grain's centre, or the point of
    /// a side that the grain touches, `[length]`.
    pub fn end(&self, state: &State, contact: &Contact, partner: Partner, times: f64) -> Vector {
        let at = match partner {
            Partner::Grain(grain) => self.assembly.grains[grain].centre,
            Partner::Side(_) => contact.point,
        };
        at + self.way(state, partner, at) * times
    }

    /// The void cells in a state, numbered as in the table `voids` of the same load step.
    pub fn void_cells(&self, state: &State) -> VoidCells {
        void_cells(&Snapshot {
            assembly: &self.assembly,
            state,
            loads: &PerBody::default(),
            reactions: &PerBody::default(),
        })
    }
}

/// The grains before loading.
fn grains(folder: &ResultsFolder) -> Result<PerGrain<Grain>, PictureError> {
    let table = folder.some_of_grains(0, &["x", "y", "radius"])?;
    let [x, y, radius] = [
        table.numbers("x")?,
        table.numbers("y")?,
        table.numbers("radius")?,
    ];
    let grain = |row: usize| Grain {
        centre: Vector::new(x[row], y[row]),
        radius: radius[row],
    };
    Ok((0..table.len()).map(grain).collect())
}

/// The partners of each contact.
fn partners(
    folder: &ResultsFolder,
    table: &Columns,
    grains: usize,
) -> Result<Vec<(Partner, Partner)>, PictureError> {
    let sides = container(folder)?.len();
    let partner = |number: Option<i64>| {
        let number = number.unwrap_or(i64::MAX);
        let (what, id, count) = match number {
            0.. => ("grain", number, grains),
            _ => ("side", -1 - number, sides),
        };
        match usize::try_from(id).ok().filter(|&id| id < count) {
            Some(id) if number < 0 => Ok(Partner::Side(SideId::from_index(id))),
            Some(id) => Ok(Partner::Grain(GrainId::from_index(id))),
            None => Err(PictureError::NotThere {
                folder: folder.path().to_owned(),
                table: "contacts",
                what,
                id: number,
            }),
        }
    };
    let (first, second) = (table.integers("first")?, table.integers("second")?);
    let pairs = first.into_iter().zip(second);
    pairs
        .map(|(first, second)| Ok((partner(first)?, partner(second)?)))
        .collect()
}

/// The sides that grains touch, each once.
fn touched(table: &Columns, partners: &[(Partner, Partner)]) -> Result<Vec<Touched>, PictureError> {
    let (nx, ny) = (table.numbers("nx")?, table.numbers("ny")?);
    let mut touched: Vec<Touched> = Vec::new();
    for (row, (_, second)) in partners.iter().enumerate() {
        if let Partner::Side(side) = second
            && touched.iter().all(|(number, _)| *number != side.index())
        {
            touched.push((side.index(), Vector::new(nx[row], ny[row])));
        }
    }
    Ok(touched)
}

fn diagram(
    grains: &PerGrain<Grain>,
    sides: &PerSide<Side>,
    table: &Columns,
    partners: &[(Partner, Partner)],
) -> Result<PowerDiagram, PictureError> {
    let centres: Vec<Vector> = grains.values().iter().map(|grain| grain.centre).collect();
    let radii: Vec<f64> = grains.values().iter().map(|grain| grain.radius).collect();
    let lengths = table.numbers("branch_length")?;
    let near = partners
        .iter()
        .zip(lengths)
        .filter_map(|(&pair, length)| match pair {
            (Partner::Grain(a), Partner::Grain(b)) => Some(NearPair {
                first: a.0,
                second: b.0,
                gap: length - (grains[a].radius + grains[b].radius),
            }),
            _ => None,
        });
    let near: Vec<NearPair> = near.collect();
    Ok(power_diagram(
        &centres,
        &radii,
        &assembly::container(sides),
        &near,
    ))
}

fn contact(
    (first, second): (Partner, Partner),
    grains: &PerGrain<Grain>,
    sides: &PerSide<Side>,
    diagram: &PowerDiagram,
) -> Contact {
    // Partners that touch and have no common edge meet in a point.
    let edge_parts = edge_parts(first, second, diagram).unwrap_or_default();
    made(
        &Site {
            first,
            second,
            edge_parts,
        },
        Bodies { grains, sides },
    )
}

fn made(site: &Site, bodies: Bodies<'_>) -> Contact {
    let shaping = Shaping {
        dual_length: assembly::DualLength::Full,
        ..Shaping::default()
    };
    site.contact(shaping, bodies, PropertyId(0), 1.0)
}

fn edge_parts(first: Partner, second: Partner, diagram: &PowerDiagram) -> Option<[f64; 2]> {
    match (first, second) {
        (Partner::Grain(a), Partner::Grain(b)) => {
            let key = |edge: &DualEdge| (edge.first, edge.second);
            let place = diagram.edges.binary_search_by_key(&(a.0, b.0), key);
            Some(diagram.edges[place.ok()?].parts)
        }
        (Partner::Grain(a), Partner::Side(b)) => {
            let key = |edge: &SideEdge| (edge.disc, edge.side);
            let place = diagram.side_edges.binary_search_by_key(&(a.0, b.0), key);
            Some(diagram.side_edges[place.ok()?].parts)
        }
        (Partner::Side(_), _) => None,
    }
}

fn ends_of_dual(contact: &Contact) -> [Vector; 2] {
    let t = contact.normal.quarter_turn();
    let [before, after] = contact.dual_parts;
    [contact.point - t * before, contact.point + t * after]
}

/// Takes displacements from a table whose ids count from the first of `bodies`.
fn take(bodies: &mut [Displacement], table: &Columns, id: &str) -> Result<(), ResultsError> {
    let ids = table.integers(id)?;
    let (x, y) = (table.numbers("ux")?, table.numbers("uy")?);
    let rotation = table.numbers("rotation")?;
    for (row, id) in ids.into_iter().enumerate() {
        let body = id.and_then(|id| bodies.get_mut(usize::try_from(id).ok()?));
        if let Some(body) = body {
            *body = Displacement {
                x: x[row],
                y: y[row],
                rotation: rotation[row],
            };
        }
    }
    Ok(())
}

/// What the word in the table tells.
fn contact_state(state: &str) -> ContactState {
    let is_active = !matches!(state, "open" | "broken");
    ContactState {
        property: (state != "broken").then_some(PropertyId(0)),
        broken: state == "broken",
        phase: if is_active {
            Phase::Closed
        } else {
            Phase::Open
        },
        displacement: RelativeDisplacement::default(),
        force: ContactForce::default(),
    }
}
