//! Event-driven breakage as columns of a memory. A factor that bonds were taken out of is made again as it was made: from
//! the stiffness that it began with, and the same bonds taken out in the same order.

use super::acting::Acting;
use super::linear::Course;
use super::network::Network;
use super::outer::{Outer, OuterPlaces};
use super::spring::Spring;
use super::{EventDriven, Run, Unfinished};
use crate::equilibrium::configuration_memory::bond_of;
use crate::equilibrium::memory::{Memory, MemoryError, code, count};
use crate::equilibrium::system::System;
use crate::equilibrium::{Displacement, Load};
use crate::ids::{ContactId, Id, PropertyId};
use crate::loading::Program;
use crate::loading::advance::{Point, Way};
use crate::loading::load_path::LoadStep;

const RUN_COUNTS: &str = "run.counts";
const RUN_NUMBERS: &str = "run.numbers";
const COUNTS: &str = "course.counts";
const BROKEN: &str = "course.broken";
const PLACE: &str = "unfinished.place";

impl Run {
    /// Writes the run of factors.
    pub fn write(&self, memory: &mut Memory) {
        let flags = [self.common, self.eventful].map(|flag| i64::from(code(flag)));
        let counts = [
            self.stage as i64,
            self.avalanches as i64,
            flags[0],
            flags[1],
        ];
        memory.put(RUN_COUNTS, counts.to_vec());
        let numbers = [self.direction, self.back, self.highest];
        memory.put(RUN_NUMBERS, numbers.to_vec());
    }

    fn read(memory: &Memory) -> Result<Self, MemoryError> {
        let [stage, avalanches, common, eventful] = memory.fixed::<i64, 4>(RUN_COUNTS)?;
        let [direction, back, highest] = memory.fixed(RUN_NUMBERS)?;
        Ok(Self {
            stage: count(RUN_COUNTS, stage)?,
            direction,
            common: common != 0,
            back,
            highest,
            eventful: eventful != 0,
            avalanches: count(RUN_COUNTS, avalanches)?,
        })
    }
}

impl EventDriven {
    /// Writes what is kept from event to event, the run apart.
    pub fn write(&self, memory: &mut Memory) {
        if let Some(course) = &self.course {
            course.write(memory);
        }
    }

    /// Reads what is kept, the point and the system being read already.
    pub fn read(
        system: &mut System<'_>,
        program: &Program,
        point: &Point,
        memory: &Memory,
    ) -> Result<Self, MemoryError> {
        Ok(Self {
            course: Course::read(system, program, point, memory)?,
            run: Run::read(memory)?,
        })
    }
}

impl Course {
    fn write(&self, memory: &mut Memory) {
        self.line.write("course", memory);
        for (part, name) in PARTS.into_iter().enumerate() {
            let u = self.network.displacements.iter();
            memory.put_triples(name, &u.map(|pair| pair[part].components()));
        }
        let events = i64::try_from(self.events).unwrap_or(-1);
        let proportional = i64::from(code(self.network.proportional));
        memory.put(COUNTS, vec![events, self.held as i64, proportional]);
        let broken = self.broken.iter();
        let broken = broken.flat_map(|(contact, p)| [i64::from(contact.0), i64::from(p.0)]);
        memory.put(BROKEN, broken.collect());
    }

    fn read(
        system: &mut System<'_>,
        program: &Program,
        point: &Point,
        memory: &Memory,
    ) -> Result<Option<Self>, MemoryError> {
        let Some(line) = LoadStep::read("course", program, memory)? else {
            return Ok(None);
        };
        let bodies = system.assembly.body_count();
        let acting = Acting::new(program, &line, bodies);
        let [events, held, proportional] = memory.fixed::<i64, 3>(COUNTS)?;
        let network = Network {
            displacements: pairs(memory, bodies)?,
            proportional: proportional != 0,
            ..Network::new(system, &point.configuration, acting)
        };
        let mut course = Self::of(network, &line);
        course.places = OuterPlaces::new(system, &course.network);
        course.held = count(COUNTS, held)?;
        course.events = usize::try_from(events).unwrap_or(usize::MAX);
        course.broken = broken(memory, system.properties.len(), point)?;
        if course.events != usize::MAX {
            course.make_factor_again(system, point);
        }
        Ok(Some(course))
    }

    fn make_factor_again(&self, system: &mut System<'_>, point: &Point) {
        let mut configuration = point.configuration.clone();
        let assembly = system.assembly;
        let mut taken_out = Vec::with_capacity(self.broken.len());
        for &(contact, property) in self.broken.iter().rev() {
            let bond = &mut configuration.bonds[contact];
            let after = *bond;
            let before = bond_of(system, &assembly.contacts[contact], i64::from(property.0));
            *bond = before.unwrap_or(after);
            let columns = Spring::new(bond).less(&Spring::new(&after));
            taken_out.push((contact, columns));
        }
        if system.factorise_bonds(&configuration).is_ok() {
            for (contact, columns) in taken_out.into_iter().rev() {
                let _ = columns.is_some_and(|columns| system.take_out(contact, columns));
            }
        }
    }
}

const PARTS: [&str; 2] = ["course.constant", "course.rate"];

fn pairs(memory: &Memory, bodies: usize) -> Result<Vec<[Displacement; 2]>, MemoryError> {
    let [constant, rate] = PARTS.map(|name| memory.triples(name, bodies));
    let pairs = constant?.into_iter().zip(rate?);
    let pairs = pairs.map(|(a, b)| [a, b].map(Displacement::from_components));
    Ok(pairs.collect())
}

fn broken(
    memory: &Memory,
    properties: usize,
    point: &Point,
) -> Result<Vec<(ContactId, PropertyId)>, MemoryError> {
    let list = memory.list::<i64>(BROKEN)?.unwrap_or_default();
    let contacts = point.configuration.bonds.len();
    let pair = |&[contact, property]: &[i64; 2]| {
        let contact = count(BROKEN, contact)?;
        let property = count(BROKEN, property)?;
        if contact >= contacts || property >= properties {
            return Err(MemoryError::unfit(BROKEN));
        }
        Ok((
            ContactId::from_index(contact),
            PropertyId::from_index(property),
        ))
    };
    list.as_chunks::<2>().0.iter().map(pair).collect()
}

impl Unfinished {
    /// Writes a load step under way, iterates apart.
    pub fn write(&self, memory: &mut Memory) {
        self.load_step.write("unfinished", memory);
        self.way.write(memory);
        let went_on = f64::from(code(self.went_on));
        let begun = f64::from(code(self.x.is_some()));
        memory.put(PLACE, vec![self.x.unwrap_or_default(), begun, went_on]);
        self.outer.write(memory);
    }

    /// Reads a load step under way; none where there is none.
    pub fn read(program: &Program, memory: &Memory) -> Result<Option<Self>, MemoryError> {
        let Some(load_step) = LoadStep::read("unfinished", program, memory)? else {
            return Ok(None);
        };
        let [x, begun, went_on] = memory.fixed(PLACE)?;
        Ok(Some(Self {
            load_step,
            way: Way::read(memory)?,
            x: (begun != 0.0).then_some(x),
            went_on: went_on != 0.0,
            outer: Outer::read(memory)?,
        }))
    }
}

const OUTER_LOADS: &str = "unfinished.outer_loads";
const OUTER_MOVED: &str = "unfinished.outer_moved";

impl Outer {
    fn write(&self, memory: &mut Memory) {
        let loads = self.loads.iter();
        let loads = loads.flat_map(|(load, u)| [load.components(), u.components()]);
        memory.put(OUTER_LOADS, loads.flatten().collect());
        memory.put(OUTER_MOVED, self.moved.iter().flatten().copied().collect());
    }

    fn read(memory: &Memory) -> Result<Self, MemoryError> {
        let loads = memory.list::<f64>(OUTER_LOADS)?.unwrap_or_default();
        let moved = memory.list::<f64>(OUTER_MOVED)?.unwrap_or_default();
        let pair = |six: &[f64; 6]| {
            let [x, y, moment, ux, uy, rotation] = *six;
            let load = Load::from_components([x, y, moment]);
            (load, Displacement::from_components([ux, uy, rotation]))
        };
        Ok(Self {
            loads: loads.as_chunks().0.iter().map(pair).collect(),
            moved: moved.as_chunks().0.to_vec(),
        })
    }
}
