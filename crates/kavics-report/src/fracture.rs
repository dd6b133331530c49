//! Fracture: where bonds broke and in which order, load factor and energy from break to break, the longest cracks.

use std::collections::HashMap;

use kavics_pictures::{What, draw};
use kavics_results::{Columns, ResultsFolder};
use serde::Serialize;

use crate::ReportError;
use crate::curves::{Figure, figure};
use crate::left_out::or_note;
use crate::number::show;
use crate::page::{Table, request};
use crate::plot::Series;

/// Cracks listed.
const CRACKS_SHOWN: usize = 5;

/// Parts of a curve of which the lowest and the highest value are drawn.
const PARTS_DRAWN: usize = 1500;

/// What the page shows of broken bonds; nothing where none has broken.
#[derive(Debug, Default, Serialize)]
pub(crate) struct Fracture {
    /// Load step of the picture.
    step: usize,
    picture: String,
    /// How many broke, in words.
    note: String,
    figures: Vec<Figure>,
    cracks: Table,
    /// Cracks in all.
    crack_count: usize,
}

/// The bonds that broke, in order.
#[derive(Debug, Default)]
struct Breaks {
    contact: Vec<i64>,
    load_factor: Vec<f64>,
    fracture: Vec<f64>,
    release: Vec<f64>,
    /// Null where breakage is not event-driven.
    avalanche: Vec<Option<i64>>,
}

impl Breaks {
    fn read(events: &Columns) -> Result<Self, ReportError> {
        let (kinds, contacts) = (events.texts("kind")?, events.integers("contact")?);
        let rows: Vec<usize> = (0..events.len())
            .filter(|&row| kinds[row] == "broke" && contacts[row].is_some())
            .collect();
        let energy = |column: &str| -> Result<Vec<f64>, ReportError> {
            let values = events.numbers(column)?;
            let finite = |value: f64| if value.is_finite() { value } else { 0.0 };
            Ok(rows.iter().map(|&row| finite(values[row])).collect())
        };
        let (factors, avalanches) = (
            events.numbers("load_factor")?,
            events.integers("avalanche")?,
        );
        Ok(Self {
            contact: rows.iter().filter_map(|&row| contacts[row]).collect(),
            load_factor: rows.iter().map(|&row| factors[row]).collect(),
            fracture: energy("fracture_energy")?,
            release: energy("release_energy")?,
            avalanche: rows.iter().map(|&row| avalanches[row]).collect(),
        })
    }

    /// How many broke, at which factors, in how many avalanches.
    fn note(&self) -> String {
        let factors = self.load_factor.iter().copied();
        let highest = factors.fold(f64::NEG_INFINITY, f64::max);
        format!(
            "{} broke, the first at load factor {}, none above {}.{}",
            counted(self.contact.len(), "bond"),
            show(self.load_factor[0]),
            show(highest),
            self.avalanches()
        )
    }

    /// Number and largest size of the avalanches, where there are some.
    fn avalanches(&self) -> String {
        let mut sizes: HashMap<i64, usize> = HashMap::new();
        for avalanche in self.avalanche.iter().flatten() {
            *sizes.entry(*avalanche).or_default() += 1;
        }
        let Some(largest) = sizes.values().max() else {
            return String::new();
        };
        format!(
            " {} between new maxima of the factor, the largest of {largest}.",
            counted(sizes.len(), "avalanche")
        )
    }

    fn figures(&self) -> Vec<Figure> {
        let series = |name: &str, values: &[f64], colour| Series {
            name: name.to_owned(),
            points: thinned(values),
            colour,
            dashed: false,
            marked: true,
        };
        let label = "number of the break";
        let factors = [series("load factor", &self.load_factor, 0)];
        let mut energies = vec![series("fracture energy", &summed(&self.fracture), 1)];
        let mut title = "Energy taken so far";
        if self.release.iter().any(|&energy| energy != 0.0) {
            title = "Energy taken and set free so far";
            energies.push(series("release energy", &summed(&self.release), 5));
        }
        vec![
            figure(
                "Load factor from break to break",
                label,
                "load factor",
                &factors,
            ),
            figure(title, label, "force × length", &energies),
        ]
    }
}

/// What broke in the run, drawn at its last recorded load step.
pub(crate) fn fracture(
    folder: &ResultsFolder,
    events: &Columns,
    left_out: &mut Vec<String>,
) -> Result<Fracture, ReportError> {
    let breaks = Breaks::read(events)?;
    let recorded = folder.recorded_steps()?.pop();
    let Some(step) = recorded.filter(|_| !breaks.contact.is_empty()) else {
        return Ok(Fracture::default());
    };
    let cracks = folder.cracks(step)?;
    let damage = request(What::Damage);
    let picture = draw(folder, &damage).map_err(ReportError::from);
    let picture = picture.map(|picture| picture.element());
    Ok(Fracture {
        step,
        picture: or_note("picture of the breaks", picture, left_out)?,
        note: breaks.note(),
        figures: breaks.figures(),
        crack_count: cracks.as_ref().map_or(0, Columns::len),
        cracks: cracks.as_ref().map_or(Ok(Table::default()), longest)?,
    })
}

/// The longest cracks; the table has them in this order.
fn longest(cracks: &Columns) -> Result<Table, ReportError> {
    let contacts = cracks.integers("contacts")?;
    let (length, extent) = (cracks.numbers("length")?, cracks.numbers("extent")?);
    let direction = cracks.numbers("direction")?;
    let row = |row: usize| {
        vec![
            contacts[row].unwrap_or(0).to_string(),
            show(length[row]),
            show(extent[row]),
            format!("{}°", show(direction[row].to_degrees().round())),
        ]
    };
    let shown = cracks.len().min(CRACKS_SHOWN);
    Ok(Table {
        names: vec!["broken_contacts", "length", "extent", "direction"],
        rows: (0..shown).map(row).collect(),
        left_out: cracks.len() - shown,
    })
}

fn counted(count: usize, name: &str) -> String {
    let ending = if count == 1 { "" } else { "s" };
    format!("{count} {name}{ending}")
}

fn summed(values: &[f64]) -> Vec<f64> {
    let sums = values.iter().scan(0.0, |sum, value| {
        *sum += value;
        Some(*sum)
    });
    sums.collect()
}

/// Values over their numbers from 1; of long rows the lowest and the highest of each part, in order.
fn thinned(values: &[f64]) -> Vec<(f64, f64)> {
    let size = values.len().div_ceil(PARTS_DRAWN).max(1);
    let mut points = Vec::new();
    for (part, values) in values.chunks(size).enumerate() {
        let by_value = |a: &usize, b: &usize| values[*a].total_cmp(&values[*b]);
        let lowest = (0..values.len()).min_by(by_value).unwrap_or(0);
        let highest = (0..values.len()).max_by(by_value).unwrap_or(0);
        let mut places = vec![lowest.min(highest), lowest.max(highest)];
        places.dedup();
        let point = |place: usize| ((part * size + place + 1) as f64, values[place]);
        points.extend(places.into_iter().map(point));
    }
    points
}

#[cfg(test)]
mod tests {
    use super::{Breaks, PARTS_DRAWN, summed, thinned};

    #[test]
    fn a_short_curve_has_all_its_points() {
        assert_eq!(
            thinned(&[3.0, 1.0, 2.0]),
            [(1.0, 3.0), (2.0, 1.0), (3.0, 2.0)]
        );
        assert_eq!(summed(&[3.0, 1.0, 2.0]), [3.0, 4.0, 6.0]);
    }

    #[test]
    fn a_long_curve_keeps_its_peaks_and_its_order() {
        let mut values = vec![0.5; 10 * PARTS_DRAWN];
        (values[37], values[31]) = (9.0, -9.0);
        let points = thinned(&values);
        assert!(points.len() <= 2 * PARTS_DRAWN);
        assert!(points.contains(&(38.0, 9.0)) && points.contains(&(32.0, -9.0)));
        assert!(points.is_sorted_by(|a, b| a.0 < b.0));
    }

    #[test]
    fn avalanches_are_counted() {
        let breaks = Breaks {
            contact: vec![4, 2, 9],
            load_factor: vec![1.0, 0.5, 2.0],
            fracture: vec![0.0; 3],
            release: vec![0.0; 3],
            avalanche: vec![Some(0), Some(0), Some(1)],
        };
        assert_eq!(
            breaks.note(),
            "3 bonds broke, the first at load factor 1, none above 2. 2 avalanches between new maxima of the factor, \
             the largest of 2."
        );
    }
}
