//! docs/keys.md has every key of the scene file, from the schema that the command writes.

use std::collections::BTreeSet;
use std::fmt::Write as _;
use std::fs;
use std::path::Path;
use std::process::Command;

use serde_json::{Map, Value};

const HEAD: &str = "\
# Keys of the scene file

Every table and key that a scene may have, made from the JSON Schema that `kavics schema` writes; a test keeps it so. How they
work together is told in [scene file](scene-file.md).

A *quantity* is a number, or a string with a number and a unit, such as `\"2.5 mm\"`, or a word that the meaning names. `NAME` is
a name of your own, or that of a side. Keys with *needed* must be there where their table is; — means that there is no
default: what the key asks for is left out.
";

/// A table of the scene: its definition in the schema, and where it may stand.
struct Table<'a> {
    definition: &'a str,
    paths: Vec<String>,
}

/// The schema, read.
struct Schema {
    root: Value,
}

impl Schema {
    fn read() -> Self {
        let mut command = Command::new(env!("CARGO_BIN_EXE_kavics"));
        let output = command.arg("schema").output().expect("the command runs");
        let root = serde_json::from_slice(&output.stdout).expect("JSON");
        Self { root }
    }

    fn definition(&self, name: &str) -> &Value {
        &self.root["$defs"][name]
    }

    /// The table that a key may hold, alone or in place of something else.
    fn table<'a>(&'a self, schema: &'a Value) -> Option<&'a str> {
        let Some(name) = schema["$ref"].as_str().and_then(|r| r.rsplit('/').next()) else {
            return choices(schema).find_map(|choice| self.table(choice));
        };
        let definition = self.definition(name);
        let has_keys = definition.get("properties").is_some();
        has_keys
            .then_some(name)
            .or_else(|| choices(definition).find_map(|choice| self.table(choice)))
    }

    /// The table below a key, and what its path ends with.
    fn below<'a>(&'a self, key: &str, schema: &'a Value) -> Option<(String, &'a str)> {
        if let Some(name) = self.table(&schema["additionalProperties"]) {
            return Some((format!("{key}.NAME"), name));
        }
        let name = self.table(schema).or_else(|| self.table(&schema["items"]));
        Some((key.to_owned(), name?))
    }

    /// All tables below one, each once, in the order in which they are met.
    fn tables<'a>(&'a self, path: &str, keys: &'a Map<String, Value>, all: &mut Vec<Table<'a>>) {
        for (key, schema) in keys {
            let Some((key, definition)) = self.below(key, schema) else {
                continue;
            };
            let path = format!("{path}{key}");
            match all.iter_mut().find(|table| table.definition == definition) {
                Some(table) => table.paths.push(path.clone()),
                None => all.push(Table {
                    definition,
                    paths: vec![path.clone()],
                }),
            }
            self.tables(
                &format!("{path}."),
                keys_of(self.definition(definition)),
                all,
            );
        }
    }

    /// The type of a key's value.
    fn kind(&self, schema: &Value, tables: &[Table]) -> String {
        if let Some(name) = schema["$ref"].as_str().and_then(|r| r.rsplit('/').next()) {
            return self.kind_of_definition(name, tables);
        }
        if let Some(item) = schema.get("items") {
            return format!("list: {}", self.kind(item, tables));
        }
        if schema["additionalProperties"].is_object() {
            return format!(
                "names: {}",
                self.kind(&schema["additionalProperties"], tables)
            );
        }
        let kinds: Vec<String> = match &schema["type"] {
            Value::String(kind) => vec![kind.clone()],
            Value::Array(all) => all
                .iter()
                .filter_map(Value::as_str)
                .map(Into::into)
                .collect(),
            _ => choices(schema)
                .map(|choice| self.kind(choice, tables))
                .collect(),
        };
        let kinds = kinds
            .into_iter()
            .filter(|kind| !kind.is_empty() && kind != "null");
        kinds.collect::<Vec<_>>().join(" or ")
    }

    fn kind_of_definition(&self, name: &str, tables: &[Table]) -> String {
        let table = tables.iter().find(|table| table.definition == name);
        match table {
            Some(table) => format!("[table](#{})", anchor(&table.paths[0])),
            None if name == "Quantity" => "quantity".to_owned(),
            None => self.kind(self.definition(name), tables),
        }
    }

    fn rows(&self, schema: &Value, tables: &[Table]) -> String {
        let mut text = String::from("\n| key | type | default | meaning |\n|---|---|---|---|\n");
        let needed = schema["required"].as_array();
        for (key, value) in keys_of(schema) {
            let is_needed = needed.is_some_and(|all| all.iter().any(|name| name == key));
            let meaning = described(value);
            let default = if is_needed {
                "*needed*".to_owned()
            } else {
                default_in(&meaning).unwrap_or_else(|| "—".to_owned())
            };
            let kind = self.kind(value, tables);
            let meaning = meaning.replace('|', "\\|").replace('*', "\\*");
            let _ = writeln!(text, "| `{key}` | {kind} | {default} | {meaning} |");
        }
        text
    }

    fn page(&self) -> String {
        let mut tables = Vec::new();
        self.tables("", keys_of(&self.root), &mut tables);
        let mut page = format!("{HEAD}\n## Top of the file\n");
        page += &self.rows(&self.root, &tables);
        for table in &tables {
            let definition = self.definition(table.definition);
            let _ = write!(
                page,
                "\n## `{}`\n\n{}\n",
                table.paths[0],
                described(definition)
            );
            if table.paths.len() > 1 {
                let others = table.paths[1..].iter().map(|path| format!("`{path}`"));
                let others: Vec<String> = others.collect();
                let _ = write!(page, "\nThe same keys: {}\n", others.join(", "));
            }
            page += &self.rows(definition, &tables);
        }
        page
    }
}

fn choices(schema: &Value) -> impl Iterator<Item = &Value> {
    schema["anyOf"].as_array().into_iter().flatten()
}

fn keys_of(schema: &Value) -> &Map<String, Value> {
    schema["properties"].as_object().expect("keys")
}

fn described(schema: &Value) -> String {
    let text = schema["description"].as_str().expect("a description");
    text.replace('\n', " ")
}

/// The name of a heading in links.
fn anchor(heading: &str) -> String {
    let kept = heading.chars().filter(|c| c.is_alphanumeric() || *c == '-');
    kept.collect::<String>().to_lowercase()
}

/// What a description says of a key that is absent.
fn default_in(meaning: &str) -> Option<String> {
    let (before, after) = meaning.split_once("when absent")?;
    let clause = before
        .rsplit(['.', ';'])
        .next()
        .filter(|_| !before.ends_with(". "));
    let clause = decimal(before).or(clause).unwrap_or_default();
    if let Some(word) = clause.split('"').nth(1) {
        return Some(format!("`\"{word}\"`"));
    }
    let clause = clause.trim_end_matches('(').trim();
    let said = if clause.is_empty() { after } else { clause };
    let said = said.trim().trim_end_matches('.');
    let said = if said == "not" { "false" } else { said };
    let is_value = said == "false" || said.parse::<f64>().is_ok();
    Some(if is_value {
        format!("`{said}`")
    } else {
        said.to_owned()
    })
}

/// A number before the words, whose point ends no sentence.
fn decimal(before: &str) -> Option<&str> {
    let last = before.split_whitespace().next_back()?;
    last.parse::<f64>().is_ok().then_some(last)
}

/// With `KAVICS_WRITE_PAGES` set the page is written instead of compared.
#[test]
fn the_page_of_keys_is_what_the_schema_gives() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/keys.md");
    let found = Schema::read().page();
    if std::env::var_os("KAVICS_WRITE_PAGES").is_some() {
        fs::write(&path, &found).expect("docs/");
    }
    let written = fs::read_to_string(&path).expect("docs/keys.md");
    for (number, (written, found)) in written.lines().zip(found.lines()).enumerate() {
        assert_eq!(written, found, "line {} of docs/keys.md", number + 1);
    }
    assert_eq!(written.lines().count(), found.lines().count());
}

#[test]
fn every_definition_of_the_schema_with_keys_has_its_table() {
    let schema = Schema::read();
    let mut tables = Vec::new();
    schema.tables("", keys_of(&schema.root), &mut tables);
    let shown: BTreeSet<&str> = tables.iter().map(|table| table.definition).collect();
    for (name, definition) in schema.root["$defs"].as_object().expect("definitions") {
        let has_keys = definition.get("properties").is_some();
        assert_eq!(has_keys, shown.contains(name.as_str()), "{name}");
    }
}

#[test]
fn defaults_are_read_from_descriptions() {
    let read = |text| default_in(text).expect("a default");
    assert_eq!(
        read("Gravity; 9.81 when absent `[length/time²]`."),
        "`9.81`"
    );
    assert_eq!(read("\"void\" (when absent) or another."), "`\"void\"`");
    assert_eq!(
        read("\"disc\": d² (when absent); \"sphere\"."),
        "`\"disc\"`"
    );
    assert_eq!(read("Energy; when absent it breaks."), "it breaks");
    assert_eq!(
        read("Grains; until the box is full when absent."),
        "until the box is full"
    );
    assert_eq!(default_in("Width `[length]`."), None);
}
