//! From the scene file to the scene: all checks, then grains, contacts and loading.

use std::path::Path;

use super::build_contacts;
use super::build_grains::{self, PlacedGrains};
use super::build_loading::Loading;
use super::check_contacts::{self, ContactsPlan};
use super::check_layers::{self, GrainsPlan};
use super::check_loading;
use super::check_run::{self, RunPlan, WindowPlan};
use super::check_stages;
use super::checker::{Bound, Checker};
use super::choose;
use super::diagnostic::Problem;
use super::file::SceneFile;
use super::loading_plan::LoadingPlan;
use super::rigid_motion;
use super::unit::Dimension;
use super::{Pack, ReadGrains, Scene};
use crate::assembly::{Assembly, Contact, Partner};
use crate::contact_law::Property;
use crate::ids::{GrainId, Id, PerGrain};
use crate::loading::{Action, Program, Stage};
use crate::warning::WarningKind;

/// All that can be known of a scene before its grains are placed.
struct Plan {
    seed: u64,
    thickness: f64,
    grains: GrainsPlan,
    contacts: ContactsPlan,
    loading: LoadingPlan,
    actions: Vec<Action>,
    stages: Vec<Stage>,
    run: RunPlan,
}

/// The scene of a scene file, or all that is wrong with it.
pub fn scene(
    file: &SceneFile,
    text: &str,
    folder: &Path,
    grain_lists: &ReadGrains<'_>,
) -> Result<Scene, Checker> {
    let mut checker = Checker::of(file);
    let plan = plan(file, folder, &mut checker);
    let built = match plan {
        Some(plan) if checker.problems.is_empty() => build(plan, folder, grain_lists, &mut checker),
        _ => None,
    };
    match built {
        Some(scene) if checker.problems.is_empty() => Ok(Scene {
            title: file.title.clone().unwrap_or_default(),
            warnings: checker.warnings,
            text: text.to_owned(),
            ..scene
        }),
        _ => Err(checker),
    }
}

/// The grains of a scene file alone; what has nothing to do with them is not looked at.
pub fn grains(
    file: &SceneFile,
    folder: &Path,
    grain_lists: &ReadGrains<'_>,
) -> Result<Pack, Checker> {
    let mut checker = Checker::of(file);
    let seed = seed(file, &mut checker);
    let tolerance = check_contacts::touching_tolerance(file, &mut checker);
    let plan = check_layers::grains(file, &mut checker);
    let placed = match (plan, seed, tolerance) {
        (Some(plan), Some(seed), Some(tolerance)) if checker.problems.is_empty() => {
            build_grains::place(&plan, seed, tolerance, folder, grain_lists, &mut checker)
        }
        _ => None,
    };
    let pack = |placed: PlacedGrains| Pack {
        sides: placed.sides(&vec![false; checker.sides.count()]),
        touching_tolerance: tolerance.unwrap_or_default() * placed.mean_radius,
        wanted_curve: placed.wanted_curve,
        grains: placed.grains,
    };
    placed.map(pack).ok_or(checker)
}

/// About the number of grains that would be placed, but for those of lists; none where box or grains are wrong.
pub fn planned_grains(file: &SceneFile) -> Option<f64> {
    let mut checker = Checker::of(file);
    let plan = check_layers::grains(file, &mut checker)?;
    Some(plan.layers.iter().filter_map(|layer| layer.about).sum())
}

fn seed(file: &SceneFile, checker: &mut Checker) -> Option<u64> {
    let Some(seed) = &file.seed else {
        return Some(0);
    };
    let value = u64::try_from(seed.value).ok();
    if value.is_none() {
        checker.push(Problem::at(
            &seed.span,
            format!("`seed` cannot be {}", seed.value),
            "expected zero or a whole number above",
        ));
    }
    value
}

fn plan(file: &SceneFile, folder: &Path, checker: &mut Checker) -> Option<Plan> {
    let seed = seed(file, checker);
    let (length, positive) = (Dimension::Length, Bound::Positive);
    let thickness = file.thickness.as_ref();
    let thickness = checker.number_or(1.0, thickness, "thickness", length, positive);
    let grains = check_layers::grains(file, checker);
    let contacts = check_contacts::contacts(file, checker);
    let loading = check_loading::loading(file, checker);
    let run = check_run::run(file, folder, checker);
    let loading = loading?;
    let actions = check_stages::actions(&loading);
    let stages = check_stages::stages(file, &actions, checker);
    Some(Plan {
        seed: seed?,
        thickness: thickness?,
        grains: grains?,
        contacts: contacts?,
        loading,
        actions,
        stages: stages?,
        run: run?,
    })
}

fn build(
    plan: Plan,
    folder: &Path,
    grain_lists: &ReadGrains<'_>,
    checker: &mut Checker,
) -> Option<Scene> {
    let touching = plan.contacts.touching_tolerance;
    let place = plan.grains.span.clone();
    let placed = build_grains::place(
        &plan.grains,
        plan.seed,
        touching,
        folder,
        grain_lists,
        checker,
    )?;
    let tolerance = touching * placed.mean_radius;
    let layers = placed.layers.clone();
    let wanted_curve = placed.wanted_curve.clone();
    let assembly =
        build_contacts::assembly(&plan.contacts, placed, plan.thickness, plan.seed, checker)?;
    let loading = Loading {
        plan: &plan.loading,
        contacts: &plan.contacts,
        assembly: &assembly,
        tolerance,
    };
    let program = loading.program(plan.actions, plan.stages, checker);
    let window = window(&plan.run.window, &assembly, &program, checker);
    if checker.problems.is_empty() {
        let support = plan.loading.supports.first().map(|s| s.span.clone());
        let side = plan.contacts.sides.values().iter().flatten().next();
        let place = support.or(side.map(|s| s.span.clone())).unwrap_or(place);
        rigid_motion::check(&assembly, &program, &place, checker);
    }
    let property =
        |plan: &super::check_property::PropertyPlan| -> Property { plan.property.clone() };
    Some(Scene {
        title: String::new(),
        seed: plan.seed,
        layers,
        properties: plan.contacts.properties.map(property),
        assembly,
        wanted_curve,
        program,
        settings: plan.run.settings,
        breakage: plan.run.breakage,
        control: plan.run.control,
        window,
        record_every: plan.run.record_every,
        record_voids: plan.run.record_voids,
        record_cracks: plan.run.record_cracks,
        record_columns: plan.run.record_columns,
        compare: plan.run.compare,
        warnings: Vec::new(),
        text: String::new(),
    })
}

fn window(
    plan: &WindowPlan,
    assembly: &Assembly,
    program: &Program,
    checker: &mut Checker,
) -> Vec<GrainId> {
    let window = choose_window(plan, assembly, program, checker);
    if !matches!(plan, WindowPlan::Undisturbed) && !window.is_empty() {
        let disturbed = disturbed(assembly, program);
        let touching = window.iter().filter(|grain| disturbed[**grain]).count();
        if touching > 0 {
            checker.warn(
                WarningKind::WindowAtBoundary,
                format!(
                    "{touching} of the {} grains of the window are held, moved, loaded or at a side: its measures hold what \
                     these do to the assembly",
                    window.len()
                ),
            );
        }
    }
    window
}

fn choose_window(
    plan: &WindowPlan,
    assembly: &Assembly,
    program: &Program,
    checker: &mut Checker,
) -> Vec<GrainId> {
    let grains = &assembly.grains;
    match plan {
        WindowPlan::All => grains.ids().collect(),
        WindowPlan::Ids(ids) => {
            if ids.value.is_empty() {
                checker.push(Problem::at(
                    &ids.span,
                    "the window names no grain",
                    format!("expected ids from 0 to {}", grains.len() - 1),
                ));
            }
            choose::by_id(&ids.value, grains, checker)
        }
        WindowPlan::Within(ranges, span) => {
            let window = choose::within(grains, |centre| ranges.contain(centre));
            if window.is_empty() {
                let expected = choose::where_centres_lie(grains);
                checker.push(Problem::at(span, "the window names no grain", expected));
            }
            window
        }
        WindowPlan::Undisturbed => {
            let disturbed = disturbed(assembly, program);
            let window: Vec<GrainId> = grains.ids().filter(|id| !disturbed[*id]).collect();
            if window.is_empty() {
                checker.warn(
                    WarningKind::WindowEmpty,
                    "the window is empty: every grain has a support, a move, a load or a side contact",
                );
            }
            window
        }
    }
}

/// Grains with support, prescribed motion, load (weight does not count) or side contact.
fn disturbed(assembly: &Assembly, program: &Program) -> PerGrain<bool> {
    let mut disturbed = PerGrain::filled(false, assembly.grains.len());
    let weight = program.actions.iter().position(|a| a.name == "weight");
    let held = program.held.iter().map(|held| held.body);
    let moved = program.prescribed.iter().map(|p| p.body);
    let loads = program.loads.iter().filter(|l| Some(l.action) != weight);
    let bodies = held.chain(moved).chain(loads.map(|load| load.body));
    let grains = bodies.filter_map(|body| match assembly.partner(body) {
        Partner::Grain(grain) => Some(grain),
        Partner::Side(_) => None,
    });
    let at_sides = assembly
        .contacts
        .values()
        .iter()
        .filter(|c| c.touches_side());
    for grain in grains.chain(at_sides.flat_map(Contact::grains)) {
        disturbed.values_mut()[grain.index()] = true;
    }
    disturbed
}
