//! The stiffness of an assembly of glued grains as a sparse matrix, K = Σ WWᵀ over the contacts.

use std::path::Path;

use kavics::assembly::Assembly;
use kavics::contact_law::ContactForce;
use kavics::equilibrium::{ContactFrame, Load};
use kavics::ids::{BodyId, Id};
use kavics::scene::Scene;
use kavics::solver::Pattern;

/// The rows of W that are not zero, by the number of the unknown.
pub type Entries = Vec<(usize, [f64; 3])>;

/// Unknowns are the displacements and rotations of the bodies that are not held.
pub struct Network {
    /// W of each contact that moves anything.
    pub contacts: Vec<Entries>,
    pub pattern: Pattern,
    pub values: Vec<f64>,
}

/// √ of the stiffnesses of every contact: normal, shear, moment.
const ROOTS: [f64; 3] = [1.0, 0.8, 0.5];

impl Network {
    fn new(assembly: &Assembly, is_held: impl Fn(BodyId) -> bool) -> Self {
        let mut numbers = vec![None; assembly.body_count()];
        let free = (0..numbers.len()).filter(|&body| !is_held(BodyId::from_index(body)));
        for (node, body) in free.enumerate() {
            numbers[body] = Some(node);
        }
        let contacts = assembly.contacts.values().iter();
        let contacts =
            contacts.map(|contact| entries(&ContactFrame::new(assembly, contact), &numbers));
        let contacts: Vec<Entries> = contacts.filter(|entries| !entries.is_empty()).collect();
        let pattern = pattern(numbers.iter().flatten().count(), &contacts);
        let mut values = vec![0.0; pattern.row.len()];
        for contact in &contacts {
            add(&pattern, &mut values, contact, 1.0);
        }
        Self {
            contacts,
            pattern,
            values,
        }
    }

    /// Equal grains in rows of so many and one less; the bottom row is held.
    pub fn hexagonal(rows: usize, longest: usize) -> Self {
        let assembly = assembly(&format!(
            "[box]\nwidth = {:?}\nheight = \"fit\"\n[grains.hexagonal]\nradius = 1.0\n\
             rows = {{ count = {rows}, longest = {longest} }}\n[contact.glue.cemented]\n\
             stiffness.layer = {{ normal = 1.0, shear = 0.6 }}\n",
            2.0 * longest as f64
        ));
        let lowest = assembly.grains.values().iter().map(|grain| grain.centre.y);
        let lowest = lowest.fold(f64::INFINITY, f64::min);
        Self::new(&assembly, |body| {
            let grain = assembly.grains.values().get(body.index());
            grain.is_none_or(|grain| grain.centre.y < lowest + 0.5)
        })
    }

    /// Dropped grains, glued to a floor and to the sides, which are held.
    #[allow(dead_code, reason = "the bench takes the regular block alone")]
    pub fn dropped(count: usize, width: f64, seed: u64) -> Self {
        let assembly = assembly(&format!(
            "seed = {seed}\n[box]\nwidth = {width:?}\nheight = \"fit\"\n[grains.dropped]\n\
             count = {count}\nradius = {{ from = 0.5, to = 1.5 }}\n[contact.glue.cemented]\n\
             stiffness.layer = {{ normal = 1.0, shear = 0.6 }}\n[side.bottom]\ncontact = \"glue\"\n\
             [side.left]\ncontact = \"glue\"\n[side.right]\ncontact = \"glue\"\n"
        ));
        Self::new(&assembly, |body| body.index() >= assembly.grains.len())
    }

    pub fn unknowns(&self) -> usize {
        self.pattern.order()
    }

    /// Takes WWᵀ from the values.
    #[allow(dead_code, reason = "the bench keeps the matrix")]
    pub fn remove(&mut self, entries: &Entries) {
        add(&self.pattern, &mut self.values, entries, -1.0);
    }
}

fn assembly(text: &str) -> Assembly {
    let loads = "[[load]]\nname = \"press\"\nedge = \"top\"\nnormal = [-0.01, -0.01]\n\
                 [[stage]]\nfactors = [1.0]\n";
    let no_lists = |_: &Path, _: Option<usize>| Err(String::new());
    let support = "[[support]]\ngrains = { edge = \"bottom\" }\nfix = [\"x\", \"y\"]\n";
    let text = format!("{text}{support}{loads}");
    let scene = Scene::parse(&text, "network", Path::new(""), &no_lists);
    scene.expect("a right scene").assembly
}

fn entries(frame: &ContactFrame, numbers: &[Option<usize>]) -> Entries {
    let unit = |normal, shear, moment| {
        frame.loads(ContactForce {
            normal,
            shear,
            moment,
        })
    };
    let [n, t, m] = ROOTS;
    let columns = [unit(n, 0.0, 0.0), unit(0.0, t, 0.0), unit(0.0, 0.0, m)];
    let bodies = [frame.first, frame.second].into_iter().enumerate();
    let free = bodies.filter_map(|(side, body)| Some((side, numbers[body.index()]?)));
    free.flat_map(|(side, node)| {
        let loads = columns.map(|column: [Load; 2]| column[side].components());
        (0..3).map(move |i| (3 * node + i, loads.map(|load| load[i])))
    })
    .collect()
}

fn pattern(nodes: usize, contacts: &[Entries]) -> Pattern {
    let mut later = vec![Vec::new(); nodes];
    for contact in contacts {
        let (a, b) = (contact[0].0 / 3, contact[contact.len() - 1].0 / 3);
        later[a.min(b)].push(a.max(b));
    }
    let mut pattern = Pattern {
        column_start: vec![0],
        row: Vec::new(),
    };
    for (node, later) in later.iter_mut().enumerate() {
        later.push(node);
        later.sort_unstable();
        later.dedup();
        for column in 3 * node..3 * node + 3 {
            let rows = later.iter().flat_map(|node| 3 * node..3 * node + 3);
            pattern.row.extend(rows.filter(|&row| row >= column));
            pattern.column_start.push(pattern.row.len());
        }
    }
    pattern
}

fn add(pattern: &Pattern, values: &mut [f64], entries: &Entries, factor: f64) {
    for (row, a) in entries {
        for (column, b) in entries.iter().filter(|(column, _)| column <= row) {
            let start = pattern.column_start[*column];
            let rows = &pattern.row[start..pattern.column_start[column + 1]];
            let place = rows.binary_search(row).expect("an entry of the pattern");
            let product: f64 = a.iter().zip(b).map(|(a, b)| a * b).sum();
            values[start + place] += factor * product;
        }
    }
}
