//! Tables of figures: plain columns, the first to the left and all others to the right.

use comfy_table::{CellAlignment, Row, Table, presets};

pub(crate) fn new(heads: impl Into<Row>) -> Table {
    let mut table = Table::new();
    table.load_style(presets::NOTHING).set_header(heads);
    for column in table.column_iter_mut().skip(1) {
        column.set_cell_alignment(CellAlignment::Right);
    }
    table
}

/// The table without the spaces that pad its lines.
pub(crate) fn text(table: &Table) -> String {
    table.lines().map(|line| line.trim().to_owned()).collect::<Vec<_>>().join("\n")
}
