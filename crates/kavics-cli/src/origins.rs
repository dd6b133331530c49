//! Where the lines of a changed scene come from, so that messages name places that the user knows.

/// Where a line comes from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Origin {
    /// A line of the file, from 1.
    File(usize),
    /// The change of this number.
    Change(usize),
}

/// Where each line of a changed text comes from.
#[derive(Clone, Debug)]
pub struct Origins {
    lines: Vec<Origin>,
}

impl Origins {
    /// Those of a text as it stands in the file.
    pub fn of_file(text: &str) -> Self {
        let lines = text.lines().enumerate();
        Self {
            lines: lines.map(|(i, _)| Origin::File(i + 1)).collect(),
        }
    }

    /// Those after change number `change` turned `old` into `new`.
    pub fn changed(&self, old: &str, new: &str, change: usize) -> Self {
        let (old, new): (Vec<&str>, Vec<&str>) = (old.lines().collect(), new.lines().collect());
        let mut lines = vec![Origin::Change(change); new.len()];
        for (i, j) in common(&old, &new) {
            lines[j] = self.lines[i];
        }
        Self { lines }
    }

    /// A message about the changed text called `name`, with lines of the file, or the change in their place as the user
    /// gave it.
    pub fn relocate(&self, message: &str, name: &str, changes: &[String]) -> String {
        let line = |line: &str| {
            self.place(line, name, changes)
                .or_else(|| self.gutter(line))
                .unwrap_or_else(|| line.to_owned())
        };
        let lines: Vec<String> = message.lines().map(line).collect();
        lines.join("\n")
    }

    fn origin(&self, line: &str) -> Option<Origin> {
        let number: usize = line.parse().ok()?;
        self.lines.get(number.checked_sub(1)?).copied()
    }

    /// A line like `  --> name:3:7`.
    fn place(&self, line: &str, name: &str, changes: &[String]) -> Option<String> {
        let (indent, place) = line.split_once("--> ")?;
        let (row, column) = place
            .strip_prefix(name)?
            .strip_prefix(':')?
            .split_once(':')?;
        Some(match self.origin(row)? {
            Origin::File(row) => format!("{indent}--> {name}:{row}:{column}"),
            Origin::Change(change) => format!("{indent}--> {}", changes[change]),
        })
    }

    /// A line like `3 | seed = 1`.
    fn gutter(&self, line: &str) -> Option<String> {
        let (number, source) = line.split_once(" |")?;
        let shown = match self.origin(number.trim_start())? {
            Origin::File(row) => row.to_string(),
            Origin::Change(_) => String::new(),
        };
        Some(format!("{shown:>width$} |{source}", width = number.len()))
    }
}

/// Pairs of equal lines in order, as many as possible: the longest common subsequence.
fn common(old: &[&str], new: &[&str]) -> Vec<(usize, usize)> {
    let mut longest = vec![vec![0_u32; new.len() + 1]; old.len() + 1];
    for i in (0..old.len()).rev() {
        for j in (0..new.len()).rev() {
            longest[i][j] = if old[i] == new[j] {
                longest[i + 1][j + 1] + 1
            } else {
                longest[i + 1][j].max(longest[i][j + 1])
            };
        }
    }
    let (mut i, mut j) = (0, 0);
    let mut pairs = Vec::new();
    while i < old.len() && j < new.len() {
        if old[i] == new[j] {
            pairs.push((i, j));
            (i, j) = (i + 1, j + 1);
        } else if longest[i + 1][j] >= longest[i][j + 1] {
            i += 1;
        } else {
            j += 1;
        }
    }
    pairs
}

#[cfg(test)]
mod tests {
    use super::Origins;

    #[test]
    fn lines_of_the_file_keep_their_numbers_and_changes_are_named() {
        let (old, new) = ("a = 1\n\n[b]\nc = 1\n", "a = 1\nd = 2\n\n[b]\nc = 3\n");
        let origins = Origins::of_file(old).changed(old, new, 0);
        let changes = ["--set d=2".to_owned()];
        let moved = |message: &str| origins.relocate(message, "s.toml", &changes);
        assert_eq!(
            moved(" --> s.toml:4:1\n  |\n4 | [b]\n  | ^^^"),
            " --> s.toml:3:1\n  |\n3 | [b]\n  | ^^^"
        );
        assert_eq!(
            moved(" --> s.toml:2:5\n  |\n2 | d = 2"),
            " --> --set d=2\n  |\n  | d = 2"
        );
        assert_eq!(moved("= help: 4 of | them"), "= help: 4 of | them");
    }

    #[test]
    fn other_ends_of_lines_change_no_number() {
        let (old, new) = ("a = 1\r\n\r\nb = 2\r\n", "d = 2\na = 1\n\nb = 2\n");
        let origins = Origins::of_file(old).changed(old, new, 0);
        let moved = origins.relocate(" --> s.toml:4:1", "s.toml", &["--set d=2".to_owned()]);
        assert_eq!(moved, " --> s.toml:3:1");
    }
}
