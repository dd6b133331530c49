//! Lists of grains in dump files of LAMMPS: frames of sections that begin with `ITEM:`.
//!
//! What is read of a frame is the number of atoms, `x` and `y` (or unwrapped `xu`, scaled `xs`, both `xsu`) and `radius`
//! or `diameter`. Grains come in the order of the column `id`, or without one in that of the file.

use std::fmt::Write;

use kavics::assembly::Grain;

use crate::grain_list_text::{Size, chosen, count, number, size};

/// A line with its number, from 1.
type Line<'a> = (usize, &'a str);

/// Rows of (x, y, radius) of a frame, from 0; of the last when none is given.
pub(crate) fn read(text: &str, frame: Option<usize>) -> Result<Vec<[f64; 3]>, String> {
    let lines: Vec<Line<'_>> = (1..)
        .zip(text.lines().map(str::trim))
        .filter(|(_, line)| !line.is_empty())
        .collect();
    if let Some((number, line)) = lines.first()
        && !line.starts_with("ITEM:")
    {
        return Err(format!(
            "line {number}: expected `ITEM: TIMESTEP`, not \"{}\"",
            cut(line)
        ));
    }
    let starts: Vec<usize> = (0..lines.len())
        .filter(|i| lines[*i].1 == "ITEM: TIMESTEP")
        .collect();
    let ends = starts.iter().skip(1).copied().chain([lines.len()]);
    let frames = starts.iter().zip(ends).map(|(&from, to)| &lines[from..to]);
    Frame(chosen(frames.collect(), frame)?).rows()
}

/// What is told of a line.
fn cut(line: &str) -> String {
    line.chars().take(40).collect()
}

/// The lines of a frame.
struct Frame<'a>(&'a [Line<'a>]);

impl<'a> Frame<'a> {
    /// What stands beside the name of a section, and the lines below it.
    fn section(&self, name: &str) -> Result<(Line<'a>, &'a [Line<'a>]), String> {
        let head = self.0.iter().position(|(_, line)| line.starts_with(name));
        let head = head.ok_or_else(|| {
            let first = self.0.first().map_or(1, |line| line.0);
            format!("line {first}: the frame has no `{name}`")
        })?;
        let below = &self.0[head + 1..];
        let end = below.iter().position(|(_, line)| line.starts_with("ITEM:"));
        let (number, line) = self.0[head];
        let beside = line[name.len()..].trim();
        Ok(((number, beside), &below[..end.unwrap_or(below.len())]))
    }

    fn rows(&self) -> Result<Vec<[f64; 3]>, String> {
        let ((line, _), below) = self.section("ITEM: NUMBER OF ATOMS")?;
        let announced = below.first();
        let &(line, text) = announced.ok_or_else(|| format!("line {line}: no number follows"))?;
        let announced = count(text, line)?;
        let (header, atoms) = self.section("ITEM: ATOMS")?;
        if atoms.len() != announced {
            return Err(format!(
                "line {line}: {announced} atoms are announced, and {} follow",
                atoms.len()
            ));
        }
        let columns = Columns::find(header, self)?;
        let mut words = Vec::new();
        let mut rows = Vec::new();
        for (line, text) in atoms {
            words.clear();
            words.extend(text.split_ascii_whitespace());
            rows.push(columns.row(&words, *line)?);
        }
        if columns.id.is_some() {
            sort(&mut rows)?;
        }
        Ok(rows.into_iter().map(|row| row.grain).collect())
    }

    /// Lower bound and length of the box along an axis.
    fn bounds(&self, axis: usize) -> Result<[f64; 2], String> {
        let ((line, kind), below) = self.section("ITEM: BOX BOUNDS")?;
        if kind.contains("xy") || kind.contains("abc") {
            return Err(format!(
                "line {line}: scaled coordinates are read in an orthogonal box only"
            ));
        }
        let &(line, text) = below
            .get(axis)
            .ok_or_else(|| format!("line {line}: bounds are missing"))?;
        let words: Vec<&str> = text.split_ascii_whitespace().collect();
        let [low, high] = words.as_slice() else {
            return Err(format!(
                "line {line}: expected two bounds, not \"{}\"",
                cut(text)
            ));
        };
        let (low, high) = (number(low, line, "lo")?, number(high, line, "hi")?);
        Ok([low, high - low])
    }
}

/// A grain, its id and its line.
struct Row {
    id: u64,
    line: usize,
    grain: [f64; 3],
}

fn sort(rows: &mut [Row]) -> Result<(), String> {
    rows.sort_by_key(|row| row.id);
    let twice = rows.windows(2).find(|pair| pair[0].id == pair[1].id);
    twice.map_or(Ok(()), |pair| {
        let (line, first) = (pair[1].line, pair[0].line);
        let id = pair[0].id;
        Err(format!(
            "line {line}, column `id`: {id} stands in line {first} as well"
        ))
    })
}

/// Names of the columns of an axis, in the order in which they are looked for, and whether they are scaled.
const COORDINATES: [[(&str, bool); 4]; 2] = [
    [("x", false), ("xu", false), ("xs", true), ("xsu", true)],
    [("y", false), ("yu", false), ("ys", true), ("ysu", true)],
];

/// A column of a coordinate: its place, its name, and lower bound and length of the box if it is scaled.
type Coordinate = (usize, &'static str, Option<[f64; 2]>);

struct Columns {
    id: Option<usize>,
    coordinates: [Coordinate; 2],
    size: (usize, &'static str, Size),
    words: usize,
}

impl Columns {
    fn find((line, header): Line<'_>, frame: &Frame<'_>) -> Result<Self, String> {
        let names: Vec<&str> = header.split_ascii_whitespace().collect();
        let place = |name: &str| names.iter().position(|other| *other == name);
        let missing = |what: &str| {
            let quoted: Vec<String> = names.iter().map(|name| format!("`{name}`")).collect();
            format!("line {line}: no {what} among {}", quoted.join(", "))
        };
        let coordinate = |axis: usize, what: &str| -> Result<Coordinate, String> {
            let found = COORDINATES[axis]
                .iter()
                .find_map(|(name, scaled)| Some((place(name)?, *name, *scaled)));
            let (place, name, scaled) = found.ok_or_else(|| missing(what))?;
            let bounds = if scaled {
                Some(frame.bounds(axis)?)
            } else {
                None
            };
            Ok((place, name, bounds))
        };
        let size = Size::COLUMNS
            .iter()
            .find_map(|(name, kind)| Some((place(name)?, *name, *kind)));
        Ok(Self {
            id: place("id"),
            coordinates: [
                coordinate(0, "`x`, `xu` or `xs`")?,
                coordinate(1, "`y`, `yu` or `ys`")?,
            ],
            size: size.ok_or_else(|| missing("`radius` or `diameter`"))?,
            words: names.len(),
        })
    }

    fn row(&self, words: &[&str], line: usize) -> Result<Row, String> {
        if words.len() != self.words {
            return Err(format!(
                "line {line}: {} words for {} columns",
                words.len(),
                self.words
            ));
        }
        let coordinate = |(place, name, bounds): Coordinate| {
            let value = number(words[place], line, name)?;
            Ok::<_, String>(bounds.map_or(value, |[low, length]| low + value * length))
        };
        let [x, y] = self.coordinates;
        let (place, name, kind) = self.size;
        let radius = kind.radius(size(words[place], line, name)?);
        Ok(Row {
            id: self.id.map_or(Ok(0), |place| id(words[place], line))?,
            line,
            grain: [coordinate(x)?, coordinate(y)?, radius],
        })
    }
}

fn id(word: &str, line: usize) -> Result<u64, String> {
    word.parse()
        .map_err(|_| format!("line {line}, column `id`: \"{word}\" is not an id"))
}

/// Grains as one frame, their ids from 1; every number reads back as the same bits.
pub(crate) fn written(grains: &[Grain]) -> String {
    let count = grains.len();
    let mut text = format!("ITEM: TIMESTEP\n0\nITEM: NUMBER OF ATOMS\n{count}\n");
    text.push_str("ITEM: BOX BOUNDS ff ff ff\n");
    let extent = |value: fn(&Grain) -> f64| {
        let ends = grains
            .iter()
            .map(|g| (value(g) - g.radius, value(g) + g.radius));
        ends.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], (a, b)| {
            [low.min(a), high.max(b)]
        })
    };
    for [low, high] in [extent(|g| g.centre.x), extent(|g| g.centre.y), [-0.5, 0.5]] {
        let _ = writeln!(text, "{low:?} {high:?}");
    }
    text.push_str("ITEM: ATOMS id type x y z radius\n");
    for (id, Grain { centre, radius }) in (1..).zip(grains) {
        let _ = writeln!(text, "{id} 1 {:?} {:?} 0.0 {radius:?}", centre.x, centre.y);
    }
    text
}
