//! Sparse matrices of small dense blocks, in compressed rows.

use rayon::prelude::*;

use super::block::{Block, Real, add_block_product, add_product, rounded, transposed};

/// Rows that one task works on: fixed, so that sums do not depend on the number of threads.
pub const CHUNK: usize = 2048;

/// A vector by nodes.
pub type Nodes<T, const B: usize> = Vec<[T; B]>;

/// Compressed block rows.
#[derive(Clone, Debug, Default)]
pub struct BlockMatrix<T, const B: usize> {
    /// First entry of each row, and the number of entries at the end.
    pub row_start: Vec<u32>,
    /// Column of each entry.
    pub column: Vec<u32>,
    /// The entries.
    pub block: Vec<Block<T, B>>,
}

impl<T: Real, const B: usize> BlockMatrix<T, B> {
    /// Number of rows.
    pub fn rows(&self) -> usize {
        self.row_start.len() - 1
    }

    /// Number of entries in a row.
    pub fn row_length(&self, row: usize) -> usize {
        (self.row_start[row + 1] - self.row_start[row]) as usize
    }

    /// Columns and entries of a row.
    #[inline]
    pub fn row(&self, row: usize) -> (&[u32], &[Block<T, B>]) {
        let entries = self.row_start[row] as usize..self.row_start[row + 1] as usize;
        (&self.column[entries.clone()], &self.block[entries])
    }

    /// Entries of a row, to be changed.
    pub fn row_mut(&mut self, row: usize) -> &mut [Block<T, B>] {
        &mut self.block[self.row_start[row] as usize..self.row_start[row + 1] as usize]
    }

    /// One row times a vector.
    #[inline]
    pub fn row_product(&self, row: usize, x: &[[T; B]]) -> [T; B] {
        let (columns, blocks) = self.row(row);
        let mut sum = [T::default(); B];
        for (&column, block) in columns.iter().zip(blocks) {
            add_product(&mut sum, block, &x[column as usize]);
        }
        sum
    }

    /// The transposed matrix, which has `rows` rows.
    #[must_use]
    pub fn transposed(&self, rows: usize) -> Self {
        let mut row_start = vec![0u32; rows + 1];
        for &column in &self.column {
            row_start[column as usize + 1] += 1;
        }
        for row in 0..rows {
            row_start[row + 1] += row_start[row];
        }
        let mut next = row_start.clone();
        let mut column = vec![0; self.column.len()];
        let mut source = vec![0; self.column.len()];
        for row in 0..self.rows() {
            for entry in self.row_start[row]..self.row_start[row + 1] {
                let place = &mut next[self.column[entry as usize] as usize];
                column[*place as usize] = row as u32;
                source[*place as usize] = entry;
                *place += 1;
            }
        }
        let entries = source.par_iter();
        Self {
            row_start,
            column,
            block: entries
                .map(|&entry| transposed(&self.block[entry as usize]))
                .collect(),
        }
    }
}

impl<const B: usize> BlockMatrix<f64, B> {
    /// The matrix in another precision.
    pub fn rounded<T: Real>(&self) -> BlockMatrix<T, B> {
        BlockMatrix {
            row_start: self.row_start.clone(),
            column: self.column.clone(),
            block: self.block.par_iter().map(rounded).collect(),
        }
    }

    /// The blocks on the diagonal, and the matrix without them.
    pub fn split(mut self) -> (Vec<Block<f64, B>>, Self) {
        let mut diagonal = vec![[[0.0; B]; B]; self.rows()];
        let (mut kept, mut entry) = (0, 0);
        for (row, own) in diagonal.iter_mut().enumerate() {
            while entry < self.row_start[row + 1] as usize {
                if self.column[entry] as usize == row {
                    *own = self.block[entry];
                } else {
                    (self.column[kept], self.block[kept]) = (self.column[entry], self.block[entry]);
                    kept += 1;
                }
                entry += 1;
            }
            self.row_start[row + 1] = kept as u32;
        }
        self.column.truncate(kept);
        self.block.truncate(kept);
        (diagonal, self)
    }

    /// A matrix built row by row: `add` puts the entries of a row into a [`RowSum`].
    pub fn from_rows(
        rows: usize,
        columns: usize,
        add: impl Fn(usize, &mut RowSum<B>) + Sync,
    ) -> Self {
        let chunks: Vec<RowSum<B>> = (0..rows.div_ceil(CHUNK))
            .into_par_iter()
            .map_init(
                || vec![u32::MAX; columns],
                |places, chunk| {
                    let mut sum = RowSum::new(std::mem::take(places));
                    for row in chunk * CHUNK..rows.min((chunk + 1) * CHUNK) {
                        add(row, &mut sum);
                        sum.end_row();
                    }
                    *places = std::mem::take(&mut sum.places);
                    sum
                },
            )
            .collect();
        Self::joined(&chunks)
    }

    fn joined(chunks: &[RowSum<B>]) -> Self {
        let mut row_start = vec![0];
        for chunk in chunks {
            let before = row_start[row_start.len() - 1];
            row_start.extend(chunk.row_end.iter().map(|end| before + end));
        }
        let columns = chunks.iter().map(|chunk| &chunk.column[..]);
        let blocks = chunks.iter().map(|chunk| &chunk.block[..]);
        Self {
            row_start,
            column: joined(0, columns),
            block: joined([[0.0; B]; B], blocks),
        }
    }
}

/// Parts one after the other, copied by all threads.
fn joined<'a, T: Copy + Send + Sync + 'a>(
    zero: T,
    parts: impl Iterator<Item = &'a [T]> + Clone,
) -> Vec<T> {
    let mut whole = vec![zero; parts.clone().map(<[T]>::len).sum()];
    let mut rest = &mut whole[..];
    let mut tasks = Vec::new();
    for part in parts {
        let (here, after) = rest.split_at_mut(part.len());
        tasks.push((here, part));
        rest = after;
    }
    tasks
        .into_par_iter()
        .for_each(|(here, part)| here.copy_from_slice(part));
    whole
}

/// The entries of some rows as they are summed up.
pub struct RowSum<const B: usize> {
    /// Place of each column's entry in the present row, if it has one.
    places: Vec<u32>,
    row_end: Vec<u32>,
    column: Vec<u32>,
    block: Vec<Block<f64, B>>,
}

impl<const B: usize> RowSum<B> {
    fn new(places: Vec<u32>) -> Self {
        Self {
            places,
            row_end: Vec::new(),
            column: Vec::new(),
            block: Vec::new(),
        }
    }

    /// The entry of a column in the present row.
    #[inline]
    pub fn entry(&mut self, column: u32) -> &mut Block<f64, B> {
        let place = &mut self.places[column as usize];
        if *place == u32::MAX {
            *place = self.column.len() as u32;
            self.column.push(column);
            self.block.push([[0.0; B]; B]);
        }
        &mut self.block[*place as usize]
    }

    /// Adds A·C to the entry of a column.
    #[inline]
    pub fn add(&mut self, column: u32, a: &Block<f64, B>, c: &Block<f64, B>) {
        add_block_product(self.entry(column), a, c);
    }

    fn end_row(&mut self) {
        let start = self.row_end.last().copied().unwrap_or(0) as usize;
        for &column in &self.column[start..] {
            self.places[column as usize] = u32::MAX;
        }
        self.row_end.push(self.column.len() as u32);
    }
}
