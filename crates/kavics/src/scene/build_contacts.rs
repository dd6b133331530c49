//! Contacts from sites: zones, strengths, properties, and the check of tension limits.

use super::build_grains::PlacedGrains;
use super::check_contacts::{ContactsPlan, ZonePlace, ZonePlan};
use super::check_softening;
use super::checker::Checker;
use super::diagnostic::{Problem, short};
use super::sides::side_called;
use crate::assembly::{
    self, Assembly, Bodies, Contact, ContactGraph, DualLength, Partner, Side, Site,
};
use crate::contact_law::{Cemented, Cohesionless, Law, StiffnessRule, StrengthKind};
use crate::geometry::Vector;
use crate::ids::{PerContact, PerSide, PropertyId};
use crate::packing::{Purpose, Stream, random::stream};
use crate::warning::WarningKind;

/// Ends that take less than this share of a dual length are rounding.
const CAPPED: f64 = 1e-9;

/// The assembly: grains, sides, contacts and dual graph.
pub fn assembly(
    plan: &ContactsPlan,
    placed: PlacedGrains,
    thickness: f64,
    seed: u64,
    checker: &mut Checker,
) -> Option<Assembly> {
    let present = plan.sides.map(Option::is_some);
    let sides = placed.sides(present.values());
    let reach: PerSide<f64> = plan.sides.map(|side| {
        side.as_ref()
            .map_or(0.0, |side| side.reach * placed.mean_radius)
    });
    let tolerance = plan.touching_tolerance * placed.mean_radius;
    let graph = assembly::contact_graph(&placed.grains, &sides, plan.between, &reach, tolerance);
    sides_touch(plan, &graph, &placed, &sides, checker);
    let bodies = Bodies {
        grains: &placed.grains,
        sides: &sides,
    };
    let met = Met {
        graph: &graph,
        bodies,
    };
    let properties = zoned(plan, met, seed, checker)?;
    let contacts = contacts(plan, met, &properties, seed);
    let assembly = Assembly {
        grains: placed.grains,
        sides,
        contacts,
        cell_area: graph.cell_area,
        triangles: graph.triangles,
        thickness,
    };
    if dual_lengths(plan, &assembly, checker) {
        capped_lengths(plan, &assembly, checker);
        tension_limits(plan, &assembly, checker);
        check_softening::brittle_bonds(&plan.properties, &assembly, checker);
    }
    Some(assembly)
}

/// A side whose reach ends short of every grain is a mistake, one without reach only worth a warning.
fn sides_touch(
    plan: &ContactsPlan,
    graph: &ContactGraph,
    placed: &PlacedGrains,
    sides: &PerSide<Side>,
    checker: &mut Checker,
) {
    for (id, side) in sides.iter() {
        let Some(side_plan) = &plan.sides[id] else {
            continue;
        };
        let joined = graph
            .sites
            .iter()
            .filter(|s| s.second == Partner::Side(id))
            .count();
        if joined > 0 {
            let reach = side_plan.reach * placed.mean_radius;
            warn_of_grains_behind(placed, side, reach, joined, checker);
            continue;
        }
        let gap = placed
            .grains
            .values()
            .iter()
            .map(|grain| side.distance(grain.centre) - grain.radius)
            .fold(f64::INFINITY, f64::min);
        let nearest = short(gap / placed.mean_radius);
        match &side_plan.reach_span {
            Some(span) if side_plan.reach > 0.0 => checker.push(
                Problem::at(
                    span,
                    format!("{} reaches no grain", side_called(&side.name)),
                    format!(
                        "expected at least {nearest}, the gap to the nearest grain in mean radii"
                    ),
                )
                .and(&side_plan.span, "this side"),
            ),
            _ => checker.warn(
                WarningKind::SideUntouched,
                format!(
                    "no grain touches {}; the nearest is {nearest} mean radii away",
                    side_called(&side.name)
                ),
            ),
        }
    }
}

/// A grain within reach whose cell does not meet the side under it has others before it: it is not joined.
fn warn_of_grains_behind(
    placed: &PlacedGrains,
    side: &Side,
    reach: f64,
    joined: usize,
    checker: &mut Checker,
) {
    let gaps = placed
        .grains
        .values()
        .iter()
        .map(|grain| side.distance(grain.centre) - grain.radius);
    let within = gaps.filter(|gap| *gap <= reach).count();
    if within > joined {
        checker.warn(
            WarningKind::SideHidden,
            format!(
                "{} grains within reach of {} are not joined to it: others lie between",
                within - joined,
                side_called(&side.name)
            ),
        );
    }
}

/// Where grains meet.
#[derive(Clone, Copy)]
struct Met<'a> {
    graph: &'a ContactGraph,
    bodies: Bodies<'a>,
}

/// The property of each site.
fn zoned(
    plan: &ContactsPlan,
    met: Met<'_>,
    seed: u64,
    checker: &mut Checker,
) -> Option<Vec<PropertyId>> {
    let mut properties: Vec<Option<PropertyId>> = vec![None; met.graph.sites.len()];
    if plan.zones.is_empty() && plan.properties.len() == 1 {
        properties.fill(Some(PropertyId(0)));
    }
    let mut seeds = stream(seed, Purpose::Zones);
    for zone in &plan.zones {
        let draws = zone_stream(&mut seeds);
        let chosen = chosen(zone, met, draws);
        if !chosen.contains(&true) {
            empty_zone(zone, plan, met, checker);
        }
        for (property, chosen) in properties.iter_mut().zip(chosen) {
            if chosen {
                *property = Some(zone.property);
            }
        }
    }
    for (property, site) in properties.iter_mut().zip(&met.graph.sites) {
        if let Partner::Side(side) = site.second {
            *property = plan.sides[side].as_ref().map(|side| side.property);
        }
    }
    let without = properties.iter().position(Option::is_none);
    if let Some(first) = without {
        without_property(plan, met, first, &properties, checker);
        return None;
    }
    properties.into_iter().collect()
}

/// A stream of its own for each zone, so that zones do not change each other's choice.
fn zone_stream(seeds: &mut Stream) -> Stream {
    const SEEDS: f64 = (1_u64 << 53) as f64;
    stream((seeds.unit() * SEEDS) as u64, Purpose::Zones)
}

fn chosen(zone: &ZonePlan, met: Met<'_>, mut draws: Stream) -> Vec<bool> {
    let between_grains = |site: &Site| matches!(site.second, Partner::Grain(_));
    met.graph
        .sites
        .iter()
        .map(|site| {
            // One draw for each contact, chosen or not.
            let draw = draws.unit();
            between_grains(site)
                && match zone.place {
                    ZonePlace::Everywhere => true,
                    ZonePlace::Strip(ranges) => ranges.contain(site.tangent_point(met.bodies)),
                    ZonePlace::Share(share) => draw < share,
                }
        })
        .collect()
}

/// A zone for all contacts may find none between grains; one that chooses is a mistake then.
fn empty_zone(zone: &ZonePlan, plan: &ContactsPlan, met: Met<'_>, checker: &mut Checker) {
    let count = tangent_points(met).count();
    let expected = match zone.place {
        ZonePlace::Everywhere => {
            let name = &plan.properties[zone.property].property.name;
            checker.warn(
                WarningKind::ZoneEmpty,
                format!(
                    "the zone of `{name}` gives it to no contact: there is none between grains"
                ),
            );
            return;
        }
        ZonePlace::Share(share) if count > 0 => {
            format!("a share of {share} of {count} contacts; expected a larger one")
        }
        _ => where_contacts_lie(met),
    };
    checker.push(Problem::at(
        &zone.span,
        "this zone names no contact",
        expected,
    ));
}

/// Contact points between grains.
fn tangent_points(met: Met<'_>) -> impl Iterator<Item = Vector> {
    let between = |site: &&Site| matches!(site.second, Partner::Grain(_));
    met.graph
        .sites
        .iter()
        .filter(between)
        .map(move |site| site.tangent_point(met.bodies))
}

fn where_contacts_lie(met: Met<'_>) -> String {
    let points = || tangent_points(met);
    let span = |value: fn(Vector) -> f64| {
        points()
            .map(value)
            .fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], v| {
                [low.min(v), high.max(v)]
            })
    };
    if points().next().is_none() {
        return "there is no contact between grains".to_owned();
    }
    let ([left, right], [low, high]) = (span(|p| p.x), span(|p| p.y));
    format!(
        "contact points lie at x from {} to {}, y from {} to {}",
        short(left),
        short(right),
        short(low),
        short(high)
    )
}

fn without_property(
    plan: &ContactsPlan,
    met: Met<'_>,
    first: usize,
    properties: &[Option<PropertyId>],
    checker: &mut Checker,
) {
    let count = properties.iter().filter(|p| p.is_none()).count();
    let site = &met.graph.sites[first];
    let point = site.tangent_point(met.bodies);
    let span = plan.zones.last().map_or(&plan.span, |zone| &zone.span);
    let verb = if count == 1 {
        "contact has"
    } else {
        "contacts have"
    };
    checker.push(
        Problem::at(
            span,
            format!(
                "{count} {verb} no property; the first is between {} at ({}, {})",
                partners(site.first, site.second),
                short(point.x),
                short(point.y)
            ),
            "expected a zone for every contact",
        )
        .help("a first `[[zone]]` with `contact` alone gives a property to all contacts"),
    );
}

pub fn partners(first: Partner, second: Partner) -> String {
    match (first, second) {
        (Partner::Grain(first), Partner::Grain(second)) => format!("grains {first} and {second}"),
        (Partner::Grain(grain), Partner::Side(side))
        | (Partner::Side(side), Partner::Grain(grain)) => {
            format!("grain {grain} and side {side}")
        }
        (Partner::Side(first), Partner::Side(second)) => format!("sides {first} and {second}"),
    }
}

fn contacts(
    plan: &ContactsPlan,
    met: Met<'_>,
    properties: &[PropertyId],
    seed: u64,
) -> PerContact<Contact> {
    let mut draws = stream(seed, Purpose::Strengths);
    met.graph
        .sites
        .iter()
        .zip(properties)
        .map(|(site, id)| {
            // One draw for each contact, so that strengths do not depend on zones.
            let draw = draws.unit();
            let property = &plan.properties[*id];
            let factor = property.scatter.map_or(1.0, |scatter| scatter.factor(draw));
            site.contact(property.shaping, met.bodies, *id, factor)
        })
        .collect()
}

/// Whether the stiffness of a property is that of each contact, whatever its dual length.
fn is_direct(plan: &ContactsPlan, id: PropertyId) -> bool {
    let (Law::Cemented(Cemented { stiffness, .. })
    | Law::Cohesionless(Cohesionless { stiffness, .. })) = &plan.properties[id].property.law;
    matches!(stiffness, StiffnessRule::Direct { .. })
}

/// Warns of dual lengths that end where the tangent leaves the hull of the two grains.
fn capped_lengths(plan: &ContactsPlan, assembly: &Assembly, checker: &mut Checker) {
    let capped = |contact: &&Contact| {
        let property = contact.property;
        plan.properties[property].shaping.dual_length == DualLength::Capped
            && contact.dual_length() < contact.dual_length_full * (1.0 - CAPPED)
            && !is_direct(plan, property)
    };
    let contacts = assembly.contacts.values();
    let count = contacts.iter().filter(capped).count();
    if count > 0 {
        checker.warn(
            WarningKind::DualLengthCapped,
            format!(
                "dual lengths of {count} of {} contacts are capped, and their stiffness with them",
                contacts.len()
            ),
        );
    }
}

/// A contact whose stiffness comes from its dual length must have one.
fn dual_lengths(plan: &ContactsPlan, assembly: &Assembly, checker: &mut Checker) -> bool {
    let without = assembly
        .contacts
        .iter()
        .find(|(_, contact)| contact.dual_length() <= 0.0 && !is_direct(plan, contact.property));
    if let Some((id, contact)) = without {
        let property = &plan.properties[contact.property];
        checker.push(
            Problem::at(
                &property.span,
                format!(
                    "contact {id} of property `{}`, between {}, has no dual length",
                    property.property.name,
                    partners(contact.first, contact.second)
                ),
                format!("its dual length is {}", short(contact.dual_length())),
            )
            .help("expected `dual_length = \"full\"` or a number for grains that do not touch"),
        );
    }
    without.is_none()
}

/// A bond must break before its shear modulus is lost: k_t0 − μ·(k_n/s)·v > 0 at the opening v = Q_lim/k_n.
fn tension_limits(plan: &ContactsPlan, assembly: &Assembly, checker: &mut Checker) {
    for (id, property) in plan.properties.iter() {
        let Law::Cemented(law) = &property.property.law else {
            continue;
        };
        if law.shear_hardening <= 0.0
            || law.shear_floor.is_some()
            || law.strength.tension.is_infinite()
        {
            continue;
        }
        let beyond = assembly
            .contacts
            .iter()
            .filter(|(_, contact)| contact.property == id)
            .find(|(_, contact)| shear_stiffness_at_break(law, contact, assembly.thickness) <= 0.0);
        if let Some((contact_id, contact)) = beyond {
            let span = property.tension_span.as_ref().unwrap_or(&property.span);
            checker.push(
                Problem::at(
                    span,
                    format!(
                        "contact {contact_id} of property `{}`, between {}, loses its shear modulus before it breaks in tension",
                        property.property.name,
                        partners(contact.first, contact.second)
                    ),
                    format!(
                        "expected less than {}, at which its shear modulus is zero",
                        short(largest_tension(law, contact, assembly.thickness))
                    ),
                )
                .help("lower the limit of tension or `shear_hardening`, or give a `shear_floor`"),
            );
        }
    }
}

/// k_n and k_t0 of a contact.
fn stiffness(rule: StiffnessRule, contact: &Contact, thickness: f64) -> [f64; 2] {
    let area = contact.dual_length() * thickness;
    match rule {
        StiffnessRule::Layer { normal, shear } => [normal * area, shear * area],
        StiffnessRule::Modulus { normal, shear } => {
            [normal, shear].map(|modulus| modulus * area / contact.branch_length)
        }
        StiffnessRule::Direct { normal, shear, .. } => [normal, shear],
    }
}

/// What turns the limit of tension into a force.
fn force_of_limit(law: &Cemented, contact: &Contact, thickness: f64) -> f64 {
    contact.strength_factor
        * match law.strength.kind {
            StrengthKind::Stress => contact.dual_length() * thickness,
            StrengthKind::Force => 1.0,
        }
}

fn shear_stiffness_at_break(law: &Cemented, contact: &Contact, thickness: f64) -> f64 {
    let [_, shear] = stiffness(law.stiffness, contact, thickness);
    let limit = law.strength.tension * force_of_limit(law, contact, thickness);
    shear - law.shear_hardening * limit / contact.dual_length()
}

/// The limit of tension at which the shear modulus is lost: k_t0·s/μ as a force.
fn largest_tension(law: &Cemented, contact: &Contact, thickness: f64) -> f64 {
    let [_, shear] = stiffness(law.stiffness, contact, thickness);
    shear * contact.dual_length() / (law.shear_hardening * force_of_limit(law, contact, thickness))
}
