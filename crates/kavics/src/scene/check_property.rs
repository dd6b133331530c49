//! Checks of contact properties.

use std::ops::Range;

use super::check_softening;
use super::check_strength;
use super::checker::{Bound, Checker};
use super::diagnostic::{Problem, either, likely};
use super::file::SceneFile;
use super::file_contacts::{
    CementedFile, CohesionlessFile, DirectFile, ModuliFile, PropertyFile, StiffnessFile,
    StrengthFile,
};
use super::scatter::Scatter;
use super::unit::Dimension;
use super::value::{Number, Placed};
use crate::assembly::{ContactPoint, DualLength, Shaping};
use crate::contact_law::{Cemented, Cohesionless, Law, Property, Reading, StiffnessRule, Strength};
use crate::ids::{Id, PerProperty, PropertyId};
use crate::warning::WarningKind;

/// A contact property with what shapes its contacts.
#[derive(Clone, Debug)]
pub struct PropertyPlan {
    /// Name and law.
    pub property: Property,
    /// How contacts are shaped.
    pub shaping: Shaping,
    /// Scatter of the strengths.
    pub scatter: Option<Scatter>,
    /// Where its name stands in the file.
    pub span: Range<usize>,
    /// Where its limit of tension stands in the file.
    pub tension_span: Option<Range<usize>>,
    /// Where its fracture energy stands in the file.
    pub energy_span: Option<Range<usize>>,
}

/// The property with a name.
pub fn named(name: &Placed<String>, names: &[&str], checker: &mut Checker) -> Option<PropertyId> {
    if let Some(index) = names.iter().position(|known| *known == name.value) {
        return Some(PropertyId::from_index(index));
    }
    let known = if names.is_empty() {
        "expected the name of a `[contact.NAME.…]`".to_owned()
    } else {
        format!("expected {}", either(names.iter().copied()))
    };
    checker.push(
        Problem::at(
            &name.span,
            format!("no contact property is called `{}`", name.value),
            known,
        )
        .suggest(likely(&name.value, names.iter().copied())),
    );
    None
}

/// All contact properties.
pub fn properties(file: &SceneFile, checker: &mut Checker) -> Option<PerProperty<PropertyPlan>> {
    let names: Vec<&str> = file
        .contact
        .0
        .iter()
        .map(|(n, _)| n.value.as_str())
        .collect();
    let plans: Vec<Option<PropertyPlan>> = file
        .contact
        .0
        .iter()
        .map(|(name, table)| property(name, table, &names, checker))
        .collect();
    let plans: PerProperty<PropertyPlan> = plans.into_iter().collect::<Option<Vec<_>>>()?.into();
    successors_end(file, &plans, checker)?;
    check_softening::successors(file, &plans, checker)?;
    Some(plans)
}

fn property(
    name: &Placed<String>,
    table: &Placed<PropertyFile>,
    names: &[&str],
    checker: &mut Checker,
) -> Option<PropertyPlan> {
    enum Table<'a> {
        Cemented(&'a CementedFile),
        Cohesionless(&'a CohesionlessFile),
    }
    if name.value == "void" {
        checker.push(Problem::at(
            &name.span,
            "a contact property cannot be called `void`",
            "expected another name",
        ));
    }
    if name.value.is_empty() {
        checker.push(Problem::at(
            &name.span,
            "a name is empty",
            "expected a name for zones and sides",
        ));
    }
    let PropertyFile {
        cemented: bonded,
        cohesionless: loose,
    } = &table.value;
    let alternatives = [
        (
            "cemented",
            bonded
                .as_ref()
                .map(|t| (Table::Cemented(&t.value), &t.span)),
        ),
        (
            "cohesionless",
            loose
                .as_ref()
                .map(|t| (Table::Cohesionless(&t.value), &t.span)),
        ),
    ];
    let what = format!("the law of contact `{}`", name.value);
    match checker.exactly_one(&name.span, &what, alternatives)? {
        Table::Cemented(file) => cemented(name, file, names, checker),
        Table::Cohesionless(file) => cohesionless(name, file, checker),
    }
}

fn cemented(
    name: &Placed<String>,
    file: &CementedFile,
    names: &[&str],
    checker: &mut Checker,
) -> Option<PropertyPlan> {
    let fracture_energy = check_softening::fracture_energy(file, names, checker);
    let stiffness = stiffness(&file.stiffness, true, checker);
    let hardening = hardening(file.shear_hardening.as_ref(), checker);
    let reading = reading(file.reading.as_ref(), checker);
    let floor = shear_floor(file.shear_floor.as_ref(), checker);
    let shaping = shaping(
        file.contact_point.as_ref(),
        file.dual_length.as_ref(),
        checker,
    );
    let strength = file
        .strength
        .as_ref()
        .map_or(Some((Strength::UNBREAKABLE, None)), |table| {
            check_strength::strength(table, checker)
        });
    let after_breakage = match &file.after_breakage {
        Some(word) if word.value != "void" => named(word, names, checker).map(Some),
        _ => Some(None),
    };
    let (strength, scatter) = strength?;
    let law = Cemented {
        stiffness: stiffness?,
        shear_hardening: hardening?,
        reading: reading?,
        shear_floor: floor?,
        eccentric: file.eccentric.unwrap_or(false),
        strength: Strength {
            fracture_energy: fracture_energy?,
            ..strength
        },
        after_breakage: after_breakage?,
    };
    warn_of_lost_shear(&name.value, &law, checker);
    let limits = file.strength.as_ref().and_then(|strength| {
        let StrengthFile { stress, force, .. } = &strength.value;
        stress.as_ref().or(force.as_ref())
    });
    let tension = limits.and_then(|limits| limits.value.tension.as_ref());
    Some(PropertyPlan {
        property: Property {
            name: name.value.clone(),
            law: Law::Cemented(law),
        },
        shaping: shaping?,
        scatter,
        span: name.span.clone(),
        tension_span: tension.map(|tension| tension.span.clone()),
        energy_span: file
            .fracture_energy
            .as_ref()
            .map(|energy| energy.span.clone()),
    })
}

fn warn_of_lost_shear(name: &str, law: &Cemented, checker: &mut Checker) {
    if law.shear_hardening > 0.0 && law.shear_floor.is_none() && law.strength.tension.is_infinite()
    {
        checker.warn(WarningKind::ShearMayVanish, format!(
            "contact `{name}` has shear_hardening but neither a limit of tension nor a shear_floor: its shear modulus may \
             fall to zero under tension, which ends the run"
        ));
    }
}

fn cohesionless(
    name: &Placed<String>,
    file: &CohesionlessFile,
    checker: &mut Checker,
) -> Option<PropertyPlan> {
    let stiffness = stiffness(&file.stiffness, false, checker);
    let hardening = hardening(file.shear_hardening.as_ref(), checker);
    let reading = reading(file.reading.as_ref(), checker);
    let floor = shear_floor(file.shear_floor.as_ref(), checker);
    let shaping = shaping(
        file.contact_point.as_ref(),
        file.dual_length.as_ref(),
        checker,
    );
    let friction = file.friction.as_ref().map_or(Some(None), |friction| {
        checker
            .number(friction, "friction", Dimension::Number, Bound::NonNegative)
            .map(Some)
    });
    let law = Cohesionless {
        stiffness: stiffness?,
        shear_hardening: hardening?,
        reading: reading?,
        shear_floor: floor?,
        friction: friction?,
    };
    if law.friction.is_none() {
        checker.warn(WarningKind::NoFriction, format!(
            "contact `{}` has no friction: as the law is printed, its shear force jumps to zero where it opens",
            name.value
        ));
    }
    Some(PropertyPlan {
        property: Property {
            name: name.value.clone(),
            law: Law::Cohesionless(law),
        },
        shaping: shaping?,
        scatter: None,
        span: name.span.clone(),
        tension_span: None,
        energy_span: None,
    })
}

fn stiffness(
    table: &Placed<StiffnessFile>,
    has_moment: bool,
    checker: &mut Checker,
) -> Option<StiffnessRule> {
    enum Table<'a> {
        Layer(&'a ModuliFile),
        Modulus(&'a ModuliFile),
        Direct(&'a Placed<DirectFile>),
    }
    let StiffnessFile {
        layer,
        modulus,
        direct,
    } = &table.value;
    let alternatives = [
        (
            "layer",
            layer.as_ref().map(|t| (Table::Layer(&t.value), &t.span)),
        ),
        (
            "modulus",
            modulus
                .as_ref()
                .map(|t| (Table::Modulus(&t.value), &t.span)),
        ),
        (
            "direct",
            direct.as_ref().map(|t| (Table::Direct(t), &t.span)),
        ),
    ];
    match checker.exactly_one(&table.span, "the stiffness", alternatives)? {
        Table::Layer(file) => {
            let [normal, shear] = moduli(
                &file.normal,
                &file.shear,
                Dimension::StressPerLength,
                checker,
            )?;
            Some(StiffnessRule::Layer { normal, shear })
        }
        Table::Modulus(file) => {
            let [normal, shear] = moduli(&file.normal, &file.shear, Dimension::Stress, checker)?;
            Some(StiffnessRule::Modulus { normal, shear })
        }
        Table::Direct(file) => direct_stiffness(file, has_moment, checker),
    }
}

fn moduli(
    normal: &Number,
    shear: &Number,
    dimension: Dimension,
    checker: &mut Checker,
) -> Option<[f64; 2]> {
    let normal = checker.number(normal, "normal", dimension, Bound::Positive);
    let shear = checker.number(shear, "shear", dimension, Bound::Positive);
    Some([normal?, shear?])
}

fn direct_stiffness(
    table: &Placed<DirectFile>,
    has_moment: bool,
    checker: &mut Checker,
) -> Option<StiffnessRule> {
    let file = &table.value;
    let forces = moduli(
        &file.normal,
        &file.shear,
        Dimension::ForcePerLength,
        checker,
    );
    let moment = match &file.moment {
        Some(moment) if has_moment => {
            checker.number(moment, "moment", Dimension::Moment, Bound::NonNegative)
        }
        None if !has_moment => Some(0.0),
        Some(moment) => {
            checker.push(Problem::at(
                &moment.span,
                "a cohesionless contact carries no moment",
                "expected no bending stiffness here",
            ));
            None
        }
        None => {
            checker.push(Problem::at(
                &table.span,
                "missing key `moment`",
                "expected the bending stiffness of a cemented contact as well",
            ));
            None
        }
    };
    let [normal, shear] = forces?;
    Some(StiffnessRule::Direct {
        normal,
        shear,
        moment: moment?,
    })
}

fn hardening(number: Option<&Number>, checker: &mut Checker) -> Option<f64> {
    let key = "shear_hardening";
    checker.number_or(0.0, number, key, Dimension::Number, Bound::NonNegative)
}

fn reading(word: Option<&Placed<String>>, checker: &mut Checker) -> Option<Reading> {
    let choices = [
        ("printed", Reading::Printed),
        ("potential", Reading::Potential),
        ("history", Reading::History),
    ];
    word.map_or(Some(Reading::Printed), |word| {
        checker.word(word, "reading", &choices)
    })
}

#[expect(clippy::option_option, reason = "wrong, absent, there")]
fn shear_floor(number: Option<&Number>, checker: &mut Checker) -> Option<Option<f64>> {
    let Some(number) = number else {
        return Some(None);
    };
    let floor = checker.number(number, "shear_floor", Dimension::Number, Bound::Positive)?;
    if floor <= 1.0 {
        return Some(Some(floor));
    }
    checker.push(Problem::at(
        &number.span,
        format!("`shear_floor` cannot be {floor}"),
        "expected a share of the initial shear modulus, above 0 and at most 1",
    ));
    None
}

fn shaping(
    point: Option<&Placed<String>>,
    length: Option<&Number>,
    checker: &mut Checker,
) -> Option<Shaping> {
    let choices = [
        ("tangent", ContactPoint::Tangent),
        ("midpoint", ContactPoint::Midpoint),
    ];
    let contact_point = point.map_or(Some(ContactPoint::Tangent), |word| {
        checker.word(word, "contact_point", &choices)
    });
    let dual_length = length.map_or(Some(DualLength::Capped), |length| dual(length, checker));
    Some(Shaping {
        dual_length: dual_length?,
        contact_point: contact_point?,
    })
}

fn dual(length: &Number, checker: &mut Checker) -> Option<DualLength> {
    let choices = [("capped", DualLength::Capped), ("full", DualLength::Full)];
    match Checker::as_word(length) {
        Some(word) => checker.word_or(&word, "dual_length", &choices, " or a length"),
        None => checker
            .number(length, "dual_length", Dimension::Length, Bound::Positive)
            .map(DualLength::Number),
    }
}

/// The property that a broken contact takes.
fn successor(plans: &PerProperty<PropertyPlan>, id: PropertyId) -> Option<PropertyId> {
    match &plans[id].property.law {
        Law::Cemented(law) => law.after_breakage,
        Law::Cohesionless(_) => None,
    }
}

fn successors_end(
    file: &SceneFile,
    plans: &PerProperty<PropertyPlan>,
    checker: &mut Checker,
) -> Option<()> {
    for start in plans.ids() {
        let mut path = vec![start];
        let mut current = start;
        while let Some(next) = successor(plans, current) {
            if next == start {
                // Each circle is told once, at its first contact.
                if path.iter().all(|id| id.index() >= start.index()) {
                    turns_into_itself(file, plans, &path, checker);
                }
                return None;
            }
            if path.contains(&next) {
                break;
            }
            path.push(next);
            current = next;
        }
    }
    Some(())
}

fn turns_into_itself(
    file: &SceneFile,
    plans: &PerProperty<PropertyPlan>,
    path: &[PropertyId],
    checker: &mut Checker,
) {
    let names: Vec<&str> = path
        .iter()
        .map(|id| plans[*id].property.name.as_str())
        .collect();
    let word = file.contact.0[path[0].index()]
        .1
        .value
        .cemented
        .as_ref()
        .and_then(|law| law.value.after_breakage.as_ref());
    let span = word.map_or(&plans[path[0]].span, |word| &word.span);
    let through = match names.split_first() {
        Some((_, rest)) if !rest.is_empty() => format!(" by way of `{}`", rest.join("`, `")),
        _ => String::new(),
    };
    checker.push(Problem::at(
        span,
        format!(
            "contact `{}` turns into itself when it breaks{through}",
            names[0]
        ),
        "expected \"void\" or a contact that does not lead back here",
    ));
}
