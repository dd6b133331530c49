//! `checkpoint/`: what a run remembers and the rows that it has written, so that it can go on.
//!
//! One Arrow file a generation, with a single row: each column is a list. Its name has the xxh3 hash of its bytes, and
//! nothing of a file is believed before that was looked at. The header stands as JSON in the metadata of the schema.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};

use arrow_array::RecordBatch;
use kavics::equilibrium::Memory;
use kavics::ids::Id;
use kavics::scene::Scene;
use serde::{Deserialize, Serialize};
use xxhash_rust::xxh3::{Xxh3, xxh3_64};

use crate::ResultsError;
use crate::checkpoint_file;
use crate::encode::publish;
use crate::folder::ResultsFolder;

/// The folder of checkpoints.
pub(crate) const CHECKPOINT: &str = "checkpoint";

/// Version of what stands in a checkpoint; rises when its meaning changes.
pub const CHECKPOINT_VERSION: u32 = 1;

/// Generations that are kept.
const GENERATIONS: usize = 2;

/// What a checkpoint is of. What another version leaves out is empty, so that its number is looked at first.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(default)]
pub struct CheckpointHeader {
    /// Version of what stands in it.
    pub checkpoint_version: u32,
    /// Version of kavics.
    pub version: String,
    /// The load step from which the run goes on: the last one that is finished.
    pub step: usize,
    /// Bonds broken so far.
    pub broken: usize,
    /// Hash of the grains and contacts of the scene, in hexadecimal digits.
    pub assembly: String,
}

/// A checkpoint that was read.
#[derive(Debug)]
pub struct Checkpoint {
    /// What it is of.
    pub header: CheckpointHeader,
    /// What the load path remembers.
    pub memory: Memory,
    /// Of the checkpoints that could not be used.
    pub notes: Vec<String>,
    pub(crate) tables: BTreeMap<String, RecordBatch>,
}

impl Checkpoint {
    /// The newest checkpoint in a results folder that is whole; none where there is none.
    ///
    /// # Errors
    /// Another scene; checkpoints none of which is whole, or of a version that is not known.
    pub fn newest(folder: &Path, scene: &Scene) -> Result<Option<Self>, ResultsError> {
        check_same(folder, scene)?;
        let mut notes = Vec::new();
        for path in generations(folder)?.into_iter().rev() {
            match read(&path) {
                Ok(found) => return found.checked(folder, scene, notes).map(Some),
                Err(ResultsError::Damaged { path, reason }) => {
                    notes.push(format!("{}: {reason}", path.display()));
                }
                Err(other) => return Err(other),
            }
        }
        if notes.is_empty() {
            return Ok(None);
        }
        Err(ResultsError::NoCheckpoint {
            folder: folder.to_owned(),
            reasons: notes.join("\n"),
        })
    }

    fn checked(
        mut self,
        folder: &Path,
        scene: &Scene,
        notes: Vec<String>,
    ) -> Result<Self, ResultsError> {
        if self.header.assembly != assembly_hash(scene) {
            return Err(ResultsError::OtherAssembly {
                folder: folder.to_owned(),
                version: self.header.version,
            });
        }
        self.notes = notes;
        let mine = env!("CARGO_PKG_VERSION");
        if self.header.version != mine {
            self.notes.push(format!(
                "the run began with kavics {}; what kavics {mine} adds may differ in the last digits",
                self.header.version
            ));
        }
        Ok(self)
    }
}

/// Whether results are of this scene.
///
/// # Errors
/// A scene that differs from the one that ran, with the first line that does.
pub fn check_same(folder: &Path, scene: &Scene) -> Result<(), ResultsError> {
    let ran = match ResultsFolder::open(folder).and_then(|results| results.scene()) {
        Ok(ran) => ran,
        Err(refused @ ResultsError::Unreadable { .. }) if !refused.is_absence() => {
            return Err(refused);
        }
        Err(_) => return Ok(()),
    };
    if ran == scene.text {
        return Ok(());
    }
    let pairs = ran.lines().zip(scene.text.lines());
    let same = pairs.take_while(|(a, b)| a == b).count();
    let line = |text: &str| {
        let mut differing = text.lines().enumerate().skip(same);
        let told = differing.find(|(_, line)| !line.trim().is_empty());
        let end = || (text.lines().count(), "the end of the scene");
        let (number, line) = told.unwrap_or_else(end);
        (number + 1, line.trim().to_owned())
    };
    let ((line, ran), (_, now)) = (line(&ran), line(&scene.text));
    Err(ResultsError::SceneChanged {
        folder: folder.to_owned(),
        line,
        ran,
        now,
    })
}

/// A hash of all that the state of a run hangs on: grains, contacts and their properties.
pub(crate) fn assembly_hash(scene: &Scene) -> String {
    let mut hash = Xxh3::new();
    let assembly = &scene.assembly;
    for grain in assembly.grains.values() {
        for value in [grain.centre.x, grain.centre.y, grain.radius] {
            hash.update(&value.to_bits().to_le_bytes());
        }
    }
    for contact in assembly.contacts.values() {
        let [below, above] = contact.dual_parts;
        let shape = [below, above, contact.branch_length, contact.strength_factor];
        for value in shape {
            hash.update(&value.to_bits().to_le_bytes());
        }
        for partner in [contact.first, contact.second] {
            let body = assembly.body(partner).index() as u64;
            hash.update(&body.to_le_bytes());
        }
        hash.update(&contact.property.0.to_le_bytes());
    }
    format!("{:016x}", hash.digest())
}

/// Reads a generation.
fn read(path: &Path) -> Result<Checkpoint, ResultsError> {
    let bytes = fs::read(path).map_err(ResultsError::unreadable(path))?;
    let damaged = |reason: String| ResultsError::Damaged {
        path: path.to_owned(),
        reason,
    };
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    if parts(&name).map(|(_, hash)| hash) != Some(xxh3_64(&bytes)) {
        return Err(damaged(
            "damaged: its bytes do not have the hash of its name".to_owned(),
        ));
    }
    let header: CheckpointHeader =
        checkpoint_file::header(&bytes).map_err(|error| damaged(error.to_string()))?;
    if header.checkpoint_version != CHECKPOINT_VERSION {
        return Err(ResultsError::CheckpointVersion {
            path: path.to_owned(),
            found: header.checkpoint_version,
            version: header.version,
        });
    }
    let (memory, tables) =
        checkpoint_file::decode(&bytes).map_err(|error| damaged(error.to_string()))?;
    Ok(Checkpoint {
        header,
        memory,
        notes: Vec::new(),
        tables,
    })
}

/// Writes a generation, and takes away those that are too old.
pub(crate) fn write(
    folder: &Path,
    header: &CheckpointHeader,
    memory: Memory,
    tables: &[(&str, RecordBatch)],
) -> Result<(), ResultsError> {
    let place = folder.join(CHECKPOINT);
    if !place.is_dir() {
        fs::create_dir(&place).map_err(ResultsError::unwritable(&place))?;
    }
    let bytes = checkpoint_file::encode(header, memory, tables)
        .map_err(|error| ResultsError::unwritable(&place)(std::io::Error::other(error)))?;
    let old = generations(folder)?;
    let newest = old.last().and_then(|path| number(path)).unwrap_or(0);
    let name = format!("{:06}-{:016x}.arrow", newest + 1, xxh3_64(&bytes));
    publish(&place.join(name), &bytes)?;
    for path in old.iter().rev().skip(GENERATIONS - 1) {
        fs::remove_file(path).map_err(ResultsError::unwritable(path))?;
    }
    Ok(())
}

/// Takes away all checkpoints: a run that has ended does not go on.
///
/// # Errors
/// Files that cannot be removed.
pub fn clear_checkpoints(folder: &Path) -> Result<(), ResultsError> {
    let place = folder.join(CHECKPOINT);
    for path in generations(folder)? {
        fs::remove_file(&path).map_err(ResultsError::unwritable(&path))?;
    }
    // What does not belong to a run stays, and the folder with it.
    let _ = fs::remove_dir(place);
    Ok(())
}

/// The generations in a results folder, the oldest first.
fn generations(folder: &Path) -> Result<Vec<PathBuf>, ResultsError> {
    let place = folder.join(CHECKPOINT);
    if !place.is_dir() {
        return Ok(Vec::new());
    }
    let listed = fs::read_dir(&place).and_then(Iterator::collect);
    let listed: Vec<fs::DirEntry> = listed.map_err(ResultsError::unreadable(&place))?;
    let paths = listed.into_iter().map(|entry| entry.path());
    let mut found: Vec<PathBuf> = paths.filter(|path| number(path).is_some()).collect();
    found.sort_by_key(|path| number(path));
    Ok(found)
}

fn number(path: &Path) -> Option<u64> {
    parts(path.file_name()?.to_str()?).map(|(number, _)| number)
}

/// Number and hash of `000012-0123456789abcdef.arrow`.
fn parts(name: &str) -> Option<(u64, u64)> {
    let (number, hash) = name.strip_suffix(".arrow")?.split_once('-')?;
    if number.len() < 6 || hash.len() != 16 {
        return None;
    }
    Some((number.parse().ok()?, u64::from_str_radix(hash, 16).ok()?))
}

/// Whether a file is a checkpoint, or what is left of one.
pub(crate) fn is_generation(name: &str) -> bool {
    let name = name.strip_prefix('.').unwrap_or(name);
    let end = name.find(".arrow").map_or(0, |at| at + ".arrow".len());
    parts(&name[..end]).is_some()
}
