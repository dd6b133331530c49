//! Shapes gathered by their ink.

use crate::ink::Ink;
use crate::picture::{Pen, Picture, Shape};

/// Shapes by ink, in the order in which inks came first.
#[derive(Debug, Default)]
pub(crate) struct Groups {
    groups: Vec<(Ink, Vec<Shape>)>,
}

impl Groups {
    pub fn add(&mut self, ink: Ink, shape: Shape) {
        match self.groups.iter_mut().find(|(known, _)| *known == ink) {
            Some((_, shapes)) => shapes.push(shape),
            None => self.groups.push((ink, vec![shape])),
        }
    }

    pub fn fill(self, picture: &mut Picture) {
        for (ink, shapes) in self.groups {
            picture.fill(shapes, ink);
        }
    }

    pub fn stroke(self, picture: &mut Picture, pen: Pen) {
        for (ink, shapes) in self.groups {
            picture.stroke(shapes, ink, pen);
        }
    }
}
