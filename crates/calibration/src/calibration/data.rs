//! Test data: reading of tables and records, the roles of their columns, zeros and cycles, and impossible values.

mod choice;
mod columns;
mod conversion;
mod cycles;
mod gross_rows;
mod layout;
mod mounting;
mod mounting_statements;
mod plausible;
mod reading;
mod readings;
mod record;
mod repeated;
mod roles;
mod rounding;
mod row_choice;
mod strain_column;
mod stretched;
mod table_reading;
mod test_data;
mod zero;

pub use conversion::Conversion;
pub use cycles::{Branches, PRECONDITIONED};
pub use mounting::{Mounted, Mounting, RestState};
pub use reading::KEYS;
pub use repeated::refuse_repeated;
pub use strain_column::StrainColumn;
pub use table_reading::{ColumnReading, TableReading};
pub use test_data::{Observation, Test, TestData, Times};
pub use zero::FoundZero;
