//! The `airlight` command.
fn main() {}
