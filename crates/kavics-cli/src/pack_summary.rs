//! What `kavics pack --summary` says of a pack, 80 columns wide.

use std::fmt::Write;

use kavics::assembly::{self, Partner, Touching};
use kavics::geometry::Container;
use kavics::measure::{Coordination, Rose, SymmetricTensor, fabric_of_normals, first_harmonic};
use kavics::packing::{Mass, statistics};
use kavics::scene::Pack;

/// Strips of the packing fraction over the height.
const STRIPS: usize = 10;

/// Classes of direction of the half circle.
const CLASSES: usize = 12;

/// Longest bar.
const BAR: usize = 40;

/// Shares of the mass at whose diameters the sieve curve is told where none is wanted.
const SHARES: [f64; 10] = [0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 1.0];

/// Sieve curve, packing fraction, coordination and directions of a pack.
pub fn summary(pack: &Pack) -> String {
    let container = assembly::container(&pack.sides);
    let touching = assembly::touching(&pack.grains, &pack.sides, pack.touching_tolerance);
    let mut text = sizes(pack, &container);
    text.push_str(&sieve_table(pack));
    text.push_str(&strips_table(pack, &container));
    text.push_str(&coordination_table(pack, &touching));
    text.push_str(&directions_table(&touching));
    text
}

/// Smallest and largest of some values.
fn extent(values: impl Iterator<Item = f64>) -> [f64; 2] {
    values.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], v| {
        [low.min(v), high.max(v)]
    })
}

fn sizes(pack: &Pack, container: &Container) -> String {
    let discs = pack.grains.values();
    let [smallest, largest] = extent(discs.iter().map(|grain| grain.radius));
    let mean = mean_radius(pack);
    let corners = container.corners().iter();
    let [left, right] = extent(corners.clone().map(|corner| corner.x));
    let [bottom, top] = extent(corners.map(|corner| corner.y));
    let whole = &statistics::strips(&pack.grains, container, 1)[0];
    let inside = statistics::inner_packing_fraction(&pack.grains, container);
    let inside = inside.map_or_else(|| "-".to_owned(), |inside| format!("{inside:.6}"));
    let margin = statistics::INSIDE;
    let digits = decimals(mean);
    format!(
        "grains            {}\n\
         radius            {smallest:.digits$} to {largest:.digits$}, mean {mean:.digits$}\n\
         box               {:.digits$} wide, {:.digits$} high\n\
         highest           {:.digits$}\n\
         packing fraction  {:.6}, from the floor to the highest grain\n\
         inside            {inside}, {margin} largest radii off sides and surface\n",
        discs.len(),
        right - left,
        top - bottom,
        whole.to,
        whole.packing_fraction(),
    )
}

fn mean_radius(pack: &Pack) -> f64 {
    let radii = pack.grains.values().iter().map(|grain| grain.radius);
    radii.sum::<f64>() / pack.grains.len() as f64
}

/// Decimals that show lengths to a millionth of the mean radius or so, whatever their unit.
fn decimals(mean_radius: f64) -> usize {
    (6.0 - mean_radius.log10().ceil()).clamp(0.0, 12.0) as usize
}

/// At the wanted diameters, or at ten that part the mass equally.
fn sieve_table(pack: &Pack) -> String {
    let wanted = pack.wanted_curve.as_ref();
    let mass = wanted.map_or(Mass::Disc, |curve| curve.mass);
    let diameters = wanted.map_or_else(
        || statistics::quantile_diameters(&pack.grains, &SHARES, mass),
        |curve| curve.diameter.clone(),
    );
    let realised = statistics::sieve_curve(&pack.grains, &diameters, mass);
    let digits = decimals(mean_radius(pack));
    let grows = match mass {
        Mass::Disc => "as d²",
        Mass::Sphere => "as d³",
    };
    let mut text = format!(
        "\nsieve curve: share of the mass, {grows}, in grains up to a diameter\n\
         {:>12} {:>10} {:>10}\n",
        "diameter", "wanted", "realised"
    );
    for (row, (diameter, realised)) in diameters.iter().zip(realised).enumerate() {
        let wanted = wanted.map_or_else(
            || "-".to_owned(),
            |curve| format!("{:.4}", curve.passing[row]),
        );
        let _ = writeln!(text, "{diameter:>12.digits$} {wanted:>10} {realised:>10.4}");
    }
    text
}

fn strips_table(pack: &Pack, container: &Container) -> String {
    let mut text = format!(
        "\npacking fraction over the height\n{:>12} {:>12} {:>10}\n",
        "from", "to", "fraction"
    );
    let digits = decimals(mean_radius(pack)).saturating_sub(2);
    let strips = statistics::strips(&pack.grains, container, STRIPS);
    for strip in strips.iter().rev() {
        let fraction = strip.packing_fraction();
        let line = format!(
            "{:>12.digits$} {:>12.digits$} {fraction:>10.4}  {}",
            strip.from,
            strip.to,
            bar(fraction)
        );
        let _ = writeln!(text, "{}", line.trim_end());
    }
    text
}

fn coordination_table(pack: &Pack, touching: &[Touching]) -> String {
    let partners = touching
        .iter()
        .map(|pair| [Partner::Grain(pair.first), pair.second]);
    let coordination = Coordination::new(pack.grains.len(), partners);
    let all = pack.grains.len() as f64;
    let mut text = format!(
        "\ncontacts of a grain, those with the sides of the box counted\n{:>12} {:>12} {:>10}\n",
        "contacts", "grains", "share"
    );
    let most = coordination
        .grains
        .iter()
        .max()
        .map_or(1.0, |&most| most as f64);
    for (contacts, &grains) in coordination.grains.iter().enumerate() {
        let count = grains as f64;
        let line = format!(
            "{contacts:>12} {grains:>12} {:>10.4}  {}",
            count / all,
            bar(count / most)
        );
        let _ = writeln!(text, "{}", line.trim_end());
    }
    let shown = |value: Option<f64>| value.map_or_else(|| "-".to_owned(), |v| format!("{v:.4}"));
    let _ = writeln!(
        text,
        "mean              {}\nwithout rattlers  {} ({} grains have no contact)",
        shown(coordination.mean()),
        shown(coordination.mean_without_rattlers()),
        coordination.rattlers()
    );
    text
}

fn directions_table(touching: &[Touching]) -> String {
    let between_grains = touching
        .iter()
        .filter(|pair| matches!(pair.second, Partner::Grain(_)));
    let normals = between_grains.map(|pair| pair.normal);
    let Some(fabric) = fabric_of_normals(normals.clone()) else {
        return "\nno contact between grains\n".to_owned();
    };
    let rose = Rose::new(normals, CLASSES);
    let contacts: usize = rose.contacts.iter().sum();
    let mut text = format!(
        "\n{contacts} contacts between grains: directions of their normals\n{}",
        fabric_lines(fabric)
    );
    let _ = writeln!(text, "{:>12} {:>12} {:>10}", "degrees", "share", "harmonic");
    let most = rose.contacts.iter().max().map_or(1.0, |&most| most as f64);
    for (class, &count) in rose.contacts.iter().enumerate() {
        let angle = class as f64 * rose.width();
        let share = count as f64 / contacts as f64;
        // Twice, for n and −n.
        let harmonic = 2.0 * rose.width() * first_harmonic(fabric, angle);
        let line = format!(
            "{:>12.0} {share:>12.4} {harmonic:>10.4}  {}",
            angle.to_degrees(),
            bar(count as f64 / most)
        );
        let _ = writeln!(text, "{}", line.trim_end());
    }
    text
}

fn fabric_lines(fabric: SymmetricTensor) -> String {
    let [larger, smaller] = fabric.eigenvalues();
    // Rounding of an isotropic tensor has a direction that means nothing.
    let direction = if fabric.deviator() > 1e-9 {
        let degrees = fabric.principal_direction().to_degrees();
        format!(" at {:.2} degrees", degrees.rem_euclid(180.0))
    } else {
        String::new()
    };
    format!(
        "fabric tensor     xx {}, xy {}, yy {}\n\
         principal values  {larger:.4}{direction}, {smaller:.4}; deviator {:.4}\n",
        component(fabric.xx),
        component(fabric.xy),
        component(fabric.yy),
        fabric.deviator()
    )
}

/// What rounds to zero has no sign.
fn component(value: f64) -> String {
    let text = format!("{value:.4}");
    if text == "-0.0000" {
        "0.0000".to_owned()
    } else {
        text
    }
}

/// A bar for a share of the longest.
fn bar(share: f64) -> String {
    "█".repeat((share * BAR as f64).round() as usize)
}
