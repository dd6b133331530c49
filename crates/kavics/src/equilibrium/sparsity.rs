//! Where the stiffness of each contact stands in the sparse stiffness of the assembly.
//!
//! The pattern follows from the bodies and contacts of the undeformed assembly and stays for the whole run: what a
//! broken contact leaves behind are zeros.

use super::kinematics::{Block, Blocks, ContactFrame, FREEDOMS};
use crate::solver::Pattern;

/// Numbers of the unknowns of each body; none where a freedom is held or moved.
pub type Numbers = [Option<u32>; FREEDOMS];

/// Which part of the matrix is stored.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stored {
    /// The lower triangle of a symmetric matrix.
    Lower,
    /// All of it.
    Full,
}

/// The pattern of the stiffness, and the places of the contacts in them.
#[derive(Debug)]
pub struct Sparsity {
    stored: Stored,
    /// The entries.
    pub pattern: Pattern,
    /// Per contact: entries above the second body's in a column of the first, and the other way round.
    places: Vec<[u32; 2]>,
    /// Per body: entries above its own in its columns.
    own: Vec<u32>,
}

impl Sparsity {
    /// The pattern of an assembly.
    pub fn new(numbers: &[Numbers], frames: &[ContactFrame], stored: Stored) -> Self {
        let neighbours = neighbours(numbers.len(), frames);
        let mut sparsity = Self {
            stored,
            pattern: Pattern {
                column_start: vec![0],
                row: Vec::new(),
            },
            places: vec![[0; 2]; frames.len()],
            own: vec![0; numbers.len()],
        };
        for (body, list) in neighbours.iter().enumerate() {
            sparsity.add_body(body, list, numbers);
        }
        sparsity
    }

    fn add_body(&mut self, body: usize, neighbours: &[Neighbour], numbers: &[Numbers]) {
        let own: Vec<u32> = numbers[body].iter().copied().flatten().collect();
        let mut rows: Vec<usize> = Vec::new();
        let mut own_added = self.stored == Stored::Lower;
        for (index, neighbour) in neighbours.iter().enumerate() {
            if self.stored == Stored::Lower && neighbour.body < body {
                continue;
            }
            if !own_added && neighbour.body > body {
                self.own[body] = rows.len() as u32;
                rows.extend(own.iter().map(|&n| n as usize));
                own_added = true;
            }
            let again = index > 0 && neighbours[index - 1].body == neighbour.body;
            let count = numbers[neighbour.body].iter().flatten().count();
            let place = if again {
                rows.len() - count
            } else {
                rows.len()
            };
            self.places[neighbour.contact][usize::from(neighbour.is_first)] = place as u32;
            if !again {
                rows.extend(
                    numbers[neighbour.body]
                        .iter()
                        .flatten()
                        .map(|&n| n as usize),
                );
            }
        }
        if !own_added {
            self.own[body] = rows.len() as u32;
            rows.extend(own.iter().map(|&n| n as usize));
        }
        for rank in 0..own.len() {
            if self.stored == Stored::Lower {
                self.pattern
                    .row
                    .extend(own[rank..].iter().map(|&n| n as usize));
            }
            self.pattern.row.extend(&rows);
            self.pattern.column_start.push(self.pattern.row.len());
        }
    }

    /// Adds a contact's stiffness to the values of the matrix.
    pub fn add(
        &self,
        values: &mut [f64],
        contact: usize,
        frame: &ContactFrame,
        numbers: &[Numbers],
        blocks: &Blocks,
    ) {
        let (first, second) = (frame.first.0 as usize, frame.second.0 as usize);
        self.add_own(values, first, &numbers[first], &blocks.first_first);
        self.add_own(values, second, &numbers[second], &blocks.second_second);
        let [second_in_first, first_in_second] = self.places[contact];
        if self.stored == Stored::Full || second > first {
            self.add_other(
                values,
                second_in_first,
                &numbers[second],
                &numbers[first],
                &blocks.second_first,
            );
        }
        if self.stored == Stored::Full || first > second {
            self.add_other(
                values,
                first_in_second,
                &numbers[first],
                &numbers[second],
                &blocks.first_second,
            );
        }
    }

    fn add_own(&self, values: &mut [f64], body: usize, numbers: &Numbers, block: &Block) {
        for (column_rank, (column, column_number)) in free(numbers).enumerate() {
            let start = self.pattern.column_start[column_number];
            for (row_rank, (row, _)) in free(numbers).enumerate() {
                match self.stored {
                    Stored::Full => {
                        values[start + self.own[body] as usize + row_rank] += block[row][column];
                    }
                    Stored::Lower if row_rank >= column_rank => {
                        values[start + row_rank - column_rank] += block[row][column];
                    }
                    Stored::Lower => {}
                }
            }
        }
    }

    fn add_other(
        &self,
        values: &mut [f64],
        place: u32,
        rows: &Numbers,
        columns: &Numbers,
        block: &Block,
    ) {
        let count = free(columns).count();
        for (column_rank, (column, column_number)) in free(columns).enumerate() {
            let own = if self.stored == Stored::Lower {
                count - column_rank
            } else {
                0
            };
            let start = self.pattern.column_start[column_number] + own + place as usize;
            for (row_rank, (row, _)) in free(rows).enumerate() {
                values[start + row_rank] += block[row][column];
            }
        }
    }
}

/// Index and number of the free freedoms.
fn free(numbers: &Numbers) -> impl Iterator<Item = (usize, usize)> + '_ {
    numbers
        .iter()
        .enumerate()
        .filter_map(|(index, number)| number.map(|n| (index, n as usize)))
}

struct Neighbour {
    body: usize,
    contact: usize,
    /// Whether the neighbour is the contact's first body.
    is_first: bool,
}

fn neighbours(bodies: usize, frames: &[ContactFrame]) -> Vec<Vec<Neighbour>> {
    let mut lists: Vec<Vec<Neighbour>> = (0..bodies).map(|_| Vec::new()).collect();
    for (contact, frame) in frames.iter().enumerate() {
        let (first, second) = (frame.first.0 as usize, frame.second.0 as usize);
        lists[first].push(Neighbour {
            body: second,
            contact,
            is_first: false,
        });
        lists[second].push(Neighbour {
            body: first,
            contact,
            is_first: true,
        });
    }
    for list in &mut lists {
        list.sort_by_key(|neighbour| (neighbour.body, neighbour.contact));
    }
    lists
}
