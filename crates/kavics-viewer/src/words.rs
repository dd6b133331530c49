//! Words by their places among names, the same places at every load step where the names are known beforehand.

use std::collections::HashMap;

/// The words that a column of a table can hold, where they do not depend on the scene.
pub(crate) fn known(table: &str, column: &str) -> &'static [&'static str] {
    match (table, column) {
        ("grains", "state") => &["free", "held", "rattler", "loose"],
        ("contacts", "state") => &["intact", "closed", "sliding", "open", "broken"],
        // Nothing is left of a broken bond without a successor.
        ("contacts", "law") => &["", "cemented", "cohesionless"],
        ("events", "kind") => &[
            "broke",
            "opened",
            "closed",
            "slid",
            "stuck",
            "set_aside",
            "taken_back",
        ],
        ("events", "mode") => &["", "tension", "compression", "shear", "bending"],
        _ => &[],
    }
}

/// The contact properties of a scene, in the order of the alphabet, after the empty word.
pub(crate) fn properties(scene: &str) -> Vec<String> {
    let scene: toml::Table = scene.parse().unwrap_or_default();
    let named = scene.get("contact").and_then(toml::Value::as_table);
    let mut names: Vec<String> = named
        .into_iter()
        .flat_map(|table| table.keys().cloned())
        .collect();
    names.sort_unstable();
    names.insert(0, String::new());
    names
}

/// Gives words their codes; names that are not known yet come after those that are.
#[derive(Debug)]
pub(crate) struct Coder<'a> {
    names: Vec<&'a str>,
    codes: HashMap<&'a str, u16>,
    last: Option<(&'a str, u16)>,
}

impl<'a> Coder<'a> {
    pub(crate) fn new(known: &'a [String]) -> Self {
        let names: Vec<&str> = known.iter().map(String::as_str).collect();
        let codes = names.iter().enumerate();
        Self {
            codes: codes.map(|(code, &name)| (name, code as u16)).collect(),
            names,
            last: None,
        }
    }

    pub(crate) fn code(&mut self, word: &'a str) -> u16 {
        // Neighbours mostly hold the same word.
        if let Some((last, code)) = self.last
            && last == word
        {
            return code;
        }
        let next = self.names.len() as u16;
        let code = *self.codes.entry(word).or_insert(next);
        if code == next {
            self.names.push(word);
        }
        self.last = Some((word, code));
        code
    }

    pub(crate) fn into_names(self) -> Vec<String> {
        self.names.into_iter().map(str::to_owned).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::{Coder, properties};

    #[test]
    fn known_names_come_first_and_others_as_they_are_met() {
        let known = ["a".to_owned(), "b".to_owned()];
        let mut coder = Coder::new(&known);
        let codes = ["b", "c", "c", "a", "d", "c"].map(|word| coder.code(word));
        assert_eq!(codes, [1, 2, 2, 0, 3, 2]);
        assert_eq!(coder.into_names(), ["a", "b", "c", "d"]);
    }

    #[test]
    fn properties_are_read_from_the_scene() {
        let scene = "[contact.mortar.cemented]\nx = 1\n[contact.grit.cohesionless]\ny = 2\n";
        assert_eq!(properties(scene), ["", "grit", "mortar"]);
        assert_eq!(properties("no TOML at all"), [""]);
    }
}
