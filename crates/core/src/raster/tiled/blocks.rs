use std::sync::Arc;

use crate::geometry::NumberMap;

/// Side of a chunk, in blocks.
const CHUNK: i32 = 8;
const CHUNK_BLOCKS: usize = (CHUNK * CHUNK) as usize;

/// A table with an entry for each block of 32 × 32 squares of one scale.
///
/// Blocks are kept in chunks of 8 × 8. Clones share the chunks: when one block of a clone changes, a chunk is
/// copied and not the whole table.
#[derive(Clone, Debug)]
pub(super) struct Blocks<T> {
    chunks: NumberMap<ChunkKey, Arc<Chunk<T>>>,
    count: usize,
}

type Chunk<T> = [Option<T>; CHUNK_BLOCKS];

impl<T> Default for Blocks<T> {
    fn default() -> Self {
        Self { chunks: NumberMap::default(), count: 0 }
    }
}

impl<T: Clone> Blocks<T> {
    #[inline]
    pub fn get(&self, x: i32, y: i32) -> Option<&T> {
        self.chunks.get(&ChunkKey::of_chunk(x, y))?[place_in_chunk(x, y)].as_ref()
    }

    pub fn contains(&self, x: i32, y: i32) -> bool {
        self.get(x, y).is_some()
    }

    pub fn get_mut(&mut self, x: i32, y: i32) -> Option<&mut T> {
        Arc::make_mut(self.chunks.get_mut(&ChunkKey::of_chunk(x, y))?)[place_in_chunk(x, y)].as_mut()
    }

    pub fn get_or_insert(&mut self, x: i32, y: i32, value: impl FnOnce() -> T) -> &mut T {
        let chunk = self.chunks.entry(ChunkKey::of_chunk(x, y));
        let chunk = chunk.or_insert_with(|| Arc::new([const { None }; CHUNK_BLOCKS]));
        let block = &mut Arc::make_mut(chunk)[place_in_chunk(x, y)];
        self.count += usize::from(block.is_none());
        block.get_or_insert_with(value)
    }

    pub fn remove(&mut self, x: i32, y: i32) -> Option<T> {
        let key = ChunkKey::of_chunk(x, y);
        let chunk = Arc::make_mut(self.chunks.get_mut(&key)?);
        let removed = chunk[place_in_chunk(x, y)].take()?;
        if chunk.iter().all(Option::is_none) {
            self.chunks.remove(&key);
        }
        self.count -= 1;
        Some(removed)
    }

    /// Returns number of blocks.
    pub fn len(&self) -> usize {
        self.count
    }

    pub fn is_empty(&self) -> bool {
        self.count == 0
    }

    /// Returns all blocks with [x, y], in the order of a hash table. Sort where the order matters.
    pub fn iter(&self) -> impl Iterator<Item = ([i32; 2], &T)> {
        self.chunks.iter().flat_map(|(key, chunk)| {
            let [left, lowest] = key.corner();
            let blocks = (0..).zip(chunk.iter());
            let at = move |n: i32| [left + n % CHUNK, lowest + n / CHUNK];
            blocks.filter_map(move |(n, block)| Some((at(n), block.as_ref()?)))
        })
    }

    /// Returns whether both tables have blocks at the same places, and `equal` accepts each pair.
    pub fn equal_by(&self, other: &Self, equal: impl Fn(&T, &T) -> bool) -> bool {
        let found = |([x, y], block): ([i32; 2], &T)| other.get(x, y).is_some_and(|b| equal(block, b));
        self.len() == other.len() && self.iter().all(found)
    }
}

#[inline]
fn place_in_chunk(x: i32, y: i32) -> usize {
    ((y & (CHUNK - 1)) * CHUNK + (x & (CHUNK - 1))) as usize
}

/// Column and row of a chunk.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
struct ChunkKey(u64);

impl ChunkKey {
    /// Returns the key of the chunk that contains the block [x, y].
    #[inline]
    fn of_chunk(x: i32, y: i32) -> Self {
        let [x, y] = [x, y].map(|n| u64::from((n >> CHUNK.ilog2()) as u32));
        Self(x << 32 | y)
    }

    /// Column and row of the first block of the chunk.
    fn corner(self) -> [i32; 2] {
        [(self.0 >> 32) as i32, self.0 as u32 as i32].map(|n| n * CHUNK)
    }
}
