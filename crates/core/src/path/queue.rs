//! A queue of nodes by value, then by number.

/// The nodes that wait, smallest value first; of equal values the node with the lower number.
///
/// A heap in which each entry has four below it: fewer levels than with two, and the four lie together. A
/// node is put again when its value falls; entries with an old value are skipped by whoever takes them.
#[derive(Clone, Debug, Default)]
pub(super) struct Queue {
    entries: Vec<Entry>,
}

#[derive(Clone, Copy, Debug)]
struct Entry {
    /// The bits of a number from 0 have its order.
    key: u64,
    node: u32,
}

impl Entry {
    #[inline]
    fn is_before(self, other: Self) -> bool {
        self.key < other.key || (self.key == other.key && self.node < other.node)
    }
}

impl Queue {
    pub fn clear(&mut self) {
        self.entries.clear();
    }

    pub fn is_empty(&self) -> bool {
        self.entries.is_empty()
    }

    /// Puts a node with a value of 0 or more.
    #[inline]
    pub fn put(&mut self, value: f64, node: u32) {
        let entry = Entry { key: value.to_bits(), node };
        let mut hole = self.entries.len();
        self.entries.push(entry);
        while hole > 0 {
            let above = (hole - 1) / 4;
            if !entry.is_before(self.entries[above]) {
                break;
            }
            self.entries[hole] = self.entries[above];
            hole = above;
        }
        self.entries[hole] = entry;
    }

    /// Takes the first node, with the value that it was put with.
    #[inline]
    pub fn take(&mut self) -> Option<(f64, u32)> {
        let last = self.entries.pop()?;
        let Some(&first) = self.entries.first() else { return Some((f64::from_bits(last.key), last.node)) };
        let entries = &mut self.entries[..];
        let mut hole = 0;
        loop {
            let below = 4 * hole + 1;
            if below >= entries.len() {
                break;
            }
            let mut least = below;
            for n in below + 1..(below + 4).min(entries.len()) {
                if entries[n].is_before(entries[least]) {
                    least = n;
                }
            }
            if !entries[least].is_before(last) {
                break;
            }
            entries[hole] = entries[least];
            hole = least;
        }
        entries[hole] = last;
        Some((f64::from_bits(first.key), first.node))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nodes_leave_in_the_order_of_their_values_and_numbers() {
        let mut random = fastrand::Rng::with_seed(1402);
        for count in 0..60 {
            let mut queue = Queue::default();
            let mut all: Vec<(f64, u32)> =
                (0..count).map(|node| (f64::from(random.u32(0..8)), node)).collect();
            random.shuffle(&mut all);
            all.iter().for_each(|&(value, node)| queue.put(value, node));
            all.sort_by(|a, b| a.partial_cmp(b).unwrap());
            let taken: Vec<_> = std::iter::from_fn(|| queue.take()).collect();
            assert_eq!(taken, all);
        }
    }
}
