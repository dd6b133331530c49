//! Displacements and bonds as columns of a memory. Stiffness and limits follow from the property and are left out.

use rayon::prelude::*;

use super::bond::{Bond, geometry};
use super::configuration::Configuration;
use super::kinematics::FREEDOMS;
use super::memory::{Memory, MemoryError, Value, code};
use super::system::System;
use super::{Displacement, Load};
use crate::assembly::Contact;
use crate::contact_law::{Law, Limits, Mode, Phase};
use crate::ids::{ContactId, Id, PerBody, PropertyId};

/// A number of a bond: its column, and the place of its value.
type Number = (&'static str, fn(&Bond) -> f64, fn(&mut Bond) -> &mut f64);

macro_rules! number {
    ($name:literal, $($field:ident).+) => {
        ($name, |bond: &Bond| bond.$($field).+, |bond: &mut Bond| &mut bond.$($field).+)
    };
}

const PRESENT: [Number; 6] = [
    number!("contact.opening", displacement.normal),
    number!("contact.shear", displacement.shear),
    number!("contact.rotation", displacement.rotation),
    number!("contact.normal_force", force.normal),
    number!("contact.shear_force", force.shear),
    number!("contact.moment", force.moment),
];

/// The same as remembered; left out where that is the present.
const REMEMBERED: [Number; 6] = [
    number!("contact.remembered_opening", memory.displacement.normal),
    number!("contact.remembered_shear", memory.displacement.shear),
    number!("contact.remembered_rotation", memory.displacement.rotation),
    number!("contact.remembered_normal_force", memory.force.normal),
    number!("contact.remembered_shear_force", memory.force.shear),
    number!("contact.remembered_moment", memory.force.moment),
];

const OTHERS: [Number; 4] = [
    number!("contact.slip", memory.slip),
    number!("contact.rotation_origin", memory.rotation_origin),
    number!("contact.utilisation", memory.damage.utilisation),
    number!("contact.dissipated", memory.damage.dissipated),
];

const PROPERTY: &str = "contact.property";
const BROKEN: &str = "contact.broken";
const PHASE: &str = "contact.phase";
const REMEMBERED_PHASE: &str = "contact.remembered_phase";
const MODE: &str = "contact.damage_mode";

impl Memory {
    /// Keeps a vector with three components a body.
    pub(crate) fn put_triples(
        &mut self,
        name: &str,
        values: &(impl Iterator<Item = [f64; FREEDOMS]> + Clone),
    ) {
        for (index, component) in ["x", "y", "rotation"].into_iter().enumerate() {
            let column = values.clone().map(|triple| triple[index]).collect();
            self.put_column(&format!("{name}_{component}"), column);
        }
    }

    /// Reads a vector with three components a body.
    pub(crate) fn triples(
        &self,
        name: &str,
        count: usize,
    ) -> Result<Vec<[f64; FREEDOMS]>, MemoryError> {
        let part = |component| self.column::<f64>(&format!("{name}_{component}"), count);
        let (x, y, rotation) = (part("x")?, part("y")?, part("rotation")?);
        Ok((0..count).map(|i| [x[i], y[i], rotation[i]]).collect())
    }

    /// Keeps loads.
    pub(crate) fn put_loads(&mut self, name: &str, loads: &PerBody<Load>) {
        let values = loads.values().iter().map(|load| load.components());
        self.put_triples(name, &values);
    }

    /// Reads loads.
    pub(crate) fn loads(&self, name: &str, count: usize) -> Result<PerBody<Load>, MemoryError> {
        let loads = self.triples(name, count)?.into_iter();
        Ok(loads.map(Load::from_components).collect())
    }
}

impl Configuration {
    /// Writes displacements and bonds into a memory.
    pub fn write(&self, system: &System<'_>, memory: &mut Memory) {
        let u = self.displacements.values().iter();
        memory.put_triples("body.displacement", &u.map(|u| u.components()));
        let bonds = self.bonds.values();
        for ((name, read, _), (remembered, read_remembered, _)) in PRESENT.iter().zip(REMEMBERED) {
            let (now, before) = (gathered(bonds, read), gathered(bonds, &read_remembered));
            memory.put_unlike(remembered, before, &now);
            memory.put_column(name, now);
        }
        for (name, read, _) in &OTHERS {
            memory.put_column(name, gathered(bonds, read));
        }
        self.write_codes(system, memory);
    }

    fn write_codes(&self, system: &System<'_>, memory: &mut Memory) {
        let bonds = self.bonds.values();
        let property = |bond: &Bond| bond.property.map_or(-1, |p| i64::from(p.0));
        memory.put_unlike(
            PROPERTY,
            gathered(bonds, &property),
            &first_properties(system),
        );
        memory.put_column(BROKEN, gathered(bonds, &|bond: &Bond| code(bond.broken)));
        let phase = gathered(bonds, &|bond: &Bond| phase_code(bond.phase));
        let before = gathered(bonds, &|bond: &Bond| phase_code(bond.memory.phase));
        memory.put_unlike(REMEMBERED_PHASE, before, &phase);
        memory.put_column(PHASE, phase);
        let mode = |bond: &Bond| bond.memory.damage.mode.map_or(0, mode_code);
        memory.put_column(MODE, gathered(bonds, &mode));
    }

    /// Reads displacements and bonds.
    ///
    /// # Errors
    /// Columns that do not fit the assembly.
    pub fn read(system: &System<'_>, memory: &Memory) -> Result<Self, MemoryError> {
        let bodies = system.assembly.body_count();
        let u = memory.triples("body.displacement", bodies)?.into_iter();
        let first = first_properties(system);
        let count = first.len();
        let property = memory.column_like(PROPERTY, &first)?;
        let broken = memory.column::<u8>(BROKEN, count)?;
        let phase = memory.column::<u8>(PHASE, count)?;
        let before = memory.column_like(REMEMBERED_PHASE, &phase)?;
        let mode = memory.column::<u8>(MODE, count)?;
        let bond = |index: usize| {
            let contact = &system.assembly.contacts[ContactId::from_index(index)];
            let unfit = || MemoryError::unfit(PROPERTY);
            let mut bond = bond_of(system, contact, property[index]).ok_or_else(unfit)?;
            bond.broken = broken[index] != 0;
            bond.phase = phase_of(phase[index])?;
            bond.memory.phase = phase_of(before[index])?;
            bond.memory.damage.mode = mode_of(mode[index]);
            Ok(bond)
        };
        let bonds: Result<Vec<Bond>, MemoryError> = (0..count).into_par_iter().map(bond).collect();
        let mut bonds = bonds?;
        read_numbers(&mut bonds, memory)?;
        Ok(Self {
            displacements: u.map(Displacement::from_components).collect(),
            bonds: bonds.into(),
        })
    }
}

fn read_numbers(bonds: &mut [Bond], memory: &Memory) -> Result<(), MemoryError> {
    let count = bonds.len();
    for ((name, _, place), (remembered, _, place_remembered)) in PRESENT.iter().zip(REMEMBERED) {
        let now = memory.column::<f64>(name, count)?;
        scattered(
            bonds,
            memory.column_like(remembered, &now)?,
            place_remembered,
        );
        scattered(bonds, &now, *place);
    }
    for (name, _, place) in &OTHERS {
        scattered(bonds, &memory.column::<f64>(name, count)?, *place);
    }
    Ok(())
}

fn gathered<V: Value>(bonds: &[Bond], read: &(impl Fn(&Bond) -> V + Sync)) -> Vec<V> {
    bonds.par_iter().with_min_len(4096).map(read).collect()
}

fn scattered(bonds: &mut [Bond], values: &[f64], place: fn(&mut Bond) -> &mut f64) {
    let pairs = bonds.par_iter_mut().zip(values).with_min_len(4096);
    pairs.for_each(|(bond, value)| *place(bond) = *value);
}

fn first_properties(system: &System<'_>) -> Vec<i64> {
    let contacts = system.assembly.contacts.values().iter();
    contacts
        .map(|contact| i64::from(contact.property.0))
        .collect()
}

/// A contact with the stiffness and the limits of a property; broken into nothing it has the stiffness of its last one.
pub(crate) fn bond_of(system: &System<'_>, contact: &Contact, property: i64) -> Option<Bond> {
    let thickness = system.assembly.thickness;
    let mut bond = Bond::new(contact, system.properties, thickness);
    let known = (0..system.properties.len() as i64).contains(&property);
    if property >= 0 && !known {
        return None;
    }
    let (of, limits) = if known {
        let id = PropertyId(property as u32);
        let law = &system.properties[id].law;
        bond.property = Some(id);
        (
            law,
            law.limits(&geometry(contact, thickness), contact.strength_factor),
        )
    } else {
        bond.property = None;
        (last_law(system, contact), Limits::UNBREAKABLE)
    };
    bond.stiffness = of
        .stiffness(&geometry(contact, thickness))
        .with_strength_factor(contact.strength_factor);
    bond.limits = limits;
    Some(bond)
}

/// The law of a contact that leaves nothing when it breaks.
fn last_law<'a>(system: &System<'a>, contact: &Contact) -> &'a Law {
    let properties = system.properties;
    let mut law = &properties[contact.property].law;
    // A chain of successors that turns in a circle never ends in nothing.
    for _ in 0..properties.len() {
        match law.after_breakage() {
            Some(next) => law = &properties[next].law,
            None => break,
        }
    }
    law
}

fn phase_code(phase: Phase) -> u8 {
    match phase {
        Phase::Closed => 0,
        Phase::SlidingForward => 1,
        Phase::SlidingBackward => 2,
        Phase::Open => 3,
    }
}

fn phase_of(code: u8) -> Result<Phase, MemoryError> {
    match code {
        0 => Ok(Phase::Closed),
        1 => Ok(Phase::SlidingForward),
        2 => Ok(Phase::SlidingBackward),
        3 => Ok(Phase::Open),
        _ => Err(MemoryError::unfit(PHASE)),
    }
}

/// A mode as a code; 0 is none.
pub(crate) fn mode_code(mode: Mode) -> u8 {
    match mode {
        Mode::Tension => 1,
        Mode::Compression => 2,
        Mode::Shear => 3,
        Mode::Bending => 4,
    }
}

/// The mode of a code.
pub(crate) fn mode_of(code: u8) -> Option<Mode> {
    match code {
        1 => Some(Mode::Tension),
        2 => Some(Mode::Compression),
        3 => Some(Mode::Shear),
        4 => Some(Mode::Bending),
        _ => None,
    }
}
