//! Pieces of the assembly: bodies tied together by active contacts.

use super::kinematics::ContactFrame;

/// Sets of bodies, merged contact by contact.
pub struct Pieces {
    parent: Vec<u32>,
}

impl Pieces {
    /// The pieces that the given contacts tie together.
    pub fn new<'a>(bodies: usize, contacts: impl Iterator<Item = &'a ContactFrame>) -> Self {
        let mut pieces = Self {
            parent: (0..bodies as u32).collect(),
        };
        for frame in contacts {
            let (first, second) = (pieces.root(frame.first.0), pieces.root(frame.second.0));
            // The lowest body stands for its piece.
            let (low, high) = (first.min(second), first.max(second));
            pieces.parent[high as usize] = low;
        }
        for body in 0..bodies as u32 {
            let root = pieces.root(body);
            pieces.parent[body as usize] = root;
        }
        pieces
    }

    fn root(&mut self, mut body: u32) -> u32 {
        while self.parent[body as usize] != body {
            let above = self.parent[self.parent[body as usize] as usize];
            self.parent[body as usize] = above;
            body = above;
        }
        body
    }

    /// The lowest body of each body's piece.
    pub fn of(&self, body: usize) -> usize {
        self.parent[body] as usize
    }

    /// For each body, whether its piece holds a body of which `flag` is true.
    pub fn any(&self, flag: impl Fn(usize) -> bool) -> Vec<bool> {
        let mut found = vec![false; self.parent.len()];
        for body in 0..self.parent.len() {
            if flag(body) {
                found[self.of(body)] = true;
            }
        }
        (0..self.parent.len())
            .map(|body| found[self.of(body)])
            .collect()
    }
}
