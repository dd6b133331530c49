//! A bond that softens linearly on the way to breakage.
//!
//! ```math
//! Q = (1-d)\,k v,\qquad d = \frac{\kappa_u\,(\kappa-1)}{\kappa\,(\kappa_u-1)},\qquad
//! \kappa_u = \frac{2\,G_f s H\,k}{Q_{\lim}^2}
//! ```
//!
//! κ is the largest utilisation of the trial force k·v ever reached, 1 at the elastic limit; k and Q_lim in κ_u are
//! those of the mode that reached its limit first. One mode alone takes G_f·s·H to break. Unloading goes to the
//! origin. The damage d takes dD = ½·v·k·v dd.

use super::{
    ContactForce, ContactMemory, Limits, Matrix, Mode, RelativeDisplacement, Response, Stiffness,
};

/// A utilisation this near below the limit counts as on it, where the tangent is asked for.
const AT_LIMIT: f64 = 1e-8;
/// Growth of the utilisation up to which its integrals are summed as series.
const SERIES: f64 = 0.25;

/// How a bond softens.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Softening {
    /// Elastic limits of the force components.
    pub limits: Limits,
    /// What it takes to break the bond in one mode: G_f·s·H, `[force·length]`.
    pub energy: f64,
}

/// What a softening bond remembers.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Damage {
    /// κ, the largest utilisation of the trial force so far, dimensionless.
    pub utilisation: f64,
    /// The mode that reached its limit first.
    pub mode: Option<Mode>,
    /// Energy taken so far, `[force·length]`.
    pub dissipated: f64,
}

/// A trial force component over its limit, on the straight way: a + b·share.
#[derive(Clone, Copy)]
struct Line {
    mode: Mode,
    start: f64,
    slope: f64,
}

impl Line {
    fn at(self, share: f64) -> f64 {
        self.start + share * self.slope
    }

    /// Share of the way at which the line rises to `height`.
    fn meets(self, height: f64) -> f64 {
        if self.slope > 0.0 {
            (height - self.start) / self.slope
        } else {
            f64::INFINITY
        }
    }
}

/// The straight way between two relative displacements.
struct Way {
    lines: [Line; 6],
    /// ½·v·k·v at share τ: the coefficients of 1, τ, τ².
    energy: [f64; 3],
}

impl Stiffness {
    /// k·v of a bond whose shear stiffness does not depend on the opening.
    pub fn trial_force(&self, v: RelativeDisplacement) -> ContactForce {
        ContactForce {
            normal: self.normal * v.normal + self.coupling * v.rotation,
            shear: self.shear * v.shear,
            moment: self.coupling * v.normal + self.moment * v.rotation,
        }
    }
}

impl Softening {
    /// κ_u: the utilisation at which a bond that began to soften in `mode` is broken.
    pub fn ultimate(&self, k: &Stiffness, mode: Mode) -> f64 {
        let (stiffness, limit) = match mode {
            Mode::Tension => (k.normal, self.limits.tension),
            Mode::Compression => (k.normal, self.limits.compression),
            Mode::Shear => (k.shear, self.limits.shear),
            Mode::Bending => (k.moment, self.limits.bending),
        };
        2.0 * self.energy * stiffness / (limit * limit)
    }

    /// The answer of the bond whose trial answer is `trial`.
    pub(super) fn soften(
        &self,
        trial: &Response,
        v: RelativeDisplacement,
        k: &Stiffness,
        memory: &ContactMemory,
    ) -> Response {
        let damage = self.damage(v, k, memory);
        let (rate, mode) = self.damage_rate(v, k, memory);
        let kept = 1.0 - self.lost(k, &damage);
        let force = [trial.force.normal, trial.force.shear, trial.force.moment];
        let slope = self.utilisation_slope(trial.force, mode, &trial.secant);
        let mut tangent = trial.secant;
        for (row, q) in tangent.iter_mut().zip(force) {
            for (entry, slope) in row.iter_mut().zip(slope) {
                *entry = kept * *entry - rate * q * slope;
            }
        }
        Response {
            force: ContactForce {
                normal: kept * force[0],
                shear: kept * force[1],
                moment: kept * force[2],
            },
            tangent,
            secant: trial.secant.map(|row| row.map(|entry| kept * entry)),
        }
    }

    /// κ, its mode, and the energy taken once `v` has become an equilibrium.
    pub(super) fn damage(
        &self,
        v: RelativeDisplacement,
        k: &Stiffness,
        memory: &ContactMemory,
    ) -> Damage {
        let before = memory.damage;
        let (reached, _) = self.limits.utilisation(k.trial_force(v));
        if reached <= before.utilisation {
            return before;
        }
        let mode = before.mode.or_else(|| {
            let lines = self.way(v, k, memory).lines;
            (reached > 1.0).then(|| first_to_meet(&lines, 1.0).mode)
        });
        Damage {
            utilisation: reached,
            mode,
            dissipated: before.dissipated,
        }
    }

    /// d: the share of the stiffness that is lost.
    fn lost(&self, k: &Stiffness, damage: &Damage) -> f64 {
        let kappa = damage.utilisation;
        match damage.mode {
            Some(mode) if kappa > 1.0 => {
                let ultimate = self.ultimate(k, mode);
                (ultimate * (kappa - 1.0) / (kappa * (ultimate - 1.0))).min(1.0)
            }
            _ => 0.0,
        }
    }

    /// ∂d/∂κ at `v`, 0 where the bond does not soften any further, and the mode whose utilisation κ is.
    fn damage_rate(
        &self,
        v: RelativeDisplacement,
        k: &Stiffness,
        memory: &ContactMemory,
    ) -> (f64, Mode) {
        let (reached, mode) = self.limits.utilisation(k.trial_force(v));
        let limit = memory.damage.utilisation.max(1.0);
        let started = self.damage(v, k, memory).mode.unwrap_or(mode);
        let ultimate = self.ultimate(k, started);
        let kappa = reached.max(limit);
        if reached < limit * (1.0 - AT_LIMIT) || kappa >= ultimate {
            return (0.0, mode);
        }
        (ultimate / ((ultimate - 1.0) * kappa * kappa), mode)
    }

    /// ∂κ/∂v.
    fn utilisation_slope(&self, trial: ContactForce, mode: Mode, k: &Matrix) -> [f64; 3] {
        let (row, component, limit) = match mode {
            Mode::Tension => (0, trial.normal, self.limits.tension),
            Mode::Compression => (0, trial.normal, self.limits.compression),
            Mode::Shear => (1, trial.shear, self.limits.shear),
            Mode::Bending => (2, trial.moment, self.limits.bending),
        };
        k[row].map(|entry| entry * component.signum() / limit)
    }

    /// Energy that softening takes on the straight way from the remembered equilibrium to `v`, `[force·length]`:
    ///
    /// ```math
    /// \int \tfrac12\,v\cdot k v\;\frac{\kappa_u}{(\kappa_u-1)\,\kappa^2}\,d\kappa
    /// ```
    ///
    /// in closed form, piece by piece of κ as a function of the way.
    pub fn dissipation(
        &self,
        v: RelativeDisplacement,
        k: &Stiffness,
        memory: &ContactMemory,
    ) -> f64 {
        let damage = self.damage(v, k, memory);
        let from = memory.damage.utilisation.max(1.0);
        let Some(mode) = damage.mode else { return 0.0 };
        let ultimate = self.ultimate(k, mode);
        let to = damage.utilisation.min(ultimate);
        if to <= from {
            return 0.0;
        }
        ultimate / (ultimate - 1.0) * self.way(v, k, memory).integral(from, to)
    }

    /// The memory of a bond that came to `v` on the way from the remembered equilibrium.
    pub(super) fn memory_at(
        &self,
        v: RelativeDisplacement,
        k: &Stiffness,
        memory: &ContactMemory,
    ) -> ContactMemory {
        ContactMemory {
            displacement: v,
            damage: self.damage(v, k, memory),
            ..*memory
        }
    }

    /// What `dissipation` grows by with `v`: ½·v·k·v·∂d/∂κ·∂κ/∂v, `[force]`, `[force]`, `[force·length]`.
    pub fn dissipation_slope(
        &self,
        v: RelativeDisplacement,
        k: &Stiffness,
        memory: &ContactMemory,
    ) -> ContactForce {
        let trial = k.trial_force(v);
        let (rate, mode) = self.damage_rate(v, k, memory);
        let energy = 0.5 * work(trial, v);
        let matrix = [
            [k.normal, 0.0, k.coupling],
            [0.0, k.shear, 0.0],
            [k.coupling, 0.0, k.moment],
        ];
        let [normal, shear, moment] = self.utilisation_slope(trial, mode, &matrix);
        ContactForce {
            normal: energy * rate * normal,
            shear: energy * rate * shear,
            moment: energy * rate * moment,
        }
    }

    /// Energy that it still takes to break the bond if its displacement grows in proportion from the remembered one,
    /// `[force·length]`; none where it is not on its limit there.
    pub fn room(&self, k: &Stiffness, memory: &ContactMemory) -> Option<f64> {
        let v = memory.displacement;
        let (rate, _) = self.damage_rate(v, k, memory);
        let (reached, mode) = self.limits.utilisation(k.trial_force(v));
        let ultimate = self.ultimate(k, memory.damage.mode.unwrap_or(mode));
        let kappa = reached.max(1.0);
        (rate > 0.0).then(|| 0.5 * work(k.trial_force(v), v) * rate * (ultimate - kappa))
    }

    /// Share of the way from the remembered displacement by `step` at which the bond comes to its limit.
    pub fn meets_limit(
        &self,
        step: RelativeDisplacement,
        k: &Stiffness,
        memory: &ContactMemory,
    ) -> f64 {
        let v = memory.displacement;
        let end = RelativeDisplacement {
            normal: v.normal + step.normal,
            shear: v.shear + step.shear,
            rotation: v.rotation + step.rotation,
        };
        let limit = memory.damage.utilisation.max(1.0);
        first_to_meet(&self.way(end, k, memory).lines, limit).meets(limit)
    }

    /// Shares of the straight way from the remembered displacement to `v` at which the bond comes to its limit and
    /// breaks.
    pub fn corners(
        &self,
        v: RelativeDisplacement,
        k: &Stiffness,
        memory: &ContactMemory,
    ) -> [f64; 2] {
        let lines = self.way(v, k, memory).lines;
        let meets = |height| first_to_meet(&lines, height).meets(height);
        let mode = self.damage(v, k, memory).mode;
        let broken = mode.map_or(f64::INFINITY, |mode| meets(self.ultimate(k, mode)));
        [meets(memory.damage.utilisation.max(1.0)), broken]
    }

    /// Share of the force that is left, and the mode in which the bond began to soften.
    pub fn left(&self, k: &Stiffness, memory: &ContactMemory) -> (f64, Option<Mode>) {
        (1.0 - self.lost(k, &memory.damage), memory.damage.mode)
    }

    fn way(&self, v: RelativeDisplacement, k: &Stiffness, memory: &ContactMemory) -> Way {
        let start = memory.displacement;
        let step = RelativeDisplacement {
            normal: v.normal - start.normal,
            shear: v.shear - start.shear,
            rotation: v.rotation - start.rotation,
        };
        let (force, growth) = (k.trial_force(start), k.trial_force(step));
        let limits = &self.limits;
        let line = |mode, sign: f64, start, slope, limit| Line {
            mode,
            start: sign * start / limit,
            slope: sign * slope / limit,
        };
        let [n, t, m] = [
            (force.normal, growth.normal),
            (force.shear, growth.shear),
            (force.moment, growth.moment),
        ];
        Way {
            lines: [
                line(Mode::Tension, 1.0, n.0, n.1, limits.tension),
                line(Mode::Compression, -1.0, n.0, n.1, limits.compression),
                line(Mode::Shear, 1.0, t.0, t.1, limits.shear),
                line(Mode::Shear, -1.0, t.0, t.1, limits.shear),
                line(Mode::Bending, 1.0, m.0, m.1, limits.bending),
                line(Mode::Bending, -1.0, m.0, m.1, limits.bending),
            ],
            energy: [
                0.5 * work(force, start),
                work(force, step),
                0.5 * work(growth, step),
            ],
        }
    }
}

impl Way {
    /// ∫ ½·v·k·v/κ² dκ while κ, the upper envelope of the lines, grows from `from` to `to`.
    fn integral(&self, from: f64, to: f64) -> f64 {
        let mut line = first_to_meet(&self.lines, from);
        let (mut share, mut sum) = (line.meets(from).clamp(0.0, 1.0), 0.0);
        loop {
            let next = self.next_corner(line, share);
            let end = next
                .map_or(1.0, |(end, _)| end)
                .min(line.meets(to))
                .min(1.0);
            sum += self.piece(line, share, end);
            match next {
                Some((corner, other)) if corner <= end && corner < 1.0 => {
                    (share, line) = (corner, other);
                }
                _ => return sum,
            }
        }
    }

    /// Where a steeper line takes over from `line` after `share`.
    fn next_corner(&self, line: Line, share: f64) -> Option<(f64, Line)> {
        self.lines
            .iter()
            .filter(|other| other.slope > line.slope)
            .map(|other| {
                let corner = (line.start - other.start) / (other.slope - line.slope);
                (corner.max(share), *other)
            })
            .reduce(|first, next| {
                let earlier = next.0 < first.0 || next.0 == first.0 && next.1.slope > first.1.slope;
                if earlier { next } else { first }
            })
    }

    /// The integral over the part of the way on which κ is this line.
    fn piece(&self, line: Line, from: f64, to: f64) -> f64 {
        if to <= from {
            return 0.0;
        }
        let (length, kappa) = (to - from, line.at(from));
        let growth = line.slope * length / kappa;
        let [a, b, c] = self.energy;
        // The energy over this piece as a polynomial of the share of the piece.
        let energy = [
            a + from * (b + from * c),
            length * (b + 2.0 * from * c),
            length * length * c,
        ];
        let [i, j, k] = moments(growth);
        growth / kappa * (energy[0] * i + energy[1] * j + energy[2] * k)
    }
}

/// ∫₀¹ xⁿ/(1 + r·x)² dx for n = 0, 1, 2.
fn moments(r: f64) -> [f64; 3] {
    let reciprocal = 1.0 / (1.0 + r);
    if r < SERIES {
        return [reciprocal, moment_series(r, 1.0), moment_series(r, 2.0)];
    }
    let logarithm = libm::log1p(r);
    [
        reciprocal,
        (logarithm + reciprocal - 1.0) / (r * r),
        (1.0 + r - 2.0 * logarithm - reciprocal) / (r * r * r),
    ]
}

/// Σ (m + 1)·(−r)^m/(n + m + 1), to the last bit.
fn moment_series(r: f64, n: f64) -> f64 {
    let (mut sum, mut power, mut m) = (0.0, 1.0, 0.0);
    loop {
        let term = (m + 1.0) * power / (n + m + 1.0);
        if sum + term == sum {
            return sum;
        }
        sum += term;
        power *= -r;
        m += 1.0;
    }
}

/// The line that rises to `height` first; of those that do together, the steepest.
fn first_to_meet(lines: &[Line; 6], height: f64) -> Line {
    let earlier = |a: Line, b: Line| {
        let (at, other) = (a.meets(height), b.meets(height));
        if other < at || other == at && b.slope > a.slope {
            b
        } else {
            a
        }
    };
    lines[1..].iter().fold(lines[0], |a, b| earlier(a, *b))
}

fn work(force: ContactForce, v: RelativeDisplacement) -> f64 {
    force.normal * v.normal + force.shear * v.shear + force.moment * v.rotation
}

#[cfg(test)]
mod tests {
    use super::*;

    /// ∫ 1/(1+rx)² = 1/(1+r); both forms of the others agree where one hands over to the other.
    #[test]
    fn moments_by_series_and_in_closed_form_agree() {
        let [_, first, second] = moments(SERIES);
        assert!((first - moment_series(SERIES, 1.0)).abs() < 1e-14);
        assert!((second - moment_series(SERIES, 2.0)).abs() < 1e-13);
        assert_eq!(moments(0.0), [1.0, 0.5, 1.0 / 3.0]);
    }
}
