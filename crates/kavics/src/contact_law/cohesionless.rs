//! The cohesionless contact: compression and shear, opening and closing, sliding by Coulomb friction.
//! Bojtár & Bagi (1989), eq. 22; friction by return mapping.

use super::{
    Cohesionless, ContactForce, ContactInstant, ContactMemory, Dissipation, Phase, PhaseChange,
    Reading, RelativeDisplacement, Response, Stiffness, shear,
};

/// +1 or −1 with the shear force of a sliding contact.
fn sense(phase: Phase) -> Option<f64> {
    match phase {
        Phase::SlidingForward => Some(1.0),
        Phase::SlidingBackward => Some(-1.0),
        Phase::Closed | Phase::Open => None,
    }
}

impl Cohesionless {
    /// Force, tangent and secant at `v` in a given phase.
    ///
    /// Closed: N = k_n·v_n, T by the shear spring. Sliding: T = ±μ_f·(−N). Open: nothing.
    pub fn respond(
        &self,
        v: RelativeDisplacement,
        k: &Stiffness,
        memory: &ContactMemory,
        phase: Phase,
    ) -> Response {
        if phase == Phase::Open {
            return Response::default();
        }
        let shear = shear::respond(self.reading, v, k, memory);
        let thrust_by_shear = if shear.thrust == 0.0 {
            0.0
        } else {
            shear.coupling
        };
        let secant = [[k.normal, 0.0, 0.0], [0.0, shear.secant, 0.0], [0.0; 3]];
        let Some((sense, friction)) = sense(phase).zip(self.friction) else {
            return Response {
                force: ContactForce {
                    normal: k.normal * v.normal + shear.thrust,
                    shear: shear.force,
                    moment: 0.0,
                },
                tangent: [
                    [k.normal, thrust_by_shear, 0.0],
                    [shear.coupling, shear.tangent, 0.0],
                    [0.0; 3],
                ],
                secant,
            };
        };
        let normal = k.normal * v.normal;
        Response {
            force: ContactForce {
                normal,
                shear: -sense * friction * normal,
                moment: 0.0,
            },
            tangent: [
                [k.normal, 0.0, 0.0],
                [-sense * friction * k.normal, 0.0, 0.0],
                [0.0; 3],
            ],
            secant,
        }
    }

    /// The phase asked for where the present one is not admissible: no tension, no penetration of an open contact,
    /// no shear force beyond μ_f·(−N), no slip against the shear force.
    pub fn phase_change(
        &self,
        v: RelativeDisplacement,
        force: ContactForce,
        k: &Stiffness,
        memory: &ContactMemory,
        phase: Phase,
    ) -> Option<PhaseChange> {
        let change = |to, violation| (violation > 0.0).then_some(PhaseChange { to, violation });
        if phase == Phase::Open {
            return change(self.closing_phase(v, k, memory), -k.normal * v.normal);
        }
        if force.normal > 0.0 {
            return change(Phase::Open, force.normal);
        }
        let friction = self.friction?;
        match sense(phase) {
            None => {
                let to = if force.shear > 0.0 {
                    Phase::SlidingForward
                } else {
                    Phase::SlidingBackward
                };
                change(to, force.shear.abs() + friction * force.normal)
            }
            Some(sense) => {
                let slipped = self.slip(v, force, k, memory, phase) - Self::slip_before(memory, k);
                change(Phase::Closed, -sense * slipped * k.shear_at(v.normal))
            }
        }
    }

    /// The phase in which an open contact closes at `v`: it slides where the shear spring would exceed the limit.
    fn closing_phase(
        &self,
        v: RelativeDisplacement,
        k: &Stiffness,
        memory: &ContactMemory,
    ) -> Phase {
        let shear = shear::respond(self.reading, v, k, memory).force;
        match self.friction {
            Some(friction) if shear > -friction * k.normal * v.normal => Phase::SlidingForward,
            Some(friction) if -shear > -friction * k.normal * v.normal => Phase::SlidingBackward,
            _ => Phase::Closed,
        }
    }

    /// The slip in which the remembered shear force is that of the shear spring.
    fn slip_before(memory: &ContactMemory, k: &Stiffness) -> f64 {
        if memory.phase == Phase::Open {
            return memory.slip;
        }
        memory.displacement.shear - felt(memory.force.shear, k.shear_at(memory.displacement.normal))
    }

    /// Slip after the way to `v`: what the shear spring does not feel. An open contact forgets its shear.
    pub(super) fn slip(
        &self,
        v: RelativeDisplacement,
        force: ContactForce,
        k: &Stiffness,
        memory: &ContactMemory,
        phase: Phase,
    ) -> f64 {
        match phase {
            Phase::Closed => memory.slip,
            // Without friction the law has no memory at all.
            Phase::Open if self.friction.is_none() => memory.slip,
            Phase::Open => v.shear,
            Phase::SlidingForward | Phase::SlidingBackward => {
                v.shear - felt(force.shear, k.shear_at(v.normal))
            }
        }
    }

    /// Work of friction, and of a shear spring without potential, on the straight way between two instants.
    ///
    /// The shear force is that of the spring, bounded by μ_f·(−N), and nothing where N > 0. Friction takes
    /// ½·(T₀ + T₁)·Δslip between the points where sticking, sliding and opening change.
    pub fn dissipation(
        &self,
        ends: [&ContactInstant; 2],
        k: &Stiffness,
        memory: &ContactMemory,
    ) -> Dissipation {
        let open = ends.map(|end| end.phase == Phase::Open);
        match self.friction {
            _ if open == [true, true] => Dissipation::default(),
            None if open == [false, false] => self.without_slip(ends, k, memory),
            None => self.opening(ends, k, memory),
            Some(_) if ends.iter().all(|end| end.phase == Phase::Closed) => {
                self.without_slip(ends, k, memory)
            }
            Some(friction) => self.sliding(friction, ends, k, memory),
        }
    }

    fn without_slip(
        &self,
        ends: [&ContactInstant; 2],
        k: &Stiffness,
        memory: &ContactMemory,
    ) -> Dissipation {
        Dissipation {
            nonpotential: shear::dissipation(self.reading, ends, k, memory),
            ..Dissipation::default()
        }
    }

    /// Without friction the shear force jumps to zero where the contact opens, and back where it closes.
    fn opening(
        &self,
        ends: [&ContactInstant; 2],
        k: &Stiffness,
        memory: &ContactMemory,
    ) -> Dissipation {
        let [from, to] = ends.map(|end| end.displacement.normal);
        let share = if from == to { 0.0 } else { from / (from - to) };
        let v = shear::between(ends, share.clamp(0.0, 1.0));
        let force = ContactForce {
            shear: shear::respond(self.reading, v, k, memory).force,
            ..ContactForce::default()
        };
        let edge = ContactInstant {
            displacement: v,
            force,
            phase: Phase::Closed,
        };
        let lost = shear::energy(force.shear, k.shear_at(v.normal));
        let opens = ends[1].phase == Phase::Open;
        let (closed, lost) = if opens {
            ([ends[0], &edge], lost)
        } else {
            ([&edge, ends[1]], -lost)
        };
        Dissipation {
            nonpotential: lost + shear::dissipation(self.reading, closed, k, memory),
            ..Dissipation::default()
        }
    }

    fn sliding(
        &self,
        friction: f64,
        ends: [&ContactInstant; 2],
        k: &Stiffness,
        memory: &ContactMemory,
    ) -> Dissipation {
        let way = SlidingWay::new(self.reading, friction, ends, k, memory);
        let mut marks = way.changes();
        marks.sort_by(f64::total_cmp);
        let mut sum = Dissipation::default();
        let (mut from, mut here) = (*ends[0], 0.0);
        for mark in marks.into_iter().chain([1.0]) {
            let to = if mark == 1.0 { *ends[1] } else { way.at(mark) };
            let part = match way.kind(0.5 * (here + mark)) {
                Kind::Open => Dissipation::default(),
                Kind::Sticking => self.without_slip([&from, &to], k, memory),
                Kind::Sliding => slipping([&from, &to], k),
            };
            sum.friction += part.friction;
            sum.nonpotential += part.nonpotential;
            (from, here) = (to, mark);
        }
        sum
    }
}

/// Shear that a spring of this stiffness feels under this force.
fn felt(force: f64, stiffness: f64) -> f64 {
    if force == 0.0 { 0.0 } else { force / stiffness }
}

/// A part of a way on which a contact slides. Slip that runs back against the shear force, as the spring takes it back
/// that counts from the last equilibrium, gives work that is not friction's.
fn slipping(ends: [&ContactInstant; 2], k: &Stiffness) -> Dissipation {
    let [before, after] = ends.map(|end| {
        end.displacement.shear - felt(end.force.shear, k.shear_at(end.displacement.normal))
    });
    let work = 0.5 * (ends[0].force.shear + ends[1].force.shear) * (after - before);
    let spring = if k.hardening == 0.0 {
        0.0
    } else {
        shear::stiffening(ends, k)
    };
    Dissipation {
        friction: work.max(0.0),
        nonpotential: work.min(0.0) + spring,
        fracture: 0.0,
    }
}

/// How a part of a way is gone.
enum Kind {
    Open,
    Sticking,
    Sliding,
}

/// A straight way on which a contact may stick, slide and open: spring force and normal force are linear along it.
struct SlidingWay<'a> {
    ends: [&'a ContactInstant; 2],
    friction: f64,
    /// What the spring would answer without a limit.
    spring: [f64; 2],
    /// Normal force, tension where the contact is open.
    normal: [f64; 2],
}

impl<'a> SlidingWay<'a> {
    fn new(
        reading: Reading,
        friction: f64,
        ends: [&'a ContactInstant; 2],
        k: &Stiffness,
        memory: &ContactMemory,
    ) -> Self {
        Self {
            ends,
            friction,
            spring: ends.map(|end| shear::respond(reading, end.displacement, k, memory).force),
            normal: ends.map(|end| match end.phase {
                Phase::Open => k.normal * end.displacement.normal,
                _ => end.force.normal,
            }),
        }
    }

    /// Shares of the way at which the spring meets a limit or the contact opens or closes.
    fn changes(&self) -> Vec<f64> {
        let [normal, spring] = [self.normal, self.spring];
        let limits = [-1.0, 1.0].map(|sense| {
            [0, 1].map(|end: usize| spring[end] + sense * self.friction * normal[end])
        });
        let crossed = [normal, limits[0], limits[1]];
        crossed
            .into_iter()
            .filter(|[from, to]| from * to < 0.0)
            .map(|[from, to]| from / (from - to))
            .collect()
    }

    /// Spring force and limit at a share of the way; the limit is negative where the contact is open.
    fn spring_and_limit(&self, share: f64) -> (f64, f64) {
        let [spring, normal] =
            [self.spring, self.normal].map(|[from, to]| from + share * (to - from));
        (spring, -self.friction * normal)
    }

    fn kind(&self, share: f64) -> Kind {
        let (spring, limit) = self.spring_and_limit(share);
        if limit < 0.0 {
            Kind::Open
        } else if spring.abs() <= limit {
            Kind::Sticking
        } else {
            Kind::Sliding
        }
    }

    fn at(&self, share: f64) -> ContactInstant {
        let (spring, limit) = self.spring_and_limit(share);
        let limit = limit.max(0.0);
        let force = ContactForce {
            shear: spring.clamp(-limit, limit),
            ..ContactForce::default()
        };
        ContactInstant {
            displacement: shear::between(self.ends, share),
            force,
            phase: Phase::Closed,
        }
    }
}
