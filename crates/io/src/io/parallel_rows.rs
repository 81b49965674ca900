//! Rows of a file that are made on all threads.

use std::io::{self, Write};

use rayon::prelude::*;

/// Rows that one thread makes at a time: some hundred kilobytes.
const ROWS: usize = 4096;

/// Writes `count` rows in their order. `write_row` appends a row, by its number, to some bytes.
///
/// Some groups of rows are made on all threads, and written; then come the next. The bytes do not depend on
/// the number of threads.
///
/// # Errors
/// Fails with the errors of `out`, and the error of the first group with a row that has one.
pub(super) fn write_rows(
    out: &mut impl Write,
    count: usize,
    write_row: impl Fn(&mut Vec<u8>, usize) -> io::Result<()> + Sync,
) -> io::Result<()> {
    let mut groups = vec![Vec::new(); (2 * rayon::current_num_threads()).min(count.div_ceil(ROWS))];
    for first in (0..count).step_by((ROWS * groups.len()).max(1)) {
        let made = groups.par_iter_mut().enumerate().map(|(group, bytes)| {
            bytes.clear();
            let start = first + ROWS * group;
            (start..count.min(start + ROWS)).try_for_each(|row| write_row(bytes, row))
        });
        let made: Vec<io::Result<()>> = made.collect();
        for (bytes, result) in groups.iter().zip(made) {
            result?;
            out.write_all(bytes)?;
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn rows(count: usize) -> Vec<u8> {
        let mut bytes = Vec::new();
        write_rows(&mut bytes, count, |out, row| writeln!(out, "{row}")).unwrap();
        bytes
    }

    #[test]
    fn rows_are_in_order_for_any_number_of_threads() {
        for count in [0, 1, ROWS - 1, ROWS, ROWS + 1, 23 * ROWS + 5] {
            let expected: String = (0..count).map(|row| format!("{row}\n")).collect();
            for threads in [1, 2, 3, 8] {
                let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
                assert!(
                    pool.install(|| rows(count)) == expected.as_bytes(),
                    "{count} rows, {threads} threads"
                );
            }
        }
    }

    #[test]
    fn the_rows_before_an_error_are_written() {
        let mut bytes = Vec::new();
        let result = write_rows(&mut bytes, 10 * ROWS, |out, row| {
            if row >= 3 * ROWS { Err(io::Error::other(format!("row {row}"))) } else { writeln!(out) }
        });
        assert_eq!(result.unwrap_err().to_string(), format!("row {}", 3 * ROWS));
        assert_eq!(bytes.len() % ROWS, 0);
        assert!(bytes.len() <= 3 * ROWS);
    }
}
