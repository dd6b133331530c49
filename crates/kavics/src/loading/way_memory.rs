//! Load steps and what has happened on the way through one, as columns of a memory.

use super::Program;
use super::advance::Way;
use super::load_path::LoadStep;
use super::work::Account;
use crate::equilibrium::configuration::{Longest, Progress};
use crate::equilibrium::configuration_memory::{mode_code, mode_of};
use crate::equilibrium::memory::{Memory, MemoryError, count};
use crate::equilibrium::{Breakdown, Drive, Event, EventKind, LargeMotion, Motion, Warning};
use crate::ids::{ContactId, GrainId};

impl LoadStep {
    /// Writes a load step under a name.
    pub fn write(&self, name: &str, memory: &mut Memory) {
        memory.put(&format!("{name}.stage"), vec![self.stage as i64]);
        memory.put(&format!("{name}.from"), self.from.clone());
        memory.put(&format!("{name}.to"), self.to.clone());
        let load_factor = format!("{name}.load_factor");
        memory.put(&load_factor, self.load_factor.to_vec());
    }

    /// Reads a load step; none where there is none of that name.
    pub fn read(
        name: &str,
        program: &Program,
        memory: &Memory,
    ) -> Result<Option<Self>, MemoryError> {
        let stage_name = format!("{name}.stage");
        if memory.list::<i64>(&stage_name)?.is_none() {
            return Ok(None);
        }
        let [stage] = memory.fixed::<i64, 1>(&stage_name)?;
        let stage = count(&stage_name, stage)?;
        if stage >= program.stages.len() {
            return Err(MemoryError::unfit(&stage_name));
        }
        let factors = |end: &str| {
            let name = format!("{name}.{end}");
            let column = memory.column::<f64>(&name, program.actions.len())?;
            Ok(column.into_owned())
        };
        Ok(Some(Self {
            stage,
            from: factors("from")?,
            to: factors("to")?,
            load_factor: memory.fixed(&format!("{name}.load_factor"))?,
        }))
    }
}

const COUNTS: &str = "way.counts";
const NUMBERS: &str = "way.numbers";
const EVENT_IDS: &str = "event.ids";
const EVENT_NUMBERS: &str = "event.numbers";
const EVENT_KINDS: &str = "event.kinds";
const WARNINGS: &str = "way.warnings";

/// Numbers an event and a warning are kept as.
const EVENT_ID_COUNT: usize = 3;
const EVENT_NUMBER_COUNT: usize = 5;
const WARNING_NUMBER_COUNT: usize = 3;

impl Way {
    /// Writes what has happened, iterates apart.
    pub fn write(&self, memory: &mut Memory) {
        let (progress, account) = (&self.progress, self.account);
        let counts = [
            progress.iterations,
            progress.held_pivots,
            account.iterations,
            progress.chattered,
            progress.longest.iterations,
            progress.longest.limit,
            usize::from(progress.uncounted),
        ];
        memory.put(COUNTS, counts.map(|n| n as i64).to_vec());
        let numbers = [
            progress.residual,
            account.scale,
            account.error,
            self.softened,
        ];
        memory.put(NUMBERS, numbers.to_vec());
        let events = self.events.iter();
        memory.put(EVENT_IDS, events.clone().flat_map(event_ids).collect());
        memory.put(
            EVENT_NUMBERS,
            events.clone().flat_map(event_numbers).collect(),
        );
        memory.put(EVENT_KINDS, events.flat_map(event_kind).collect());
        let warnings = self.warnings.iter();
        memory.put(WARNINGS, warnings.flat_map(Warning::numbers).collect());
    }

    /// Reads what has happened.
    pub fn read(memory: &Memory) -> Result<Self, MemoryError> {
        let counts = memory.fixed::<i64, 7>(COUNTS)?;
        let at = |place: usize| count(COUNTS, counts[place]);
        let [residual, scale, error, softened] = memory.fixed(NUMBERS)?;
        let warnings = memory.list::<f64>(WARNINGS)?.unwrap_or_default();
        let warnings = warnings.as_chunks::<WARNING_NUMBER_COUNT>().0.iter();
        Ok(Self {
            events: events(memory)?,
            warnings: warnings.filter_map(|w| Warning::of_numbers(*w)).collect(),
            progress: Progress {
                iterations: at(0)?,
                residual,
                held_pivots: at(1)?,
                chattered: at(3)?,
                longest: Longest {
                    iterations: at(4)?,
                    limit: at(5)?,
                },
                uncounted: at(6)? > 0,
                iterates: Vec::new(),
            },
            account: Account {
                iterations: at(2)?,
                scale,
                error,
            },
            softened,
        })
    }
}

/// Iteration, contact or grain, avalanche.
fn event_ids(event: &Event) -> [i64; EVENT_ID_COUNT] {
    let id = match event.kind {
        EventKind::Broke { contact, .. }
        | EventKind::Opened(contact)
        | EventKind::Closed(contact)
        | EventKind::Slid(contact)
        | EventKind::Stuck(contact) => contact.0,
        EventKind::SetAside(grain) | EventKind::TakenBack(grain) => grain.0,
    };
    let avalanche = event.avalanche.map_or(-1, |number| number as i64);
    [event.iteration as i64, i64::from(id), avalanche]
}

/// Load factor, energies, drive; the last not a number where there is none.
fn event_numbers(event: &Event) -> [f64; EVENT_NUMBER_COUNT] {
    let [displacement, force] = event
        .drive
        .map_or([f64::NAN; 2], |drive| [drive.displacement, drive.force]);
    let [fracture, release] = match event.kind {
        EventKind::Broke {
            fracture_energy,
            release_energy,
            ..
        } => [fracture_energy, release_energy],
        _ => [0.0; 2],
    };
    [event.load_factor, fracture, release, displacement, force]
}

/// Kind and mode.
fn event_kind(event: &Event) -> [u8; 2] {
    match event.kind {
        EventKind::Broke { mode, .. } => [0, mode_code(mode)],
        EventKind::Opened(_) => [1, 0],
        EventKind::Closed(_) => [2, 0],
        EventKind::Slid(_) => [3, 0],
        EventKind::Stuck(_) => [4, 0],
        EventKind::SetAside(_) => [5, 0],
        EventKind::TakenBack(_) => [6, 0],
    }
}

fn events(memory: &Memory) -> Result<Vec<Event>, MemoryError> {
    let kinds = memory.list::<u8>(EVENT_KINDS)?.unwrap_or_default();
    let (kinds, _) = kinds.as_chunks::<2>();
    let ids = memory.column::<i64>(EVENT_IDS, EVENT_ID_COUNT * kinds.len())?;
    let numbers = memory.column::<f64>(EVENT_NUMBERS, EVENT_NUMBER_COUNT * kinds.len())?;
    let rows = kinds.iter().zip(ids.as_chunks::<EVENT_ID_COUNT>().0);
    rows.zip(numbers.as_chunks::<EVENT_NUMBER_COUNT>().0)
        .map(|((kind, ids), numbers)| event(*kind, *ids, *numbers))
        .collect()
}

fn event(
    kind: [u8; 2],
    ids: [i64; EVENT_ID_COUNT],
    numbers: [f64; EVENT_NUMBER_COUNT],
) -> Result<Event, MemoryError> {
    let unfit = || MemoryError::unfit(EVENT_KINDS);
    let id = u32::try_from(ids[1]).map_err(|_| unfit())?;
    let (contact, grain) = (ContactId(id), GrainId(id));
    let [
        load_factor,
        fracture_energy,
        release_energy,
        displacement,
        force,
    ] = numbers;
    Ok(Event {
        iteration: count(EVENT_IDS, ids[0])?,
        load_factor,
        kind: match kind[0] {
            0 => EventKind::Broke {
                contact,
                mode: mode_of(kind[1]).ok_or_else(unfit)?,
                fracture_energy,
                release_energy,
            },
            1 => EventKind::Opened(contact),
            2 => EventKind::Closed(contact),
            3 => EventKind::Slid(contact),
            4 => EventKind::Stuck(contact),
            5 => EventKind::SetAside(grain),
            6 => EventKind::TakenBack(grain),
            _ => return Err(unfit()),
        },
        avalanche: usize::try_from(ids[2]).ok(),
        drive: (!displacement.is_nan()).then_some(Drive {
            displacement,
            force,
        }),
    })
}

impl Warning {
    /// The warning as its kind and its sizes.
    pub fn numbers(&self) -> [f64; WARNING_NUMBER_COUNT] {
        let of = |kind: f64, size: usize| [kind, size as f64, 0.0];
        match self {
            Self::RegularisedPivots { count } => of(0.0, *count),
            Self::ShearFloor { contacts } => of(1.0, *contacts),
            Self::SolvedDirectly { breakdown } => match breakdown {
                Breakdown::NotPositive => of(2.0, 0),
                Breakdown::Stagnated => of(2.0, 1),
            },
            Self::SecondOrderWork { contacts } => of(3.0, *contacts),
            Self::WorkError { relative } => [4.0, *relative, 0.0],
            Self::Separated => of(5.0, 0),
            Self::StepCut { cuts } => of(6.0, *cuts),
            Self::SetAside { grains } => of(7.0, *grains),
            Self::Chattered { contacts } => of(8.0, *contacts),
            Self::ManyIterations { iterations, limit } => [9.0, *iterations as f64, *limit as f64],
            Self::NoModes => of(10.0, 0),
            Self::FloppyModesUncounted => of(11.0, 0),
            Self::LargeDisplacements(LargeMotion { size, motion }) => match motion {
                Motion::Branch(contact) => [12.0, *size, f64::from(contact.0)],
                Motion::Along(contact) => [13.0, *size, f64::from(contact.0)],
                Motion::Turn(grain) => [14.0, *size, f64::from(grain.0)],
            },
        }
    }

    /// The warning of a kind and its sizes; none where no warning is of that kind.
    pub fn of_numbers([kind, size, other]: [f64; WARNING_NUMBER_COUNT]) -> Option<Self> {
        let count = size as usize;
        Some(match kind as i64 {
            0 => Self::RegularisedPivots { count },
            1 => Self::ShearFloor { contacts: count },
            2 => Self::SolvedDirectly {
                breakdown: if count == 0 {
                    Breakdown::NotPositive
                } else {
                    Breakdown::Stagnated
                },
            },
            3 => Self::SecondOrderWork { contacts: count },
            4 => Self::WorkError { relative: size },
            5 => Self::Separated,
            6 => Self::StepCut { cuts: count },
            7 => Self::SetAside { grains: count },
            8 => Self::Chattered { contacts: count },
            9 => Self::ManyIterations {
                iterations: count,
                limit: other as usize,
            },
            10 => Self::NoModes,
            11 => Self::FloppyModesUncounted,
            12..=14 => Self::LargeDisplacements(LargeMotion {
                size,
                motion: match kind as i64 {
                    12 => Motion::Branch(ContactId(other as u32)),
                    13 => Motion::Along(ContactId(other as u32)),
                    _ => Motion::Turn(GrainId(other as u32)),
                },
            }),
            _ => return None,
        })
    }
}
