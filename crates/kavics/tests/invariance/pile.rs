//! Grains in a container, what they are made of and what acts on them.

use kavics::assembly::{
    Assembly, Between, Bodies, Contact, ContactGraph, Grain, Partner, Shaping, contact_graph,
    polygon_sides,
};
use kavics::contact_law::{
    Cemented, Cohesionless, ContactGeometry, Law, Property, Reading, StiffnessRule, Strength,
};
use kavics::equilibrium::{Displacement, Equilibrium, Freedom, Load, Settings, SolveError};
use kavics::geometry::Vector;
use kavics::ids::{GrainId, Id, PerGrain, PerProperty, PerSide, PropertyId, SideId};
use kavics::loading::{Action, AppliedLoad, Breakage, Held, LoadPath, Prescribed, Program, Stage};
use kavics::packing::{Bed, dropped};

use crate::change::{Change, GRAINS, SIDES};

/// Width of the container, `[length]`.
const WIDTH: f64 = 16.0;
/// Grains in each row of regular ones, from the bottom.
const ROWS: [usize; 5] = [8, 7, 8, 7, 8];
/// The roof is absent: it only cuts power cells.
const PRESENT: [bool; SIDES] = [true, true, false, false, true];
/// The side that moves.
const MOVED: Partner = Partner::Side(SideId(1));

/// Grains in a house of five corners; sides 0, 1 and 4 are its floor and walls.
#[derive(Clone, Debug)]
pub struct Pile {
    pub grains: PerGrain<Grain>,
    pub corners: Vec<Vector>,
}

impl Pile {
    pub fn dropped(seed: u64) -> Self {
        let radii: Vec<f64> = (0..GRAINS)
            .map(|k| 0.5 + (k * 7 % GRAINS) as f64 / GRAINS as f64)
            .collect();
        let bed = dropped::drop(&Bed::empty_box(WIDTH), &radii, 1, seed);
        Self::under_a_roof(bed.expect("a pack").grains)
    }

    /// Equal grains in rows from wall to wall, each in the gaps of the row below: whatever presses on them is held.
    pub fn of_rows() -> Self {
        let rows = ROWS.into_iter().enumerate();
        let grains = rows.flat_map(|(row, count)| {
            let left = 1.0 + (8 - count) as f64;
            let y = 1.0 + 3.0_f64.sqrt() * row as f64;
            (0..count).map(move |k| Grain {
                centre: Vector::new(left + 2.0 * k as f64, y),
                radius: 1.0,
            })
        });
        Self::under_a_roof(grains.collect())
    }

    fn under_a_roof(grains: PerGrain<Grain>) -> Self {
        let tops = grains.values().iter().map(|g| g.centre.y + g.radius);
        let eaves = 0.5 + tops.fold(0.0, f64::max);
        let corners = [
            (0.0, 0.0),
            (WIDTH, 0.0),
            (WIDTH, eaves),
            (5.0, eaves + 2.0),
            (0.0, eaves),
        ];
        Self {
            grains,
            corners: corners.map(|(x, y)| Vector::new(x, y)).to_vec(),
        }
    }

    /// The contact graph after a change.
    pub fn graph(&self, change: &Change, between: Between) -> ContactGraph {
        let (grains, sides) = (change.grains(&self.grains), self.sides(change));
        let reach = PerSide::filled(0.0, SIDES);
        contact_graph(&grains, &sides, between, &reach, 1e-7 * change.scale)
    }

    fn sides(&self, change: &Change) -> PerSide<kavics::assembly::Side> {
        let mut corners: Vec<Vector> = self.corners.iter().map(|&x| change.point(x)).collect();
        let mut present = PRESENT;
        corners.rotate_left(change.first_side);
        present.rotate_left(change.first_side);
        polygon_sides(&corners, &present)
    }

    /// The assembly after a change.
    pub fn assembly(&self, change: &Change, between: Between, shaping: Shaping) -> Assembly {
        let (grains, sides) = (change.grains(&self.grains), self.sides(change));
        let ContactGraph {
            sites,
            cell_area,
            triangles,
        } = self.graph(change, between);
        let bodies = Bodies {
            grains: &grains,
            sides: &sides,
        };
        let contact = |site: &kavics::assembly::Site| {
            let factor = strength_factor([site.first, site.second].map(|p| change.original(p)));
            site.contact(shaping, bodies, PropertyId(0), factor)
        };
        Assembly {
            contacts: sites.iter().map(contact).collect(),
            grains,
            sides,
            cell_area,
            triangles,
            thickness: 1.0,
        }
    }
}

/// A factor in [0.5, 1.5) of its own for each number: the shares of multiples of the golden section never meet.
fn factor(number: usize) -> f64 {
    0.5 + (number as f64 * 0.618_033_988_749_895).fract()
}

fn strength_factor(pair: [Partner; 2]) -> f64 {
    let mut numbers = pair.map(|partner| match partner {
        Partner::Grain(grain) => grain.index(),
        Partner::Side(side) => GRAINS + side.index(),
    });
    numbers.sort_unstable();
    factor(numbers[0] * (GRAINS + SIDES) + numbers[1])
}

/// What contacts are made of.
#[derive(Clone, Debug)]
pub struct Material {
    pub is_layer: bool,
    pub between: Between,
    pub shaping: Shaping,
    pub eccentric: bool,
    /// μ of the stiffness.
    pub hardening: f64,
    pub reading: Reading,
    /// Coulomb friction: of contacts without cement, and of broken bonds; none: broken bonds are gone.
    pub friction: Option<f64>,
    pub is_cemented: bool,
    /// Limits of the force components.
    pub strength: Strength,
}

impl Material {
    pub const CEMENT: Self = Self {
        is_layer: true,
        between: Between::Touching,
        shaping: Shaping {
            dual_length: kavics::assembly::DualLength::Capped,
            contact_point: kavics::assembly::ContactPoint::Tangent,
        },
        eccentric: false,
        hardening: 0.0,
        reading: Reading::Printed,
        friction: None,
        is_cemented: true,
        strength: Strength::UNBREAKABLE,
    };

    /// Exponent of the scale in the stiffness of contacts: E·s, or E·s/l.
    pub fn power(&self) -> i32 {
        i32::from(self.is_layer)
    }

    pub fn stiffness(&self) -> StiffnessRule {
        let (normal, shear) = (1000.0, 600.0);
        if self.is_layer {
            StiffnessRule::Layer { normal, shear }
        } else {
            StiffnessRule::Modulus { normal, shear }
        }
    }

    /// Limits are forces, and for bending force times length.
    pub fn properties(&self, change: &Change) -> PerProperty<Property> {
        let (stiffness, force) = (self.stiffness(), change.force);
        let strength = Strength {
            tension: force * self.strength.tension,
            compression: force * self.strength.compression,
            shear: force * self.strength.shear,
            bending: force * change.scale * self.strength.bending,
            ..self.strength
        };
        let cement = Law::Cemented(Cemented {
            stiffness,
            shear_hardening: self.hardening,
            reading: self.reading,
            shear_floor: None,
            eccentric: self.eccentric,
            strength,
            after_breakage: self.friction.map(|_| PropertyId(1)),
        });
        let grit = Law::Cohesionless(Cohesionless {
            stiffness,
            shear_hardening: self.hardening,
            reading: self.reading,
            shear_floor: None,
            friction: self.friction,
        });
        let laws = if self.is_cemented {
            [cement, grit]
        } else {
            [grit, cement]
        };
        laws.map(|law| Property {
            name: law.name().into(),
            law,
        })
        .to_vec()
        .into()
    }

    /// Normal stiffness of the stiffest contact, `[force/length]`.
    pub fn stiffest(&self, assembly: &Assembly, change: &Change) -> f64 {
        let law = &self.properties(change)[PropertyId(0)].law;
        let stiffness = |contact: &Contact| {
            let geometry = ContactGeometry {
                dual_parts: contact.dual_parts,
                branch_length: contact.branch_length,
                thickness: assembly.thickness,
            };
            law.stiffness(&geometry).normal
        };
        let all = assembly.contacts.values().iter().map(stiffness);
        all.fold(0.0, f64::max)
    }
}

/// What acts on a pile: floor and walls are held, but that a wall moves in the end.
#[derive(Clone, Debug)]
pub struct Acting {
    /// Load per area of a grain, times a factor of its own.
    pub weight: Vector,
    /// On grain 20.
    pub push: Load,
    /// Of a wall.
    pub wall: Displacement,
    /// Factors of weight and push, then of the wall.
    pub factors: [Vec<f64>; 2],
    pub breakage: Breakage,
}

impl Acting {
    /// The program after a change.
    fn program(&self, pile: &Pile, assembly: &Assembly, change: &Change) -> Program {
        let body = |partner| assembly.body(change.partner(partner));
        let name = ["load", "wall"];
        let weight = pile.grains.iter().map(|(id, grain)| {
            let area = std::f64::consts::PI * grain.radius * grain.radius;
            let f = self.weight * (area * factor(id.index()));
            let load = Load {
                x: f.x,
                y: f.y,
                moment: 0.0,
            };
            (id, load)
        });
        let load = |(grain, load): (GrainId, Load)| AppliedLoad {
            body: body(Partner::Grain(grain)),
            load: change.load(load),
            action: 0,
        };
        let wall = change.displacement(self.wall);
        let freedoms = [Freedom::X, Freedom::Y, Freedom::Rotation];
        let prescribed = freedoms.into_iter().zip([wall.x, wall.y, wall.rotation]);
        let held = [0, 4].map(|side| body(Partner::Side(SideId(side))));
        Program {
            actions: name.map(|name| Action { name: name.into() }).to_vec(),
            held: held
                .into_iter()
                .flat_map(|body| freedoms.map(|freedom| Held { body, freedom }))
                .collect(),
            prescribed: prescribed
                .map(|(freedom, amplitude)| Prescribed {
                    body: body(MOVED),
                    freedom,
                    amplitude,
                    action: 1,
                })
                .collect(),
            loads: weight.chain([(GrainId(20), self.push)]).map(load).collect(),
            stages: (0..2)
                .map(|k| Stage {
                    name: name[k].into(),
                    actions: vec![k],
                    factors: self.factors[k].clone(),
                })
                .collect(),
        }
    }

    /// The equilibria after a change, and why there are not more.
    pub fn path(
        &self,
        pile: &Pile,
        assembly: &Assembly,
        material: &Material,
        change: &Change,
    ) -> (Vec<Equilibrium>, Option<SolveError>) {
        let (properties, program) = (
            material.properties(change),
            self.program(pile, assembly, change),
        );
        let settings = Settings {
            tolerance: 1e-12,
            modes: 1,
            keep_tangents: true,
            ..Settings::default()
        };
        let mut found = Vec::new();
        for step in LoadPath::new(assembly, &properties, &program, self.breakage, settings) {
            match step {
                Ok(equilibrium) => found.push(equilibrium),
                Err(error) => return (found, Some(error)),
            }
        }
        (found, None)
    }
}
