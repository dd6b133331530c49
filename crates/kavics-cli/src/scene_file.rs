//! From the command line to a scene.

use std::path::{Path, PathBuf};

use kavics::scene::{Pack, Scene, SceneError, read_text};
use kavics::warning::WarningKind;
use kavics_report::ComparedTable;
use kavics_results::read_grains;

use crate::arguments::SceneArguments;
use crate::failure::Failure;
use crate::limits::check_placing;
use crate::overrides::Changed;
pub use crate::terminal::{say, show_warnings};
use crate::{compared, overrides, own_files};

/// Reads the scene file, with what `--set` says, and the table that it is compared with.
pub fn read(
    arguments: &SceneArguments,
    any_size: bool,
) -> Result<(Scene, Option<ComparedTable>), Failure> {
    with_text(arguments, |text, name, folder| {
        check_placing(text, true, any_size)?;
        let mut scene = Scene::parse(text, name, folder, &read_grains).map_err(Failure::Scene)?;
        let Some(path) = scene.compare.clone() else {
            return Ok((scene, None));
        };
        let table = compared::read(&path, text, name)?;
        let warnings = table.warnings().iter();
        let of_table = warnings
            .map(|warning| WarningKind::ComparedTable.says(format_args!("compare.csv: {warning}")));
        scene.warnings.extend(of_table);
        Ok((scene, Some(table)))
    })
}

/// Reads no more of the scene file than places the grains.
pub fn place_grains(arguments: &SceneArguments, any_size: bool) -> Result<Pack, Failure> {
    with_text(arguments, |text, name, folder| {
        check_placing(text, false, any_size)?;
        Scene::place_grains(text, name, folder, &read_grains).map_err(Failure::Scene)
    })
}

/// The files that a run of the scene reads: the scene itself, and those it names.
pub fn files_read(arguments: &SceneArguments, scene: &Scene) -> Vec<PathBuf> {
    let mut files = files_of_grains(arguments, &scene.text);
    files.extend(scene.compare.clone());
    files
}

/// The files that placing the grains reads, before they are read.
pub fn files_placing(arguments: &SceneArguments) -> Result<Vec<PathBuf>, Failure> {
    with_text(arguments, |text, _, _| Ok(files_of_grains(arguments, text)))
}

fn files_of_grains(arguments: &SceneArguments, text: &str) -> Vec<PathBuf> {
    let folder = arguments.scene.parent().unwrap_or(Path::new(""));
    let listed = own_files::listed(text);
    let listed = listed.into_iter().map(|file| folder.join(file));
    [arguments.scene.clone()]
        .into_iter()
        .chain(listed)
        .collect()
}

fn with_text<T>(
    arguments: &SceneArguments,
    read: impl FnOnce(&str, &str, &Path) -> Result<T, Failure>,
) -> Result<T, Failure> {
    let path = &arguments.scene;
    let text = read_text(path).map_err(Failure::Scene)?;
    let Changed { text, origins } = overrides::apply(&text, &arguments.set)?;
    let folder = path.parent().unwrap_or(Path::new(""));
    let name = path.to_string_lossy();
    read(&text, &name, folder).map_err(|failure| match failure {
        Failure::Scene(SceneError::Wrong(message)) if !arguments.set.is_empty() => {
            let changes = arguments.set.iter().map(|given| format!("--set {given}"));
            let message = origins.relocate(&message, &name, &changes.collect::<Vec<_>>());
            Failure::Scene(SceneError::Wrong(message))
        }
        other => other,
    })
}

/// Where results of the scene go when nothing else is said: `NAME.results` in the working folder.
pub fn usual_folder(scene: &Path) -> PathBuf {
    let name = scene.file_stem().unwrap_or_default().to_string_lossy();
    PathBuf::from(format!("{name}.results"))
}

/// Starts the threads that everything shares.
pub fn start_threads(count: Option<usize>) -> Result<usize, Failure> {
    let mut pool = rayon::ThreadPoolBuilder::new();
    if let Some(count) = count {
        pool = pool.num_threads(count);
    }
    pool.build_global()?;
    Ok(rayon::current_num_threads())
}
