//! Checks of contacts, zones and sides.

use std::ops::Range;

use super::check_property::{self, PropertyPlan};
use super::checker::{Bound, Checker};
use super::diagnostic::Problem;
use super::file::SceneFile;
use super::file_contacts::{RangesFile, SideFile, ZoneFile};
use super::unit::Dimension;
use super::value::{Number, Placed};
use crate::assembly::Between;
use crate::equilibrium::Freedom;
use crate::ids::{Id, PerProperty, PerSide, PropertyId, SideId};

/// Contacts, their properties and where they hold.
#[derive(Clone, Debug)]
pub struct ContactsPlan {
    /// Which grains carry a contact.
    pub between: Between,
    /// Gap up to which grains touch and overlap that is allowed, in mean radii.
    pub touching_tolerance: f64,
    /// Contact properties.
    pub properties: PerProperty<PropertyPlan>,
    /// Zones.
    pub zones: Vec<ZonePlan>,
    /// The sides of the container; none: absent.
    pub sides: PerSide<Option<SidePlan>>,
    /// Where contacts stand in the file.
    pub span: Range<usize>,
}

/// Which contact property where.
#[derive(Clone, Debug)]
pub struct ZonePlan {
    /// The property.
    pub property: PropertyId,
    /// Where the zone stands in the file.
    pub span: Range<usize>,
    /// Which contacts.
    pub place: ZonePlace,
}

/// The contacts of a zone.
#[derive(Clone, Copy, Debug)]
pub enum ZonePlace {
    /// All.
    Everywhere,
    /// With the contact point in ranges of x and y.
    Strip(Ranges),
    /// A random share of all contacts.
    Share(f64),
}

/// Ranges of coordinates, `[length]`.
#[derive(Clone, Copy, Debug)]
pub struct Ranges {
    /// Of x.
    pub x: Option<[f64; 2]>,
    /// Of y.
    pub y: Option<[f64; 2]>,
}

impl Ranges {
    /// Whether a point lies within.
    pub fn contain(&self, point: crate::geometry::Vector) -> bool {
        let within = |range: Option<[f64; 2]>, value: f64| {
            range.is_none_or(|[from, to]| (from..=to).contains(&value))
        };
        within(self.x, point.x) && within(self.y, point.y)
    }
}

/// A side that grains touch.
#[derive(Clone, Debug)]
pub struct SidePlan {
    /// Property of its contacts.
    pub property: PropertyId,
    /// Gap up to which grains are joined to it, in mean radii.
    pub reach: f64,
    /// Where the reach stands in the file, when it is given.
    pub reach_span: Option<Range<usize>>,
    /// Its free freedoms.
    pub free: Vec<Freedom>,
    /// Where the side stands in the file.
    pub span: Range<usize>,
}

/// Names of the freedoms.
pub const FREEDOMS: [(&str, Freedom); 3] = [
    ("x", Freedom::X),
    ("y", Freedom::Y),
    ("rotation", Freedom::Rotation),
];

/// Contacts, properties, zones and sides.
pub fn contacts(file: &SceneFile, checker: &mut Checker) -> Option<ContactsPlan> {
    let properties = check_property::properties(file, checker);
    if file.contact.0.is_empty() {
        checker.push(
            Problem::at(
                &(0..0),
                "the scene has no contact property",
                "expected a table such as `[contact.mortar.cemented]` in this file",
            )
            .help("a contact property gives contacts their stiffness and strength"),
        );
    }
    let names: Vec<&str> = file
        .contact
        .0
        .iter()
        .map(|(n, _)| n.value.as_str())
        .collect();
    let table = file.contacts.as_ref().map(|table| &table.value);
    let between = table.and_then(|t| t.between.as_ref());
    let between = between.map_or(Some(Between::Touching), |word| {
        let choices = [
            ("touching", Between::Touching),
            ("neighbours", Between::Neighbours),
        ];
        checker.word(word, "between", &choices)
    });
    let tolerance = touching_tolerance(file, checker);
    let zones: Vec<Option<ZonePlan>> = file
        .zone
        .iter()
        .map(|table| zone(table, &names, checker))
        .collect();
    let sides = sides(file, &names, checker);
    Some(ContactsPlan {
        between: between?,
        touching_tolerance: tolerance?,
        properties: properties?,
        zones: zones.into_iter().collect::<Option<_>>()?,
        sides: sides?,
        span: first_property(file),
    })
}

/// Gap up to which grains touch and overlap that is allowed, in mean radii.
pub fn touching_tolerance(file: &SceneFile, checker: &mut Checker) -> Option<f64> {
    let table = file.contacts.as_ref();
    let number = table.and_then(|table| table.value.touching_tolerance.as_ref());
    let key = "touching_tolerance";
    let tolerance = checker.number_or(1e-7, number, key, Dimension::Number, Bound::Positive)?;
    if tolerance < 1.0 {
        return Some(tolerance);
    }
    checker.push(Problem::at(
        &number?.span,
        format!("`{key}` cannot be {tolerance}"),
        "expected a small part of the mean radius, such as `1e-6`",
    ));
    None
}

fn first_property(file: &SceneFile) -> Range<usize> {
    let first = file.contact.0.first();
    first.map_or(0..0, |(name, _)| name.span.clone())
}

fn zone(table: &Placed<ZoneFile>, names: &[&str], checker: &mut Checker) -> Option<ZonePlan> {
    let file = &table.value;
    let property = check_property::named(&file.contact, names, checker);
    let place = match (&file.strip, &file.share) {
        (None, None) => Some(ZonePlace::Everywhere),
        (Some(strip), None) => ranges(strip, checker).map(ZonePlace::Strip),
        (None, Some(share)) => self::share(share, checker).map(ZonePlace::Share),
        (Some(strip), Some(share)) => {
            checker.push(
                Problem::at(
                    &share.span,
                    "a zone with both `strip` and `share`",
                    "expected only one of them",
                )
                .and(&strip.span, "the strip"),
            );
            None
        }
    };
    Some(ZonePlan {
        property: property?,
        span: table.span.clone(),
        place: place?,
    })
}

fn share(number: &Number, checker: &mut Checker) -> Option<f64> {
    let share = checker.number(number, "share", Dimension::Number, Bound::Positive)?;
    if share <= 1.0 {
        return Some(share);
    }
    checker.push(Problem::at(
        &number.span,
        format!("`share` cannot be {share}"),
        "expected a number above 0 and at most 1",
    ));
    None
}

fn ranges(table: &Placed<RangesFile>, checker: &mut Checker) -> Option<Ranges> {
    let RangesFile { x, y } = &table.value;
    if x.is_none() && y.is_none() {
        checker.push(Problem::at(
            &table.span,
            "a strip without a range",
            "expected `x` or `y`, such as `{ y = [0.0, 2.0] }`",
        ));
        return None;
    }
    let x = optional_range(x.as_ref(), "x", checker);
    let y = optional_range(y.as_ref(), "y", checker);
    Some(Ranges { x: x?, y: y? })
}

/// A range, if there is one.
#[expect(clippy::option_option, reason = "wrong, absent, there")]
pub fn optional_range(
    list: Option<&Placed<Vec<Number>>>,
    key: &str,
    checker: &mut Checker,
) -> Option<Option<[f64; 2]>> {
    list.map_or(Some(None), |list| checker.range(list, key).map(Some))
}

fn sides(
    file: &SceneFile,
    names: &[&str],
    checker: &mut Checker,
) -> Option<PerSide<Option<SidePlan>>> {
    let mut sides = PerSide::filled(None, checker.sides.count());
    let mut right = true;
    for (name, table) in &file.side.0 {
        let found = checker.side(name, "side");
        let plan = side(table, names, checker);
        match (found, plan) {
            (Some(found), Some(plan)) => sides[SideId::from_index(found)] = Some(plan),
            _ => right = false,
        }
    }
    right.then_some(sides)
}

fn side(table: &Placed<SideFile>, names: &[&str], checker: &mut Checker) -> Option<SidePlan> {
    let file = &table.value;
    let property = check_property::named(&file.contact, names, checker);
    let (number, non_negative) = (Dimension::Number, Bound::NonNegative);
    let reach = checker.number_or(0.0, file.reach.as_ref(), "reach", number, non_negative);
    let free = file.free.as_deref().unwrap_or_default();
    let free = freedoms(free, "free", checker);
    Some(SidePlan {
        property: property?,
        reach: reach?,
        reach_span: file.reach.as_ref().map(|reach| reach.span.clone()),
        free: free?,
        span: table.span.clone(),
    })
}

/// Freedoms by name, each at most once.
pub fn freedoms(list: &[Placed<String>], key: &str, checker: &mut Checker) -> Option<Vec<Freedom>> {
    let mut found: Vec<Freedom> = Vec::new();
    let mut right = true;
    for word in list {
        match checker.word(word, key, &FREEDOMS) {
            Some(freedom) if found.contains(&freedom) => {
                right = false;
                checker.push(Problem::at(
                    &word.span,
                    format!("`{}` stands twice in `{key}`", word.value),
                    "expected each freedom once",
                ));
            }
            Some(freedom) => found.push(freedom),
            None => right = false,
        }
    }
    right.then_some(found)
}
