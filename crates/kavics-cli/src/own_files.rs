//! The files that a scene names, and the same files in its results folder.

use toml_edit::{DocumentMut, Item, Value};

/// The grain list that a scene names.
pub fn listed(text: &str) -> Option<String> {
    let document = text.parse::<DocumentMut>().ok()?;
    let file = document.get("grains")?.get("listed")?.get("file")?;
    file.as_str().map(str::to_owned)
}

/// The scene with the names that its files have in the results folder: listed grains are those before loading,
/// which every run records.
pub fn named(text: &str) -> String {
    let Ok(mut document) = text.parse::<DocumentMut>() else {
        return text.to_owned();
    };
    let listed = document
        .get_mut("grains")
        .and_then(|grains| grains.get_mut("listed"))
        .and_then(|listed| listed.get_mut("file"));
    let renamed = listed.is_some_and(|file| rename(file, "grains/000000.parquet"));
    let compared = document
        .get_mut("compare")
        .and_then(|compare| compare.get_mut("file"));
    if compared.is_some_and(|file| rename(file, "compare.csv")) || renamed {
        document.to_string()
    } else {
        text.to_owned()
    }
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
    use super::{listed, named};

    const SCENE: &str =
        "[grains.listed]\nfile = \"../a.csv\" # ours\n\n[compare]\nfile = \"/b.csv\"\n";

    #[test]
    fn files_have_the_names_of_the_folder_and_comments_stay() {
        let expected = "[grains.listed]\nfile = \"grains/000000.parquet\" # ours\n\n[compare]\nfile = \"compare.csv\"\n";
        assert_eq!(named(SCENE), expected);
        assert_eq!(listed(SCENE).as_deref(), Some("../a.csv"));
    }

    #[test]
    fn a_scene_that_names_no_file_stays_as_it_is() {
        assert_eq!(named("seed = 1\r\n"), "seed = 1\r\n");
    }
}
