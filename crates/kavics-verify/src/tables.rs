//! Rows of the tables as structs, for identities that are recomputed from them.

use std::ops::{Add, Mul, Sub};

use kavics_results::Columns;

use crate::run::Run;

/// A vector in the plane.
#[derive(Clone, Copy, Debug, Default)]
pub struct Vector(
    /// To the right.
    pub f64,
    /// Upwards.
    pub f64,
);

impl Vector {
    /// Scalar product.
    pub fn dot(self, other: Self) -> f64 {
        self.0 * other.0 + self.1 * other.1
    }

    /// The component of the vector product that leaves the plane.
    pub fn cross(self, other: Self) -> f64 {
        self.0 * other.1 - self.1 * other.0
    }

    /// Turned counter-clockwise by a right angle.
    #[must_use]
    pub fn quarter_turn(self) -> Self {
        Self(-self.1, self.0)
    }

    /// Its length.
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
    /// Centre before loading, `[length]`.
    pub centre: Vector,
    /// Radius, `[length]`.
    pub radius: f64,
    /// Displacement, `[length]`.
    pub translation: Vector,
    /// Rotation.
    pub rotation: f64,
    /// External force and reaction, `[force]`.
    pub force: Vector,
    /// Moment, `[force·length]`.
    pub moment: f64,
    /// Area of its power cell, `[length²]`.
    pub cell_area: f64,
    /// xx, xy, yx, yy.
    pub stress: [f64; 4],
    /// State.
    pub state: String,
}

/// A row of `contacts`.
#[derive(Clone, Debug)]
pub struct ContactRow {
    /// First grain.
    pub first: usize,
    /// None: a side.
    pub second: Option<usize>,
    /// Contact normal.
    pub normal: Vector,
    /// Branch length, `[length]`.
    pub branch_length: f64,
    /// Dual length for the stiffness, `[length]`.
    pub dual_length: f64,
    /// Dual length in full, `[length]`.
    pub dual_length_full: f64,
    /// Opening, shear, relative rotation.
    pub displacement: [f64; 3],
    /// Of the contact on its first partner.
    pub force: Vector,
    /// Normal force, `[force]`.
    pub normal_force: f64,
    /// Shear force, `[force]`.
    pub shear_force: f64,
    /// Moment, `[force·length]`.
    pub moment: f64,
    /// Contact point before loading, `[length]`.
    pub point: Vector,
    /// State.
    pub state: String,
}

/// A contact seen from one of its grains: normal outward, force and moment on that grain.
#[derive(Clone, Copy, Debug)]
pub struct Half {
    /// The grain.
    pub grain: usize,
    /// Contact normal.
    pub normal: Vector,
    /// Force, `[force]`.
    pub force: Vector,
    /// Moment, `[force·length]`.
    pub moment: f64,
    /// From its centre to the contact point, `[length]`.
    pub lever: Vector,
}

/// The tables of one load step.
#[derive(Clone, Debug)]
pub struct Tables {
    /// Every grain.
    pub grains: Vec<GrainRow>,
    /// Every contact.
    pub contacts: Vec<ContactRow>,
    /// Force, moment, translation and rotation of each side by its id; zero where there is none.
    pub sides: Vec<(Vector, f64, Vector, f64)>,
}

struct Reader(Columns);

impl Reader {
    fn numbers(&self, column: &str) -> Result<Vec<f64>, String> {
        self.0.numbers(column).map_err(|error| error.to_string())
    }

    fn several<const N: usize>(&self, columns: [&str; N]) -> Result<[Vec<f64>; N], String> {
        let mut all = [const { Vec::new() }; N];
        for (values, column) in all.iter_mut().zip(columns) {
            *values = self.numbers(column)?;
        }
        Ok(all)
    }

    fn vectors(&self, x: &str, y: &str) -> Result<Vec<Vector>, String> {
        let pairs = self.numbers(x)?.into_iter().zip(self.numbers(y)?);
        Ok(pairs.map(|(x, y)| Vector(x, y)).collect())
    }

    fn words(&self, column: &str) -> Result<Vec<String>, String> {
        let words = self.0.texts(column).map_err(|error| error.to_string())?;
        Ok(words.into_iter().map(str::to_owned).collect())
    }
}

impl Tables {
    /// The tables of a run at a load step.
    ///
    /// # Errors
    /// Tables that cannot be read, in words.
    pub fn read(run: &Run, step: usize) -> Result<Self, String> {
        let table = |name| run.table(name, step).map(Reader);
        Ok(Self {
            grains: grains(&table("grains")?)?,
            contacts: contacts(&table("contacts")?)?,
            sides: sides(&table("sides")?)?,
        })
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

    /// The largest contact force, `[force]`.
    pub fn largest_force(&self) -> f64 {
        let forces = self.contacts.iter().map(|c| c.force.length());
        forces.fold(0.0, f64::max)
    }

    /// Area of all cells, `[length²]`.
    pub fn area(&self) -> f64 {
        self.grains.iter().map(|grain| grain.cell_area).sum()
    }
}

fn grains(table: &Reader) -> Result<Vec<GrainRow>, String> {
    let (centre, translation) = (table.vectors("x", "y")?, table.vectors("ux", "uy")?);
    let force = table.vectors("fx", "fy")?;
    let [radius, rotation, moment, area] =
        table.several(["radius", "rotation", "moment", "cell_area"])?;
    let stress = table.several(["stress_xx", "stress_xy", "stress_yx", "stress_yy"])?;
    let state = table.words("state")?;
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
    Ok((0..radius.len()).map(row).collect())
}

fn contacts(table: &Reader) -> Result<Vec<ContactRow>, String> {
    let (normal, point) = (table.vectors("nx", "ny")?, table.vectors("x", "y")?);
    let [first, second] = table.several(["first", "second"])?;
    let lengths = table.several(["branch_length", "dual_length", "dual_length_full"])?;
    let displacement = table.several(["opening", "shear", "relative_rotation"])?;
    let forces = table.several(["normal_force", "shear_force", "bending_moment"])?;
    let state = table.words("state")?;
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
    Ok((0..first.len()).map(row).collect())
}

fn sides(table: &Reader) -> Result<Vec<(Vector, f64, Vector, f64)>, String> {
    let (force, translation) = (table.vectors("fx", "fy")?, table.vectors("ux", "uy")?);
    let [moment, rotation, sides] = table.several(["moment", "rotation", "side"])?;
    // Four of a box, present or not.
    let count = sides.iter().fold(3.0, |a: f64, b| a.max(*b)) as usize + 1;
    let mut all = vec![Default::default(); count];
    for (i, side) in sides.into_iter().enumerate() {
        all[side as usize] = (force[i], moment[i], translation[i], rotation[i]);
    }
    Ok(all)
}
