//! The shear spring whose stiffness depends on the opening, in its three readings.
//!
//! k_t(v_n) = k_t0 − h·v_n; e = v_t − slip is the shear that the spring feels. Printed: T = k_t·e. Potential: the
//! same T from U = ½·k_t·e², with the thrust ∂U/∂v_n. History: dT = k_t·dv_t, and where k_t falls T falls with it,
//! in closed form on the straight way from the last equilibrium.

use super::{ContactInstant, ContactMemory, Reading, RelativeDisplacement, Stiffness};

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

/// Work of the shear force less the energy kept, on the straight way between two instants without slip,
/// `[force·length]`; both carry what the spring answers with the same memory.
pub(super) fn dissipation(
    reading: Reading,
    ends: [&ContactInstant; 2],
    k: &Stiffness,
    memory: &ContactMemory,
) -> f64 {
    if k.hardening == 0.0 {
        return 0.0;
    }
    match reading {
        Reading::Potential => 0.0,
        Reading::Printed => stiffening(ends, k),
        Reading::History => remembered(ends, k, memory),
    }
}

/// −½·∫ e² dk_t with e and k_t linear along the way: what a spring takes whose stiffness falls while it feels e.
pub(super) fn stiffening(ends: [&ContactInstant; 2], k: &Stiffness) -> f64 {
    let [before, now] = ends.map(|end| k.shear_at(end.displacement.normal));
    let felt = [ends[0].force.shear / before, ends[1].force.shear / now];
    let opening = ends.map(|end| end.displacement.normal);
    -0.5 * (now - before) * mean_square_above_floor(felt, opening, k)
}

/// The history reading: where k_t is above that of the memory T is of second order in it, below it is k_t·e.
fn remembered(ends: [&ContactInstant; 2], k: &Stiffness, memory: &ContactMemory) -> f64 {
    let start = k.shear_at(memory.displacement.normal);
    let above = ends.map(|end| k.shear_at(end.displacement.normal) - start);
    if above[0] >= 0.0 && above[1] >= 0.0 {
        return rising(ends, k, memory);
    }
    if above[0] <= 0.0 && above[1] <= 0.0 {
        return stiffening(ends, k);
    }
    let v = between(ends, above[0] / (above[0] - above[1]));
    let mut crossing = ContactInstant {
        displacement: v,
        ..*ends[0]
    };
    crossing.force.shear = history(v, k, memory).force;
    let (first, second) = ([ends[0], &crossing], [&crossing, ends[1]]);
    if above[0] > 0.0 {
        rising(first, k, memory) + stiffening(second, k)
    } else {
        stiffening(first, k) + rising(second, k, memory)
    }
}

/// ∫ T dv_t less the energy kept, with T = T_m + ½·(k_m + k_t)·(v_t − v_m) from the memory m: Simpson's rule is exact.
fn rising(ends: [&ContactInstant; 2], k: &Stiffness, memory: &ContactMemory) -> f64 {
    let [from, to] = ends;
    let middle = history(between(ends, 0.5), k, memory).force;
    let step = to.displacement.shear - from.displacement.shear;
    let work = step / 6.0 * (from.force.shear + 4.0 * middle + to.force.shear);
    let [before, now] =
        ends.map(|end| energy(end.force.shear, k.shear_at(end.displacement.normal)));
    work - now + before
}

/// The relative displacement at a share of the straight way.
pub(super) fn between(ends: [&ContactInstant; 2], share: f64) -> RelativeDisplacement {
    let [from, to] = ends.map(|end| end.displacement);
    RelativeDisplacement {
        normal: from.normal + share * (to.normal - from.normal),
        shear: from.shear + share * (to.shear - from.shear),
        rotation: from.rotation + share * (to.rotation - from.rotation),
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
