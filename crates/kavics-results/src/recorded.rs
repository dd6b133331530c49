//! A recorded load step, read back as the state of the scene's assembly.

use kavics::assembly::Partner;
use kavics::contact_law::{ContactForce, Phase, Property, RelativeDisplacement};
use kavics::equilibrium::{ContactState, Displacement, Load, State};
use kavics::ids::{GrainId, Id, PerBody, PerProperty, PropertyId, SideId};
use kavics::scene::Scene;

use crate::{Columns, ResultsError, ResultsFolder};

/// A recorded load step: what a measure reads.
#[derive(Clone, Debug, Default)]
pub struct Recorded {
    /// Displacements and contacts.
    pub state: State,
    /// External loads and reactions together.
    pub loads: PerBody<Load>,
    /// Zero: the tables hold loads and reactions as one.
    pub reactions: PerBody<Load>,
}

impl Recorded {
    /// Reads a recorded load step of `scene`.
    ///
    /// # Errors
    /// Tables that cannot be read, or that belong to another scene.
    pub fn read(folder: &ResultsFolder, step: usize, scene: &Scene) -> Result<Self, ResultsError> {
        let bodies = scene.assembly.body_count();
        let mut recorded = Self {
            state: State {
                displacements: PerBody::filled(Displacement::default(), bodies),
                contacts: contact_states(folder, step, scene)?.into(),
            },
            loads: PerBody::filled(Load::default(), bodies),
            reactions: PerBody::filled(Load::default(), bodies),
        };
        let grains = folder.grains(step)?;
        expect_rows(folder, "grains", grains.len(), scene.assembly.grains.len())?;
        recorded.take_bodies(&grains, "grain", scene, |index| {
            Partner::Grain(GrainId::from_index(index))
        })?;
        let sides = folder.sides(step)?;
        recorded.take_bodies(&sides, "side", scene, |index| {
            Partner::Side(SideId::from_index(index))
        })?;
        Ok(recorded)
    }

    fn take_bodies(
        &mut self,
        table: &Columns,
        id: &str,
        scene: &Scene,
        partner: fn(usize) -> Partner,
    ) -> Result<(), ResultsError> {
        let ids = table.integers(id)?;
        let [ux, uy, rotation] = three(table, ["ux", "uy", "rotation"])?;
        let [fx, fy, moment] = three(table, ["fx", "fy", "moment"])?;
        for (row, id) in ids.iter().enumerate() {
            let index = id.and_then(|id| usize::try_from(id).ok()).unwrap_or(row);
            let body = scene.assembly.body(partner(index));
            if body.index() < self.loads.len() {
                self.state.displacements[body] = Displacement {
                    x: ux[row],
                    y: uy[row],
                    rotation: rotation[row],
                };
                self.loads[body] = Load {
                    x: fx[row],
                    y: fy[row],
                    moment: moment[row],
                };
            }
        }
        Ok(())
    }
}

fn three(table: &Columns, names: [&str; 3]) -> Result<[Vec<f64>; 3], ResultsError> {
    let [a, b, c] = names;
    Ok([table.numbers(a)?, table.numbers(b)?, table.numbers(c)?])
}

fn contact_states(
    folder: &ResultsFolder,
    step: usize,
    scene: &Scene,
) -> Result<Vec<ContactState>, ResultsError> {
    let table = folder.contacts(step)?;
    let expected = scene.assembly.contacts.len();
    expect_rows(folder, "contacts", table.len(), expected)?;
    let [opening, shear, rotation] = three(&table, ["opening", "shear", "relative_rotation"])?;
    let [normal, tangential, moment] =
        three(&table, ["normal_force", "shear_force", "bending_moment"])?;
    let properties = table.texts("property")?;
    let status = table.texts("state")?;
    let state = |row: usize| ContactState {
        displacement: RelativeDisplacement {
            normal: opening[row],
            shear: shear[row],
            rotation: rotation[row],
        },
        force: ContactForce {
            normal: normal[row],
            shear: tangential[row],
            moment: moment[row],
        },
        property: property(&scene.properties, properties[row]),
        broken: status[row] == "broken",
        phase: phase(status[row], tangential[row]),
    };
    Ok((0..table.len()).map(state).collect())
}

fn property(properties: &PerProperty<Property>, name: &str) -> Option<PropertyId> {
    let mut named = properties
        .iter()
        .filter(|(_, property)| property.name == name);
    named.next().map(|(id, _)| id)
}

fn phase(status: &str, shear_force: f64) -> Phase {
    match status {
        "open" | "broken" => Phase::Open,
        "sliding" if shear_force < 0.0 => Phase::SlidingBackward,
        "sliding" => Phase::SlidingForward,
        _ => Phase::Closed,
    }
}

fn expect_rows(
    folder: &ResultsFolder,
    table: &'static str,
    found: usize,
    expected: usize,
) -> Result<(), ResultsError> {
    if found == expected {
        return Ok(());
    }
    Err(ResultsError::OtherScene {
        folder: folder.path().to_owned(),
        table,
        found,
        expected,
    })
}
