//! A queue of nodes by value, then by number.

/// The priority queue of nodes, smallest value first; of equal values, the node with the lower number.
///
/// A march takes ascending values, and adds values a little above the one that it took. So most entries wait
/// unsorted in buckets of equal width, each of which is sorted when its turn comes. A node is added again
/// when its value falls: entries with an old value are dropped with their bucket, before anything is sorted.
///
/// ```text
///   sorted, heap        buckets, each after the ones before it        far
///   [now ........ ]  [......] [......] [......]  …  [......]  [after all buckets ...
/// ```
///
/// The order of what is taken follows from the entries alone, whatever the width of the buckets: those put
/// for the bucket that is open, or one before it, go to a heap beside it.
#[derive(Clone, Debug, Default)]
pub(super) struct Queue {
    /// What is left of the open bucket, the first last.
    sorted: Vec<QueueEntry>,
    /// What was put for the open bucket, or one before it, since it is open.
    heap: Heap,
    /// So many entries in the heap ask for narrower buckets.
    most_in_heap: usize,
    buckets: Vec<Vec<QueueEntry>>,
    /// A bit for each bucket with entries.
    occupied: [u64; BUCKETS / 64],
    /// The number of the open bucket.
    open: usize,
    /// The value at which the first bucket begins.
    start: f64,
    /// How many buckets there are for values that differ by 1. At 0, all are in the first.
    per_unit: f64,
    far: Vec<QueueEntry>,
}

/// The bits of a value from 0, which have its order, and the number of the node.
type QueueEntry = u128;

const BUCKETS: usize = 256;
/// Buckets are so wide that about this number of entries is in one.
const IN_A_BUCKET: f64 = 32.0;
/// A heap with fewer entries is as fast as buckets are.
const MOST_IN_HEAP: usize = 256;

fn entry(value: f64, node: u32) -> QueueEntry {
    u128::from(value.to_bits()) << 32 | u128::from(node)
}

fn value_of(entry: QueueEntry) -> f64 {
    f64::from_bits((entry >> 32) as u64)
}

fn node_of(entry: QueueEntry) -> u32 {
    entry as u32
}

impl Queue {
    pub fn clear(&mut self) {
        self.sorted.clear();
        self.heap.0.clear();
        self.buckets.iter_mut().for_each(Vec::clear);
        self.far.clear();
        (self.occupied, self.open, self.per_unit) = ([0; BUCKETS / 64], 0, 0.0);
        self.most_in_heap = MOST_IN_HEAP;
    }

    pub fn is_empty(&self) -> bool {
        self.sorted.is_empty()
            && self.heap.0.is_empty()
            && self.far.is_empty()
            && self.occupied.iter().all(|&bits| bits == 0)
    }

    /// Puts a node with a value of 0 or more.
    #[inline]
    pub fn put(&mut self, value: f64, node: u32) {
        let bucket = ((value - self.start) * self.per_unit) as usize;
        if bucket <= self.open {
            self.heap.put(entry(value, node));
            if self.heap.0.len() > self.most_in_heap {
                self.make_narrower();
            }
        } else {
            self.put_later(bucket, entry(value, node));
        }
    }

    #[inline]
    fn put_later(&mut self, bucket: usize, entry: QueueEntry) {
        if bucket < BUCKETS {
            self.buckets[bucket].push(entry);
            self.occupied[bucket / 64] |= 1 << (bucket % 64);
        } else {
            self.far.push(entry);
        }
    }

    /// Takes the first node, with the value that it was put with. `is_wanted` may say of a node with a value
    /// that it is not wanted any more: it may be left out then.
    #[inline]
    pub fn take(&mut self, is_wanted: impl Fn(f64, u32) -> bool) -> Option<(f64, u32)> {
        loop {
            let first = match (self.sorted.last(), self.heap.0.first()) {
                (Some(sorted), Some(other)) if other < sorted => self.heap.take(),
                (Some(_), _) => self.sorted.pop(),
                (None, Some(_)) => self.heap.take(),
                (None, None) => None,
            };
            match first {
                Some(first) => return Some((value_of(first), node_of(first))),
                None if self.open_next(&is_wanted) => {}
                None => return None,
            }
        }
    }

    /// Opens the next bucket with entries. Returns whether there is one.
    fn open_next(&mut self, is_wanted: &impl Fn(f64, u32) -> bool) -> bool {
        let word = (self.open / 64..self.occupied.len()).find(|&word| self.occupied[word] != 0);
        let Some(word) = word else {
            let far = std::mem::take(&mut self.far);
            self.most_in_heap = MOST_IN_HEAP;
            return self.divide(far);
        };
        let bucket = 64 * word + self.occupied[word].trailing_zeros() as usize;
        self.occupied[word] &= self.occupied[word] - 1;
        self.open = bucket;
        let entries = self.buckets[bucket].drain(..);
        self.sorted.extend(entries.filter(|&entry| is_wanted(value_of(entry), node_of(entry))));
        self.sorted.sort_unstable_by(|a, b| b.cmp(a));
        true
    }

    /// Divides all entries among narrower buckets.
    #[cold]
    fn make_narrower(&mut self) {
        let mut all = std::mem::take(&mut self.far);
        all.append(&mut self.sorted);
        all.append(&mut self.heap.0);
        self.buckets.iter_mut().for_each(|bucket| all.append(bucket));
        self.occupied = [0; BUCKETS / 64];
        self.divide(all);
        self.most_in_heap = MOST_IN_HEAP.max(2 * self.heap.0.len());
    }

    /// Divides entries among buckets, whose width follows from those of the first half. All others must be
    /// empty. Returns whether there are any entries.
    #[cold]
    fn divide(&mut self, mut entries: Vec<QueueEntry>) -> bool {
        let Some(&first) = entries.iter().min() else { return false };
        let middle = entries.len() / 2;
        let (_, &mut half, _) = entries.select_nth_unstable(middle);
        self.start = value_of(first);
        let per_unit = (middle as f64 / IN_A_BUCKET) / (value_of(half) - self.start);
        self.per_unit = if per_unit.is_finite() { per_unit } else { 0.0 };
        self.open = 0;
        self.buckets.resize_with(BUCKETS, Vec::new);
        for entry in entries.drain(..) {
            let bucket = ((value_of(entry) - self.start) * self.per_unit) as usize;
            if bucket == 0 {
                self.heap.put(entry);
            } else {
                self.put_later(bucket, entry);
            }
        }
        if self.far.capacity() == 0 {
            // The memory is of use again.
            self.far = entries;
        }
        true
    }
}

/// A 4-ary heap: it has fewer levels than a binary one, and the four children of an entry are adjacent in
/// memory.
#[derive(Clone, Debug, Default)]
struct Heap(Vec<QueueEntry>);

impl Heap {
    #[inline]
    fn put(&mut self, entry: QueueEntry) {
        let mut hole = self.0.len();
        self.0.push(entry);
        while hole > 0 {
            let above = (hole - 1) / 4;
            if entry >= self.0[above] {
                break;
            }
            self.0[hole] = self.0[above];
            hole = above;
        }
        self.0[hole] = entry;
    }

    #[inline]
    fn take(&mut self) -> Option<QueueEntry> {
        let last = self.0.pop()?;
        let Some(&first) = self.0.first() else { return Some(last) };
        let entries = &mut self.0[..];
        let mut hole = 0;
        loop {
            let below = 4 * hole + 1;
            if below >= entries.len() {
                break;
            }
            let mut least = below;
            for n in below + 1..(below + 4).min(entries.len()) {
                if entries[n] < entries[least] {
                    least = n;
                }
            }
            if entries[least] >= last {
                break;
            }
            entries[hole] = entries[least];
            hole = least;
        }
        entries[hole] = last;
        Some(first)
    }
}

#[cfg(test)]
mod tests {
    use std::cell::RefCell;
    use std::collections::{BTreeSet, HashMap};

    use super::*;

    /// Values of one kind: few that are often equal, many, or of any size.
    fn value(random: &mut fastrand::Rng, kind: u32) -> f64 {
        match kind {
            0 => f64::from(random.u32(0..8)),
            1 => random.f64(),
            2 => libm::exp2(600.0 * (random.f64() - 0.5)),
            // Most are small, and some have no end.
            _ => [random.f64(), 1e18 * random.f64()][usize::from(random.u32(..10) == 0)],
        }
    }

    #[test]
    fn nodes_leave_in_the_order_of_their_values_and_numbers() {
        let mut random = fastrand::Rng::with_seed(1402);
        let mut queue = Queue::default();
        for (kind, count) in (0..4).flat_map(|kind| [0, 1, 5, 60, 3000].map(|count| (kind, count))) {
            queue.clear();
            let mut all: Vec<(f64, u32)> = (0..count).map(|node| (value(&mut random, kind), node)).collect();
            all.iter().for_each(|&(value, node)| queue.put(value, node));
            all.sort_by(|a, b| a.partial_cmp(b).unwrap());
            let taken: Vec<_> = std::iter::from_fn(|| queue.take(|_, _| true)).collect();
            assert_eq!(taken, all);
            assert!(queue.is_empty());
        }
    }

    /// Puts above what was taken last, as a march does, and now and then any value; entries of which a newer
    /// one is known are not wanted.
    #[test]
    fn a_queue_that_is_filled_while_nodes_leave_is_a_sorted_set() {
        let mut random = fastrand::Rng::with_seed(1403);
        let mut queue = Queue::default();
        let (mut in_buckets, mut in_heap) = (0, 0);
        for kind in (0..4).cycle().take(24) {
            queue.clear();
            let known = RefCell::new(HashMap::new());
            let (mut set, mut now, mut number) = (BTreeSet::new(), 0.0, 0);
            let most = [10, 400, 20_000][random.usize(..3)];
            let mut growing = true;
            for _ in 0..40_000 {
                growing = if set.len() > most { false } else { growing || set.is_empty() };
                for _ in 0..random.u32(..if growing { 5 } else { 2 }) {
                    let node = if random.bool() { number } else { random.u32(..number + 1) };
                    number += u32::from(node == number);
                    let step = value(&mut random, kind);
                    let value = if random.u32(..200) == 0 { step } else { now + step };
                    if let Some(old) = known.borrow_mut().insert(node, value) {
                        set.remove(&entry(old, node));
                    }
                    set.insert(entry(value, node));
                    queue.put(value, node);
                }
                let is_wanted = |value: f64, node: u32| known.borrow().get(&node) == Some(&value);
                let taken = loop {
                    let next = queue.take(is_wanted);
                    if next.is_none_or(|(value, node)| is_wanted(value, node)) {
                        break next;
                    }
                };
                assert_eq!(taken.map(|(value, node)| entry(value, node)), set.pop_first());
                in_buckets += queue.sorted.len();
                in_heap += queue.heap.0.len();
                let Some((value, node)) = taken else { continue };
                now = value;
                known.borrow_mut().remove(&node);
            }
        }
        assert!(in_buckets > 100_000 && in_heap > 100_000, "{in_buckets} {in_heap}");
    }
}
