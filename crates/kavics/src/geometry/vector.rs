//! Vectors of the plane.

use std::ops::{Add, Mul, Neg, Sub};

/// A point or vector of the plane.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Vector {
    /// Component to the right.
    pub x: f64,
    /// Component upwards.
    pub y: f64,
}

impl Vector {
    /// The vector (`x`, `y`).
    pub const fn new(x: f64, y: f64) -> Self {
        Self { x, y }
    }

    /// Inner product a·b.
    pub fn dot(self, other: Self) -> f64 {
        self.x * other.x + self.y * other.y
    }

    /// The component of a×b that leaves the plane.
    pub fn cross(self, other: Self) -> f64 {
        self.x * other.y - self.y * other.x
    }

    /// This vector turned by a quarter turn, counter-clockwise.
    #[must_use]
    pub fn quarter_turn(self) -> Self {
        Self::new(-self.y, self.x)
    }

    /// Squared length.
    pub fn length_squared(self) -> f64 {
        self.dot(self)
    }

    /// Length.
    pub fn length(self) -> f64 {
        self.length_squared().sqrt()
    }
}

impl Add for Vector {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        Self::new(self.x + other.x, self.y + other.y)
    }
}

impl Sub for Vector {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        Self::new(self.x - other.x, self.y - other.y)
    }
}

impl Neg for Vector {
    type Output = Self;
    fn neg(self) -> Self {
        Self::new(-self.x, -self.y)
    }
}

impl Mul<f64> for Vector {
    type Output = Self;
    fn mul(self, factor: f64) -> Self {
        Self::new(self.x * factor, self.y * factor)
    }
}
