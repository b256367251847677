//! Columns of a table, and rows into a file, a group at a time.

use crate::error::FleetError;
use parquet::basic::{Compression, LogicalType, Repetition, TimeUnit, Type as Physical};
use parquet::data_type::{BoolType, ByteArray, ByteArrayType, DataType, DoubleType, Int64Type};
use parquet::errors::ParquetError;
use parquet::file::properties::WriterProperties;
use parquet::file::writer::{SerializedFileWriter, SerializedRowGroupWriter};
use parquet::schema::types::Type;
use std::io::Write;
use std::sync::Arc;

/// Rows held at once.
const ROWS: usize = 1 << 16;

/// A column of rows `R`.
pub struct Column<R> {
    /// Its name, with the unit.
    pub name: &'static str,
    /// What it is, in words.
    pub doc: &'static str,
    pub(super) of: Of<R>,
}

/// The values of a column; what a row has none of is null.
pub(super) enum Of<R> {
    Text(fn(&R) -> Option<String>),
    Number(fn(&R) -> Option<f64>),
    Whole(fn(&R) -> Option<i64>),
    Truth(fn(&R) -> Option<bool>),
    /// Milliseconds since 1970, UTC.
    Time(fn(&R) -> Option<i64>),
}

impl<R> Column<R> {
    fn field(&self) -> Result<Type, ParquetError> {
        let (physical, logical) = match self.of {
            Of::Text(_) => (Physical::BYTE_ARRAY, Some(LogicalType::String)),
            Of::Number(_) => (Physical::DOUBLE, None),
            Of::Whole(_) => (Physical::INT64, None),
            Of::Truth(_) => (Physical::BOOLEAN, None),
            Of::Time(_) => (Physical::INT64, Some(LogicalType::timestamp(true, TimeUnit::MILLIS))),
        };
        Type::primitive_type_builder(self.name, physical)
            .with_repetition(Repetition::OPTIONAL)
            .with_logical_type(logical)
            .build()
    }

    fn put<W: Write + Send>(
        &self,
        rows: &[R],
        group: &mut SerializedRowGroupWriter<W>,
    ) -> Result<(), ParquetError> {
        match self.of {
            Of::Text(of) => {
                let bytes = |row| of(row).map(|text| ByteArray::from(text.into_bytes()));
                put::<ByteArrayType, W>(rows.iter().map(bytes), group)
            }
            Of::Number(of) => put::<DoubleType, W>(rows.iter().map(of), group),
            Of::Whole(of) | Of::Time(of) => put::<Int64Type, W>(rows.iter().map(of), group),
            Of::Truth(of) => put::<BoolType, W>(rows.iter().map(of), group),
        }
    }
}

fn put<T: DataType, W: Write + Send>(
    values: impl Iterator<Item = Option<T::T>>,
    group: &mut SerializedRowGroupWriter<W>,
) -> Result<(), ParquetError> {
    let (mut levels, mut there) = (vec![], vec![]);
    for value in values {
        levels.push(i16::from(value.is_some()));
        there.extend(value);
    }
    if let Some(mut column) = group.next_column()? {
        column.typed::<T>().write_batch(&there, Some(&levels), None)?;
        column.close()?;
    }
    Ok(())
}

/// Writes rows as a table.
pub(super) fn write<R>(
    columns: &[Column<R>],
    name: &str,
    rows: impl Iterator<Item = R>,
    out: impl Write + Send,
) -> Result<(), FleetError> {
    write_rows(columns, name, rows, out).map_err(|error| FleetError::Table(error.to_string()))
}

fn write_rows<R>(
    columns: &[Column<R>],
    name: &str,
    mut rows: impl Iterator<Item = R>,
    out: impl Write + Send,
) -> Result<(), ParquetError> {
    let fields: Result<Vec<_>, _> =
        columns.iter().map(|column| column.field().map(Arc::new)).collect();
    let schema = Type::group_type_builder(name).with_fields(fields?).build()?;
    let properties = WriterProperties::builder()
        .set_compression(Compression::SNAPPY)
        .set_created_by(format!("Boresight {}", env!("CARGO_PKG_VERSION")))
        .build();
    let mut file = SerializedFileWriter::new(out, Arc::new(schema), Arc::new(properties))?;
    loop {
        let some: Vec<R> = rows.by_ref().take(ROWS).collect();
        if some.is_empty() {
            break;
        }
        let mut group = file.next_row_group()?;
        for column in columns {
            column.put(&some, &mut group)?;
        }
        group.close()?;
    }
    file.close()?;
    Ok(())
}
