//! Why grains cannot be placed.

use thiserror::Error;

/// Grains that cannot be placed. Rows and diameters count from 1, grains from 0.
#[derive(Clone, Debug, Error, PartialEq)]
pub enum PackingError {
    /// No grain was asked for.
    #[error("no grains to place")]
    NoGrains,
    /// More grains than the ids can number or a machine can hold.
    #[error("more than {most} grains")]
    TooManyGrains {
        /// Largest number of grains.
        most: usize,
    },
    /// A radius that is not a positive number between 1e-30 and 1e30.
    #[error("radius {radius} is not a number from 1e-30 to 1e30")]
    Radius {
        /// The radius, `[length]`.
        radius: f64,
    },
    /// A grain so much smaller than its container that coordinates hardly tell its places apart.
    #[error(
        "radius {radius} is less than 1e-10 of the coordinates of the container, up to {farthest}"
    )]
    TooSmall {
        /// The smallest radius, `[length]`.
        radius: f64,
        /// The largest coordinate of the container, `[length]`.
        farthest: f64,
    },
    /// A width or height that is not a positive number between 1e-30 and 1e30.
    #[error("box length {length} is not a number from 1e-30 to 1e30")]
    BoxLength {
        /// The length, `[length]`.
        length: f64,
    },
    /// The smallest radius is above the largest.
    #[error("radii from {from} to {to} do not rise")]
    RadiusRange {
        /// Smallest radius, `[length]`.
        from: f64,
        /// Largest radius, `[length]`.
        to: f64,
    },
    /// A grain is wider than the box.
    #[error("a grain of diameter {diameter} does not fit into a box of width {width}")]
    BoxTooNarrow {
        /// Diameter of the widest grain, `[length]`.
        diameter: f64,
        /// Width of the box, `[length]`.
        width: f64,
    },
    /// Not even one grain fits below the top of the box.
    #[error("a grain of diameter {diameter} does not fit into a box of height {height}")]
    BoxTooLow {
        /// Diameter of the first grain, `[length]`.
        diameter: f64,
        /// Height of the box, `[length]`.
        height: f64,
    },
    /// Not even one grain finds room beside those that lie there.
    #[error("there is no room for a grain of diameter {diameter}")]
    NoRoom {
        /// Diameter of the first grain, `[length]`.
        diameter: f64,
    },
    /// A container is full before all grains are placed.
    #[error("{count} grains do not fit into the container, which is full with {fitted}")]
    ContainerFull {
        /// The grains wanted.
        count: usize,
        /// Those that found a place.
        fitted: usize,
    },
    /// A grain is to be placed at the lowest of zero places.
    #[error("a grain needs at least one try")]
    NoTries,
    /// A grain rolled on without end; a bug of kavics if ever seen.
    #[error("grain {grain} found no place to rest within {moves} falls and rolls")]
    Restless {
        /// Its place in the order of dropping.
        grain: usize,
        /// Falls and rolls tried.
        moves: usize,
    },
    /// Not as many values as diameters, or fewer than two.
    #[error(
        "a sieve curve needs a value for each of at least two diameters, not {passing} for {diameters}"
    )]
    SieveLength {
        /// Number of diameters.
        diameters: usize,
        /// Number of values of passing.
        passing: usize,
    },
    /// A diameter that is not positive or not above the one before.
    #[error("diameter {diameter} (number {number}) of the sieve curve must be above {previous}")]
    SieveDiameter {
        /// Which diameter, from 1.
        number: usize,
        /// The diameter, `[length]`.
        diameter: f64,
        /// The one before it, or zero, `[length]`.
        previous: f64,
    },
    /// A share that is below the one before, or no number.
    #[error("passing {passing} (number {number}) of the sieve curve must not be below {previous}")]
    SieveFalls {
        /// Which value, from 1.
        number: usize,
        /// The share that passes.
        passing: f64,
        /// The one before it.
        previous: f64,
    },
    /// The curve does not run from 0 to 1.
    #[error("the sieve curve must run from 0 to 1, not from {first} to {last}")]
    SieveEnds {
        /// First share.
        first: f64,
        /// Last share.
        last: f64,
    },
    /// A row is longer than the box is wide.
    #[error(
        "row {row} of {grains} grains of radius {radius} is {length} long, the box {width} wide"
    )]
    RowTooLong {
        /// Which row from the bottom, from 1.
        row: usize,
        /// Its grains.
        grains: usize,
        /// Their radius, `[length]`.
        radius: f64,
        /// Length of the row, `[length]`.
        length: f64,
        /// Width of the box, `[length]`.
        width: f64,
    },
    /// Neighbouring rows whose grains would not lie in each other's gaps.
    #[error("rows {row} and {} have {lower} and {upper} grains; they must differ by an odd number", row + 1)]
    RowsMismatch {
        /// The lower row, from 1.
        row: usize,
        /// Its grains.
        lower: usize,
        /// Grains of the row above.
        upper: usize,
    },
    /// A row without grains.
    #[error("row {row} has no grains")]
    EmptyRow {
        /// Which row from the bottom, from 1.
        row: usize,
    },
    /// A packing fraction that is not between 0 and 1.
    #[error("packing fraction {fraction} is not between 0 and 1")]
    PackingFraction {
        /// The packing fraction.
        fraction: f64,
    },
    /// The largest grain is wider than the container.
    #[error("a grain of diameter {diameter} does not fit into the container")]
    ContainerTooNarrow {
        /// Diameter of the largest grain, `[length]`.
        diameter: f64,
    },
    /// The wanted packing fraction was not reached.
    #[error(
        "packing fraction {wanted} was not reached without overlap; the nearest was {nearest:.6}"
    )]
    TargetMissed {
        /// The wanted packing fraction.
        wanted: f64,
        /// The highest one reached with the same grains, all made smaller in proportion.
        nearest: f64,
    },
}
