//! The cohesionless contact: compression and shear, opening and closing, sliding by Coulomb friction.
//! Bojtár & Bagi (1989), eq. 22; friction by return mapping.

use super::{
    Cohesionless, ContactForce, ContactMemory, Dissipation, Phase, PhaseChange, Reading,
    RelativeDisplacement, Response, Stiffness, shear,
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

    /// Work of friction, and of a shear spring without potential, on the straight way to `v`.
    ///
    /// The contact sticks until its shear force meets the limit, then slides along it; where it opens on the way
    /// it slides until nothing is left. Friction takes ½·(T_θ + T₁)·Δslip.
    pub fn dissipation(
        &self,
        v: RelativeDisplacement,
        force: ContactForce,
        k: &Stiffness,
        memory: &ContactMemory,
        phase: Phase,
    ) -> Dissipation {
        let opens = phase == Phase::Open && memory.phase != Phase::Open;
        let Some(friction) = self.friction else {
            let lost = if opens {
                shear::energy(memory.force.shear, k.shear_at(memory.displacement.normal))
            } else {
                0.0
            };
            let nonpotential = if phase == Phase::Open || memory.phase == Phase::Open {
                lost
            } else {
                shear::dissipation(self.reading, v, force.shear, k, memory)
            };
            return Dissipation {
                nonpotential,
                ..Dissipation::default()
            };
        };
        if phase == Phase::Closed {
            return Dissipation {
                nonpotential: shear::dissipation(self.reading, v, force.shear, k, memory),
                ..Dissipation::default()
            };
        }
        if sense(phase).is_none() && !opens {
            return Dissipation::default();
        }
        // What the spring feels changes with k_t whether it slides or not: −½·∫ e² dk_t.
        let nonpotential = if opens {
            0.0
        } else {
            shear::dissipation(Reading::Printed, v, force.shear, k, memory)
        };
        Dissipation {
            friction: sliding_work(friction, v, force, k, memory, opens),
            nonpotential,
            fracture: 0.0,
        }
    }
}

/// Shear that a spring of this stiffness feels under this force.
fn felt(force: f64, stiffness: f64) -> f64 {
    if force == 0.0 { 0.0 } else { force / stiffness }
}

/// Work of friction on the straight way from the remembered equilibrium to `v`; exact at constant shear stiffness.
fn sliding_work(
    friction: f64,
    v: RelativeDisplacement,
    force: ContactForce,
    k: &Stiffness,
    memory: &ContactMemory,
    opens: bool,
) -> f64 {
    let start = memory.displacement;
    let stiffness = k.shear_at(start.normal);
    let end = if opens {
        start.normal / (start.normal - v.normal)
    } else {
        1.0
    };
    let step = v.shear - start.shear;
    let (shear_before, limit_before) = (memory.force.shear, -friction * memory.force.normal);
    let limit_after = if opens { 0.0 } else { -friction * force.normal };
    let trial = shear_before + stiffness * step * end;
    let sense = if opens {
        trial.signum()
    } else {
        force.shear.signum()
    };
    // Where the elastic shear force meets the limit, as a share of the way to `end`.
    let room = limit_before - sense * shear_before;
    let closing = sense * (trial - shear_before) - (limit_after - limit_before);
    let meets = if closing > 0.0 {
        (room / closing).clamp(0.0, 1.0)
    } else {
        0.0
    };
    let shear_at_slip = sense * (limit_before + meets * (limit_after - limit_before));
    let shear_after = sense * limit_after;
    let felt_after = felt(shear_after, k.shear_at(v.normal));
    let slip = step * end * (1.0 - meets) - (felt_after - felt(shear_at_slip, stiffness));
    0.5 * (shear_at_slip + shear_after) * slip
}
