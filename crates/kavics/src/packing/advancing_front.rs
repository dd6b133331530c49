/// To come.
///
/// # Errors
/// Always.
pub fn advancing_front(
    _: &crate::geometry::Container,
    _: &super::Sizes,
    _: Option<usize>,
    _: u64,
) -> Result<crate::ids::PerGrain<crate::assembly::Grain>, super::PackingError> {
    Err(super::PackingError::NoGrains)
}
