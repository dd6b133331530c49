//! Radii in the order in which they come; a few wait together, so that a place too narrow for one may take a smaller one.

/// How many wait together.
const TOGETHER: usize = 8;

/// Radii that are not placed yet.
pub(super) struct Waiting {
    /// All others, the next one last.
    rest: Vec<f64>,
    /// Those that wait together, in the order of their coming.
    together: Vec<f64>,
    /// Which of them is tried next.
    turn: usize,
}

/// A radius that fits.
pub(super) struct Choice<T> {
    /// Its place among those that wait together.
    pub(super) index: usize,
    pub(super) radius: f64,
    /// Where or how it fits.
    pub(super) answer: T,
}

impl Waiting {
    /// All but the first radii wait.
    pub(super) fn new(mut radii: Vec<f64>, placed: usize) -> Self {
        radii.reverse();
        radii.truncate(radii.len() - placed);
        let mut waiting = Self {
            rest: radii,
            together: Vec::with_capacity(TOGETHER),
            turn: 0,
        };
        waiting.fill_up();
        waiting
    }

    pub(super) fn is_empty(&self) -> bool {
        self.together.is_empty()
    }

    /// The radius whose turn it is, if `fits` has an answer for it; or else the largest that fits below the limit that
    /// `or_below` tells, if it does. The turn goes on when a radius does not fit.
    pub(super) fn choose<T>(
        &mut self,
        mut fits: impl FnMut(f64) -> Option<T>,
        or_below: impl Fn(f64) -> Option<f64>,
    ) -> Option<Choice<T>> {
        let index = self.turn % self.together.len().max(1);
        let radius = *self.together.get(index)?;
        if let Some(answer) = fits(radius) {
            return Some(Choice {
                index,
                radius,
                answer,
            });
        }
        self.turn = index + 1;
        self.largest(or_below(radius)?, fits)
    }

    /// Those that wait together.
    pub(super) fn together(&self) -> &[f64] {
        &self.together
    }

    /// Takes away what was chosen last.
    pub(super) fn take(&mut self, index: usize) {
        self.together.remove(index);
        self.fill_up();
    }

    /// The largest radius below a `limit` that fits, by halving: where a grain fits, smaller ones mostly do.
    fn largest<T>(&self, limit: f64, mut fits: impl FnMut(f64) -> Option<T>) -> Option<Choice<T>> {
        let mut smaller: Vec<(usize, f64)> = self.together.iter().copied().enumerate().collect();
        smaller.retain(|&(_, radius)| radius < limit);
        smaller.sort_by(|a, b| a.1.total_cmp(&b.1));
        let mut choice = |&(index, radius): &(usize, f64)| {
            fits(radius).map(|answer| Choice {
                index,
                radius,
                answer,
            })
        };
        let mut found = choice(smaller.first()?)?;
        let (mut fitting, mut too_large) = (0, smaller.len());
        while too_large - fitting > 1 {
            let middle = fitting.midpoint(too_large);
            match choice(&smaller[middle]) {
                Some(larger) => (fitting, found) = (middle, larger),
                None => too_large = middle,
            }
        }
        Some(found)
    }

    fn fill_up(&mut self) {
        while self.together.len() < TOGETHER
            && let Some(radius) = self.rest.pop()
        {
            self.together.push(radius);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn taken(radii: &[f64], room: f64, or_smaller: bool) -> Option<f64> {
        let mut waiting = Waiting::new(radii.to_vec(), 0);
        let fits = |r: f64| (r <= room).then_some(());
        let chosen = waiting.choose(fits, |radius| or_smaller.then_some(radius))?;
        waiting.take(chosen.index);
        assert_eq!(waiting.rest.len() + waiting.together.len(), radii.len() - 1);
        Some(chosen.radius)
    }

    #[test]
    fn the_first_radius_is_taken_or_the_largest_smaller_one_that_fits() {
        let radii = [3.0, 1.0, 2.0, 4.0, 2.5];
        assert_eq!(taken(&radii, 9.0, true), Some(3.0));
        assert_eq!(taken(&radii, 2.7, true), Some(2.5));
        assert_eq!(taken(&radii, 2.2, true), Some(2.0));
        assert_eq!(taken(&radii, 0.5, true), None);
        assert_eq!(taken(&radii, 2.7, false), None);
        assert_eq!(taken(&[], 9.0, true), None);
    }

    #[test]
    fn only_the_next_few_wait_together() {
        let mut radii = vec![2.0; TOGETHER];
        radii.push(1.0);
        assert_eq!(taken(&radii, 1.5, true), None);
        radii.remove(0);
        assert_eq!(taken(&radii, 1.5, true), Some(1.0));
    }

    #[test]
    fn the_turn_goes_on_after_a_radius_that_does_not_fit() {
        let mut waiting = Waiting::new(vec![3.0, 1.0], 0);
        let mut asked = Vec::new();
        for _ in 0..3 {
            let nothing = waiting.choose(
                |r| {
                    asked.push(r);
                    None::<()>
                },
                |_| None,
            );
            assert!(nothing.is_none());
        }
        assert_eq!(asked, [3.0, 1.0, 3.0]);
    }
}
