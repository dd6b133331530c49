//! Eigenvalues of the tangent, second-order work, static indeterminacy.

use std::path::Path;

use faer::{Mat, Side};
use kavics::assembly::Partner;
use kavics::contact_law::Matrix;
use kavics::equilibrium::{
    ContactFrame, Equilibrium, FREEDOMS, Freedom, Stability, StabilitySummary,
};
use kavics::ids::{BodyId, GrainId, Id, PerContact};
use kavics::scene::Scene;

fn parse(text: &str) -> Scene {
    let lists = |_: &Path, _: Option<usize>| Err("no lists here".to_owned());
    Scene::parse(text, "stability.toml", Path::new("."), &lists).expect("a scene")
}

/// A dropped pack glued to the floor, loaded by its weight.
fn pack(count: usize, seed: u64, moment: f64) -> Scene {
    parse(&format!(
        "seed = {seed}\n[box]\nwidth = 14.0\nheight = \"fit\"\n\
         [grains.dropped]\ncount = {count}\nradius = {{ from = 0.5, to = 1.0 }}\n\
         [contact.mortar.cemented]\n\
         stiffness.direct = {{ normal = 1000.0, shear = 400.0, moment = {moment} }}\n\
         [side.bottom]\ncontact = \"mortar\"\n\
         [weight]\ndensity = 1.0\n\
         [[stage]]\nfactors = [0.5, 1.0]\n\
         [measure]\nstability = 6\nmoduli = true\n"
    ))
}

fn end(scene: &Scene) -> Equilibrium {
    let last = scene.load_path().last();
    last.expect("a load step").expect("an equilibrium")
}

fn stability(equilibrium: &Equilibrium) -> &Stability {
    equilibrium.stability.as_ref().expect("it is asked for")
}

/// The tangent with all freedoms, by the frames of the contacts; symmetric part.
fn dense(scene: &Scene, tangents: &PerContact<Matrix>) -> Mat<f64> {
    let order = FREEDOMS * scene.assembly.body_count();
    let mut matrix = Mat::<f64>::zeros(order, order);
    for (contact, k) in scene
        .assembly
        .contacts
        .values()
        .iter()
        .zip(tangents.values())
    {
        let frame = ContactFrame::new(&scene.assembly, contact);
        let blocks = frame.stiffness(k);
        let (one, two) = (
            FREEDOMS * frame.first.index(),
            FREEDOMS * frame.second.index(),
        );
        let places = [
            (one, one, blocks.first_first),
            (one, two, blocks.first_second),
            (two, one, blocks.second_first),
            (two, two, blocks.second_second),
        ];
        for (row, column, block) in places {
            for i in 0..FREEDOMS {
                for j in 0..FREEDOMS {
                    matrix[(row + i, column + j)] += 0.5 * block[i][j];
                    matrix[(column + j, row + i)] += 0.5 * block[i][j];
                }
            }
        }
    }
    matrix
}

/// Numbers of the freedoms that are neither held nor moved.
fn free(scene: &Scene) -> Vec<usize> {
    let held = scene.program.held.iter().map(|h| (h.body, h.freedom));
    let moved = scene.program.prescribed.iter().map(|p| (p.body, p.freedom));
    let bound: Vec<(BodyId, Freedom)> = held.chain(moved).collect();
    let present = |body: BodyId| match scene.assembly.partner(body) {
        Partner::Grain(_) => true,
        Partner::Side(side) => scene.assembly.sides[side].present,
    };
    let bodies = (0..scene.assembly.body_count()).map(BodyId::from_index);
    let all = bodies.filter(|&body| present(body)).flat_map(|body| {
        [Freedom::X, Freedom::Y, Freedom::Rotation].map(|freedom| (body, freedom))
    });
    all.filter(|freedom| !bound.contains(freedom))
        .map(|(body, freedom)| FREEDOMS * body.index() + freedom.index())
        .collect()
}

fn arm(scene: &Scene, body: usize) -> f64 {
    let partner = scene.assembly.partner(BodyId::from_index(body));
    scene.assembly.moment_arm(partner)
}

/// Eigenvalues of the free part, rotations by what they move at the rim, in rising order.
fn dense_eigenvalues(scene: &Scene, tangents: &PerContact<Matrix>) -> Vec<f64> {
    let (matrix, free) = (dense(scene, tangents), free(scene));
    let scale = |freedom: usize| match freedom % FREEDOMS {
        2 => 1.0 / arm(scene, freedom / FREEDOMS),
        _ => 1.0,
    };
    let entry = |i: usize, j: usize| matrix[(free[i], free[j])] * scale(free[i]) * scale(free[j]);
    let part = Mat::from_fn(free.len(), free.len(), entry);
    part.self_adjoint_eigenvalues(Side::Lower)
        .expect("eigenvalues")
}

#[test]
fn the_lowest_eigenvalues_are_those_of_the_dense_tangent() {
    // The last two packs are solved sparse.
    for (count, seed) in [(20, 1), (60, 2), (150, 3)] {
        let scene = pack(count, seed, 50.0);
        let end = end(&scene);
        let dense = dense_eigenvalues(&scene, end.tangents.as_ref().expect("asked for"));
        let modes = &stability(&end).modes;
        assert_eq!(modes.len(), 6);
        for (mode, expected) in modes.iter().zip(&dense) {
            assert!(
                (mode.eigenvalue / expected - 1.0).abs() < 1e-9,
                "{expected}"
            );
        }
    }
}

#[test]
fn a_mode_is_an_eigenvector_with_largest_amplitude_one() {
    let scene = pack(150, 4, 50.0);
    let end = end(&scene);
    let matrix = dense(&scene, end.tangents.as_ref().expect("asked for"));
    for mode in &stability(&end).modes {
        let u: Vec<f64> = mode
            .displacements
            .values()
            .iter()
            .flat_map(|u| u.components())
            .collect();
        let mut largest = 0.0_f64;
        for &row in &free(&scene) {
            let force: f64 = (0..u.len())
                .map(|column| matrix[(row, column)] * u[column])
                .sum();
            let arm = if row % FREEDOMS == 2 {
                arm(&scene, row / FREEDOMS)
            } else {
                1.0
            };
            assert!((force / arm - mode.eigenvalue * u[row] * arm).abs() < 1e-6);
        }
        let mut sums = [0.0; 2];
        for (body, u) in mode.displacements.values().iter().enumerate() {
            let amplitude = u.x.hypot(u.y).hypot(u.rotation * arm(&scene, body));
            largest = largest.max(amplitude);
            sums[0] += amplitude.powi(2);
            sums[1] += amplitude.powi(4);
        }
        assert!((largest - 1.0).abs() < 1e-12);
        assert!((mode.participation - sums[0].powi(2) / sums[1]).abs() < 1e-9);
        let first = mode.displacements[BodyId(mode.foremost[0].0)];
        let amplitude = first
            .x
            .hypot(first.y)
            .hypot(first.rotation * arm(&scene, mode.foremost[0].index()));
        assert!((amplitude - 1.0).abs() < 1e-12);
    }
}

/// Σ tr(k_c·C_c) = n with C_c = B_c·K⁻¹·B_cᵀ: what equilibrium leaves to the contacts is 3·N_c − n.
#[test]
fn redundancies_add_up_to_the_static_indeterminacy() {
    let scene = pack(30, 5, 50.0);
    let end = end(&scene);
    let tangents = end.tangents.as_ref().expect("asked for");
    let (matrix, free) = (dense(&scene, tangents), free(&scene));
    let part = Mat::from_fn(free.len(), free.len(), |i, j| matrix[(free[i], free[j])]);
    let eigen = part.self_adjoint_eigen(Side::Lower).expect("eigenvectors");
    // Of each contact alone: the trace of its stiffness times the inverse.
    let (mut determined, mut components) = (0.0, 0);
    for contact in 0..tangents.len() {
        let mut alone = PerContact::filled(Matrix::default(), tangents.len());
        alone.values_mut()[contact] = tangents.values()[contact];
        let own = dense(&scene, &alone);
        for mode in 0..free.len() {
            let x = |i: usize| eigen.U()[(i, mode)];
            let rows = (0..free.len()).filter(|&i| own[(free[i], free[i])] != 0.0);
            let rows: Vec<usize> = rows.collect();
            for &i in &rows {
                for &j in &rows {
                    let entry = own[(free[i], free[j])];
                    determined += x(i) * entry * x(j) / eigen.S()[mode];
                }
            }
        }
        components += 3;
    }
    assert!((determined - free.len() as f64).abs() < 1e-8 * free.len() as f64);
    let indeterminacy = stability(&end).summary.static_indeterminacy;
    assert!((components as f64 - determined - indeterminacy as f64).abs() < 1e-6);
}

const THREE_DISCS: &str = "[box]\nwidth = 4.0\nheight = \"fit\"\n\
     [grains.hexagonal]\nradius = 1.0\nrows = [2, 1]\n\
     [contact.bead.cemented]\nstiffness.direct = { normal = 2.0, shear = 1.0, moment = MOMENT }\n\
     [[support]]\ngrains = { ids = [0] }\nfix = [\"x\", \"y\"]\n\
     [[support]]\ngrains = { ids = [1] }\nfix = [\"y\"]\n\
     [[load]]\nname = \"press\"\ngrains = { ids = [2] }\nforce = { y = -0.1 }\n\
     [[stage]]\nfactors = [FACTOR]\n\
     [measure]\nstability = 2\n";

fn three_discs(moment: &str, factor: &str) -> Scene {
    parse(
        &THREE_DISCS
            .replace("MOMENT", moment)
            .replace("FACTOR", factor),
    )
}

fn summary(scene: &Scene) -> StabilitySummary {
    stability(&end(scene)).summary
}

/// Three contacts and six freedoms: nine force components with bending stiffness, six without.
#[test]
fn three_discs_are_three_times_indeterminate_by_their_moments() {
    let summary = summary(&three_discs("0.5", "1.0"));
    assert_eq!(
        (summary.static_indeterminacy, summary.zero_eigenvalues),
        (3, 0)
    );
    assert!(summary.lowest_eigenvalue.is_some_and(|lowest| lowest > 0.0));
}

/// Without the lower contact and without moments four force components hold six freedoms.
#[test]
fn three_discs_without_their_lower_contact_are_a_mechanism() {
    let mut scene = three_discs("0.0", "0.0");
    let contacts = scene.assembly.contacts.values().iter();
    let upper = contacts.filter(|c| c.grains().any(|grain| grain == GrainId(2)));
    scene.assembly.contacts = upper.copied().collect();
    let summary = summary(&scene);
    assert_eq!(
        (summary.static_indeterminacy, summary.zero_eigenvalues),
        (0, 2)
    );
    assert_eq!(summary.negative_eigenvalues, 0);
}

/// Work of the change of loads and reactions in the change of displacements: the contacts take just that.
#[test]
fn second_order_work_is_that_of_the_loads() {
    let scene = pack(60, 6, 50.0);
    let path: Vec<Equilibrium> = scene.load_path().collect::<Result<_, _>>().expect("a path");
    for pair in path.windows(2) {
        let (from, to) = (&pair[0], &pair[1]);
        let mut work = 0.0;
        for body in from.state.displacements.ids() {
            let step = to.state.displacements[body] - from.state.displacements[body];
            work += (to.loads[body] - from.loads[body]).work(step);
            work += (to.reactions[body] - from.reactions[body]).work(step);
        }
        let found = stability(to).summary.second_order_work;
        assert!(
            found > 0.0 && (found / work - 1.0).abs() < 1e-8,
            "{found} for {work}"
        );
    }
}

/// A grain between two plates, sheared by s: the printed law couples opening and shear by h·v_t/2 in the symmetric
/// part, h = μ·k_n/s = 1.5, v_t = 2, and k_n = k_t = 1 in both contacts give 2 ± 3 in translation.
#[test]
fn a_law_without_potential_may_lose_its_stability() {
    let scene = |shear: f64| {
        parse(&format!(
            "[box]\nwidth = 2.0\nheight = \"fit\"\n\
             [grains.hexagonal]\nradius = 1.0\nrows = [1]\n\
             [contact.pad.cemented]\n\
             stiffness.direct = {{ normal = 1.0, shear = 1.0, moment = 1e6 }}\n\
             shear_hardening = 3.0\nshear_floor = 0.1\ndual_length = 2.0\n\
             [side.bottom]\ncontact = \"pad\"\n[side.top]\ncontact = \"pad\"\n\
             [[move]]\nname = \"shear\"\nside = \"top\"\nx = {shear}\n\
             [[stage]]\nfactors = [1.0]\n[measure]\nstability = 3\n"
        ))
    };
    let stable = summary(&scene(2.0));
    assert_eq!(stable.negative_eigenvalues, 0);
    let lost = summary(&scene(4.0));
    assert_eq!(lost.negative_eigenvalues, 1);
    assert!(
        lost.lowest_eigenvalue
            .is_some_and(|lowest| (lowest + 1.0).abs() < 1e-3)
    );
}

#[test]
fn what_is_not_asked_for_is_not_there() {
    let text = pack(20, 7, 50.0).text;
    let scene = parse(&text.replace("stability = 6\nmoduli = true", ""));
    let end = end(&scene);
    assert!(end.stability.is_none() && end.tangents.is_none());
}
