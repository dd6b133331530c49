//! Whether an Arrow file is laid out as ours are: the library that reads it takes offsets and lengths as they stand there.

use arrow_ipc::convert::try_fb_to_schema;
use arrow_ipc::reader::read_footer_length;
use arrow_ipc::{Block, Buffer, FieldNode, RecordBatch, root_as_footer, root_as_message};
use arrow_schema::{ArrowError, DataType, Schema};

/// Bytes after the footer: its length, and the name of the format.
const TRAILER: usize = 10;
/// What stands before the length of a message.
const CONTINUATION: [u8; 4] = [0xff; 4];
/// Buffers begin at multiples of so many bytes.
const ALIGNMENT: usize = 8;
/// Bytes of an offset in a list or a text.
const OFFSET: usize = size_of::<i32>();

/// Checks the footer, the one row and its buffers.
pub(crate) fn check(bytes: &[u8]) -> Result<(), ArrowError> {
    let (front, trailer) = bytes.split_last_chunk::<TRAILER>().ok_or_else(wrong)?;
    let length = read_footer_length(*trailer)?;
    let start = front.len().checked_sub(length).ok_or_else(wrong)?;
    let footer = root_as_footer(&front[start..]).map_err(|_| wrong())?;
    if footer.dictionaries().is_some_and(|list| !list.is_empty()) {
        return Err(wrong());
    }
    let schema = try_fb_to_schema(footer.schema().ok_or_else(wrong)?)?;
    let mut blocks = footer.recordBatches().into_iter().flatten();
    let (block, None) = (blocks.next().ok_or_else(wrong)?, blocks.next()) else {
        return Err(wrong());
    };
    check_block(bytes, block, &schema)
}

fn check_block(bytes: &[u8], block: &Block, schema: &Schema) -> Result<(), ArrowError> {
    let (offset, body) = (count(block.offset())?, count(block.bodyLength())?);
    let head = count(i64::from(block.metaDataLength()))?;
    let start = bytes.get(offset..).ok_or_else(wrong)?;
    let (head, rest) = start.split_at_checked(head).ok_or_else(wrong)?;
    let lengths = if head.starts_with(&CONTINUATION) {
        8
    } else {
        4
    };
    let message = head.get(lengths..).ok_or_else(wrong)?;
    let message = root_as_message(message).map_err(|_| wrong())?;
    let batch = message.header_as_record_batch().ok_or_else(wrong)?;
    if rest.len() < body || batch.length() != 1 || batch.compression().is_some() {
        return Err(wrong());
    }
    let mut layout = Layout::of(&batch, body)?;
    for field in schema.fields() {
        layout.check_list(field.data_type())?;
    }
    Ok(())
}

/// Lengths and buffers in the order in which columns take them.
struct Layout<'a> {
    nodes: Box<dyn Iterator<Item = &'a FieldNode> + 'a>,
    buffers: Box<dyn Iterator<Item = &'a Buffer> + 'a>,
    body: usize,
}

impl<'a> Layout<'a> {
    fn of(batch: &RecordBatch<'a>, body: usize) -> Result<Self, ArrowError> {
        Ok(Self {
            nodes: Box::new(batch.nodes().ok_or_else(wrong)?.into_iter()),
            buffers: Box::new(batch.buffers().ok_or_else(wrong)?.into_iter()),
            body,
        })
    }

    /// A column: a list in one row.
    fn check_list(&mut self, column: &DataType) -> Result<(), ArrowError> {
        let DataType::List(item) = column else {
            return Err(wrong());
        };
        if self.nulls_and_length()? != 1 {
            return Err(wrong());
        }
        self.take(2, OFFSET)?;
        let length = self.nulls_and_length()?;
        match item.data_type() {
            DataType::Float64 | DataType::Int64 => self.take(length, 8),
            DataType::UInt8 => self.take(length, 1),
            DataType::Utf8 => {
                self.take(length.checked_add(1).ok_or_else(wrong)?, OFFSET)?;
                self.take(0, 1)
            }
            _ => Err(wrong()),
        }
    }

    /// The length of the next array, whose first buffer tells what of it is null.
    fn nulls_and_length(&mut self) -> Result<usize, ArrowError> {
        let node = self.nodes.next().ok_or_else(wrong)?;
        let (length, nulls) = (count(node.length())?, count(node.null_count())?);
        if nulls > length {
            return Err(wrong());
        }
        self.take(if nulls > 0 { length.div_ceil(8) } else { 0 }, 1)?;
        Ok(length)
    }

    /// The next buffer, of at least so many values of so many bytes.
    fn take(&mut self, least: usize, bytes: usize) -> Result<(), ArrowError> {
        let buffer = self.buffers.next().ok_or_else(wrong)?;
        let (offset, length) = (count(buffer.offset())?, count(buffer.length())?);
        let is_within = offset
            .checked_add(length)
            .is_some_and(|end| end <= self.body);
        let is_even = offset.is_multiple_of(ALIGNMENT) && length.is_multiple_of(bytes);
        if is_within && is_even && length / bytes >= least {
            Ok(())
        } else {
            Err(wrong())
        }
    }
}

fn count(value: i64) -> Result<usize, ArrowError> {
    usize::try_from(value).map_err(|_| wrong())
}

fn wrong() -> ArrowError {
    ArrowError::ParseError("it is not laid out as a checkpoint is".to_owned())
}
