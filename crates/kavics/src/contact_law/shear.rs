//! The shear spring whose stiffness depends on the opening, in its three readings.
//!
//! k_t(v_n) = k_t0 − h·v_n; e = v_t − slip is the shear that the spring feels. Printed: T = k_t·e. Potential: the
//! same T from U = ½·k_t·e², with the thrust ∂U/∂v_n. History: dT = k_t·dv_t, and where k_t falls T falls with it,
//! in closed form on the straight way from the last equilibrium.

use super::{ContactMemory, Reading, RelativeDisplacement, Stiffness};

/// The shear force and what it does to the normal force, with derivatives.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Shear {
    /// T.
    pub force: f64,
    /// ∂T/∂v_n.
    pub coupling: f64,
    /// ∂T/∂v_t.
    pub tangent: f64,
    /// What shear adds to the normal force.
    pub thrust: f64,
    /// k_t for the secant.
    pub secant: f64,
}

/// Response of the shear spring at `v`, without a slip limit.
pub(super) fn respond(
    reading: Reading,
    v: RelativeDisplacement,
    k: &Stiffness,
    memory: &ContactMemory,
) -> Shear {
    match reading {
        Reading::Printed => total(v, k, memory),
        Reading::Potential => {
            let shear = total(v, k, memory);
            let felt = v.shear - memory.slip;
            Shear {
                thrust: 0.5 * k.shear_slope(v.normal) * felt * felt,
                ..shear
            }
        }
        Reading::History => history(v, k, memory),
    }
}

fn total(v: RelativeDisplacement, k: &Stiffness, memory: &ContactMemory) -> Shear {
    let felt = v.shear - memory.slip;
    let stiffness = k.shear_at(v.normal);
    Shear {
        force: stiffness * felt,
        coupling: k.shear_slope(v.normal) * felt,
        tangent: stiffness,
        thrust: 0.0,
        secant: stiffness,
    }
}

fn history(v: RelativeDisplacement, k: &Stiffness, memory: &ContactMemory) -> Shear {
    let (before, now) = (k.shear_at(memory.displacement.normal), k.shear_at(v.normal));
    let slope = k.shear_slope(v.normal);
    let step = v.shear - memory.displacement.shear;
    if now >= before {
        let mean = 0.5 * (before + now);
        Shear {
            force: memory.force.shear + mean * step,
            coupling: 0.5 * slope * step,
            tangent: mean,
            thrust: 0.0,
            secant: now,
        }
    } else {
        let felt = memory.force.shear / before + step;
        Shear {
            force: now * felt,
            coupling: slope * felt,
            tangent: now,
            thrust: 0.0,
            secant: now,
        }
    }
}

/// Energy T²/(2·k_t) of the spring, `[force·length]`.
pub(super) fn energy(force: f64, stiffness: f64) -> f64 {
    if force == 0.0 {
        0.0
    } else {
        0.5 * force * force / stiffness
    }
}

/// Work of the shear force less the energy kept, on the straight way from the remembered equilibrium to `v`
/// without slip, `[force·length]`.
pub(super) fn dissipation(
    reading: Reading,
    v: RelativeDisplacement,
    force: f64,
    k: &Stiffness,
    memory: &ContactMemory,
) -> f64 {
    if k.hardening == 0.0 {
        return 0.0;
    }
    let (before, now) = (k.shear_at(memory.displacement.normal), k.shear_at(v.normal));
    let felt = [memory.force.shear / before, force / now];
    let mean_square = mean_square_above_floor(felt, [memory.displacement.normal, v.normal], k);
    match reading {
        Reading::Potential => 0.0,
        // −½·∫ e² dk_t with e and k_t linear along the way.
        Reading::Printed => -0.5 * (now - before) * mean_square,
        Reading::History if now < before => 0.5 * (before - now) * mean_square,
        Reading::History => {
            let step = v.shear - memory.displacement.shear;
            let work = step * (memory.force.shear + step * (before / 2.0 + (now - before) / 6.0));
            work - energy(force, now) + energy(memory.force.shear, before)
        }
    }
}

/// Mean of e² over the part of the straight way on which the floor does not hold the stiffness.
fn mean_square_above_floor(felt: [f64; 2], opening: [f64; 2], k: &Stiffness) -> f64 {
    let at = |share: f64| felt[0] + share * (felt[1] - felt[0]);
    // Share of the way at which the stiffness meets the floor.
    let meets = ((k.shear - k.shear_floor) / k.hardening - opening[0]) / (opening[1] - opening[0]);
    let (from, to) = match opening.map(|opening| k.on_floor(opening)) {
        [false, true] => (felt[0], at(meets)),
        [true, false] => (at(meets), felt[1]),
        _ => (felt[0], felt[1]),
    };
    (from * from + from * to + to * to) / 3.0
}
