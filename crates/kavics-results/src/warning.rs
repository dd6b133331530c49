//! Warnings of the solver in words.

use std::mem::discriminant;

use kavics::equilibrium::{Breakdown, LargeMotion, Motion, Warning};
use kavics::warning::WarningKind;

/// Warnings of the load steps, each once with all its load steps.
#[derive(Clone, Debug, Default)]
pub(crate) struct SolverWarnings {
    list: Vec<(Warning, Vec<usize>)>,
}

impl SolverWarnings {
    /// Adds a warning of load step `step`.
    pub(crate) fn add(&mut self, step: usize, warning: &Warning) {
        let same = |known: &Warning| discriminant(known) == discriminant(warning);
        match self.list.iter_mut().find(|(known, _)| same(known)) {
            Some((known, steps)) => {
                if size(warning) > size(known) {
                    *known = warning.clone();
                }
                if steps.last() != Some(&step) {
                    steps.push(step);
                }
            }
            None => self.list.push((warning.clone(), vec![step])),
        }
    }

    /// The warnings as numbers: load step, kind and sizes.
    pub(crate) fn numbers(&self) -> Vec<f64> {
        let list = self.list.iter();
        list.flat_map(|(warning, steps)| {
            let [kind, size, other] = warning.numbers();
            let steps = steps.iter();
            steps.flat_map(move |&step| [step as f64, kind, size, other])
        })
        .collect()
    }

    /// The warnings of such numbers.
    pub(crate) fn of_numbers(numbers: &[f64]) -> Self {
        let mut warnings = Self::default();
        for &[step, kind, size, other] in numbers.as_chunks::<4>().0 {
            if let Some(warning) = Warning::of_numbers([kind, size, other]) {
                warnings.add(step as usize, &warning);
            }
        }
        warnings
    }

    /// The warnings in words, in the order in which they first came.
    pub(crate) fn texts(&self) -> impl Iterator<Item = String> + '_ {
        let warnings = self.list.iter();
        warnings.map(|(warning, steps)| warning_text(warning, steps))
    }
}

/// What a warning of some load steps says; its number is the largest among them.
fn warning_text(warning: &Warning, steps: &[usize]) -> String {
    let up_to = if steps.len() > 1 { "up to " } else { "" };
    let count = |word| format!("{up_to}{}", counted(count(warning), word));
    let what = match warning {
        Warning::RegularisedPivots { .. } => {
            format!("{} that no load moves held in place", count("floppy mode"))
        }
        Warning::ShearFloor { .. } => {
            format!("shear modulus at its floor in {}", count("contact"))
        }
        Warning::SolvedDirectly { breakdown } => {
            let why = match breakdown {
                Breakdown::NotPositive => "the stiffness is not positive definite",
                Breakdown::Stagnated => "the iteration gained no more",
            };
            format!("solved directly instead of by iteration, as {why}")
        }
        Warning::SecondOrderWork { .. } => {
            format!("second-order work negative in {}", count("contact"))
        }
        Warning::WorkError { relative } if *relative < 1.0 => {
            format!("work and energies known to within {relative:.0e} of the work")
        }
        Warning::WorkError { .. } => "work and energies no larger than their error".to_owned(),
        Warning::Separated => {
            "separated: the loads fell to zero; what would follow is left out".to_owned()
        }
        Warning::StepCut { .. } => {
            format!("did not go in one, halved {}", count("time"))
        }
        Warning::SetAside { .. } => {
            format!("{} set aside, neither held nor loaded", count("grain"))
        }
        Warning::Chattered { .. } => {
            format!(
                "{} changed phase in circles before they settled",
                count("contact")
            )
        }
        Warning::ManyIterations { iterations, limit } => {
            format!("{up_to}{iterations} iterations where {limit} are the limit")
        }
        Warning::NoModes => "the lowest modes asked for were not found".to_owned(),
        Warning::FloppyModesUncounted => {
            "solved by iteration, which counts no floppy modes".to_owned()
        }
        Warning::LargeDisplacements(large) => large_text(large, up_to),
    };
    let plural = if steps.len() == 1 { "" } else { "s" };
    let what = format!("load step{plural} {}: {what}", ranges(steps));
    warning.kind().says(what)
}

fn large_text(LargeMotion { size, motion }: &LargeMotion, up_to: &str) -> String {
    let size = three_digits(*size);
    let what = match motion {
        Motion::Branch(contact) => {
            format!("contact {contact} displaced by {up_to}{size} branch lengths")
        }
        Motion::Along(contact) => {
            format!("contact {contact} displaced along its side by {up_to}{size} side lengths")
        }
        Motion::Turn(grain) => format!("grain {grain} turned by {up_to}{size} radians"),
    };
    format!(
        "{what}, which is not small: results hold for the geometry of the start; read them as those of the linear \
         theory, scaled up from smaller loads"
    )
}

/// A number in three digits.
fn three_digits(value: f64) -> f64 {
    format!("{value:.2e}").parse().unwrap_or(value)
}

fn count(warning: &Warning) -> usize {
    match warning {
        Warning::RegularisedPivots { count } => *count,
        Warning::ShearFloor { contacts }
        | Warning::SecondOrderWork { contacts }
        | Warning::Chattered { contacts } => *contacts,
        Warning::SetAside { grains } => *grains,
        Warning::StepCut { cuts } => *cuts,
        Warning::ManyIterations { iterations, .. } => *iterations,
        Warning::SolvedDirectly { .. }
        | Warning::Separated
        | Warning::NoModes
        | Warning::FloppyModesUncounted => 1,
        Warning::WorkError { .. } | Warning::LargeDisplacements(_) => 0,
    }
}

/// The number by which the worst of equal warnings is known.
fn size(warning: &Warning) -> f64 {
    match warning {
        Warning::WorkError { relative } => *relative,
        Warning::LargeDisplacements(large) => large.size,
        _ => count(warning) as f64,
    }
}

/// What is said of load steps without the moduli asked for; nothing where there are none.
pub(crate) fn without_moduli(steps: &[usize]) -> Option<String> {
    let plural = if steps.len() == 1 { "" } else { "s" };
    let what = format!(
        "load step{plural} {}: no moduli, as the window has no rim of grains that its contacts hold together",
        ranges(steps)
    );
    (!steps.is_empty()).then(|| WarningKind::NoModuli.says(what))
}

/// Rising numbers in short: "1, 3 to 7".
fn ranges(steps: &[usize]) -> String {
    let runs = steps.chunk_by(|a, b| a + 1 == *b);
    let texts: Vec<String> = runs
        .map(|run| match run {
            [first, .., last] => format!("{first} to {last}"),
            _ => run.iter().map(ToString::to_string).collect(),
        })
        .collect();
    texts.join(", ")
}

fn counted(count: usize, word: &str) -> String {
    let plural = if count == 1 { "" } else { "s" };
    format!("{count} {word}{plural}")
}

#[cfg(test)]
mod tests {
    use kavics::ids::{ContactId, GrainId};

    use super::*;

    #[test]
    fn a_warning_stands_once_with_its_load_steps() {
        let mut warnings = SolverWarnings::default();
        for (step, contacts) in [(1, 2), (3, 5), (4, 1), (4, 1)] {
            warnings.add(step, &Warning::ShearFloor { contacts });
        }
        warnings.add(4, &Warning::RegularisedPivots { count: 1 });
        for relative in [1e-5, 3e-4, 2e-6] {
            warnings.add(7, &Warning::WorkError { relative });
        }
        let texts: Vec<String> = warnings.texts().collect();
        assert_eq!(
            texts,
            [
                "load steps 1, 3 to 4: shear modulus at its floor in up to 5 contacts [shear-floor]",
                "load step 4: 1 floppy mode that no load moves held in place [floppy-modes-held]",
                "load step 7: work and energies known to within 3e-4 of the work [work-error]"
            ]
        );
    }

    #[test]
    fn the_largest_of_large_motions_stands_with_all_load_steps_and_goes_through_numbers() {
        let motions = [
            Motion::Branch(ContactId(7)),
            Motion::Turn(GrainId(3)),
            Motion::Along(ContactId(9)),
        ];
        let says = [
            "contact 7 displaced by up to 0.25 branch lengths",
            "grain 3 turned by up to 0.25 radians",
            "contact 9 displaced along its side by up to 0.25 side lengths",
        ];
        for (motion, says) in motions.into_iter().zip(says) {
            let mut warnings = SolverWarnings::default();
            for (step, size, motion) in [
                (2, 0.11, Motion::Branch(ContactId(0))),
                (3, 0.250_04, motion),
                (4, 0.2, Motion::Turn(GrainId(1))),
            ] {
                let large = LargeMotion { size, motion };
                warnings.add(step, &Warning::LargeDisplacements(large));
            }
            let again = SolverWarnings::of_numbers(&warnings.numbers());
            for warnings in [warnings, again] {
                let texts: Vec<String> = warnings.texts().collect();
                assert_eq!(texts.len(), 1);
                assert!(texts[0].starts_with(&format!("load steps 2 to 4: {says}, ")));
                assert!(texts[0].ends_with("[large-displacements]"));
            }
        }
    }
}
