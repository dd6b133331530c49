//! Checksums in the footer of a Parquet file, by which a damaged table is told from a whole one.
//!
//! The library that writes the files has no checksums of pages. So the metadata of the footer have hashes (xxh3) of all
//! bytes of the file: of each block of what comes before the footer, and of the footer itself, in which the digits of its
//! own hash count as zeros. A reader looks at the footer and at the blocks of the columns that it reads, and no more. It
//! finds them by their bytes, as the place that a damaged footer gives may be wrong.

use std::collections::BTreeSet;
use std::fs::File;
use std::io::{self, Read, Seek, SeekFrom, Write};
use std::ops::Range;

use xxhash_rust::xxh3::{Xxh3, xxh3_64};

/// The name of the checksums among the metadata of the footer.
pub(crate) const KEY: &str = "kavics.checksums";

/// How the footer names kavics as the writer of the file: what others make of our tables may keep the checksums, which
/// are then of other bytes.
pub(crate) const WRITER: &str = "kavics version ";

/// What the numbers begin with: the hash of the footer, the bytes before it, the hash of each block of these.
const FUNCTION: &str = "xxh3";

/// Hexadecimal digits of a number, and those of a hash that is not known yet.
const DIGITS: usize = 16;
const UNKNOWN: u64 = 0;

/// Bytes of a block.
const BLOCK: u64 = 1 << 18;

/// Hashes what is written through it; from [`Summed::seal`] on it is kept back, as the footer holds its own checksum.
pub(crate) struct Summed<W> {
    to: W,
    block: Xxh3,
    written: u64,
    blocks: Vec<u64>,
    footer: Option<Vec<u8>>,
}

impl<W: Write> Summed<W> {
    pub(crate) fn new(to: W) -> Self {
        Self {
            to,
            block: Xxh3::new(),
            written: 0,
            blocks: Vec::new(),
            footer: None,
        }
    }

    /// What follows is the footer, whose metadata have the text that comes back.
    pub(crate) fn seal(&mut self) -> String {
        if !self.written.is_multiple_of(BLOCK) {
            self.end_block();
        }
        self.footer = Some(Vec::new());
        let numbers = [UNKNOWN, self.written]
            .into_iter()
            .chain(self.blocks.drain(..));
        let numbers = numbers.map(|number| format!(" {number:016x}"));
        numbers.fold(FUNCTION.to_owned(), |text, number| text + &number)
    }

    /// Writes the footer with its checksum.
    pub(crate) fn finish(mut self) -> io::Result<()> {
        let mut footer = self.footer.take().unwrap_or_default();
        let sum = format!("{:016x}", xxh3_64(&footer));
        if let Some(first) = first_number(&footer) {
            footer[first..first + DIGITS].copy_from_slice(sum.as_bytes());
        }
        self.to.write_all(&footer)?;
        self.to.flush()
    }

    fn end_block(&mut self) {
        self.blocks.push(self.block.digest());
        self.block.reset();
    }
}

impl<W: Write> Write for Summed<W> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        if let Some(footer) = &mut self.footer {
            return footer.write(bytes);
        }
        let left = (BLOCK - self.written % BLOCK) as usize;
        let count = self.to.write(&bytes[..left.min(bytes.len())])?;
        self.block.update(&bytes[..count]);
        self.written += count as u64;
        if count == left {
            self.end_block();
        }
        Ok(count)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.to.flush()
    }
}

/// The last place of a word among bytes.
fn place_of(bytes: &[u8], word: &str) -> Option<usize> {
    let mut windows = bytes.windows(word.len());
    windows.rposition(|window| window == word.as_bytes())
}

/// Where the first of the numbers stands in a footer.
fn first_number(footer: &[u8]) -> Option<usize> {
    let after = place_of(footer, KEY)? + KEY.len();
    let mut windows = footer[after..].windows(FUNCTION.len());
    let function = windows.position(|window| window == FUNCTION.as_bytes())?;
    Some(after + function + FUNCTION.len() + 1).filter(|first| first + DIGITS <= footer.len())
}

/// The number that begins at a place.
fn number(bytes: &[u8], first: usize) -> Option<u64> {
    let digits = str::from_utf8(bytes.get(first..first + DIGITS)?).ok()?;
    u64::from_str_radix(digits, 16).ok()
}

/// What the bytes of a file tell of themselves.
#[derive(Debug)]
pub(crate) enum Checksums {
    /// The file is of others, or of a version that kept no checksums.
    None,
    /// The footer is damaged.
    Damaged,
    /// The footer is whole.
    Blocks {
        /// Bytes before the footer.
        length: u64,
        /// The hash of each block of them.
        hashes: Vec<u64>,
    },
}

impl Checksums {
    /// Those of a file of so many bytes.
    ///
    /// # Errors
    /// A file that cannot be read.
    pub(crate) fn read(file: &mut File, length: u64) -> io::Result<Self> {
        let metadata = metadata(file, length)?;
        if place_of(&metadata, WRITER).is_none() || place_of(&metadata, KEY).is_none() {
            return Ok(Self::None);
        }
        let before = first_number(&metadata).and_then(|at| number(&metadata, at + DIGITS + 1));
        let Some(before) = before.filter(|before| *before <= length) else {
            return Ok(Self::Damaged);
        };
        let footer = bytes(file, before..length)?;
        Ok(Self::of(footer, before).unwrap_or(Self::Damaged))
    }

    fn of(mut footer: Vec<u8>, length: u64) -> Option<Self> {
        let first = first_number(&footer)?;
        let own = number(&footer, first)?;
        let at = |block: u64| first + (DIGITS + 1) * (2 + block as usize);
        let hashes = (0..length.div_ceil(BLOCK)).map(|block| number(&footer, at(block)));
        let hashes = hashes.collect::<Option<Vec<u64>>>()?;
        footer[first..first + DIGITS].fill(b'0');
        (own == xxh3_64(&footer)).then_some(Self::Blocks { length, hashes })
    }

    /// Whether all blocks are whole that hold some of these ranges of bytes.
    ///
    /// # Errors
    /// A file that cannot be read.
    pub(crate) fn hold(
        &self,
        file: &mut File,
        ranges: impl Iterator<Item = Range<u64>>,
    ) -> io::Result<bool> {
        let Self::Blocks { length, hashes } = self else {
            return Ok(matches!(self, Self::None));
        };
        let blocks = |range: Range<u64>| range.start / BLOCK..range.end.div_ceil(BLOCK);
        let wanted: BTreeSet<u64> = ranges.flat_map(blocks).collect();
        for block in wanted {
            let start = block * BLOCK;
            let found = bytes(file, start..(start + BLOCK).min(*length))?;
            if hashes.get(block as usize) != Some(&xxh3_64(&found)) {
                return Ok(false);
            }
        }
        Ok(true)
    }
}

/// The metadata at the end of a Parquet file, after the four bytes that follow them; nothing where it is none.
fn metadata(file: &mut File, length: u64) -> io::Result<Vec<u8>> {
    let end = bytes(file, length.saturating_sub(8)..length)?;
    let count = end
        .first_chunk()
        .map_or(0, |count| u32::from_le_bytes(*count));
    let first = length.saturating_sub(8 + u64::from(count));
    bytes(file, first..length)
}

fn bytes(file: &mut File, range: Range<u64>) -> io::Result<Vec<u8>> {
    file.seek(SeekFrom::Start(range.start))?;
    let mut bytes = Vec::new();
    let count = range.end.saturating_sub(range.start);
    (&*file).take(count).read_to_end(&mut bytes)?;
    Ok(bytes)
}
