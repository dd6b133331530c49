//! Pictures of the lowest modes of the tangent: the grains displaced, the stronger in colour the farther.

use std::fmt::Write;

use kavics_results::{Columns, ResultsFolder};
use serde::Serialize;

use crate::ReportError;
use crate::discs::{Discs, Map, Path, stroke};
use crate::number::{brief, show};

/// Above this many grains neither ways nor spokes are drawn; above so many no picture.
const WAYS_DRAWN: usize = 3000;
const GRAINS_DRAWN: usize = 50_000;

/// Shades of the amplitude.
const SHADES: usize = 8;

/// How far the largest amplitude is drawn, in mean radii.
const FARTHEST: f64 = 0.9;

/// Grains that a picture names.
const NAMED: usize = 5;

/// The modes at a load step.
#[derive(Debug, Default, Serialize)]
pub(crate) struct Modes {
    step: usize,
    pictures: Vec<Picture>,
    /// Whether a picture takes half of the page.
    large: bool,
}

/// A mode of the tangent.
#[derive(Debug, Serialize)]
struct Picture {
    number: usize,
    eigenvalue: String,
    participation: String,
    foremost: String,
    svg: String,
}

/// The rows of one mode.
#[derive(Debug, Default)]
struct Motion {
    x: Vec<f64>,
    y: Vec<f64>,
    rotation: Vec<f64>,
}

/// The modes at the last recorded load step that has some.
pub(crate) fn modes(folder: &ResultsFolder) -> Result<Modes, ReportError> {
    for &step in folder.recorded_steps()?.iter().rev() {
        let Some(table) = folder.modes(step)? else {
            continue;
        };
        let discs = Discs::read(&folder.grains(step)?)?;
        let pictures = if discs.x.len() <= GRAINS_DRAWN {
            pictures(&table, &discs)?
        } else {
            Vec::new()
        };
        let large = discs.x.len() > 200;
        return Ok(Modes {
            step,
            pictures,
            large,
        });
    }
    Ok(Modes::default())
}

fn pictures(table: &Columns, discs: &Discs) -> Result<Vec<Picture>, ReportError> {
    let eigenvalues = table.numbers("eigenvalue")?;
    let participation = table.numbers("participation")?;
    let [x, y, rotation] = [
        table.numbers("ux")?,
        table.numbers("uy")?,
        table.numbers("rotation")?,
    ];
    let grains = discs.x.len().max(1);
    let picture = |mode: usize| {
        let rows = mode * grains..(mode + 1) * grains;
        let motion = Motion {
            x: x[rows.clone()].to_vec(),
            y: y[rows.clone()].to_vec(),
            rotation: rotation[rows.clone()].to_vec(),
        };
        Picture {
            number: mode + 1,
            eigenvalue: show(eigenvalues[rows.start]),
            participation: brief(participation[rows.start]),
            foremost: foremost(&amplitudes(discs, &motion)),
            svg: draw(discs, &motion),
        }
    };
    Ok((0..table.len() / grains).map(picture).collect())
}

/// √(u_x² + u_y² + (R·ω)²) of each grain.
fn amplitudes(discs: &Discs, motion: &Motion) -> Vec<f64> {
    let rims = discs.radius.iter().zip(&motion.rotation);
    let ways = motion.x.iter().zip(&motion.y);
    ways.zip(rims)
        .map(|((x, y), (radius, rotation))| x.hypot(*y).hypot(radius * rotation))
        .collect()
}

/// Ids of the grains that move most.
fn foremost(amplitudes: &[f64]) -> String {
    let mut grains: Vec<usize> = (0..amplitudes.len()).collect();
    grains.sort_by(|&a, &b| amplitudes[b].total_cmp(&amplitudes[a]).then(a.cmp(&b)));
    let named = grains.iter().take(NAMED).map(ToString::to_string);
    named.collect::<Vec<_>>().join(", ")
}

fn draw(discs: &Discs, motion: &Motion) -> String {
    let map = Map::around(discs);
    let mean_radius = discs.radius.iter().sum::<f64>() / discs.radius.len().max(1) as f64;
    let far = FARTHEST * mean_radius;
    let mut shades: [Path; SHADES] = Default::default();
    let mut ways = Path::default();
    for (row, amplitude) in amplitudes(discs, motion).into_iter().enumerate() {
        let from = (discs.x[row], discs.y[row]);
        let to = (from.0 + far * motion.x[row], from.1 + far * motion.y[row]);
        let shade = ((amplitude * SHADES as f64) as usize).min(SHADES - 1);
        shades[shade].circle(map.point(to.0, to.1), map.length(discs.radius[row]));
        if discs.x.len() <= WAYS_DRAWN && shade > 0 {
            ways.line(map.point(from.0, from.1), map.point(to.0, to.1));
            let (sine, cosine) = (mean_radius * motion.rotation[row]).sin_cos();
            let radius = discs.radius[row];
            let rim = (to.0 - radius * sine, to.1 + radius * cosine);
            ways.line(map.point(to.0, to.1), map.point(rim.0, rim.1));
        }
    }
    let (width, height) = (map.width + 2.0 * map.margin, map.height + 2.0 * map.margin);
    let mut svg = format!(
        "<svg class=\"graph\" viewBox=\"0 0 {width:.0} {height:.0}\" role=\"img\" \
         aria-label=\"mode of the tangent\">"
    );
    for (shade, path) in shades.iter().enumerate() {
        let opacity = shade as f64 / (SHADES - 1) as f64;
        path.write(
            &mut svg,
            "moved",
            &format!(" fill-opacity=\"{opacity:.2}\""),
        );
    }
    ways.write(
        &mut svg,
        "way",
        &stroke(f64::from(map.length(0.08 * mean_radius))),
    );
    let _ = write!(svg, "</svg>");
    svg
}
