//! Libraries that decode files panic on some that are damaged or forged: bytes of others must not end the program.

use std::cell::Cell;
use std::panic::{AssertUnwindSafe, catch_unwind};

use parquet::errors::ParquetError;

thread_local! {
    static GUARDED: Cell<bool> = const { Cell::new(false) };
}

/// Whether a panic on this thread becomes an error of the file that is read: a panic hook has nothing to say of it.
pub fn is_guarded() -> bool {
    GUARDED.get()
}

/// Decodes what stands in a file; a panic of the decoder is an error.
pub(crate) fn guarded<T, E: From<ParquetError>>(
    decode: impl FnOnce() -> Result<T, E>,
) -> Result<T, E> {
    let before = GUARDED.replace(true);
    let decoded = catch_unwind(AssertUnwindSafe(decode));
    GUARDED.set(before);
    decoded.unwrap_or_else(|_| {
        let damaged = ParquetError::General("its bytes cannot be decoded".to_owned());
        Err(damaged.into())
    })
}
