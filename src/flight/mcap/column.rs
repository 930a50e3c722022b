//! Columns that grow row by row, within bounds that no file can exceed.

use crate::flight::table::{LOG_TIME, Table};
use std::cell::Cell;
use std::collections::HashMap;
use std::rc::Rc;

/// Numbers that one message may hold.
const COLUMNS: usize = 4096;

/// Number of the column `LOG_TIME`.
const LOG_TIME_COLUMN: usize = 0;

/// Bytes that the columns of all topics of a file may still take.
#[derive(Clone)]
pub struct Budget(Rc<Cell<usize>>);

impl Budget {
    pub fn new(bytes: usize) -> Self {
        Self(Rc::new(Cell::new(bytes)))
    }

    /// An error where less than `bytes` is left.
    pub fn spend(&self, bytes: usize) -> Result<(), String> {
        let left = self.0.get().checked_sub(bytes).ok_or("the file holds more numbers than fit into memory")?;
        self.0.set(left);
        Ok(())
    }
}

/// A time in seconds, rounded once, so that the same time is the same number wherever it comes from.
pub fn seconds(whole: i64, nanoseconds: i64) -> f64 {
    (i128::from(whole) * 1_000_000_000 + i128::from(nanoseconds)) as f64 / 1e9
}

/// The table of one topic while it is read.
pub struct Columns {
    values: Vec<Vec<f64>>,
    by_path: HashMap<String, usize>,
    rows: usize,
    budget: Budget,
}

impl Columns {
    pub fn new(budget: Budget) -> Self {
        let by_path = HashMap::from([(LOG_TIME.to_string(), LOG_TIME_COLUMN)]);
        Self { values: vec![Vec::new()], by_path, rows: 0, budget }
    }

    /// What else the topic keeps in memory.
    pub fn spend(&self, bytes: usize) -> Result<(), String> {
        self.budget.spend(bytes)
    }

    pub fn rows(&self) -> usize {
        self.rows
    }

    /// The number of the column called `path`, which is made if need be.
    pub fn column(&mut self, path: &str) -> Result<usize, String> {
        if let Some(&column) = self.by_path.get(path) {
            return Ok(column);
        }
        let column = self.values.len();
        if column == COLUMNS {
            return Err(format!("its messages hold more than {COLUMNS} numbers"));
        }
        self.budget.spend(8 * self.rows + 128 + 2 * path.len())?;
        self.by_path.insert(path.into(), column);
        self.values.push(Vec::new());
        Ok(column)
    }

    /// Sets a number of the row being read. Of two for the same column the later holds.
    pub fn set(&mut self, column: usize, value: f64) {
        let values = &mut self.values[column];
        values.resize(self.rows, f64::NAN);
        values.push(value);
    }

    pub fn end_row(&mut self, log_time_s: f64) -> Result<(), String> {
        self.budget.spend(8 * self.values.len())?;
        self.set(LOG_TIME_COLUMN, log_time_s);
        self.rows += 1;
        Ok(())
    }

    pub fn into_table(mut self) -> Table {
        for values in &mut self.values {
            // Also drops what a row that broke off has left.
            values.resize(self.rows, f64::NAN);
        }
        let columns =
            self.by_path.into_iter().map(|(path, column)| (path, std::mem::take(&mut self.values[column]))).collect();
        Table { columns }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_a_row_lacks_is_nan_and_a_broken_row_is_dropped() {
        let mut columns = Columns::new(Budget::new(10_000));
        columns.end_row(1.0).unwrap();
        let x = columns.column("x").unwrap();
        columns.set(x, 2.0);
        columns.end_row(2.0).unwrap();
        columns.set(x, 3.0);
        let table = columns.into_table();
        assert_eq!(table.columns[LOG_TIME], [1.0, 2.0]);
        assert!(table.columns["x"][0].is_nan());
        assert_eq!(table.columns["x"][1..], [2.0]);
    }

    #[test]
    fn growth_is_bounded() {
        let mut columns = Columns::new(Budget::new(100));
        assert!(columns.column("a").is_err());
        let mut columns = Columns::new(Budget::new(usize::MAX));
        assert!((0..COLUMNS).any(|i| columns.column(&i.to_string()).is_err()));
    }
}
