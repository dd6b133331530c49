//! A root in a bracket, after Oliveira & Takahashi (2020): interpolation, truncation, projection; never slower than
//! halving by more than one step.

/// Shares between 0, where the function is not positive, and 1, where it is.
#[derive(Debug)]
pub struct Bracket {
    /// Ends and values there.
    low: [f64; 2],
    high: [f64; 2],
    tolerance: f64,
    /// How far from the middle the next share may be, with half of the bracket: halves with each share.
    reach: f64,
}

impl Bracket {
    /// All shares; `low` and `high` are the values at 0 and 1.
    pub fn new(low: f64, high: f64, tolerance: f64) -> Self {
        let mut reach = tolerance;
        while reach < 0.5 {
            reach *= 2.0;
        }
        Self {
            low: [0.0, low],
            high: [1.0, high],
            tolerance,
            reach: 2.0 * reach,
        }
    }

    /// The next share to look at; none once the root is known.
    pub fn next(&mut self) -> Option<f64> {
        let ([a, fa], [b, fb]) = (self.low, self.high);
        let (width, middle) = (b - a, 0.5 * (a + b));
        if width <= self.tolerance || middle <= a || middle >= b {
            return None;
        }
        let straight = (fb * a - fa * b) / (fb - fa);
        let side = if straight <= middle { 1.0 } else { -1.0 };
        let truncated = 0.2 * width * width;
        let near = if truncated <= (middle - straight).abs() {
            straight + side * truncated
        } else {
            middle
        };
        let reach = (self.reach - 0.5 * width).max(0.0);
        self.reach *= 0.5;
        let share = if (near - middle).abs() <= reach {
            near
        } else {
            middle - side * reach
        };
        Some(if share > a && share < b {
            share
        } else {
            middle
        })
    }

    /// The value at a share.
    pub fn narrow(&mut self, share: f64, value: f64) {
        if value > 0.0 {
            self.high = [share, value];
        } else {
            self.low = [share, value];
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn root(f: impl Fn(f64) -> f64) -> (f64, usize) {
        let mut bracket = Bracket::new(f(0.0), f(1.0), 1e-12);
        let mut looks = 0;
        while let Some(share) = bracket.next() {
            bracket.narrow(share, f(share));
            looks += 1;
        }
        (bracket.high[0], looks)
    }

    #[test]
    fn a_root_is_found_to_the_tolerance() {
        let (found, looks) = root(|x| x * x - 0.3);
        assert!((found - 0.3_f64.sqrt()).abs() <= 1e-12);
        assert!(looks <= 12, "{looks}");
    }

    #[test]
    fn a_jump_is_no_slower_than_halving() {
        let (found, looks) = root(|x| if x < 0.7 { -1e-9 } else { 1e9 });
        assert!((found - 0.7).abs() <= 1e-12);
        assert!(looks <= 42, "{looks}");
    }
}
