//! Sends parts of arrays to their buffers.

use std::ops::Range;

use super::chunks::ChunkedArray;

/// Changed ranges of triangles or nodes with at most this many entries between them are written as one.
const SMALL_GAP: usize = 32;
/// Sends items from `*next` on, as many as the budget in bytes allows and at least one. Returns the bytes
/// sent.
pub(super) fn send<T: bytemuck::Pod>(
    queue: &wgpu::Queue,
    array: &ChunkedArray,
    items: &[T],
    next: &mut usize,
    byte_budget: usize,
) -> usize {
    if byte_budget == 0 {
        return 0;
    }
    let end = next.saturating_add((byte_budget / size_of::<T>()).max(1)).min(items.len());
    let bytes: &[u8] = bytemuck::cast_slice(&items[*next..end]);
    array.write(queue, *next, bytes);
    *next = end;
    bytes.len()
}

pub(super) fn send_ranges<T: bytemuck::Pod>(
    queue: &wgpu::Queue,
    array: &ChunkedArray,
    items: &[T],
    ranges: &[Range<usize>],
) {
    send_joined(queue, array, items, joined(ranges.iter().cloned(), SMALL_GAP));
}

pub(super) fn send_joined<T: bytemuck::Pod>(
    queue: &wgpu::Queue,
    array: &ChunkedArray,
    items: &[T],
    ranges: Vec<Range<usize>>,
) {
    for range in ranges {
        let range = range.start.min(items.len())..range.end.min(items.len());
        array.write(queue, range.start, bytemuck::cast_slice(&items[range]));
    }
}

/// Joins ascending ranges across small gaps, for fewer and longer writes.
pub(super) fn joined(ranges: impl IntoIterator<Item = Range<usize>>, small_gap: usize) -> Vec<Range<usize>> {
    let mut joined: Vec<Range<usize>> = Vec::new();
    for range in ranges {
        match joined.last_mut() {
            Some(last) if range.start <= last.end + small_gap => last.end = last.end.max(range.end),
            _ => joined.push(range),
        }
    }
    joined
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn near_ranges_are_joined() {
        assert_eq!(joined([0..3, 4..6, 6..9, 500..501], 32), [0..9, 500..501]);
        assert_eq!(joined([0..30, 5..7, 100..101], 32), [0..30, 100..101]);
        assert_eq!(joined([], 32), []);
    }
}
