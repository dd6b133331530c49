//! What is wrong with a scene, shown in its lines.

use std::ops::Range;

use annotate_snippets::renderer::DecorStyle;
use annotate_snippets::{AnnotationKind, Level, Renderer, Snippet};

/// A mistake in the scene file.
#[derive(Clone, Debug)]
pub struct Problem {
    message: String,
    marks: Vec<Mark>,
    help: Vec<String>,
}

#[derive(Clone, Debug)]
struct Mark {
    span: Range<usize>,
    label: String,
}

impl Problem {
    /// A mistake at a place, with what is wrong there.
    pub fn at(span: &Range<usize>, message: impl Into<String>, label: impl Into<String>) -> Self {
        Self {
            message: brief(&message.into()),
            marks: vec![Mark {
                span: span.clone(),
                label: brief(&label.into()),
            }],
            help: Vec::new(),
        }
    }

    /// The same mistake with another place that has to do with it.
    pub fn and(mut self, span: &Range<usize>, label: impl Into<String>) -> Self {
        self.marks.push(Mark {
            span: span.clone(),
            label: brief(&label.into()),
        });
        self
    }

    /// The same mistake with what was expected.
    pub fn help(mut self, help: impl Into<String>) -> Self {
        self.help.push(brief(&help.into()));
        self
    }

    /// The same mistake with a likely correction, if there is one.
    pub fn suggest(self, suggestion: Option<&str>) -> Self {
        match suggestion {
            Some(name) => self.help(format!("did you mean `{name}`?")),
            None => self,
        }
    }

    fn render(&self, text: &str, name: &str) -> String {
        let mut snippet = Snippet::source(text).path(name);
        for (i, mark) in self.marks.iter().enumerate() {
            let kind = if i == 0 {
                AnnotationKind::Primary
            } else {
                AnnotationKind::Context
            };
            let span = shown(&mark.span, text);
            snippet = snippet.annotation(kind.span(span).label(mark.label.as_str()));
        }
        let mut group = Level::ERROR
            .primary_title(self.message.as_str())
            .element(snippet);
        for help in &self.help {
            group = group.element(Level::HELP.message(help.as_str()));
        }
        let renderer = Renderer::plain().decor_style(DecorStyle::Ascii);
        renderer.render(&[group])
    }
}

/// Characters of a quote that are shown, at its beginning and at its end.
const QUOTED: [usize; 2] = [40, 20];

/// A sentence in which long quotes are cut in their middle.
fn brief(sentence: &str) -> String {
    let mut open = None;
    let is_end = |character: char| match open {
        None if matches!(character, '`' | '"') => {
            open = Some(character);
            true
        }
        Some(begin) if begin == character => {
            open = None;
            true
        }
        _ => false,
    };
    let parts = sentence.split_inclusive(is_end).enumerate();
    let quoted = |(number, part): (usize, &str)| match number % 2 {
        0 => part.to_owned(),
        _ => cut(part),
    };
    parts.map(quoted).collect()
}

fn cut(quote: &str) -> String {
    let [first, last] = QUOTED;
    let characters: Vec<char> = quote.chars().collect();
    if characters.len() <= first + last + 1 {
        return quote.to_owned();
    }
    let ends = [
        &characters[..first],
        &['…'],
        &characters[characters.len() - last - 1..],
    ];
    ends.concat().into_iter().collect()
}

/// A span cut to what exists of the text, and to its first line.
fn shown(span: &Range<usize>, text: &str) -> Range<usize> {
    let floor = |mut at: usize| {
        at = at.min(text.len());
        while !text.is_char_boundary(at) {
            at -= 1;
        }
        at
    };
    let start = floor(span.start);
    let end = floor(span.end).max(start);
    let line = text[start..end].find('\n').map_or(end, |n| start + n);
    start..line
}

/// How many mistakes are told.
const SHOWN: usize = 20;

/// The mistakes found so far.
#[derive(Debug, Default)]
pub struct Problems {
    list: Vec<Problem>,
}

impl Problems {
    /// Adds a mistake.
    pub fn push(&mut self, problem: Problem) {
        self.list.push(problem);
    }

    /// Whether none was found.
    pub fn is_empty(&self) -> bool {
        self.list.is_empty()
    }

    /// All mistakes as the user sees them, in the order of their places.
    pub fn render(mut self, text: &str, name: &str) -> String {
        self.list.sort_by_key(|problem| problem.marks[0].span.start);
        let shown = self.list.iter().take(SHOWN);
        let mut blocks: Vec<String> = shown.map(|p| p.render(text, name)).collect();
        if let Some(more @ 1..) = self.list.len().checked_sub(SHOWN) {
            blocks.push(format!("and {more} more"));
        }
        blocks.join("\n\n")
    }
}

/// The candidate that a mistyped name is likely to be.
pub fn likely<'a>(name: &str, candidates: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    let similarity = |candidate: &str| strsim::damerau_levenshtein(name, candidate);
    candidates
        .into_iter()
        .map(|candidate| (similarity(candidate), candidate))
        .filter(|(distance, candidate)| {
            *distance <= (name.chars().count().max(candidate.chars().count()) / 3).max(1)
                && *distance < name.chars().count()
        })
        .min_by_key(|(distance, _)| *distance)
        .map(|(_, candidate)| candidate)
}

/// Names in a sentence: "`a`, `b` or `c`".
pub fn either<'a>(names: impl IntoIterator<Item = &'a str>) -> String {
    let names: Vec<String> = names.into_iter().map(|name| format!("`{name}`")).collect();
    match names.split_last() {
        None => String::new(),
        Some((last, [])) => last.clone(),
        Some((last, others)) => format!("{} or {last}", others.join(", ")),
    }
}

/// A number with six digits.
pub fn short(value: f64) -> String {
    let rounded = format!("{value:.5e}").parse::<f64>();
    let rounded = rounded.unwrap_or(value);
    if rounded == 0.0 || (1e-4..1e9).contains(&rounded.abs()) {
        rounded.to_string()
    } else {
        format!("{rounded:e}")
    }
}

/// What serde calls things, and what a user of scene files does.
const WORDS: [(&str, &str); 8] = [
    ("invalid type: map", "invalid type: a table"),
    ("invalid type: sequence", "invalid type: a list"),
    ("floating point ", "number "),
    ("i64", "a whole number"),
    ("a sequence", "a list"),
    ("a map", "a table"),
    ("a string", "a word in quotes"),
    ("a boolean", "`true` or `false`"),
];

/// What the TOML reader says of a text, in our words.
pub fn from_toml(error: &toml::de::Error, text: &str) -> Problem {
    let span = error.span().unwrap_or(0..0);
    if let Some(problem) =
        wrong_brackets(error.message(), &span, text).or_else(|| too_large(error.message(), &span))
    {
        return problem;
    }
    let message = WORDS
        .iter()
        .fold(error.message().to_owned(), |text, (theirs, ours)| {
            text.replace(theirs, ours)
        });
    let message = message.as_str();
    if message.starts_with("string values must be quoted") {
        return Problem::at(
            &span,
            "text without quotes",
            "expected quotes around a word or a number with a unit",
        )
        .help("write for example `\"30 GPa\"`");
    }
    let quoted: Vec<&str> = message.split('`').skip(1).step_by(2).collect();
    match quoted.split_first() {
        Some((key, names)) if message.starts_with("unknown field") => {
            let problem = Problem::at(&span, format!("unknown key `{key}`"), "not known here");
            let known = if names.is_empty() {
                "nothing is expected here".to_owned()
            } else {
                format!("expected {}", either(names.iter().copied()))
            };
            let problem = match *key {
                "layer" if names.contains(&"dropped") => {
                    problem.help("write `dropped = { … }` or `[layer.dropped]` below `[[layer]]`")
                }
                _ => problem,
            };
            problem
                .help(known)
                .suggest(likely(key, names.iter().copied()))
        }
        Some((key, [])) if message.starts_with("missing field") => Problem::at(
            &span,
            format!("missing key `{key}`"),
            format!("`{key}` is missing here"),
        ),
        _ => match message.split_once(", expected ") {
            Some((what, expected)) => Problem::at(&span, what, format!("expected {expected}")),
            None => Problem::at(&span, "this is not TOML as a scene has it", message),
        },
    }
}

/// `[load]` for `[[load]]`, and the other way round.
fn wrong_brackets(message: &str, span: &Range<usize>, text: &str) -> Option<Problem> {
    let before = text.get(..span.start)?;
    let header = text.get(shown(span, text))?;
    let single = header.strip_prefix('[')?.strip_suffix(']')?;
    let (is, right) = match message {
        _ if !before.is_empty() && !before.ends_with('\n') => return None,
        _ if message.starts_with("invalid type: map") => ("a table", format!("[{header}]")),
        _ if message.starts_with("invalid type: sequence") => {
            ("a list of tables", single.to_owned())
        }
        _ => return None,
    };
    Some(Problem::at(
        span,
        format!("`{header}` begins {is}"),
        format!("expected `{right}`"),
    ))
}

/// A whole number that the TOML reader has no type for.
fn too_large(message: &str, span: &Range<usize>) -> Option<Problem> {
    let number = message
        .strip_prefix("invalid value: integer `")
        .or_else(|| message.strip_prefix("invalid type: integer `"))?;
    let (number, rest) = number.split_once('`')?;
    let large = rest.contains("128") || message.starts_with("invalid value");
    large.then(|| {
        let message = format!("the whole number {number} is too large");
        Problem::at(span, message, "expected at most 9223372036854775807")
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn likely_names_are_near() {
        assert_eq!(likely("mortr", ["grit", "mortar"]), Some("mortar"));
        assert_eq!(likely("xyz", ["grit", "mortar"]), None);
        assert_eq!(likely("x", ["y"]), None);
    }

    #[test]
    fn numbers_are_short() {
        assert_eq!(short(0.1 + 0.2), "0.3");
        assert_eq!(short(-1_234.567_89), "-1234.57");
        assert_eq!(short(2.5e-7), "2.5e-7");
        assert_eq!(short(0.0), "0");
    }

    #[test]
    fn only_long_quotes_are_cut() {
        let prose = "x".repeat(90);
        let key = "k".repeat(1_000_000);
        let short = format!("{prose} `solver = \"auto\"` {prose}");
        assert_eq!(brief(&short), short);
        let long = format!("{prose} `{key}` {prose}");
        let (begin, end) = ("k".repeat(40), "k".repeat(20));
        assert_eq!(brief(&long), format!("{prose} `{begin}…{end}` {prose}"));
    }

    #[test]
    fn a_span_outside_the_text_is_cut() {
        assert_eq!(shown(&(3..90), "aé"), 3..3);
        assert_eq!(shown(&(2..90), "aé\nb"), 1..3);
    }
}
