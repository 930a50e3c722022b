//! Rows of text in columns.

use comfy_table::{Cell, CellAlignment, Table, presets};

/// A table without frames, numbers to the right from column `numbers` on.
pub fn table(header: &[&str], rows: Vec<Vec<String>>, numbers: std::ops::Range<usize>) -> String {
    let mut table = Table::new();
    table.load_style(presets::NOTHING).set_header(header.iter().enumerate().map(|(i, text)| {
        let side = if numbers.contains(&i) { CellAlignment::Right } else { CellAlignment::Left };
        Cell::new(text).set_alignment(side)
    }));
    table.add_rows(rows);
    for i in numbers {
        if let Some(column) = table.column_mut(i) {
            column.set_cell_alignment(CellAlignment::Right);
        }
    }
    table.trim_fmt()
}
