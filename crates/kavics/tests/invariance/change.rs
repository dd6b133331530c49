//! What is done to an assembly, and what each quantity becomes by it.

use kavics::assembly::{Grain, Partner};
use kavics::equilibrium::{Displacement, Load};
use kavics::geometry::Vector;
use kavics::ids::{GrainId, Id, PerGrain, SideId};
use kavics::measure::{SymmetricTensor, Tensor};
use proptest::prelude::*;

pub const GRAINS: usize = 38;
pub const SIDES: usize = 5;

/// x becomes scale·Q·x + shift, loads become force·Q·f, grains and sides get other ids.
#[derive(Clone, Debug)]
pub struct Change {
    pub scale: f64,
    pub angle: f64,
    pub shift: Vector,
    pub force: f64,
    /// New id of each grain.
    pub ids: Vec<usize>,
    /// The side that becomes side 0; the others follow in their order.
    pub first_side: usize,
    /// Factor on displacements: not that of lengths, as displacements are small.
    pub displacement: f64,
}

impl Change {
    pub fn none() -> Self {
        Self {
            scale: 1.0,
            angle: 0.0,
            shift: Vector::new(0.0, 0.0),
            force: 1.0,
            ids: (0..GRAINS).collect(),
            first_side: 0,
            displacement: 1.0,
        }
    }

    /// With displacements that follow from k ∝ scale^power: u = f/k.
    #[must_use]
    pub fn with_stiffness(self, power: i32) -> Self {
        let displacement = self.force / self.scale.powi(power);
        Self {
            displacement,
            ..self
        }
    }

    /// With loads under which displacements grow as lengths do, so that all strains stay.
    #[must_use]
    pub fn similar(self, power: i32) -> Self {
        let force = self.scale.powi(power + 1);
        Self { force, ..self }.with_stiffness(power)
    }

    pub fn turned(&self, v: Vector) -> Vector {
        let (s, c) = (libm::sin(self.angle), libm::cos(self.angle));
        Vector::new(c * v.x - s * v.y, s * v.x + c * v.y)
    }

    pub fn point(&self, x: Vector) -> Vector {
        self.turned(x) * self.scale + self.shift
    }

    pub fn grains(&self, grains: &PerGrain<Grain>) -> PerGrain<Grain> {
        let mut changed = grains.clone();
        for (id, grain) in grains.iter() {
            changed[self.grain(id)] = Grain {
                centre: self.point(grain.centre),
                radius: self.scale * grain.radius,
            };
        }
        changed
    }

    pub fn grain(&self, grain: GrainId) -> GrainId {
        GrainId::from_index(self.ids[grain.index()])
    }

    pub fn partner(&self, partner: Partner) -> Partner {
        match partner {
            Partner::Grain(grain) => Partner::Grain(self.grain(grain)),
            Partner::Side(side) => {
                let place = (side.index() + SIDES - self.first_side) % SIDES;
                Partner::Side(SideId::from_index(place))
            }
        }
    }

    /// What was a partner's name before.
    pub fn original(&self, partner: Partner) -> Partner {
        let is_it = |candidate: &Partner| self.partner(*candidate) == partner;
        let grains = (0..GRAINS).map(|k| Partner::Grain(GrainId::from_index(k)));
        let sides = (0..SIDES).map(|k| Partner::Side(SideId::from_index(k)));
        grains.chain(sides).find(is_it).expect("a partner")
    }

    /// What a displacement that the assembly answers with becomes; a rotation is one over a length.
    pub fn displacement(&self, u: Displacement) -> Displacement {
        let v = self.turned(Vector::new(u.x, u.y)) * self.displacement;
        Displacement {
            x: v.x,
            y: v.y,
            rotation: self.displacement / self.scale * u.rotation,
        }
    }

    pub fn load(&self, load: Load) -> Load {
        let f = self.turned(Vector::new(load.x, load.y)) * self.force;
        Load {
            x: f.x,
            y: f.y,
            moment: self.force * self.scale * load.moment,
        }
    }

    /// Factor on energies and works.
    pub fn energy(&self) -> f64 {
        self.force * self.displacement
    }

    /// Factor on stresses; the thickness stays.
    pub fn stress(&self) -> f64 {
        self.force / self.scale
    }

    /// Factor on strains.
    pub fn strain(&self) -> f64 {
        self.displacement / self.scale
    }

    /// Q·a·Qᵀ.
    pub fn tensor(&self, a: Tensor) -> Tensor {
        let [ex, ey] = [(1.0, 0.0), (0.0, 1.0)].map(|(x, y)| self.turned(Vector::new(x, y)));
        let sum = |b: Tensor, part: f64, [p, q]: [Vector; 2]| b + Tensor::product(p, q) * part;
        let sum_of = [
            (a.xx, [ex, ex]),
            (a.xy, [ex, ey]),
            (a.yx, [ey, ex]),
            (a.yy, [ey, ey]),
        ];
        sum_of
            .into_iter()
            .fold(Tensor::default(), |b, (part, axes)| sum(b, part, axes))
    }

    pub fn symmetric(&self, a: SymmetricTensor) -> Tensor {
        self.tensor(full(a))
    }
}

pub fn full(a: SymmetricTensor) -> Tensor {
    Tensor {
        xx: a.xx,
        xy: a.xy,
        yx: a.xy,
        yy: a.yy,
    }
}

/// All changes at once, the shift up to `far`.
pub fn changes(far: f64) -> impl Strategy<Value = Change> {
    let ids = Just((0..GRAINS).collect::<Vec<_>>()).prop_shuffle();
    let numbers = (
        0.2..5.0_f64,
        -3.2..3.2_f64,
        -far..far,
        -far..far,
        0.2..5.0_f64,
    );
    (numbers, ids, 0..SIDES).prop_map(|((scale, angle, x, y, force), ids, first_side)| Change {
        scale,
        angle,
        shift: Vector::new(x, y),
        force,
        ids,
        first_side,
        displacement: force,
    })
}
