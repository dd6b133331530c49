//! `kavics measure`: the measures of finished results again, in another window.

use std::io::{Write, stdout};

use kavics::measure::{Snapshot, Window, measures};
use kavics::scene::{Scene, SceneError};
use kavics_results::{
    Recorded, ResultsFolder, StepRow, check_output, read_grains, write_steps, write_steps_csv,
};
use toml_edit::{DocumentMut, Item, Value};

use crate::arguments::MeasureArguments;
use crate::failure::Failure;
use crate::origins::Origins;
use crate::{own_files, scene_file};

pub fn measure(arguments: &MeasureArguments) -> Result<(), Failure> {
    if let Some(path) = &arguments.output {
        check_output(path, &[])?;
    }
    let folder = ResultsFolder::open(&arguments.results)?;
    folder.check_whole()?;
    let scene = scene_of(&folder, arguments.window.as_deref())?;
    let rows = measured_rows(&folder, &scene)?;
    match &arguments.output {
        Some(path) => write_steps(path, &rows)?,
        None => stdout().write_all(&write_steps_csv(&rows))?,
    }
    scene_file::show_warnings(&scene.warnings);
    let last = rows.last().map_or(0, |row| row.step);
    let unfinished = folder.record()?.state.unfinished(last);
    scene_file::show_warnings(unfinished.as_slice());
    Ok(())
}

/// The rows of `steps` at the recorded load steps, measured again.
fn measured_rows(folder: &ResultsFolder, scene: &Scene) -> Result<Vec<StepRow>, Failure> {
    let window = Window::new(scene.window.clone(), scene.assembly.grains.len());
    let recorded = folder.recorded_steps()?;
    let mut rows = folder.step_rows()?;
    rows.retain(|row| recorded.contains(&row.step));
    for row in &mut rows {
        let recorded = Recorded::read(folder, row.step, scene)?;
        let snapshot = Snapshot {
            assembly: &scene.assembly,
            state: &recorded.state,
            loads: &recorded.loads,
            reactions: &recorded.reactions,
        };
        row.measures = measures(&snapshot, &window);
    }
    Ok(rows)
}

/// The scene of the results. What it read from other files is read from the folder.
fn scene_of(folder: &ResultsFolder, window: Option<&str>) -> Result<Scene, Failure> {
    let ran = own_files::named(&folder.scene()?, &[]);
    let text = in_window(&ran, window)?;
    let path = folder.path().join("scene.toml");
    let name = path.to_string_lossy();
    let parsed = Scene::parse(&text, &name, folder.path(), &read_grains);
    parsed.map_err(|error| match (error, window) {
        (SceneError::Wrong(message), Some(window)) => {
            let origins = Origins::of_file(&ran).changed(&ran, &text, 0);
            let given = [format!("--window {window}")];
            Failure::Scene(SceneError::Wrong(origins.relocate(&message, &name, &given)))
        }
        (error, _) => Failure::Scene(error),
    })
}

fn in_window(text: &str, window: Option<&str>) -> Result<String, Failure> {
    let (Some(window), Ok(mut document)) = (window, text.parse::<DocumentMut>()) else {
        return Ok(text.to_owned());
    };
    let measure = document.entry("measure").or_insert_with(toml_edit::table);
    measure["window"] = Item::Value(parse_window(window)?);
    Ok(document.to_string())
}

fn parse_window(given: &str) -> Result<Value, Failure> {
    if given.trim_start().starts_with('{') {
        return given.parse().map_err(|_| Failure::Window {
            given: given.to_owned(),
            reason: "not a TOML table; expected e.g. { x = [0, 5], y = [0, 5] }".to_owned(),
        });
    }
    Ok(Value::from(given))
}
