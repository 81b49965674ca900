//! The order of rows: files have the top row first, rasters the lowest.

/// Reverses the order of the rows of a picture in place, without a copy of a large one.
pub(super) fn reverse_rows(values: &mut [f32], columns: u32) {
    let columns = columns as usize;
    let rows = values.len() / columns;
    for row in 0..rows / 2 {
        let (low, high) = values.split_at_mut((rows - 1 - row) * columns);
        low[row * columns..][..columns].swap_with_slice(&mut high[..columns]);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_last_row_becomes_the_first() {
        for (before, columns, after) in [
            (vec![1.0, 2.0, 3.0, 4.0, 5.0, 6.0], 2, vec![5.0, 6.0, 3.0, 4.0, 1.0, 2.0]),
            (vec![1.0, 2.0, 3.0, 4.0], 2, vec![3.0, 4.0, 1.0, 2.0]),
            (vec![1.0, 2.0], 2, vec![1.0, 2.0]),
        ] {
            let mut values = before;
            reverse_rows(&mut values, columns);
            assert_eq!(values, after);
        }
    }
}
