//! Checks of bonds that soften.

use std::ops::Range;

use super::build_contacts::partners;
use super::check_property::PropertyPlan;
use super::checker::{Bound, Checker};
use super::diagnostic::{Problem, short};
use super::file::SceneFile;
use super::file_contacts::{CementedFile, LimitsFile};
use super::unit::Dimension;
use super::value::Number;
use crate::assembly::{Assembly, Contact};
use crate::contact_law::{Cemented, ContactGeometry, Law, Mode};
use crate::ids::{ContactId, Id, PerProperty, PropertyId};

/// The fracture energy of a cemented contact, refused beside what it does not go with.
#[expect(clippy::option_option, reason = "wrong, absent, there")]
pub fn fracture_energy(
    file: &CementedFile,
    names: &[&str],
    checker: &mut Checker,
) -> Option<Option<f64>> {
    let Some(number) = &file.fracture_energy else {
        return Some(None);
    };
    let (key, dimension) = ("fracture_energy", Dimension::ForcePerLength);
    let energy = checker.number(number, key, dimension, Bound::Positive);
    let limits = limits(file);
    let mut right = true;
    if file.shear_hardening.as_ref().is_some_and(|h| !is_zero(h)) {
        right = refuse(
            &number.span,
            "`fracture_energy` with `shear_hardening`",
            "the energy of a law without potential cannot be told from that of fracture",
            checker,
        );
    }
    if limits.is_none_or(|limits| !has_limit(limits)) {
        right = refuse(
            &number.span,
            "`fracture_energy`, but no limit at which the bond begins to soften",
            "give `strength.stress` or `strength.force` as well",
            checker,
        );
    }
    let becomes = file.after_breakage.as_ref();
    let becomes = becomes.filter(|word| names.contains(&word.value.as_str()));
    if becomes.is_some() && limits.is_some_and(fails_in_contact) {
        right = refuse(
            &number.span,
            "`fracture_energy` with `after_breakage` and a limit of compression, shear or bending",
            "a bond that breaks while it is pressed would take up its force anew; only bonds with a limit of tension \
             alone end open",
            checker,
        );
    }
    if right { energy.map(Some) } else { None }
}

fn refuse(span: &Range<usize>, what: &str, why: &str, checker: &mut Checker) -> bool {
    checker.push(Problem::at(span, what, "not possible together").help(why));
    false
}

fn is_zero(number: &Number) -> bool {
    matches!(&number.value, super::value::Quantity::Number(value) if *value == 0.0)
}

fn limits(file: &CementedFile) -> Option<&LimitsFile> {
    let strength = &file.strength.as_ref()?.value;
    let limits = strength.stress.as_ref().or(strength.force.as_ref())?;
    Some(&limits.value)
}

fn has_limit(limits: &LimitsFile) -> bool {
    limits.tension.is_some() || fails_in_contact(limits)
}

fn fails_in_contact(limits: &LimitsFile) -> bool {
    limits.compression.is_some() || limits.shear.is_some() || limits.bending.is_some()
}

/// No bond may become one that softens: it would begin beyond its limits.
pub fn successors(
    file: &SceneFile,
    plans: &PerProperty<PropertyPlan>,
    checker: &mut Checker,
) -> Option<()> {
    let softens = |id: PropertyId| plans[id].energy_span.is_some();
    let mut right = true;
    for (id, plan) in plans.iter() {
        let Law::Cemented(law) = &plan.property.law else {
            continue;
        };
        if !law.after_breakage.is_some_and(softens) {
            continue;
        }
        let table = &file.contact.0[id.index()].1.value.cemented;
        let word = table
            .as_ref()
            .and_then(|law| law.value.after_breakage.as_ref());
        checker.push(Problem::at(
            word.map_or(&plan.span, |word| &word.span),
            format!(
                "contact `{}` becomes one with a `fracture_energy`",
                plan.property.name
            ),
            "expected \"void\" or a contact that does not soften",
        ));
        right = false;
    }
    right.then_some(())
}

/// A bond must not be so brittle that it cannot soften: κ_u > 1 in every mode that has a limit.
pub fn brittle_bonds(
    plans: &PerProperty<PropertyPlan>,
    assembly: &Assembly,
    checker: &mut Checker,
) {
    for (id, plan) in plans.iter() {
        let (Law::Cemented(law), Some(span)) = (&plan.property.law, &plan.energy_span) else {
            continue;
        };
        let own = assembly.contacts.iter().filter(|(_, c)| c.property == id);
        let worst = own
            .map(|(contact, c)| (contact, c, least_energy(law, c, assembly.thickness)))
            .reduce(|worst, next| if next.2 > worst.2 { next } else { worst });
        let Some((contact, bond, least)) = worst else {
            continue;
        };
        if law
            .strength
            .fracture_energy
            .is_some_and(|energy| energy <= least)
        {
            too_brittle(span, &plan.property.name, contact, bond, least, checker);
        }
    }
}

fn too_brittle(
    span: &Range<usize>,
    name: &str,
    contact: ContactId,
    bond: &Contact,
    least: f64,
    checker: &mut Checker,
) {
    checker.push(
        Problem::at(
            span,
            format!(
                "contact {contact} of property `{name}`, between {}, holds more energy at its limit than it takes to break it",
                partners(bond.first, bond.second)
            ),
            format!("expected more than {}", short(least)),
        )
        .help("lower the strength or its scatter, raise the stiffness, or leave out `fracture_energy`"),
    );
}

/// The fracture energy at which κ_u = 1 in the mode that asks for most: max Q_lim²/(2·k·s·H).
fn least_energy(law: &Cemented, contact: &Contact, thickness: f64) -> f64 {
    let geometry = ContactGeometry {
        dual_parts: contact.dual_parts,
        branch_length: contact.branch_length,
        thickness,
    };
    let k = law
        .stiffness(&geometry)
        .with_strength_factor(contact.strength_factor);
    let (Some(softening), Some(energy)) = (k.softening, law.strength.fracture_energy) else {
        return 0.0;
    };
    let modes = [Mode::Tension, Mode::Compression, Mode::Shear, Mode::Bending];
    // A mode without limit has κ_u = 0 and never begins.
    let ultimate = modes.map(|mode| softening.ultimate(&k, mode));
    let limited = ultimate.into_iter().filter(|ultimate| *ultimate > 0.0);
    limited
        .map(|ultimate| energy / ultimate)
        .fold(0.0, f64::max)
}
