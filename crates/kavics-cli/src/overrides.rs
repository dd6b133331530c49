//! `--set KEY=VALUE`: the text of a scene with values replaced.

use toml_edit::{DocumentMut, Item, Key, Table, Value};

use crate::failure::Failure;
use crate::origins::Origins;

/// A text with values replaced.
#[derive(Clone, Debug)]
pub struct Changed {
    /// The text.
    pub text: String,
    /// Where its lines come from.
    pub origins: Origins,
}

/// `text` with every override in place. A text that is no TOML comes back as it is: the scene's own check says
/// what is wrong with it, and where.
pub fn apply(text: &str, overrides: &[String]) -> Result<Changed, Failure> {
    let mut changed = Changed {
        text: text.to_owned(),
        origins: Origins::of_file(text),
    };
    for (number, given) in overrides.iter().enumerate() {
        let Ok(mut document) = changed.text.parse::<DocumentMut>() else {
            return Ok(changed);
        };
        set(document.as_item_mut(), given).map_err(|reason| Failure::Override {
            given: given.clone(),
            reason,
        })?;
        let text = document.to_string();
        changed.origins = changed.origins.changed(&changed.text, &text, number);
        changed.text = text;
    }
    Ok(changed)
}

fn set(scene: &mut Item, given: &str) -> Result<(), String> {
    let (key, value) = given.split_once('=').ok_or("expected KEY=VALUE")?;
    let path = Key::parse(key.trim()).map_err(|_| "the key is not a TOML key".to_owned())?;
    let (last, tables) = path.split_last().ok_or("the key is empty")?;
    let mut at = scene;
    for key in tables {
        at = step_into(at, key)?;
    }
    replace(at, last, parse_value(value.trim())?)
}

/// The table or array element that `key` names; a table that is absent is made.
fn step_into<'a>(at: &'a mut Item, key: &Key) -> Result<&'a mut Item, String> {
    let name = key.get();
    if is_array(at) {
        return element(at, name);
    }
    let table = at
        .as_table_like_mut()
        .ok_or_else(|| format!("{name} stands in something that is no table"))?;
    Ok(table.entry(name).or_insert_with(|| {
        let mut table = Table::new();
        table.set_implicit(true);
        Item::Table(table)
    }))
}

fn replace(at: &mut Item, key: &Key, mut value: Value) -> Result<(), String> {
    let name = key.get();
    if at.is_array_of_tables() {
        let Value::InlineTable(table) = value else {
            return Err(format!(
                "element {name} of the list is a table; expected e.g. {{ name = \"press\" }}"
            ));
        };
        *element(at, name)? = Item::Table(table.into_table());
        return Ok(());
    }
    if is_array(at) {
        *element(at, name)? = Item::Value(value);
        return Ok(());
    }
    let table = at
        .as_table_like_mut()
        .ok_or_else(|| format!("{name} stands in something that is no table"))?;
    if let Some(old) = table.get(name).and_then(Item::as_value) {
        *value.decor_mut() = old.decor().clone();
    }
    table.insert(name, Item::Value(value));
    Ok(())
}

fn is_array(item: &Item) -> bool {
    item.is_array() || item.is_array_of_tables()
}

fn element<'a>(array: &'a mut Item, number: &str) -> Result<&'a mut Item, String> {
    let index: usize = number
        .parse()
        .map_err(|_| format!("{number} stands in a list; expected a number from 0"))?;
    array
        .get_mut(index)
        .ok_or_else(|| format!("the list has no element {index}"))
}

/// A TOML value; what does not begin like one is a string, so that `title=Two discs` needs no quotes within quotes.
fn parse_value(text: &str) -> Result<Value, String> {
    match text.parse() {
        Ok(value) => Ok(value),
        Err(_) if text.starts_with(['[', '{', '"', '\'']) => {
            Err("the value is not TOML; a bracket or a quote may be missing".to_owned())
        }
        Err(_) => Ok(Value::from(text)),
    }
}

#[cfg(test)]
mod tests {
    use super::apply;

    fn applied(text: &str, given: &str) -> String {
        let changed = apply(text, &[given.to_owned()]);
        changed.expect("a right override").text
    }

    #[test]
    fn a_value_is_replaced_and_its_comment_stays() {
        let text = "seed = 1 # of everything\n";
        assert_eq!(applied(text, "seed=7"), "seed = 7 # of everything\n");
    }

    #[test]
    fn an_absent_table_is_made() {
        assert_eq!(
            applied("seed = 1\n", "equilibrium.tolerance=1e-12"),
            "seed = 1\n\n[equilibrium]\ntolerance = 1e-12\n"
        );
    }

    #[test]
    fn an_element_of_a_list_is_found_by_its_number() {
        let text = "[[stage]]\nfactors = [1.0]\n[[stage]]\nfactors = [2.0]\n";
        assert_eq!(
            applied(text, "stage.1.factors=[3.0]"),
            "[[stage]]\nfactors = [1.0]\n[[stage]]\nfactors = [3.0]\n"
        );
        assert_eq!(
            applied(text, "stage.0.factors.0=5"),
            "[[stage]]\nfactors = [5]\n[[stage]]\nfactors = [2.0]\n"
        );
    }

    #[test]
    fn a_dotted_key_inside_a_table_is_replaced_in_place() {
        let text = "[contact.mortar.cemented]\nstiffness.layer = { normal = 1.0, shear = 0.5 }\n";
        assert_eq!(
            applied(text, "contact.mortar.cemented.stiffness.layer.shear=0.4"),
            "[contact.mortar.cemented]\nstiffness.layer = { normal = 1.0, shear = 0.4 }\n"
        );
    }

    #[test]
    fn words_need_no_quotes() {
        assert_eq!(applied("", "title=Two discs"), "title = \"Two discs\"\n");
    }

    #[test]
    fn a_table_of_a_list_is_replaced_by_a_table_alone() {
        let text = "[[stage]]\nfactors = [1.0]\n";
        let refused = |given: &str| apply(text, &[given.to_owned()]).is_err();
        assert!(refused("stage.0=5"));
        assert!(refused("seed=[1,"));
        assert_eq!(
            applied(text, "stage.0={ factors = [2.0] }"),
            "[[stage]]\nfactors = [2.0]\n"
        );
    }
}
