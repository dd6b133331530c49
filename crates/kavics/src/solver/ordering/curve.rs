//! Nodes along a curve that fills the plane.

/// Sorts nodes along the curve of Morton through their positions, so that neighbours are near each other in memory.
pub(super) fn sort_along_curve(nodes: &mut [u32], position: impl Fn(u32) -> [f64; 2]) {
    let (mut low, mut high) = ([f64::INFINITY; 2], [f64::NEG_INFINITY; 2]);
    for &node in nodes.iter() {
        for (axis, value) in position(node).into_iter().enumerate() {
            low[axis] = low[axis].min(value);
            high[axis] = high[axis].max(value);
        }
    }
    let extent = (high[0] - low[0]).max(high[1] - low[1]);
    let cells = f64::from(u16::MAX);
    let scale = if extent > 0.0 { cells / extent } else { 0.0 };
    nodes.sort_by_cached_key(|&node| {
        let [x, y] = position(node);
        let cell = |value: f64, low: f64| ((value - low) * scale) as u16;
        (interleaved(cell(x, low[0]), cell(y, low[1])), node)
    });
}

/// The bits of two numbers in turn: the place of a square cell on the curve.
fn interleaved(x: u16, y: u16) -> u32 {
    spread(x) | spread(y) << 1
}

fn spread(bits: u16) -> u32 {
    let steps = [
        (8, 0x00ff_00ff),
        (4, 0x0f0f_0f0f),
        (2, 0x3333_3333),
        (1, 0x5555_5555),
    ];
    steps.iter().fold(u32::from(bits), |spread, (shift, mask)| {
        (spread | spread << shift) & mask
    })
}
