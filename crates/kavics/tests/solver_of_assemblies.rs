//! What a contact does for the whole, by the factor of the stiffness of packs: flexibility, removal, energy released.

mod network;

use kavics::solver::{SymmetricSolver, minimum_degree};
use network::{Entries, Network};

fn packs() -> [Network; 2] {
    [Network::hexagonal(12, 15), Network::dropped(300, 20.0, 7)]
}

fn solver(network: &Network) -> SymmetricSolver {
    let order = minimum_degree(&network.pattern).expect("memory");
    let mut solver = SymmetricSolver::new(&network.pattern, &order).expect("memory");
    let inertia = solver
        .factorise(&network.pattern, &network.values)
        .expect("a factor");
    assert_eq!(inertia.positive, network.unknowns());
    solver
}

/// Weight, and a little of everything else.
fn load(unknowns: usize) -> Vec<f64> {
    let others = |i: usize| 0.01 * ((i * 7 % 11) as f64 - 5.0);
    let weight = |i: usize| if i % 3 == 1 { -1.0 } else { 0.0 };
    (0..unknowns).map(|i| weight(i) + others(i)).collect()
}

fn displacements(solver: &mut SymmetricSolver, load: &[f64]) -> Vec<f64> {
    let mut u = load.to_vec();
    solver.solve(&mut u);
    u
}

/// Largest difference over largest value.
fn difference(a: &[f64], b: &[f64]) -> f64 {
    let largest = b.iter().fold(0.0, |most: f64, b| most.max(b.abs()));
    let pairs = a.iter().zip(b);
    pairs.fold(0.0, |most: f64, (a, b)| most.max((a - b).abs())) / largest
}

/// Wᵀu.
fn stretch(entries: &Entries, u: &[f64]) -> [f64; 3] {
    std::array::from_fn(|r| entries.iter().map(|(i, w)| w[r] * u[*i]).sum())
}

/// (1 − F)⁻¹p, by Cramer's rule.
fn amplified(flexibility: &[[f64; 3]; 3], p: [f64; 3]) -> [f64; 3] {
    let a: [[f64; 3]; 3] =
        std::array::from_fn(|i| std::array::from_fn(|j| f64::from(i == j) - flexibility[i][j]));
    let det = |a: &[[f64; 3]; 3]| {
        a[0][0] * (a[1][1] * a[2][2] - a[1][2] * a[2][1])
            - a[0][1] * (a[1][0] * a[2][2] - a[1][2] * a[2][0])
            + a[0][2] * (a[1][0] * a[2][1] - a[1][1] * a[2][0])
    };
    std::array::from_fn(|j| {
        let mut replaced = a;
        for i in 0..3 {
            replaced[i][j] = p[i];
        }
        det(&replaced) / det(&a)
    })
}

/// Contacts that can go without setting anything free, a stride apart.
fn removable(network: &Network, solver: &mut SymmetricSolver, count: usize) -> Vec<Entries> {
    let stride = network.contacts.len() / count;
    let some = network.contacts.iter().step_by(stride);
    let some = some.filter(|entries| {
        let flexibility = solver.flexibility::<3>(entries);
        (0..3).map(|r| flexibility[r][r]).fold(0.0, f64::max) < 0.95
    });
    some.cloned().collect()
}

/// Redundancy: Σ tr(k C) over the contacts is the number of unknowns.
#[test]
fn shares_of_the_contacts_add_up_to_the_number_of_unknowns() {
    for network in packs() {
        let mut solver = solver(&network);
        let shares = network.contacts.iter().map(|entries| {
            let flexibility = solver.flexibility::<3>(entries);
            (0..3).map(|r| flexibility[r][r]).sum::<f64>()
        });
        let sum: f64 = shares.sum();
        assert!(
            (sum / network.unknowns() as f64 - 1.0).abs() < 1e-12,
            "{sum}"
        );
    }
}

/// Sherman, Morrison and Woodbury: u' = u + K⁻¹W(1 − F)⁻¹Wᵀu.
#[test]
fn a_removed_contact_leaves_the_same_by_woodbury_by_downdate_and_by_a_new_factor() {
    for mut network in packs() {
        let (mut kept, mut changed) = (solver(&network), solver(&network));
        let load = load(network.unknowns());
        for entries in removable(&network, &mut kept, 5) {
            let mut u = displacements(&mut kept, &load);
            let p = amplified(&kept.flexibility(&entries), stretch(&entries, &u));
            let mut z = vec![[0.0; 3]; u.len()];
            kept.solve_sparse(&entries, &mut z);
            for (u, z) in u.iter_mut().zip(&z) {
                *u += z.iter().zip(&p).map(|(z, p)| z * p).sum::<f64>();
            }
            network.remove(&entries);
            kept = solver(&network);
            changed.remove(&entries).expect("no mechanism");
            let fresh = displacements(&mut kept, &load);
            assert!(difference(&u, &fresh) < 1e-9);
            assert!(difference(&displacements(&mut changed, &load), &fresh) < 1e-9);
        }
    }
}

/// At fixed load ½ f·u grows by ½ v·(k⁻¹ − C)⁻¹v, and by no less than ½ v·kv.
#[test]
fn the_energy_released_is_that_of_the_flexibility() {
    for network in packs() {
        let mut solver = solver(&network);
        let load = load(network.unknowns());
        let work = |u: &[f64]| 0.5 * load.iter().zip(u).map(|(f, u)| f * u).sum::<f64>();
        for entries in removable(&network, &mut solver, 6) {
            let u = displacements(&mut solver, &load);
            let v = stretch(&entries, &u);
            let q = amplified(&solver.flexibility(&entries), v);
            let released = 0.5 * (v[0] * q[0] + v[1] * q[1] + v[2] * q[2]);
            let own = 0.5 * (v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
            solver.remove(&entries).expect("no mechanism");
            let after = displacements(&mut solver, &load);
            // The difference of two works loses what they have in common.
            let rounding = 1e-11 * work(&after);
            assert!((work(&after) - work(&u) - released).abs() < rounding);
            assert!(released >= own);
        }
    }
}

#[test]
fn a_thousand_removals_leave_the_factor_of_what_is_left() {
    let mut network = Network::hexagonal(45, 50);
    let mut changed = solver(&network);
    let load = load(network.unknowns());
    let mut removed = 0;
    for contact in (0..network.contacts.len()).step_by(5) {
        let entries = network.contacts[contact].clone();
        let flexibility = changed.flexibility::<3>(&entries);
        if removed == 1000 || (0..3).any(|r| flexibility[r][r] > 0.9) {
            continue;
        }
        changed.remove(&entries).expect("no mechanism");
        network.remove(&entries);
        removed += 1;
    }
    assert_eq!(removed, 1000);
    let fresh = displacements(&mut solver(&network), &load);
    assert!(difference(&displacements(&mut changed, &load), &fresh) < 1e-9);
}

#[test]
fn a_factor_gives_the_same_bits_again() {
    let network = Network::dropped(200, 15.0, 3);
    let once = || {
        let mut solver = solver(&network);
        solver.remove(&network.contacts[100]).expect("no mechanism");
        displacements(&mut solver, &load(network.unknowns()))
    };
    let (first, again) = (once(), once());
    assert!(
        first
            .iter()
            .zip(&again)
            .all(|(a, b)| a.to_bits() == b.to_bits())
    );
}
