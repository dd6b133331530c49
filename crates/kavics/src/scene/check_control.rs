//! Checks of what steers the load steps.

use super::checker::Checker;
use super::diagnostic::Problem;
use super::file::{EquilibriumFile, SceneFile};
use super::value::Placed;
use crate::loading::{Control, PathControl};

/// What steers the load steps.
pub fn control(
    file: &SceneFile,
    equilibrium: &EquilibriumFile,
    checker: &mut Checker,
) -> Option<PathControl> {
    let default = PathControl::default();
    let word = equilibrium.control.as_ref();
    let control = word.map_or(Some(default.control), |word| {
        let choices = [
            ("load", Control::Load),
            ("displacement", Control::Displacement),
            ("dissipation", Control::Dissipation),
            ("auto", Control::Auto),
        ];
        checker.word(word, "control", &choices)
    });
    let most_steps = equilibrium
        .most_steps
        .as_ref()
        .map_or(Some(default.most_steps), |count| {
            checker.count(count, "most_steps", 1)
        });
    let softens = softens(file);
    if let (Some(Control::Dissipation), Some(word), false) = (control, word, softens) {
        needs_softening(word, checker);
    }
    let event_driven = equilibrium.breakage.as_ref();
    let event_driven = event_driven.filter(|word| word.value == "event-driven");
    if let Some(word) = event_driven.filter(|_| softens) {
        not_event_driven(word, checker);
    }
    if let (Some(word), Some(Control::Displacement)) = (event_driven, control) {
        steered_by_events(word, checker);
    }
    Some(PathControl {
        control: control?,
        most_steps: most_steps?,
    })
}

/// Whether a contact property has a fracture energy.
fn softens(file: &SceneFile) -> bool {
    let laws = file.contact.0.iter().filter_map(|(_, property)| {
        let law = property.value.cemented.as_ref()?;
        law.value.fracture_energy.as_ref()
    });
    laws.count() > 0
}

fn needs_softening(word: &Placed<String>, checker: &mut Checker) {
    checker.push(
        Problem::at(
            &word.span,
            "`control = \"dissipation\"`, but no contact softens",
            "expected a contact with a `fracture_energy`",
        )
        .help(
            "bonds without it break at once, and there is nothing that grows steadily to steer by",
        ),
    );
}

fn not_event_driven(breakage: &Placed<String>, checker: &mut Checker) {
    checker.push(
        Problem::at(
            &breakage.span,
            "`breakage = \"event-driven\"` with a contact that has a `fracture_energy`",
            "expected another `breakage`",
        )
        .help("softening bonds break by themselves; `control = \"auto\"` follows them beyond the peak"),
    );
}

fn steered_by_events(breakage: &Placed<String>, checker: &mut Checker) {
    checker.push(
        Problem::at(
            &breakage.span,
            "`breakage = \"event-driven\"` with `control = \"displacement\"`",
            "expected another `breakage`, or `control = \"load\"`",
        )
        .help("from event to event the load factor follows by itself beyond the peak"),
    );
}
