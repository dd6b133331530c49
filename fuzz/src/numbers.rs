//! Numbers from bytes, with those in front that geometry finds hard: equal, on a lattice, nearly equal, huge, tiny, none.

/// A stream of numbers.
#[derive(Clone, Debug)]
pub struct Numbers<'a> {
    bytes: &'a [u8],
    last: f64,
}

impl<'a> Numbers<'a> {
    /// The numbers that some bytes stand for.
    pub fn new(bytes: &'a [u8]) -> Self {
        Self { bytes, last: 1.0 }
    }

    /// Whether no byte is left.
    pub fn is_empty(&self) -> bool {
        self.bytes.is_empty()
    }

    /// A byte; 0 at the end.
    pub fn byte(&mut self) -> u8 {
        let Some((&first, others)) = self.bytes.split_first() else {
            return 0;
        };
        self.bytes = others;
        first
    }

    /// A number: its first byte says of which kind, the next ones which. At the end 0.
    #[expect(
        clippy::should_implement_trait,
        reason = "there is always a next number"
    )]
    pub fn next(&mut self) -> f64 {
        let kind = self.byte();
        let number = match kind % 10 {
            0 => f64::from(self.byte()),
            1 => f64::from(self.byte().cast_signed()) / 8.0,
            2 => self.last,
            3 => self.last.next_up(),
            4 => self.last.next_down(),
            5 => self.last + f64::from(self.byte().cast_signed()) * 1e-9,
            6 => f64::from(self.byte()) * 3_f64.sqrt(),
            7 => f64::from(self.byte()) * 10_f64.powi(i32::from(self.byte().cast_signed()) * 2),
            8 => [
                f64::NAN,
                f64::INFINITY,
                f64::NEG_INFINITY,
                -0.0,
                f64::MAX,
                f64::MIN_POSITIVE,
            ][usize::from(self.byte()) % 6],
            _ => f64::from_le_bytes(std::array::from_fn(|_| self.byte())),
        };
        self.last = number;
        number
    }

    /// Rows of three numbers, to the end.
    pub fn rows(&mut self) -> impl Iterator<Item = [f64; 3]> {
        std::iter::from_fn(|| (!self.is_empty()).then(|| std::array::from_fn(|_| self.next())))
    }
}
