//! The files that a scene names, and the same files in its results folder.

use toml_edit::{Array, DocumentMut, Item, Value};

/// The grain lists that a scene names.
pub fn listed(text: &str) -> Vec<String> {
    let Ok(document) = text.parse::<DocumentMut>() else {
        return Vec::new();
    };
    let layers = (0..).map_while(|number| document.get("layer")?.get(number));
    let tables = document.get("grains").into_iter().chain(layers);
    let file = |table: &Item| Some(table.get("listed")?.get("file")?.as_str()?.to_owned());
    tables.filter_map(file).collect()
}

/// Where a run records the grains before loading.
const GRAINS: &str = "grains/000000.parquet";

/// The scene with the names that its files have in the results folder: listed grains are those before loading,
/// which every run records; `layers` has the number of grains of each layer, where they are known.
pub fn named(text: &str, layers: &[usize]) -> String {
    let Ok(mut document) = text.parse::<DocumentMut>() else {
        return text.to_owned();
    };
    let mut renamed = listed_file(document.get_mut("grains"))
        .is_some_and(|listed| rename(&mut listed["file"], GRAINS));
    let mut first = 0;
    for (number, count) in layers.iter().enumerate() {
        let layer = document
            .get_mut("layer")
            .and_then(|layers| layers.get_mut(number));
        if let Some(listed) = listed_file(layer)
            && rename(&mut listed["file"], GRAINS)
        {
            let rows = Array::from_iter([first, first + count - 1].map(|row| row as i64));
            listed["rows"] = Item::Value(rows.into());
            renamed = true;
        }
        first += count;
    }
    let compared = document
        .get_mut("compare")
        .and_then(|compare| compare.get_mut("file"));
    if compared.is_some_and(|file| rename(file, "compare.csv")) || renamed {
        document.to_string()
    } else {
        text.to_owned()
    }
}

/// The table of a list of grains, which is to be read whole from one file now.
fn listed_file(layer: Option<&mut Item>) -> Option<&mut Item> {
    let listed = layer?.get_mut("listed")?;
    listed.get("file")?;
    let table = listed.as_table_like_mut()?;
    table.remove("frame");
    table.remove("rows");
    Some(listed)
}

fn rename(file: &mut Item, name: &str) -> bool {
    let Item::Value(value) = file else {
        return false;
    };
    let mut renamed = Value::from(name);
    *renamed.decor_mut() = value.decor().clone();
    *value = renamed;
    true
}

#[cfg(test)]
mod tests {
    use super::{GRAINS, listed, named};

    const SCENE: &str =
        "[grains.listed]\nfile = \"../a.csv\" # ours\n\n[compare]\nfile = \"/b.csv\"\n";

    #[test]
    fn files_have_the_names_of_the_folder_and_comments_stay() {
        let expected = "[grains.listed]\nfile = \"grains/000000.parquet\" # ours\n\n[compare]\nfile = \"compare.csv\"\n";
        assert_eq!(named(SCENE, &[]), expected);
        assert_eq!(listed(SCENE), ["../a.csv"]);
    }

    #[test]
    fn a_scene_that_names_no_file_stays_as_it_is() {
        assert_eq!(named("seed = 1\r\n", &[3]), "seed = 1\r\n");
    }

    #[test]
    fn a_listed_layer_names_its_rows_among_the_recorded_grains() {
        let scene = "[[layer]]\nsquare = { radius = 1, rows = [3] }\n\
                     [[layer]]\nlisted = { file = \"a.dump\", frame = 2 }\n\
                     [[layer]]\n[layer.listed]\nfile = \"b.csv\"\n";
        assert_eq!(listed(scene), ["a.dump", "b.csv"]);
        let named = named(scene, &[3, 4, 5]);
        assert_eq!(listed(&named), [GRAINS, GRAINS]);
        assert!(named.contains("rows = [3, 6]"), "{named}");
        assert!(named.contains("rows = [7, 11]"), "{named}");
        assert!(!named.contains("frame"), "{named}");
    }
}
