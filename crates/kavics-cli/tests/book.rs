//! The pages of docs/ as a book: each is in the summary, and every link leads somewhere.

use std::collections::BTreeSet;
use std::fs;
use std::path::{Component, Path, PathBuf};

fn workspace() -> PathBuf {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    root.canonicalize().expect("the workspace")
}

/// Pages of a folder and those below it, sorted.
fn pages(folder: &Path) -> Vec<PathBuf> {
    let mut all = Vec::new();
    for entry in fs::read_dir(folder).expect("a folder") {
        let path = entry.expect("an entry").path();
        if path.is_dir() {
            all.extend(pages(&path));
        } else if path.extension().is_some_and(|ending| ending == "md") {
            all.push(path);
        }
    }
    all.sort();
    all
}

/// The pages that a reader may come to: those of docs/, of validation/, and those at the root.
fn all_pages() -> Vec<PathBuf> {
    let at_root = ["README.md", "ARCHITECTURE.md", "CONTRIBUTING.md"];
    let at_root = at_root.map(|name| workspace().join(name)).into_iter();
    let below = ["docs", "validation"].map(|name| pages(&workspace().join(name)));
    at_root.chain(below.into_iter().flatten()).collect()
}

fn read(page: &Path) -> String {
    fs::read_to_string(page).expect("a page")
}

/// The lines of a page that are no code.
fn prose(text: &str) -> impl Iterator<Item = &str> {
    let mut in_code = false;
    text.lines().filter(move |line| {
        let is_fence = line.trim_start().starts_with("```");
        in_code ^= is_fence;
        !in_code && !is_fence
    })
}

/// A line without its code spans.
fn without_code(line: &str) -> String {
    let parts = line.split('`').enumerate();
    parts
        .filter(|(at, _)| at % 2 == 0)
        .map(|(_, part)| part)
        .collect()
}

/// Where the links and pictures of a page lead, those to other hosts left out.
fn links(text: &str) -> Vec<String> {
    let mut all = Vec::new();
    for line in prose(text).map(without_code) {
        for rest in line.split("](").skip(1) {
            let target = rest.split(')').next().unwrap_or_default();
            if !target.contains("://") {
                all.push(target.to_owned());
            }
        }
    }
    all
}

/// Names of the headings of a page in links, as forges and mdBook form them.
fn anchors(text: &str) -> BTreeSet<String> {
    let headings = prose(text).filter_map(|line| line.strip_prefix('#'));
    headings
        .map(|heading| anchor(heading.trim_start_matches('#')))
        .collect()
}

fn anchor(heading: &str) -> String {
    let heading = heading.trim().to_lowercase().replace(' ', "-");
    let is_kept = |c: &char| c.is_alphanumeric() || matches!(c, '-' | '_');
    heading.chars().filter(is_kept).collect()
}

/// A path without `..`.
fn plain(path: &Path) -> PathBuf {
    let mut plain = PathBuf::new();
    for part in path.components() {
        if part == Component::ParentDir {
            plain.pop();
        } else {
            plain.push(part);
        }
    }
    plain
}

/// What is wrong with a link of a page, if anything.
fn fault(page: &Path, link: &str) -> Option<String> {
    let (file, name) = link.split_once('#').unwrap_or((link, ""));
    let folder = page.parent().expect("a folder");
    let target = if file.is_empty() {
        page.to_owned()
    } else {
        plain(&folder.join(file))
    };
    if !target.exists() {
        return Some(format!("{}: no file {link}", page.display()));
    }
    let is_there = name.is_empty() || anchors(&read(&target)).contains(name);
    (!is_there).then(|| format!("{}: no heading {link}", page.display()))
}

#[test]
fn every_link_and_anchor_leads_somewhere() {
    let mut faults = Vec::new();
    for page in all_pages() {
        let text = read(&page);
        faults.extend(links(&text).iter().filter_map(|link| fault(&page, link)));
    }
    assert!(faults.is_empty(), "{faults:#?}");
}

#[test]
fn the_summary_has_every_page_once() {
    let docs = workspace().join("docs");
    let mut listed = links(&read(&docs.join("SUMMARY.md")));
    listed.sort();
    let mut written: Vec<String> = pages(&docs)
        .iter()
        .map(|page| page.strip_prefix(&docs).expect("below docs"))
        .map(|page| page.to_string_lossy().replace('\\', "/"))
        .filter(|page| page != "SUMMARY.md")
        .collect();
    written.sort();
    assert_eq!(listed, written);
}

#[test]
fn formulas_within_a_line_are_code_spans_between_dollar_signs() {
    for page in pages(&workspace().join("docs")) {
        for line in prose(&read(&page)).map(without_code) {
            let dollars = line.matches('$').count();
            let between = line.matches("$$").count();
            assert_eq!(dollars, 2 * between, "{}: {line}", page.display());
        }
    }
}

#[test]
fn anchors_are_those_of_forges() {
    assert_eq!(anchor(" `contact.NAME.cemented`"), "contactnamecemented");
    assert_eq!(anchor(" Beyond the peak"), "beyond-the-peak");
    assert_eq!(anchor(" run.json"), "runjson");
}
