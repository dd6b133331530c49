//! What acts from outside as the scene file says it, before the grains are known.

use std::ops::Range;

use super::check_contacts::Ranges;
use super::value::Placed;
use crate::equilibrium::{Freedom, Load};

/// All that acts from outside, before the grains are known.
#[derive(Clone, Debug)]
pub struct LoadingPlan {
    /// Supports.
    pub supports: Vec<SupportPlan>,
    /// Weight, if grains have one.
    pub weight: Option<WeightPlan>,
    /// Moves.
    pub moves: Vec<MovePlan>,
    /// Loads.
    pub loads: Vec<LoadPlan>,
}

/// A support.
#[derive(Clone, Debug)]
pub struct SupportPlan {
    /// Of which grains.
    pub grains: ChoicePlan,
    /// Freedoms that are held.
    pub fix: Vec<Freedom>,
    /// Where it stands in the file.
    pub span: Range<usize>,
}

/// A choice of grains with its place.
#[derive(Clone, Debug)]
pub struct ChoicePlan {
    /// Which.
    pub kind: ChoiceKind,
    /// Where it stands in the file.
    pub span: Range<usize>,
}

/// A choice of grains.
#[derive(Clone, Debug)]
pub enum ChoiceKind {
    /// Grains that touch an edge of the box.
    Edge(usize),
    /// Grains by id, each with its place in the file.
    Ids(Vec<Placed<i64>>),
    /// Grains with their centre in ranges.
    Within(Ranges),
    /// Grains on the boundary of the assembly.
    Boundary,
}

/// The weight of the grains.
#[derive(Clone, Copy, Debug)]
pub struct WeightPlan {
    /// `[mass/length³]`.
    pub density: f64,
    /// `[length/time²]`.
    pub gravity: f64,
}

/// Side or grains.
#[derive(Clone, Debug)]
pub enum TargetPlan {
    /// A side of the box, with its place in the file.
    Side(usize, Range<usize>),
    /// Grains.
    Grains(ChoicePlan),
}

/// A prescribed motion.
#[derive(Clone, Debug)]
pub struct MovePlan {
    /// Its name.
    pub name: Placed<String>,
    /// What moves.
    pub target: TargetPlan,
    /// How.
    pub motion: MotionPlan,
}

/// How something moves at factor 1.
#[derive(Clone, Debug)]
pub enum MotionPlan {
    /// Some freedoms by given amounts, each with its place in the file.
    Freedoms(Vec<(Freedom, f64, Range<usize>)>),
    /// In an affine way about the centre of the box.
    Strain {
        /// ∂u_x/∂x.
        xx: f64,
        /// ∂u_y/∂x.
        xy: f64,
        /// ∂u_x/∂y.
        yx: f64,
        /// ∂u_y/∂y.
        yy: f64,
        /// Whether the rotation stays free; else it is (xy − yx)/2.
        free_rotation: bool,
        /// Its place in the file.
        span: Range<usize>,
    },
}

/// A load.
#[derive(Clone, Debug)]
pub struct LoadPlan {
    /// Its name.
    pub name: Placed<String>,
    /// What it is.
    pub kind: LoadKind,
}

/// Kinds of loads.
#[derive(Clone, Debug)]
pub enum LoadKind {
    /// Along an edge of the box, at its start and end, `[force/length]`.
    Edge {
        /// Which edge.
        edge: usize,
        /// Its place in the file.
        span: Range<usize>,
        /// Along the outward normal.
        normal: [f64; 2],
        /// Along the edge.
        shear: [f64; 2],
    },
    /// A force on a side or on each of some grains.
    Force(TargetPlan, Load, Vec<(Freedom, Range<usize>)>),
}
