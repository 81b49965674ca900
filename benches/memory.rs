//! What the memory of the machine permits.

use std::hint::black_box;

use rayon::prelude::*;

/// Bytes of a triangle and its share of the nodes.
pub const TRIANGLE_BYTES: usize = 38;

/// Returns memory for the bytes of so many triangles, which is mapped when it is written.
pub fn unmapped(triangles: usize) -> Vec<u64> {
    vec![0; triangles * TRIANGLE_BYTES / 8]
}

/// Writes to memory, a part on each thread of the current pool.
pub fn write(memory: &mut [u64]) {
    let part = memory.len().div_ceil(rayon::current_num_threads()).max(1);
    memory.par_chunks_mut(part).for_each(|part| part.fill(black_box(7)));
}
