//! Rows of the tables as structs, for identities that are recomputed from them.

use std::ops::{Add, Mul, Sub};

use kavics_results::Columns;

use super::Run;

/// A vector in the plane.
#[derive(Clone, Copy, Debug, Default)]
pub struct Vector(pub f64, pub f64);

impl Vector {
    pub fn dot(self, other: Self) -> f64 {
        self.0 * other.0 + self.1 * other.1
    }

    pub fn cross(self, other: Self) -> f64 {
        self.0 * other.1 - self.1 * other.0
    }

    pub fn quarter_turn(self) -> Self {
        Self(-self.1, self.0)
    }

    pub fn length(self) -> f64 {
        self.dot(self).sqrt()
    }
}

impl Add for Vector {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        Self(self.0 + other.0, self.1 + other.1)
    }
}

impl Sub for Vector {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        Self(self.0 - other.0, self.1 - other.1)
    }
}

impl Mul<f64> for Vector {
    type Output = Self;
    fn mul(self, factor: f64) -> Self {
        Self(self.0 * factor, self.1 * factor)
    }
}

/// A row of `grains`.
#[derive(Clone, Debug)]
pub struct GrainRow {
    pub centre: Vector,
    pub radius: f64,
    pub translation: Vector,
    pub rotation: f64,
    pub force: Vector,
    pub moment: f64,
    pub cell_area: f64,
    /// xx, xy, yx, yy.
    pub stress: [f64; 4],
    pub state: String,
}

/// A row of `contacts`.
#[derive(Clone, Debug)]
pub struct ContactRow {
    pub first: usize,
    /// None: a side.
    pub second: Option<usize>,
    pub normal: Vector,
    pub branch_length: f64,
    pub dual_length: f64,
    pub dual_length_full: f64,
    /// Opening, shear, relative rotation.
    pub displacement: [f64; 3],
    /// Of the contact on its first partner.
    pub force: Vector,
    pub normal_force: f64,
    pub shear_force: f64,
    pub moment: f64,
    pub point: Vector,
    pub state: String,
}

/// A contact seen from one of its grains: normal outward, force and moment on that grain.
#[derive(Clone, Copy, Debug)]
pub struct Half {
    pub grain: usize,
    pub normal: Vector,
    pub force: Vector,
    pub moment: f64,
    pub lever: Vector,
}

/// The tables of one load step.
#[derive(Clone, Debug)]
pub struct Tables {
    pub grains: Vec<GrainRow>,
    pub contacts: Vec<ContactRow>,
    /// Force, moment, translation and rotation of each side by its id; zero where there is none.
    pub sides: Vec<(Vector, f64, Vector, f64)>,
}

struct Reader(Columns);

impl Reader {
    fn numbers(&self, column: &str) -> Vec<f64> {
        self.0.numbers(column).expect("a column of numbers")
    }

    fn vectors(&self, x: &str, y: &str) -> Vec<Vector> {
        let pairs = self.numbers(x).into_iter().zip(self.numbers(y));
        pairs.map(|(x, y)| Vector(x, y)).collect()
    }

    fn words(&self, column: &str) -> Vec<String> {
        let words = self.0.texts(column).expect("a column of words");
        words.into_iter().map(str::to_owned).collect()
    }
}

impl Tables {
    pub fn read(run: &Run, step: usize) -> Self {
        let table = |name| Reader(run.table(name, step).expect("a table"));
        Self {
            grains: grains(&table("grains")),
            contacts: contacts(&table("contacts")),
            sides: sides(&table("sides")),
        }
    }

    /// Every contact from each of its grains.
    pub fn halves(&self) -> Vec<Half> {
        let mut halves = Vec::new();
        for contact in &self.contacts {
            let half = |grain: usize, sign: f64| Half {
                grain,
                normal: contact.normal * sign,
                force: contact.force * sign,
                moment: contact.moment * sign,
                lever: contact.point - self.grains[grain].centre,
            };
            halves.push(half(contact.first, 1.0));
            halves.extend(contact.second.map(|second| half(second, -1.0)));
        }
        halves
    }

    pub fn largest_force(&self) -> f64 {
        let forces = self.contacts.iter().map(|c| c.force.length());
        forces.fold(0.0, f64::max)
    }

    pub fn area(&self) -> f64 {
        self.grains.iter().map(|grain| grain.cell_area).sum()
    }
}

fn grains(table: &Reader) -> Vec<GrainRow> {
    let (centre, translation) = (table.vectors("x", "y"), table.vectors("ux", "uy"));
    let force = table.vectors("fx", "fy");
    let [radius, rotation, moment, area] =
        ["radius", "rotation", "moment", "cell_area"].map(|c| table.numbers(c));
    let stress =
        ["stress_xx", "stress_xy", "stress_yx", "stress_yy"].map(|name| table.numbers(name));
    let state = table.words("state");
    let row = |i: usize| GrainRow {
        centre: centre[i],
        radius: radius[i],
        translation: translation[i],
        rotation: rotation[i],
        force: force[i],
        moment: moment[i],
        cell_area: area[i],
        stress: [0, 1, 2, 3].map(|k| stress[k][i]),
        state: state[i].clone(),
    };
    (0..radius.len()).map(row).collect()
}

fn contacts(table: &Reader) -> Vec<ContactRow> {
    let (normal, point) = (table.vectors("nx", "ny"), table.vectors("x", "y"));
    let [first, second] = ["first", "second"].map(|c| table.numbers(c));
    let lengths =
        ["branch_length", "dual_length", "dual_length_full"].map(|name| table.numbers(name));
    let displacement = ["opening", "shear", "relative_rotation"].map(|name| table.numbers(name));
    let forces = ["normal_force", "shear_force", "bending_moment"].map(|name| table.numbers(name));
    let state = table.words("state");
    let row = |i: usize| ContactRow {
        first: first[i] as usize,
        second: (second[i] >= 0.0).then_some(second[i] as usize),
        normal: normal[i],
        branch_length: lengths[0][i],
        dual_length: lengths[1][i],
        dual_length_full: lengths[2][i],
        displacement: [0, 1, 2].map(|k| displacement[k][i]),
        force: normal[i] * forces[0][i] + normal[i].quarter_turn() * forces[1][i],
        normal_force: forces[0][i],
        shear_force: forces[1][i],
        moment: forces[2][i],
        point: point[i],
        state: state[i].clone(),
    };
    (0..first.len()).map(row).collect()
}

fn sides(table: &Reader) -> Vec<(Vector, f64, Vector, f64)> {
    let (force, translation) = (table.vectors("fx", "fy"), table.vectors("ux", "uy"));
    let (moment, rotation) = (table.numbers("moment"), table.numbers("rotation"));
    let sides = table.numbers("side");
    // Four of a box, present or not.
    let count = sides.iter().fold(3.0, |a: f64, b| a.max(*b)) as usize + 1;
    let mut all = vec![Default::default(); count];
    for (i, side) in sides.into_iter().enumerate() {
        all[side as usize] = (force[i], moment[i], translation[i], rotation[i]);
    }
    all
}
