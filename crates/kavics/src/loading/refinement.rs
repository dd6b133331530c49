//! A way that is divided where its work is known worst, with extrapolation in every part.

use super::work::{Sample, Work};

/// A part is halved at most so often.
const MOST_HALVINGS: usize = 12;
/// An error is little beside another at this share of it.
const LITTLE: f64 = 0.1;

/// A part of the way: whole, or in two halves.
struct Part {
    /// Its samples.
    ends: [usize; 2],
    shares: [f64; 2],
    halvings: usize,
    within: Option<usize>,
    halves: Option<[usize; 2]>,
    /// Extrapolated from 1, 2, 4, … equal parts.
    levels: Vec<Work>,
    best: Work,
    error: f64,
}

/// A way in parts; the first part is the whole.
pub struct Refinement {
    /// Equilibria on the way, in the order in which they were found.
    pub samples: Vec<Sample>,
    parts: Vec<Part>,
}

impl Refinement {
    /// A way in one part between two equilibria.
    pub fn new(ends: Vec<Sample>, work: Work) -> Self {
        Self {
            samples: ends,
            parts: vec![Part::new([0, 1], [0.0, 1.0], 0, None, work)],
        }
    }

    /// The best that is known of the work.
    pub fn work(&self) -> &Work {
        &self.parts[0].best
    }

    /// Estimate of its error.
    pub fn error(&self) -> f64 {
        self.parts[0].error
    }

    /// The undivided part that has the largest share of the error, of those that may still be divided.
    ///
    /// What is left of the error of a part is left of that of its halves, each in its measure: where extrapolation does
    /// well, dividing the halves gains nothing. None where parts that may not be divided leave more than `allowed`, and
    /// the others little beside that: the way is not continuous there.
    pub fn worst(&self, allowed: f64) -> Option<usize> {
        let mut shares = vec![self.error(); self.parts.len()];
        let mut worst: Option<usize> = None;
        let mut fixed = 0.0;
        for (place, part) in self.parts.iter().enumerate() {
            let Some(halves) = part.halves else {
                let is_worse = worst.is_none_or(|other| shares[place] > shares[other]);
                if part.halvings >= MOST_HALVINGS {
                    fixed += shares[place];
                } else if is_worse {
                    worst = Some(place);
                }
                continue;
            };
            let errors = halves.map(|half| self.parts[half].error);
            for (half, error) in halves.into_iter().zip(errors) {
                shares[half] =
                    shares[place] * error / (errors[0] + errors[1]).max(f64::MIN_POSITIVE);
            }
        }
        worst.filter(|&place| fixed <= allowed || shares[place] > LITTLE * fixed)
    }

    /// Leaves a part as it is.
    pub fn give_up(&mut self, part: usize) {
        self.parts[part].halvings = MOST_HALVINGS;
    }

    /// The two ends of a part, as shares of the way.
    pub fn shares(&self, part: usize) -> [f64; 2] {
        self.parts[part].shares
    }

    /// The equilibria at the two ends of a part.
    pub fn ends(&self, part: usize) -> [&Sample; 2] {
        self.parts[part].ends.map(|end| &self.samples[end])
    }

    /// Divides a part in halves at an equilibrium in its middle.
    pub fn split(&mut self, part: usize, sample: Sample, works: [Work; 2]) {
        let middle = self.samples.len();
        self.samples.push(sample);
        let Part {
            ends: [from, to],
            shares: [start, end],
            halvings,
            ..
        } = self.parts[part];
        let centre = 0.5 * (start + end);
        let next = self.parts.len();
        let spans = [
            ([from, middle], [start, centre]),
            ([middle, to], [centre, end]),
        ];
        for ((ends, shares), work) in spans.into_iter().zip(works) {
            let half = Part::new(ends, shares, halvings + 1, Some(part), work);
            self.parts.push(half);
        }
        self.parts[part].halves = Some([next, next + 1]);
        let mut above = Some(part);
        while let Some(part) = above {
            self.extrapolate(part);
            above = self.parts[part].within;
        }
    }

    /// Romberg's scheme from the halves of a part; where it does worse than they do by themselves, their sum.
    fn extrapolate(&mut self, part: usize) {
        let Some(halves) = self.parts[part].halves else {
            return;
        };
        let [first, second] = halves.map(|half| &self.parts[half]);
        let mut levels = vec![self.parts[part].levels[0].clone()];
        let mut weight = 1.0;
        for (one, other) in first.levels.iter().zip(&second.levels) {
            weight *= 4.0;
            let both = one.plus(1.0, other);
            let last = &levels[levels.len() - 1];
            levels.push(both.plus(1.0 / (weight - 1.0), &both.plus(-1.0, last)));
        }
        let (mut best, mut error) = (
            first.best.plus(1.0, &second.best),
            first.error + second.error,
        );
        let extrapolated = error_of(&levels);
        if extrapolated <= error {
            (best, error) = (levels[levels.len() - 1].clone(), extrapolated);
        }
        let part = &mut self.parts[part];
        (part.levels, part.best, part.error) = (levels, best, error);
    }
}

impl Part {
    fn new(
        ends: [usize; 2],
        shares: [f64; 2],
        halvings: usize,
        within: Option<usize>,
        work: Work,
    ) -> Self {
        Self {
            ends,
            shares,
            halvings,
            within,
            halves: None,
            error: work.imbalance().abs(),
            best: work.clone(),
            levels: vec![work],
        }
    }
}

/// Error of the last level: what does not add up, or what the next difference would be if differences went on to fall
/// as the last ones did.
fn error_of(levels: &[Work]) -> f64 {
    let last = levels.len() - 1;
    let difference = |level: usize| {
        if level == 0 {
            levels[0].largest()
        } else {
            levels[level].plus(-1.0, &levels[level - 1]).largest()
        }
    };
    let (before, now) = (difference(last - 1), difference(last));
    let next = if now == 0.0 { 0.0 } else { now * now / before };
    levels[last].imbalance().abs().max(next)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// ∫ f dg by the trapezoid, with f = x³ + 2, g = x⁴ + x on [0, 1]: exact 4/7 + 1/4 + 2·2.
    fn trapezoid([from, to]: [f64; 2]) -> Work {
        let f = |x: f64| x * x * x + 2.0;
        let g = |x: f64| x * x * x * x + x;
        let external = 0.5 * (f(from) + f(to)) * (g(to) - g(from));
        Work {
            external,
            elastic: primitive(to) - primitive(from),
            ..Work::default()
        }
    }

    /// ∫ (x³ + 2)·(4·x³ + 1) dx.
    fn primitive(x: f64) -> f64 {
        4.0 * x * x * x * x * x * x * x / 7.0 + 9.0 * x * x * x * x / 4.0 + 2.0 * x
    }

    fn divide(refinement: &mut Refinement, part: usize) {
        let [from, to] = refinement.shares(part);
        let middle = 0.5 * (from + to);
        let halves = [[from, middle], [middle, to]].map(trapezoid);
        refinement.split(part, Sample::default(), halves);
    }

    fn whole() -> Refinement {
        let ends = vec![Sample::default(), Sample::default()];
        Refinement::new(ends, trapezoid([0.0, 1.0]))
    }

    #[test]
    fn each_level_of_extrapolation_is_two_orders_better() {
        // f dg is a polynomial of degree 6 in x: its fourth level is exact.
        let mut refinement = whole();
        let mut errors = vec![refinement.work().imbalance().abs()];
        for parts in [1, 2, 4] {
            let leaves: Vec<usize> = (0..refinement.parts.len())
                .filter(|&part| refinement.parts[part].halves.is_none())
                .collect();
            assert_eq!(leaves.len(), parts);
            for leaf in leaves {
                divide(&mut refinement, leaf);
            }
            let levels = &refinement.parts[0].levels;
            errors.push(levels[levels.len() - 1].imbalance().abs());
        }
        assert!(errors[1] < 0.2 * errors[0] && errors[2] < 0.02 * errors[1]);
        assert!(errors[3] < 1e-14);
    }

    #[test]
    fn the_part_with_the_largest_error_is_divided_until_it_is_too_small() {
        let mut refinement = whole();
        assert_eq!(refinement.worst(0.0), Some(0));
        divide(&mut refinement, 0);
        // The trapezoid is off by 0.0151 in the first half and by 0.0072 in the second.
        assert_eq!(refinement.worst(0.0), Some(1));
        let mut part = 1;
        for _ in 1..MOST_HALVINGS {
            divide(&mut refinement, part);
            part = refinement.parts.len() - 1;
        }
        // The other parts are still there to be divided.
        let other = refinement.worst(1.0).expect("a part");
        assert_ne!(other, part);
        assert!(refinement.parts[other].halves.is_none());
        // Beside a jump they are not worth it.
        let mut above = Some(part);
        while let Some(part) = above {
            refinement.parts[part].error += 10.0;
            above = refinement.parts[part].within;
        }
        assert_eq!(refinement.worst(1.0), None);
    }
}
