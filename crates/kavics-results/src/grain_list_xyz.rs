//! Lists of grains in extended XYZ: as many frames as wanted, each a count, a line of keys, and a line a grain.
//!
//! `Properties=species:S:1:pos:R:3:radius:R:1` names the columns: name, type and number of words. What is read is
//! `pos` (x and y of it) and `radius` or `diameter`, wherever they stand.

use std::fmt::Write;

use kavics::assembly::Grain;

use crate::grain_list_text::{Size, chosen, count, number, size};

/// A frame: the line of its count and how many grains follow.
#[derive(Clone, Copy, Debug)]
struct Frame {
    start: usize,
    grains: usize,
}

/// Rows of (x, y, radius) of a frame, from 0; of the last when none is given.
pub(crate) fn read(text: &str, frame: Option<usize>) -> Result<Vec<[f64; 3]>, String> {
    let lines: Vec<&str> = text.lines().collect();
    let Frame { start, grains } = chosen(frames(&lines, frame)?, frame)?;
    let columns = Columns::parse(lines[start + 1], start + 2)?;
    let rows = lines[start + 2..].iter().take(grains);
    let mut words = Vec::new();
    rows.enumerate()
        .map(|(row, line)| {
            words.clear();
            words.extend(line.split_ascii_whitespace());
            columns.row(&words, start + 3 + row)
        })
        .collect()
}

/// The frames of a file, up to the one that is asked for.
fn frames(lines: &[&str], wanted: Option<usize>) -> Result<Vec<Frame>, String> {
    let mut frames = Vec::new();
    let mut at = 0;
    while wanted.is_none_or(|wanted| frames.len() <= wanted) {
        let Some(blank) = lines[at..].iter().position(|line| !line.trim().is_empty()) else {
            break;
        };
        let start = at + blank;
        let grains = count(lines[start], start + 1)?;
        let Some(follow) = lines.len().checked_sub(start + 2) else {
            return Err(format!("line {}: the file ends after it", start + 1));
        };
        if follow < grains {
            return Err(format!(
                "line {}: {grains} grains are announced, and {follow} lines follow",
                start + 1
            ));
        }
        frames.push(Frame { start, grains });
        at = start + 2 + grains;
    }
    Ok(frames)
}

/// Where x, y and the size stand in a line of `words` words.
#[derive(Clone, Copy, Debug)]
struct Columns {
    x: usize,
    size: usize,
    kind: Size,
    name: &'static str,
    words: usize,
}

impl Columns {
    /// From the line of keys.
    fn parse(keys: &str, line: usize) -> Result<Self, String> {
        let properties = value(keys, "Properties")
            .ok_or_else(|| format!("line {line}: no `Properties=` names the columns"))?;
        let parts: Vec<&str> = properties.split(':').collect();
        let mut known: Vec<(&str, usize, usize)> = Vec::new();
        let mut words = 0_usize;
        for part in parts.chunks(3) {
            let (name, width) = column(part).ok_or_else(|| {
                format!(
                    "line {line}: `{}` of `Properties` is not a name, a type and a number of words",
                    part.join(":")
                )
            })?;
            known.push((name, words, width));
            words = words.saturating_add(width);
        }
        let find = |wanted: &str, width: usize| {
            let same = |c: &&(&str, usize, usize)| c.0.eq_ignore_ascii_case(wanted) && c.2 >= width;
            known.iter().find(same).map(|column| column.1)
        };
        let names = || {
            let quoted: Vec<String> = known.iter().map(|(name, ..)| format!("`{name}`")).collect();
            quoted.join(", ")
        };
        let x = find("pos", 2)
            .ok_or_else(|| format!("line {line}: no `pos` of two numbers among {}", names()))?;
        let size = Size::COLUMNS.iter().find_map(|(name, kind)| {
            let size = find(name, 1)?;
            Some((size, *kind, *name))
        });
        let (size, kind, name) = size
            .ok_or_else(|| format!("line {line}: no `radius` or `diameter` among {}", names()))?;
        Ok(Self {
            x,
            size,
            kind,
            name,
            words,
        })
    }

    fn row(&self, words: &[&str], line: usize) -> Result<[f64; 3], String> {
        if words.len() != self.words {
            return Err(format!(
                "line {line}: {} words where `Properties` names {}",
                words.len(),
                self.words
            ));
        }
        let x = number(words[self.x], line, "x")?;
        let y = number(words[self.x + 1], line, "y")?;
        let size = size(words[self.size], line, self.name)?;
        Ok([x, y, self.kind.radius(size)])
    }
}

/// Name and number of words of a column.
fn column<'a>(part: &[&'a str]) -> Option<(&'a str, usize)> {
    let [name, kind, width] = part else {
        return None;
    };
    let width: usize = width.parse().ok()?;
    (["S", "R", "I", "L"].contains(kind) && width > 0).then_some((*name, width))
}

/// The value of a key in a line such as `a=1 b="2 3"`.
fn value<'a>(line: &'a str, key: &str) -> Option<&'a str> {
    let mut quoted = false;
    let words = line.split(|c: char| {
        quoted ^= c == '"';
        c.is_ascii_whitespace() && !quoted
    });
    let mut pairs = words.filter_map(|word| word.split_once('='));
    let found = pairs.find(|(name, _)| name.eq_ignore_ascii_case(key));
    found.map(|(_, value)| value.trim_matches('"'))
}

/// Grains as one frame; every number reads back as the same bits.
pub(crate) fn written(grains: &[Grain]) -> String {
    let mut text = format!("{}\n", grains.len());
    text.push_str("Properties=species:S:1:pos:R:3:radius:R:1 pbc=\"F F F\"\n");
    for Grain { centre, radius } in grains {
        let _ = writeln!(text, "X {:?} {:?} 0.0 {radius:?}", centre.x, centre.y);
    }
    text
}
