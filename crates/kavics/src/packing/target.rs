/// To come.
///
/// # Errors
/// Always.
pub fn target(
    _: &crate::geometry::Container,
    _: &super::Sizes,
    _: f64,
    _: u64,
) -> Result<crate::ids::PerGrain<crate::assembly::Grain>, super::PackingError> {
    Err(super::PackingError::NoGrains)
}
